// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/study_spec.hpp"

#include "cases/text/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace dielast::cases {

std::vector<std::string> Study::varied() const {
  std::vector<std::string> names;
  for (const StudyAxis& axis : axes) names.push_back(axis.key);
  for (const DerivedKey& one : derived) names.push_back(one.key);
  return names;
}

std::size_t Study::column(const std::string& quantity) const {
  return static_cast<std::size_t>(std::ranges::find(collect, quantity) - collect.begin());
}

bool Study::goes_together(const std::string& axis) const {
  return std::ranges::find(pair, axis) != pair.end();
}

bool Study::is_parameter(const std::string& axis) const {
  return std::ranges::find(parameters, axis) != parameters.end();
}

std::vector<std::vector<std::string>> grid_of(const Study& study) {
  std::vector<std::vector<std::string>> grid{std::vector<std::string>(study.axes.size())};
  bool paired = false;
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    std::vector<std::size_t> together{a};
    if (study.goes_together(study.axes[a].key)) {
      if (std::exchange(paired, true)) continue;
      for (std::size_t b = a + 1; b < study.axes.size(); ++b)
        if (study.goes_together(study.axes[b].key)) together.push_back(b);
    }
    std::vector<std::vector<std::string>> finer;
    for (const auto& values : grid)
      for (std::size_t v = 0; v < study.axes[a].values.size(); ++v) {
        finer.push_back(values);
        for (const std::size_t b : together) finer.back()[b] = study.axes[b].values[v];
      }
    grid = std::move(finer);
  }
  return grid;
}

std::vector<std::string> derived_values(const Study& study, const std::vector<std::string>& axis_values) {
  std::map<std::string, std::string> variables;
  for (std::size_t a = 0; a < study.axes.size(); ++a) variables[study.axes[a].key] = axis_values[a];
  std::vector<std::string> values;
  for (const DerivedKey& one : study.derived) {
    std::vector<std::string> items;
    for (const std::string& expression : one.expressions) {
      try {
        items.push_back(evaluate(expression, variables));
      } catch (const ExpressionError& error) {
        std::string where;
        for (const std::string& name : names_in(expression))
          if (const auto variable = variables.find(name); variable != variables.end())
            where += fmt::format("{}{} = {}", where.empty() ? ", where " : ", ", name, variable->second);
        throw ExpressionError(fmt::format("{}: \"{}\" {}{}", one.key, expression, error.what(), where));
      }
    }
    values.push_back(one.is_list ? fmt::format("[{}]", fmt::join(items, ", ")) : items.at(0));
  }
  return values;
}

} // namespace dielast::cases
