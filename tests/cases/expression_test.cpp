// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/expression.hpp"

#include "cases/text/units.hpp"

#include <gtest/gtest.h>

namespace dielast::cases::expression_test {
namespace {

using Variables = std::map<std::string, std::string>;

std::string problem_of(const std::string& expression, const Variables& variables = {}) {
  try {
    return "no problem: " + evaluate(expression, variables);
  } catch (const ExpressionError& error) {
    return error.what();
  }
}

TEST(Expression, NumbersStayNumbers) {
  EXPECT_EQ(evaluate("10 / l1", {{"l1", "4"}}), "2.5");
  EXPECT_EQ(evaluate("-l1^2 + 1e-3", {{"l1", "2"}}), "-3.999");
  EXPECT_EQ(evaluate("abs(-n) * 2", {{"n", "5"}}), "10");
  EXPECT_EQ(evaluate("l1 - 4", {{"l1", "4"}}), "0");
}

TEST(Expression, UnitsFollowFromThoseWithin) {
  const Variables variables{
      {"film.thickness", "\"1 mm\""}, {"angle", "\"150 deg\""}, {"field", "\"20 V/um\""}};
  EXPECT_EQ(evaluate("film.thickness / 2", variables), "\"0.0005 m\"");
  EXPECT_EQ(evaluate("film.thickness + 2*mm", variables), "\"0.003 m\"");
  EXPECT_EQ(evaluate("field * film.thickness", variables), "\"20000 V\"");
  EXPECT_EQ(evaluate("field / (4*MV/m)", variables), "5");
  EXPECT_EQ(evaluate("sqrt(film.thickness * 9*mm)", variables), "\"0.003 m\"");
  EXPECT_EQ(evaluate("film.thickness - 1*mm", variables), "\"0 m\"");
  EXPECT_EQ(evaluate("film.thickness * sin(angle)", variables), "\"0.0005 m\"");
  EXPECT_NEAR(written_measure(evaluate("atan(1) + 15*deg", variables))->number, 1.0471975511966, 1e-12);
  EXPECT_EQ(written_measure(evaluate("atan(1)", variables))->unit, "rad");
}

TEST(Expression, TermsMustAgreeInTheirUnits) {
  const std::string disagree = "adds or compares what has different units, or takes a function of it";
  EXPECT_EQ(problem_of("t + 2", {{"t", "\"1 mm\""}}), disagree);
  EXPECT_EQ(problem_of("exp(t)", {{"t", "\"1 mm\""}}), disagree);
  const std::string angles = disagree + "; angles have a unit, too: sin(30*deg), cos(pi/2*rad)";
  EXPECT_EQ(problem_of("sin(2)"), angles);
  EXPECT_EQ(problem_of("1 + sin(pi/2)"), angles);
  EXPECT_EQ(evaluate("1 + sin(pi/2*rad)", {}), "2");
}

TEST(Expression, SaysWhatIsWrong) {
  EXPECT_EQ(problem_of("10 / (l1 - 2)", {{"l1", "2"}}), "is not a finite number");
  EXPECT_EQ(problem_of("l11", {{"l1", "2"}}),
            "has \"l11\", which is neither a varied key nor a unit nor a function; did you mean \"l1\"?");
  EXPECT_EQ(problem_of("name", {{"name", "\"soft\""}}), "has name, which is \"soft\", no number");
  EXPECT_EQ(problem_of("1, 2"), "is more than one value; a list has brackets");
  EXPECT_TRUE(problem_of("2 mm").starts_with("cannot be read: ")) << problem_of("2 mm");
  EXPECT_EQ(problem_of("l1 = 3", {{"l1", "2"}}), "has \"=\", which no expression has");
  EXPECT_EQ(problem_of("l1 > 3 ? 2 : l1", {{"l1", "2"}}), "has \">\", which no expression has");
  EXPECT_TRUE(problem_of("").starts_with("cannot be read: "));
}

// What has a unit in the table must be had back from its powers: the product of both is what a key gets.
TEST(Expression, UnitsOfTheLanguageAreProductsOfBaseUnits) {
  for (const Dimension& one : dimensions()) {
    const SiUnit unit = si_unit(std::string(one.unit));
    EXPECT_EQ(unit.factor, 1) << one.unit;
    EXPECT_EQ(parse_measure("2 " + name_of_unit(unit.powers), one.unit).value, 2) << one.unit;
  }
  EXPECT_EQ(si_unit("%").factor, 0.01);
  EXPECT_EQ(si_unit("kV/mm").factor, 1e6);
  EXPECT_THROW(si_unit("celsius"), UnitError);
}

} // namespace
} // namespace dielast::cases::expression_test
