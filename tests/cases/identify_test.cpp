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

namespace dielast::cases {
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
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("is at its bound"), std::string::npos);
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
  EXPECT_NE(message().find("the run does not come to 4000"), std::string::npos);
  write("stack.toml", stack.substr(0, stack.rfind("[[step]]")));
  write_test("\"film.material.shear_modulus\"", displacement);
  EXPECT_EQ(message(), "error: identify.test[1].response: the case has no step of kind \"harmonic\", whose "
                       "response it would be");
}

} // namespace
} // namespace dielast::cases
