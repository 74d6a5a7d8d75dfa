// SPDX-License-Identifier: GPL-3.0-or-later
// Identification of whole devices: what was put into a run is found again, and what cannot be is told.
#include "cases/case/quantities.hpp"
#include "cases/fits/device_model.hpp"
#include "cases/fits/identify.hpp"
#include "cases/readers/identify_reader.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

namespace dielast::cases::identify_test {
namespace {

const std::string stack = R"toml(
[film]
thickness = "50 um"
[film.material]
shear_modulus = "0.4 MPa"
viscosity = "150 Pa.s"
relative_permittivity = 2.5
[strip]
length = "12 mm"
width = "13 mm"
layers = 10
[weight]
mass = "50 g"
[circuit]
resistance = "100 kOhm"
[drive]
voltage = "1 kV"
[mesh]
across = 2
[[step]]
kind = "weight"
[[step]]
kind = "voltage"
[[step]]
kind = "harmonic"
points = 2
)toml";

class Identify : public test::ScratchTest {
 protected:
  Identify() { write("stack.toml", stack); }

  void write_test(const std::string& unknowns, const std::string& tests) const {
    write("identify.toml", "case = \"stack.toml\"\n[identify]\nunknowns = [" + unknowns + "]\n" + tests);
  }
  std::string message() const {
    try {
      solve_identification(read_identification(directory / "identify.toml"), 2, {});
    } catch (const CaseError& error) {
      const std::string text = error.what();
      return text.substr(text.find("error: "));
    }
    return "";
  }
};

const std::string displacement = "[[identify.test]]\nfile = \"g.csv\"\nresponse = \"displacement\"\n";

// Static curve, held-out response and start values of its own; the tables come from runs with other values.
TEST_F(Identify, FindsWhatWasPutIn) {
  write("v.csv", "voltage[V],stroke[mm]\n200,0\n400,0\n600,0\n800,0\n1000,0\n");
  write("g.csv", "frequency[Hz],real[m/V^2],imaginary[m/V^2]\n1,1,0\n10,1,0\n20,1,0\n30,1,0\n");
  write("z.csv", "frequency[Hz],magnitude[kOhm],phase[deg]\n10,1,0\n100,1,0\n1000,1,0\n");
  const std::string tests =
      "[identify.start]\n\"film.material.shear_modulus\" = \"300 kPa\"\n"
      "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"stroke\"\n" +
      displacement + "set = { \"weight.mass\" = \"30 g\" }\n" +
      "[[identify.test]]\nfile = \"z.csv\"\nresponse = \"impedance\"\nuse = \"predict\"\n";
  write_test("\"film.material.shear_modulus\", \"film.material.viscosity\"", tests);
  write("v.csv", "voltage[V],stroke[mm]\n200,1\n400,1\n600,1\n800,1\n1000,1\n");
  Identification asked = read_identification(directory / "identify.toml");
  EXPECT_TRUE(asked.tests[0].bare.empty());
  write("v.csv", "voltage,stroke[mm]\n200,1\n400,1\n600,1\n800,1\n1000,1\n");
  const Identification bare = read_identification(directory / "identify.toml");
  EXPECT_EQ(bare.tests[0].bare, std::vector<std::string>{"voltage (V)"});
  EXPECT_EQ(asked.unknowns[0].start, 300);
  EXPECT_EQ(asked.unknowns[0].unit, "kPa");
  const DeviceModel device(asked);
  ASSERT_EQ(device.run_count(), 2u);
  for (std::size_t run = 0; run < 2; ++run) {
    const std::vector<double> truth = device.run(run, {500, 200});
    std::size_t at = 0;
    for (const std::size_t t : device.tests_of(run))
      for (auto& value : asked.tests[t].measured) {
        const double real = truth[at++];
        value = {real, asked.tests[t].is_response() ? truth[at++] : 0.0};
      }
  }
  const IdentifyOutcome found = solve_identification(asked, 2, {});
  EXPECT_EQ(found.ending, FitEnding::converged);
  EXPECT_NEAR(found.unknowns[0].value, 500, 1e-3);
  EXPECT_NEAR(found.unknowns[1].value, 200, 1e-2);
  for (const double error : found.errors) EXPECT_LT(error, 1e-4);
}

// Where something was measured the run stops, however few increments the case takes: between them a limit
// point's neighbourhood is no straight line.
TEST_F(Identify, TakesTheRunWhereItWasMeasured) {
  const std::string patch =
      "[film]\nthickness = \"1 mm\"\n[film.material]\nlaw = \"gent\"\nshear_modulus = \"50 kPa\"\n"
      "stretch_limit = 20\npermittivity = \"4e-11 F/m\"\n[patch]\n[[quantity]]\nname = \"Q\"\n"
      "kind = \"charge\"\nof = \"film\"\n[drive]\n";
  const std::string ramp = "voltage = \"20 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = ";
  const std::string wave = "voltage = { wave = \"sine\", mean = \"9 kV\", amplitude = \"6 kV\", frequency "
                           "= \"1 Hz\" }\n[[step]]\nkind = \"transient\"\nduration = \"0.2 s\"\n"
                           "increments = ";
  struct Measured {
    std::string drive, against, quantity;
  };
  for (const Measured& each :
       {Measured{ramp, "voltage[V]", "Q[C]"}, Measured{ramp, "Q[C]", "stretch_x"},
        Measured{wave, "time[s]", "Q[C]"}, Measured{wave, "voltage[V]", "stretch_x"}}) {
    write("stack.toml", patch + each.drive + "150\n");
    const Case fine = read_case(directory / "stack.toml");
    const std::vector<post::Column> columns = history_columns(fine);
    const auto place = [&](const std::string& name) {
      const auto found = std::ranges::find(columns, name.substr(0, name.find('[')), &post::Column::name);
      return static_cast<std::size_t>(found - columns.begin());
    };
    std::string table = each.against + "," + each.quantity + "\n";
    Simulation simulation(fine, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      std::vector<double> row{frame.record.load_factor, frame.record.time};
      row.insert(row.end(), frame.record.voltages.begin(), frame.record.voltages.end());
      row.insert(row.end(), frame.values.begin(), frame.values.end());
      if (frame.record.index % 7 == 3)
        table += fmt::format("{:.17g},{:.17g}\n", row[place(each.against)], row[place(each.quantity)]);
      return true;
    };
    ASSERT_EQ(simulation.run(observer).ending, Ending::complete);
    write("v.csv", table);
    write("stack.toml", patch + each.drive + "4\n");
    write_test("\"film.material.shear_modulus\"", "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"" +
                                                      each.quantity.substr(0, each.quantity.find('[')) +
                                                      "\"\n");
    const Identification asked = read_identification(directory / "identify.toml");
    const std::vector<double> model = DeviceModel(asked).run(0, {50});
    ASSERT_EQ(model.size(), asked.tests[0].measured.size());
    for (std::size_t row = 0; row < model.size(); ++row)
      EXPECT_NEAR(model[row], asked.tests[0].measured[row].real(), 1e-6 * std::abs(model[row]))
          << each.against << " " << row;
  }
}

/// The model's values of the only test, with the unknown at `value`.
std::vector<double> model_of(const Identification& asked, double value) {
  return DeviceModel(asked).run(0, {value});
}

void expect_measured(const Identification& asked, double value, double tolerance) {
  const std::vector<double> model = model_of(asked, value);
  ASSERT_EQ(model.size(), asked.tests[0].measured.size());
  for (std::size_t row = 0; row < model.size(); ++row)
    EXPECT_NEAR(model[row], asked.tests[0].measured[row].real(), tolerance * std::abs(model[row])) << row;
}

const std::string creeping = R"toml(
[film]
thickness = "1 mm"
[film.material]
permittivity = "4e-11 F/m"
shear_modulus = "25 kPa"
[[film.material.branch]]
shear_modulus = "40 kPa"
relaxation_time = "2 s"
[patch]
)toml";

