// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"

#include "cases/readers/case_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

/// Keys that say how a case is computed, not which device it is.
bool keeps_the_device(std::string_view assignment) {
  for (const std::string_view how : {"model=", "mesh.", "solver.", "output.", "check", "quantity", "title"})
    if (assignment.starts_with(how)) return !assignment.starts_with("mesh.file");
  const std::string_view key = std::string_view(assignment).substr(0, assignment.find('='));
  return key.starts_with("step") && key.ends_with(".increments");
}

Case read(const std::filesystem::path& path, const std::vector<std::string>& overrides, bool to_linearise) {
  Node tree = read_case_file(path);
  std::vector<Diagnostic> wrong;
  std::size_t more = 0;
  const auto gather = [&](const CaseError& error) {
    wrong.insert(wrong.end(), error.diagnostics().begin(), error.diagnostics().end());
    more += error.more();
  };
  for (const std::string& assignment : overrides) {
    try {
      override_case(tree, assignment);
    } catch (const CaseError& error) {
      gather(error);
    }
  }
  if (to_linearise && !tree.find("linearise")) tree.add("linearise", {}).source = tree.source;
  try {
    Case one = interpret(std::move(tree), path);
    if (!std::all_of(overrides.begin(), overrides.end(), keeps_the_device)) {
      one.skipped_checks = static_cast<int>(one.checks.size());
      one.checks.clear();
    }
    if (wrong.empty()) return one;
  } catch (const CaseError& error) {
    gather(error);
  }
  throw CaseError(wrong, more);
}

} // namespace

Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return read(path, overrides, false);
}

Case read_case_to_linearise(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return read(path, overrides, true);
}

void check_places(const Case& one, const std::vector<std::string>& places) {
  std::vector<Diagnostic> unknown;
  for (const Mention& mention : one.places)
    if (std::find(places.begin(), places.end(), mention.name) == places.end())
      unknown.push_back(
          {mention.source, mention.key,
           fmt::format("found {}: the mesh has no such place, allowed {}{}", toml_string(mention.name),
                       listed(places), did_you_mean(mention.name, places))});
  if (!unknown.empty()) throw CaseError(unknown);
}

} // namespace dielast::cases
