// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <tuple>

namespace dielast::cases {
namespace {

std::string lines_of(const std::vector<Diagnostic>& diagnostics, std::size_t more) {
  std::string lines;
  for (const Diagnostic& diagnostic : diagnostics)
    lines += fmt::format("{}{}", lines.empty() ? "" : "\n", diagnostic.text());
  return more == 0 ? lines : fmt::format("{}\nand at least {} more errors", lines, more);
}

std::vector<Diagnostic> first_in_file(std::vector<Diagnostic> diagnostics) {
  std::stable_sort(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.source.line, a.source.column) < std::tie(b.source.line, b.source.column);
  });
  diagnostics.resize(std::min(diagnostics.size(), most_diagnostics));
  return diagnostics;
}

/// Those that first_in_file leaves out, and those that have been left out before.
std::size_t left_out(const std::vector<Diagnostic>& diagnostics, std::size_t before) {
  return before + std::max(diagnostics.size(), most_diagnostics) - most_diagnostics;
}

/// Optimal string alignment distance, blind to upper and lower case: a swap of neighbours is one mistake.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + !same(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

const std::string& FileName::text() const {
  static const std::string none;
  return name_ ? *name_ : none;
}

std::string Diagnostic::text() const {
  std::string place = source.file.text();
  if (source.line > 0) place += fmt::format(":{}:{}", source.line, source.column);
  return fmt::format("{}: {}: {}{}{}", place, severity == Severity::error ? "error" : "warning", key,
                     key.empty() ? "" : ": ", message);
}

CaseError::CaseError(std::vector<Diagnostic> diagnostics, std::size_t more)
    : std::runtime_error(lines_of(first_in_file(diagnostics), left_out(diagnostics, more))),
      diagnostics_(first_in_file(diagnostics)), more_(left_out(diagnostics, more)) {}

std::string called_here(std::string_view word, const std::vector<std::string>& names) {
  struct Word {
    std::string_view elsewhere, here;
  };
  static constexpr std::array words{Word{"offset", "mean"},
                                    Word{"bias", "mean"},
                                    Word{"omega", "frequency"},
                                    Word{"E", "youngs_modulus"},
                                    Word{"young_modulus", "youngs_modulus"},
                                    Word{"nu", "poisson_ratio"},
                                    Word{"mu", "shear_modulus"},
                                    Word{"G", "shear_modulus"},
                                    Word{"C1", "c1"},
                                    Word{"C10", "c1"},
                                    Word{"C01", "c2"},
                                    Word{"C20", "c2"},
                                    Word{"C30", "c3"},
                                    Word{"Jm", "stretch_limit"},
                                    Word{"J_m", "stretch_limit"},
                                    Word{"J_lim", "stretch_limit"},
                                    Word{"jlim", "stretch_limit"},
                                    Word{"tau", "relaxation_time"},
                                    Word{"eps_r", "relative_permittivity"},
                                    Word{"epsilon_r", "relative_permittivity"},
                                    Word{"dielectric_constant", "relative_permittivity"},
                                    Word{"epsilon", "permittivity"},
                                    Word{"rho", "density"},
                                    Word{"steps", "increments"},
                                    Word{"n_steps", "increments"}};
  for (const auto& [elsewhere, here] : words)
    if (elsewhere == word && std::ranges::find(names, here) != names.end())
      return fmt::format("; here it is \"{}\"", here);
  return "";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t longest_word = 100; // nobody mistypes that much; keeps the distance cheap
  std::string_view closest;
  std::size_t smallest = word.size() < 3 ? 1 : std::max<std::size_t>(1, word.size() / 3) + 1;
  if (word.size() <= longest_word)
    for (const std::string& name : names)
      if (const std::size_t distance = edit_distance(word, name); distance < smallest)
        smallest = distance, closest = name;
  return closest.empty() ? "" : fmt::format("; did you mean \"{}\"?", closest);
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    text += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", names[i]);
  return names.size() > most ? text + ", ..." : text;
}

} // namespace dielast::cases