// A ramp at once, P = (40 + 40) kPa (l - 1/l^2), and a hold in which the film creeps at that stress, known to
// round-off only; a charge in closed form on a film of 30 + 40 kPa, and a hold at the voltage.
TEST_F(Identify, TakesTheStateInWhichTheColumnComesToAValueThatItKeeps) {
  const std::string test = "[[identify.test]]\nfile = \"v.csv\"\nquantity = ";
  write("v.csv", "stress_x_kPa,stretch_x\n3,1.012657552\n15,1.066568329\n27,1.126091914\n30,1.141903856\n");
  write_test("\"film.material.shear_modulus\"", test + "\"stretch_x\"\n");
  for (const int increments : {5, 20, 100}) {
    write("stack.toml", creeping +
                            "stress_x = \"30 kPa\"\n[[step]]\nkind = \"force\"\nresponse = "
                            "\"instantaneous\"\nincrements = " +
                            std::to_string(increments) +
                            "\n[[step]]\nkind = \"hold\"\nduration = \"20 s\"\n");
    expect_measured(read_identification(directory / "identify.toml"), 40, 1e-9);
  }
  const std::string ramp = creeping +
                           "length = \"20 mm\"\nmode = \"equal-biaxial\"\n[drive]\nvoltage = \"9 kV\"\n"
                           "[[step]]\nkind = \"voltage\"\nresponse = \"instantaneous\"\n"
                           "[[step]]\nkind = \"hold\"\nduration = \"20 s\"\n";
  write("stack.toml", ramp);
  write("v.csv", "voltage_kV,charge_nC\n1,16.006099\n5,80.774862\n8,131.261122\n9,148.700078\n");
  write_test("\"film.material.shear_modulus\"", test + "\"charge\"\n");
  expect_measured(read_identification(directory / "identify.toml"), 30, 1e-7);
  // A row alone may be of the hold: then its step has to be said.
  Identification alone = read_identification(directory / "identify.toml");
  alone.tests[0].x = {9000};
  alone.tests[0].measured = {148.700078e-9};
  EXPECT_THROW(model_of(alone, 30), std::runtime_error);
  alone.tests[0].step = "voltage";
  expect_measured(alone, 30, 1e-7);
  alone.tests[0].step = "hold"; // over ten relaxation times
  EXPECT_NEAR(model_of(alone, 30)[0], 155.775066e-9, 1e-12);
  // Behind the hold the voltage is lowered without time.
  write("stack.toml", ramp + "[[step]]\nkind = \"voltage\"\nname = \"off\"\nto = \"1 kV\"\n"
                             "response = \"instantaneous\"\n");
  write("v.csv", "time_s,charge_nC\n10,154.908524\n20,155.775066\n");
  expect_measured(read_identification(directory / "identify.toml"), 30, 1e-5); // by its own time steps
}

