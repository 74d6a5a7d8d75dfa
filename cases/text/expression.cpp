// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/expression.hpp"

#include "cases/text/tree.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

namespace dielast::cases {
namespace {

/// Sizes of the base units, for the value in SI and for those that tell its unit, see powers_of_value(). An
/// angle's is known to functions that have no other argument.
using BaseSizes = std::array<double, base_units.size()>;
constexpr std::size_t angle = base_units.size() - 1;
constexpr double other_angle = 1.37;

template<bool other>
constexpr double angle_size = other ? other_angle : 1.0;

template<bool other>
void define_functions(mu::Parser& parser) {
  parser.ClearFun();
  parser.ClearConst();
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineFun(
      "sin", +[](double x) { return std::sin(x / angle_size<other>); });
  parser.DefineFun(
      "cos", +[](double x) { return std::cos(x / angle_size<other>); });
  parser.DefineFun(
      "tan", +[](double x) { return std::tan(x / angle_size<other>); });
  parser.DefineFun(
      "asin", +[](double x) { return std::asin(x) * angle_size<other>; });
  parser.DefineFun(
      "acos", +[](double x) { return std::acos(x) * angle_size<other>; });
  parser.DefineFun(
      "atan", +[](double x) { return std::atan(x) * angle_size<other>; });
  parser.DefineFun(
      "sqrt", +[](double x) { return std::sqrt(x); });
  parser.DefineFun(
      "exp", +[](double x) { return std::exp(x); });
  parser.DefineFun(
      "ln", +[](double x) { return std::log(x); });
  parser.DefineFun(
      "log10", +[](double x) { return std::log10(x); });
  parser.DefineFun(
      "abs", +[](double x) { return std::abs(x); });
}

/// Whether the units that people write have this one, alone or within another: MV of "MV/m".
bool is_unit_name(const std::string& name) {
  return std::ranges::any_of(dimensions(), [&](const Dimension& one) {
    const std::vector<std::string> units = names_in(std::string(one.usual));
    return std::ranges::find(units, name) != units.end();
  });
}

/// A quantity by its number in SI and the powers of the base units.
struct Quantity {
  double number = 0;
  BasePowers powers{};
};

/// Every name of the expression that stands for a quantity.
std::map<std::string, Quantity> quantities_of(const std::string& expression,
                                              const std::map<std::string, std::string>& variables) {
  std::map<std::string, Quantity> found;
  const auto& functions = expression_functions();
  for (const std::string& name : names_in(expression)) {
    if (std::ranges::find(functions, name) != functions.end()) continue;
    if (const auto variable = variables.find(name); variable != variables.end()) {
      const auto written = written_measure(variable->second);
      if (!written)
        throw ExpressionError(fmt::format("has {}, which is {}, no number", name, variable->second));
      try {
        const SiUnit unit = si_unit(written->unit);
        found[name] = {written->number * unit.factor, unit.powers};
      } catch (const UnitError& error) {
        throw ExpressionError(fmt::format("has {}, which is {}, {}", name, variable->second, error.what()));
      }
    } else if (is_unit_name(name)) {
      const SiUnit unit = si_unit(name);
      found[name] = {unit.factor, unit.powers};
    } else {
      std::vector<std::string> known = functions;
      for (const auto& entry : variables) known.push_back(entry.first);
      throw ExpressionError(
          fmt::format("has \"{}\", which is neither a varied key nor a unit nor a function{}", name,
                      did_you_mean(name, known)));
    }
  }
  return found;
}

/// The expression's value where the base units have these sizes.
double value_of(const std::string& expression, const std::map<std::string, Quantity>& quantities,
                const BaseSizes& sizes) {
  try {
    mu::Parser parser;
    parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    if (sizes[angle] == 1.0)
      define_functions<false>(parser);
    else
      define_functions<true>(parser);
    for (const auto& [name, quantity] : quantities) {
      double number = quantity.number;
      for (std::size_t i = 0; i < sizes.size(); ++i) number *= std::pow(sizes[i], quantity.powers[i]);
      parser.DefineConst(name, number);
    }
    parser.SetExpr(expression);
    const double value = parser.Eval();
    if (parser.GetNumResults() != 1) throw ExpressionError("is more than one value; a list has brackets");
    return value;
  } catch (const mu::Parser::exception_type& error) {
    std::string message = error.GetMsg();
    while (message.ends_with('.')) message.pop_back();
    throw ExpressionError(fmt::format("cannot be read: {}; units are factors, as in 2*mm", message));
  }
}

/// Powers of the base units in the value: what it is multiplied by when a base unit has another size. Nothing
/// when the terms of the expression do not agree.
std::optional<BasePowers> powers_of_value(const std::string& expression,
                                          const std::map<std::string, Quantity>& quantities, double value) {
  BasePowers powers{};
  BaseSizes all;
  all.fill(1.0);
  constexpr BaseSizes other{1.21, 1.73, 1.57, 1.93, other_angle};
  constexpr double round_off = 1e-7;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    BaseSizes sizes;
    sizes.fill(1.0);
    sizes[i] = all[i] = other[i];
    const double power = std::log(value_of(expression, quantities, sizes) / value) / std::log(other[i]);
    powers[i] = std::round(2 * power) / 2;
    if (!(std::abs(power - powers[i]) < round_off)) return std::nullopt;
  }
  double expected = value;
  for (std::size_t i = 0; i < powers.size(); ++i) expected *= std::pow(other[i], powers[i]);
  const double found = value_of(expression, quantities, all);
  return std::abs(found - expected) <= round_off * std::abs(expected) ? std::optional(powers) : std::nullopt;
}

} // namespace

