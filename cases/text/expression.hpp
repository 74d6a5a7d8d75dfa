// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace dielast::cases {

/// An expression cannot be evaluated; what() says why.
class ExpressionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Names in an expression: variables, functions and units, in their order.
std::vector<std::string> names_in(const std::string& expression);

/// The functions and the constant that an expression may use.
const std::vector<std::string>& expression_functions();

/// Whether a name is a function's or a unit's, so that no variable may have it.
bool is_reserved_in_expressions(const std::string& name);

/// The TOML text of an expression's value, such as "10 / l1" or "film.thickness / 2 + 1*mm". `variables` has
/// values as they stand in TOML: numbers, or texts such as "8 mm". Units are factors. The value comes with
/// the SI unit that follows from those of the expression, whose terms must agree in it: "0.005 m". Angles
/// have a unit, too; sin(), cos() and tan() take one, asin(), acos() and atan() give one. Throws
/// ExpressionError.
std::string evaluate(const std::string& expression, const std::map<std::string, std::string>& variables);

} // namespace dielast::cases