// The log of a creep test begins with the film at rest, at the instant at which the voltage is switched on.
TEST_F(Identify, AsksWhichSideOfAJumpWasMeasured) {
  write("stack.toml", creeping + "mode = \"equal-biaxial\"\n[drive]\nvoltage = { wave = \"step\", to = \"10 "
                                 "kV\" }\n[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n"
                                 "increments = 20\n[[quantity]]\nname = \"strain\"\nkind = \"areal "
                                 "strain\"\nof = \"film\"\n");
  write("v.csv", "time_s,strain\n0,0\n0.5,0.023098704\n1.0,0.025715204\n");
  const std::string test = "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"strain\"\n";
  write_test("\"film.material.shear_modulus\"", test);
  EXPECT_NE(message().find("v: at time = 0 strain jumps from 0 to 0.0218859"), std::string::npos)
      << message();
  write_test("\"film.material.shear_modulus\"", test + "at_jump = \"before\"\n");
  expect_measured(read_identification(directory / "identify.toml"), 30, 1e-4); // by its own time steps
  write_test("\"film.material.shear_modulus\"", test + "at_jump = \"after\"\n");
  EXPECT_NEAR(model_of(read_identification(directory / "identify.toml"), 30)[0], 0.0202241096, 1e-9);
  // Eight digits in another unit: 20 ns behind the run's end.
  write("v.csv", "time_min,strain\n0,0\n0.0083333333,0.023098704\n0.016666667,0.025715204\n");
  write_test("\"film.material.shear_modulus\"", test + "at_jump = \"before\"\n");
  expect_measured(read_identification(directory / "identify.toml"), 30, 1e-4);
  write("v.csv", "time_s,strain\n0.5,0.023098704\n1.0,0.025715204\n");
  EXPECT_NE(message().find("at_jump has no effect"), std::string::npos) << message();
}

TEST_F(Identify, AsksForTheStepWhereTheRunComesToAValueInSeveral) {
  const auto write_case = [&](const std::string& second) {
    write("stack.toml", creeping +
                            "[drive]\nvoltage = \"6 kV\"\n[[step]]\nkind = \"voltage\"\nname = "
                            "\"up\"\n[[step]]\nkind = \"voltage\"\nname = \"down\"\n" +
                            second);
  };
  const std::string test = "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"stretch_x\"\n",
                    unknown = "\"film.material.shear_modulus\"";
  write_case("to = \"1 kV\"\n");
  write("v.csv", "voltage_kV,stretch_x\n1.5,1.001\n3,1.003\n6,1.01\n");
  write_test(unknown, test);
  // Branches that have all the time they need: up and down are the same states.
  const std::vector<double> both = model_of(read_identification(directory / "identify.toml"), 30);
  write_test(unknown, test + "step = \"up\"\n");
  const std::vector<double> up = model_of(read_identification(directory / "identify.toml"), 30);
  for (std::size_t row = 0; row < up.size(); ++row) EXPECT_NEAR(both[row], up[row], 1e-9);
  write_case("to = \"1 kV\"\nresponse = \"instantaneous\"\n");
  EXPECT_EQ(model_of(read_identification(directory / "identify.toml"), 30), up);
  write_test(unknown, test);
  EXPECT_NE(message().find("v: the run comes to voltage = 1500 more than once, with stretch_x at "),
            std::string::npos)
      << message();
  write("v.csv", "load_factor,stretch_x\n0.25,1.001\n0.5,1.003\n1,1.01\n");
  EXPECT_NE(message().find("begins again in each step; say by step in which it was measured, one of \"up\", "
                           "\"down\""),
            std::string::npos)
      << message();
  write_test(unknown, test + "step = \"up\"\n");
  const std::vector<double> same = model_of(read_identification(directory / "identify.toml"), 30);
  for (std::size_t row = 0; row < up.size(); ++row) EXPECT_NEAR(same[row], up[row], 1e-9);
  write_test(unknown, test + "step = \"upp\"\n");
  EXPECT_NE(
      message().find("found \"upp\": the case has no such step with a history, allowed \"up\", \"down\""),
      std::string::npos)
      << message();
}