std::vector<std::string> names_in(const std::string& expression) {
  std::vector<std::string> names;
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; };
  for (std::size_t i = 0; i < expression.size();) {
    const auto c = static_cast<unsigned char>(expression[i]);
    std::size_t end = i + 1;
    if (is_letter(c)) {
      while (end < expression.size() && (is_letter(static_cast<unsigned char>(expression[end])) ||
                                         is_digit(static_cast<unsigned char>(expression[end]))))
        ++end;
      names.push_back(expression.substr(i, end - i));
    } else if (is_digit(c)) { // the e of 1e-3 is no name
      while (end < expression.size() && is_digit(static_cast<unsigned char>(expression[end]))) ++end;
      if (end + 1 < expression.size() && (expression[end] == 'e' || expression[end] == 'E') &&
          std::string_view("+-0123456789").find(expression[end + 1]) != std::string_view::npos)
        ++end;
    }
    i = end;
  }
  return names;
}

const std::vector<std::string>& expression_functions() {
  static const std::vector<std::string> names{"sin",  "cos", "tan", "asin", "acos",  "atan",
                                              "sqrt", "exp", "ln",  "abs",  "log10", "pi"};
  return names;
}

bool is_reserved_in_expressions(const std::string& name) {
  return is_unit_name(name) ||
         std::ranges::find(expression_functions(), name) != expression_functions().end();
}

std::string evaluate(const std::string& expression, const std::map<std::string, std::string>& variables) {
  if (const std::size_t at = expression.find_first_of("<>=!&|?:"); at != std::string::npos)
    throw ExpressionError(fmt::format("has \"{}\", which no expression has", expression[at]));
  std::map<std::string, Quantity> quantities = quantities_of(expression, variables);
  BaseSizes si;
  si.fill(1.0);
  const double value = value_of(expression, quantities, si);
  if (!std::isfinite(value)) throw ExpressionError("is not a finite number");
  double telling = value;
  for (int attempt = 1; telling == 0 && attempt < 4; ++attempt) { // 0 has every unit: look beside it
    double shift = 0.1 * attempt;
    for (auto& [name, quantity] : quantities)
      if (variables.contains(name))
        quantity.number = (quantity.number + 0.1 * attempt) * (1 + (shift += 0.07));
    telling = value_of(expression, quantities, si);
  }
  const auto powers =
      telling == 0 ? std::optional(BasePowers{}) : powers_of_value(expression, quantities, telling);
  if (!powers) {
    const std::vector<std::string> names = names_in(expression);
    const bool turns = std::ranges::any_of(
        names, [](const auto& name) { return name == "sin" || name == "cos" || name == "tan"; });
    throw ExpressionError(
        std::string("adds or compares what has different units, or takes a function of it") +
        (turns ? "; angles have a unit, too: sin(30*deg), cos(pi/2*rad)" : ""));
  }
  const std::string unit = name_of_unit(*powers);
  const std::string number = fmt::format("{:.15g}", value + 0.0);
  return unit.empty() ? number : toml_string(fmt::format("{} {}", number, unit));
}

} // namespace dielast::cases
