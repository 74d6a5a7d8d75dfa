// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/fit_spec.hpp"
#include "cases/language/schema.hpp"

namespace dielast::cases {
namespace {

Section fit_section() {
  Section section;
  section.name = "fit";
  section.meaning = "a fit of the film's material to measured tests, run by `dielast fit`";
  section.presence = Section::Presence::separate;
  section.access = same_object();
  section.keys = {
      text(
          "parameters", to(&Fit::parameters),
          "what the fit changes, such as \"shear_modulus\" of the law, \"viscosity\" and "
          "\"branch[1].relaxation_time\" (or \"branch[1].viscosity\": the branch keeps that of the two which "
          "is named here or given with the material); without it everything")
          .values(1, 100)
          .optional(),
      number(
          "range", to(&Fit::range),
          "largest factor between start value and result, either way: the bounds of every parameter; of one "
          "that may have any sign, of its size, which may fall to 0")
          .above(1)
          .at_most(1e6)
          .otherwise("1e4"),
      integer(
          "max_iterations", to(&Fit::max_iterations),
          "iterations before an attempt gives up; a fit that does not converge, that ends at a bound or that "
          "has relaxation times or exponents is tried again, from other starts")
          .at_least(1)
          .at_most(10000)
          .otherwise("200"),
  };
  return section;
}

Section test_section() {
  Section section =
      list_section("test", "a measured test of a fit: rows of a CSV file, nominal stress against stretch",
                   each(&Fit::tests));
  section.presence = Section::Presence::separate;
  section.keys = {
      text("file", to(&FitTest::file), "CSV file; its path starts at this file's folder"),
      word("kind",
           {{"uniaxial", "one axis is pulled, the others are free", materials::Mode::uniaxial},
            {"pure shear", "one axis is pulled, the width is held", materials::Mode::pure_shear},
            {"equal-biaxial",
             "two axes are pulled alike; where nominal dashpots flow along one of them alone, the stress is "
             "the mean of both",
             materials::Mode::equal_biaxial}},
           to(&FitTest::kind), "how the film is held"),
      text("stretch", to(&FitTest::stretch_column),
           "column of the stretch, a number that is 1 in the undeformed film; without it \"stretch\"")
          .optional(),
      text("stress", to(&FitTest::stress_column),
           "column of the nominal stress, with the unit in its name as in \"P_kPa\" or \"stress (MPa)\"; "
           "without it the only "
           "one "
           "that ends in a unit of stress")
          .optional(),
      text(
          "strain", to(&FitTest::strain_column),
          "column of the nominal strain, stretch - 1, in percent where its name says so (%, percent or pct), "
          "instead of the stretch")
          .optional(),
      text("displacement", to(&FitTest::displacement_column),
           "column of the specimen's elongation, with a unit of length in its name, instead of the stretch; "
           "needs "
           "length")
          .optional(),
      measure("length", "m", to(&FitTest::length), "length of the undeformed specimen").above(0).optional(),
      text("force", to(&FitTest::force_column),
           "column of the force, with a unit of force in its name, instead of the stress; needs area")
          .optional(),
      measure("area", "m^2", to(&FitTest::area), "cross-section of the undeformed specimen")
          .above(0)
          .optional(),
      text("time", to(&FitTest::time_column),
           "column of the time since the film was undeformed; without it \"time_s\" or "
           "\"time (min)\" and the like where there is one")
          .optional(),
      measure("rate", "1/s", to(&FitTest::rate),
              "stretch per time between all rows, up and down, of a file without a column of time")
          .above(0)
          .optional(),
      flag("equilibrium", to(&FitTest::equilibrium), "infinitely slow: the branches carry nothing")
          .otherwise("false"),
      flag("zero", to(&FitTest::zero),
           "the first row is the origin: all stretches, strains and stresses are less by its own, so that "
           "its stretch counts as 1 and its stress as 0")
          .otherwise("false"),
      word("use",
           {{"fit", "the material is fitted to it", false},
            {"predict", "kept out of the fit; how well it is predicted is reported", true}},
           to(&FitTest::predict), "what it is for")
          .otherwise("fit"),
      number("weight", to(&FitTest::weight), "of its errors, which are relative to its largest stress")
          .above(0)
          .otherwise("1"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& test = *static_cast<const FitTest*>(object);
    const auto given = [](const std::string& column) { return column.empty() ? 0 : 1; };
    if (given(test.stretch_column) + given(test.strain_column) + given(test.displacement_column) > 1)
      return Conflict{test.strain_column.empty() ? "displacement" : "strain",
                      "given twice: write one of stretch, strain and displacement"};
    if (given(test.stress_column) + given(test.force_column) > 1)
      return Conflict{"force", "given twice: write either stress or force"};
    if (given(test.displacement_column) != (test.length ? 1 : 0))
      return Conflict{"length", "displacement and length need each other"};
    if (given(test.force_column) != (test.area ? 1 : 0))
      return Conflict{"area", "force and area need each other"};
    if (test.rate && !test.time_column.empty()) return Conflict{"rate", "the column of the time says it"};
    if (test.equilibrium && test.rate) return Conflict{"rate", "in equilibrium there is no rate"};
    if (test.equilibrium && !test.time_column.empty())
      return Conflict{"time", "in equilibrium there is no time"};
    return std::nullopt;
  };
  return section;
}

} // namespace

std::vector<Section> fit_sections() { return {fit_section(), test_section()}; }

} // namespace dielast::cases