TEST_F(Identify, AsksForTheStepWhereSeveralAreHarmonic) {
  write("stack.toml", stack + "[[step]]\nkind = \"voltage\"\nname = \"lower\"\nto = \"500 V\"\n[[step]]\n"
                              "kind = \"harmonic\"\nname = \"again\"\npoints = 2\n");
  write("g.csv", "frequency[Hz],real[m/V^2],imaginary[m/V^2]\n1,1,0\n10,1,0\n");
  write_test("\"film.material.shear_modulus\"", displacement);
  EXPECT_EQ(message(), "error: identify.test[1].step: missing: the case has several steps of kind "
                       "\"harmonic\"; say which was measured, one of \"harmonic\", \"again\"");
  const auto first = [&](const std::string& step) {
    write_test("\"film.material.shear_modulus\"", displacement + step);
    return model_of(read_identification(directory / "identify.toml"), 0.4);
  };
  const std::vector<double> at_1000 = first("step = \"harmonic\"\n"), at_500 = first("step = \"again\"\n");
  EXPECT_GT(std::abs(at_1000[0] - at_500[0]), 1e-3 * std::abs(at_500[0]));
  write("stack.toml", stack.substr(0, stack.rfind("[[step]]")) +
                          "to = \"500 V\"\n[[step]]\nkind = \"harmonic\"\npoints = 2\n");
  const std::vector<double> alone = first("");
  EXPECT_NEAR(at_500[0], alone[0], 1e-5 * std::abs(alone[0])); // behind a branch that has relaxed
}

// The measured impedance is that of a permittivity below the lowest that the key takes.
TEST_F(Identify, TellsThatAnUnknownEndsAtTheLimitOfItsKey) {
  write("z.csv", "frequency[Hz],magnitude[kOhm],phase[deg]\n10,1,0\n100,1,0\n1000,1,0\n");
  write_test("\"film.material.relative_permittivity\"",
             "[[identify.test]]\nfile = \"z.csv\"\nresponse = \"impedance\"\n");
  Identification asked = read_identification(directory / "identify.toml");
  const std::vector<double> least = DeviceModel(asked).run(0, {1});
  for (std::size_t row = 0; row < asked.tests[0].measured.size(); ++row)
    asked.tests[0].measured[row] = {least[2 * row], 2 * least[2 * row + 1]};
  const IdentifyOutcome found = solve_identification(asked, 2, {});
  EXPECT_NEAR(found.unknowns[0].value, 1, 2e-3);
  EXPECT_TRUE(found.unknowns[0].at_bound);
  const std::vector<std::string> warnings = identify_warnings(asked, found);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("is at its bound"), std::string::npos);
  EXPECT_NE(warnings[1].find("the model misses what was measured by"), std::string::npos);
}

TEST_F(Identify, ConvertsFrequenciesAndPercent) {
  write("g.csv", "frequency (rad/s),real_um/V^2,imaginary_mm/V^2\n6.283185307179586,1,2\n60,1,0\n");
  write_test("\"film.material.shear_modulus\"", displacement);
  const DeviceTest response = read_identification(directory / "identify.toml").tests[0];
  EXPECT_NEAR(response.x[0], 1, 1e-12);
  EXPECT_NEAR(response.measured[0].real(), 1e-6, 1e-18);
  EXPECT_NEAR(response.measured[0].imag(), 2e-3, 1e-15);
  write("v.csv", "voltage_kV,breakdown_ratio_%\n0.2,1\n0.4,2\n");
  write_test("\"film.material.shear_modulus\"",
             "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"breakdown_ratio\"\n");
  const DeviceTest quantity = read_identification(directory / "identify.toml").tests[0];
  EXPECT_DOUBLE_EQ(quantity.x[1], 400);
  EXPECT_DOUBLE_EQ(quantity.measured[1].real(), 0.02);
  write("v.csv", "voltage_foo,breakdown_ratio\n0.2,1\n0.4,2\n");
  EXPECT_NE(message().find("found \"voltage_foo\", whose unit \"foo\" is none of voltage"), std::string::npos)
      << message();
}

