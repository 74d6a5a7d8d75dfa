// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/rational_spec.hpp"
#include "cases/tables/motion_keys.hpp"

namespace dielast::cases {
namespace {

std::vector<Choice> responses() {
  return {{"displacement", "of the harmonic step's quantity per squared volt of the source (m/V^2)",
           MeasuredResponse::displacement},
          {"impedance", "that the source sees (Ohm)", MeasuredResponse::impedance},
          {"admittance", "that the source sees (S)", MeasuredResponse::admittance}};
}

int place(CircuitElement element) { return static_cast<int>(element); }

} // namespace

Section rational_section() {
  Section section =
      list_section("rational",
                   "a rational function of s, or the circuit of an electrode, fitted to a measured response "
                   "without a case, by `dielast fit`",
                   each(&RationalFits::fits));
  section.presence = Section::Presence::separate;
  section.keys = {
      text("file", to(&RationalFit::file), "CSV file as of an [[identify.test]]"),
      word("response", responses(), to(&RationalFit::response), "what was measured"),
      integer("poles", to_part<RationalFit>([](auto& fit) -> auto& { return fit.order.poles; }),
              "degree of the denominator")
          .at_least(1)
          .at_most(20),
      integer("zeros", to_part<RationalFit>([](auto& fit) -> auto& { return fit.order.zeros; }),
              "degree of the numerator")
          .at_least(0)
          .at_most(20)
          .otherwise("0"),
      word("circuit",
           {{"resistance", "in series, of leads and electrodes", place(CircuitElement::resistance)},
            {"leakage_resistance", "beside the capacitance, through the film",
             place(CircuitElement::leakage_resistance)},
            {"capacitance", "of the film", place(CircuitElement::capacitance)}},
           flags(&RationalFit::elements), "the elements of an electrode's circuit, instead of a degree")
          .values(1, 3)
          .replacing("poles"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& fit = *static_cast<const RationalFit*>(object);
    if (!fit.is_circuit()) {
      if (fit.order.zeros <= fit.order.poles) return std::nullopt;
      return Conflict{"zeros", "more zeros than poles: such a response grows with the frequency for ever"};
    }
    if (fit.order.zeros > 0) return Conflict{"zeros", "a circuit has its own"};
    if (fit.response == MeasuredResponse::displacement)
      return Conflict{"circuit", "it has an impedance or an admittance, and no displacement"};
    if (!fit.elements[static_cast<std::size_t>(place(CircuitElement::capacitance))])
      return Conflict{"circuit", "an electrode has a capacitance"};
    return std::nullopt;
  };
  return section;
}

Section identify_section() {
  Section test =
      list_section("test", "what was measured on the device, a CSV file", each(&Identification::tests));
  test.keys = {
      text("file", to(&DeviceTest::file), "CSV file; its path starts at this file's folder"),
      text("quantity", to(&DeviceTest::quantity),
           "quantity of the case whose column the file has, against its first column: \"time\" or another "
           "column of the run's history. The run stops at each of its values. A value that the column keeps "
           "is "
           "that of the state in which the column begins to move, or comes to rest for the rest of the run"),
      text("step", to(&DeviceTest::step),
           "the step of the case in which it was measured, where the run comes to the same value in several, "
           "or has several of kind \"harmonic\"; a value that a column keeps all through it is that of its "
           "end")
          .optional(),
      word(
          "at_jump",
          {{"before", "in the state before", AtJump::before}, {"after", "in the state after", AtJump::after}},
          to(&DeviceTest::at_jump),
          "where rows lie at the instant of a jump (a wave's, or of a step that takes no time): what was "
          "measured there")
          .optional(),
      word("response", responses(), to(&DeviceTest::response),
           "of the case's step of kind \"harmonic\", instead of a quantity: columns \"frequency\", and "
           "\"real\" and \"imaginary\" or \"magnitude\" and \"phase[deg]\" (or [rad])")
          .replacing("quantity"),
      word("use",
           {{"fit", "the unknowns are fitted to it", false},
            {"predict", "kept out of the fit; how well it is predicted is reported", true}},
           to(&DeviceTest::predict), "what it is for")
          .otherwise("fit"),
      number("weight", to(&DeviceTest::weight),
             "of its errors, which are relative: to the largest value, of a response to each")
          .above(0)
          .otherwise("1"),
  };
  Section set;
  set.name = "set";
  set.meaning = "keys that have another value than in the case in this test, as \"weight.mass\" = \"35 g\"";
  set.presence = Section::Presence::separate;
  test.sections = {set};
  Section section;
  section.name = "identify";
  section.meaning = "keys of a case are fitted to what was measured on the device, by `dielast fit`";
  section.presence = Section::Presence::separate;
  section.access = same_object();
  section.keys = {
      text("unknowns", to(&Identification::keys),
           "keys of the case, which has their start values, such as \"film.material.shear_modulus\"")
          .values(1, 100),
      number(
          "range", to(&Identification::range),
          "largest factor between start value and result; where a result lies at it, the tests do not tell")
          .above(1)
          .at_most(1e6)
          .otherwise("1e3"),
      integer("max_iterations", to(&Identification::max_iterations), "iterations before the fit gives up")
          .at_least(1)
          .at_most(1000)
          .otherwise("50"),
  };
  Section start;
  start.name = "start";
  start.meaning = "start values of unknowns other than the case's";
  start.presence = Section::Presence::separate;
  section.sections = {start, test};
  return section;
}

} // namespace dielast::cases