TEST_F(Identify, RefusesATimeWithoutUnitAndSettingsOfUnknowns) {
  write("v.csv", "time,breakdown_ratio\n0.2,1\n0.4,2\n");
  write_test("\"film.material.shear_modulus\"",
             "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"breakdown_ratio\"\n"
             "[identify.test.set]\n\"film.material.shear_modulus\" = \"20 kPa\"\n");
  const std::string told = message();
  EXPECT_NE(told.find("found \"time\" without a unit; write \"time[s]\" or \"time[min]\""), std::string::npos)
      << told;
  EXPECT_NE(told.find("test[1].set: found \"film.material.shear_modulus\": it is one of the unknowns"),
            std::string::npos)
      << told;
}

TEST_F(Identify, TellsWhatAResponseLacks) {
  write("g.csv", "hertz,real[m/V^2],imaginary[m/V^2]\n1,1,0\n10,1,0\n");
  write_test("\"film.material.shear_modulus\"", displacement);
  EXPECT_EQ(message(), fmt::format("error: identify.test[1].file: {}/g.csv has no column frequency, only "
                                   "\"hertz\", \"real[m/V^2]\", \"imaginary[m/V^2]\"",
                                   directory.string()));
}

TEST_F(Identify, RefusesMoreUnknownsThanNumbers) {
  write("g.csv", "frequency[Hz],real[m/V^2],imaginary[m/V^2]\n1,1,0\n");
  write_test("\"film.material.shear_modulus\", \"film.material.viscosity\"", displacement);
  EXPECT_EQ(message(), "error: identify.unknowns: there are 2 unknowns, and the fitted tests have 2 numbers; "
                       "more are needed");
}

TEST_F(Identify, RefusesAnUnknownThatChangesNothing) {
  write("v.csv", "voltage[V],stroke[mm]\n200,1\n400,1\n1000,1\n");
  write_test("\"film.material.shear_modulus\", \"circuit.resistance\"",
             "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"stroke\"\n");
  EXPECT_EQ(message(),
            "error: identify.unknowns: found \"circuit.resistance\": it changes nothing that was measured");
}

TEST_F(Identify, RefusesUnknownsThatTheCaseDoesNotHave) {
  write("g.csv", "frequency[Hz],real[m/V^2],imaginary[m/V^2]\n1,1,0\n10,1,0\n");
  write_test("\"film.material.stiffness\"", displacement);
  EXPECT_EQ(message(),
            "error: identify.unknowns: found \"film.material.stiffness\": the case has no such key "
            "with a number; write its start value there, or in identify.start");
  write_test("\"film.material.shear_modulus\"",
             "[identify.start]\n\"film.thickness\" = \"40 um\"\n" + displacement);
  EXPECT_EQ(message(), "error: identify.start: found \"film.thickness\": none of the unknowns");
}

TEST_F(Identify, RefusesTestsThatTheCaseCannotAnswer) {
  write("v.csv", "voltage[V],stroke[mm]\n200,1\n400,1\n1000,1\n");
  write("g.csv", "frequency[Hz],real[m/V^2],imaginary[m/V^2]\n1,1,0\n10,1,0\n");
  write_test("\"film.material.shear_modulus\"",
             "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"stroek\"\n");
  EXPECT_NE(message().find("identify.test[1].quantity: found \"stroek\": the case has no such quantity"),
            std::string::npos);
  write("v.csv", "volt,stroke[mm]\n200,1\n400,1\n");
  write_test("\"film.material.shear_modulus\"",
             "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"stroke\"\n");
  EXPECT_NE(message().find("found \"volt\": its first column is none of the run's history"),
            std::string::npos);
  write("v.csv", "voltage[V],stroke[mm]\n200,1\n4000,1\n");
  EXPECT_NE(message().find("the run does not come to voltage = 4000"), std::string::npos);
  write("stack.toml", stack.substr(0, stack.rfind("[[step]]")));
  write_test("\"film.material.shear_modulus\"", displacement);
  EXPECT_EQ(message(), "error: identify.test[1].response: the case has no step of kind \"harmonic\", whose "
                       "response it would be");
}

} // namespace
} // namespace dielast::cases::identify_test
