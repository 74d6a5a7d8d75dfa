// SPDX-License-Identifier: GPL-3.0-or-later
// Rational functions and circuits are found again from responses that were made of them.
#include "cases/fits/rational.hpp"
#include "cases/readers/identify_reader.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace dielast::cases::rational_test {
namespace {

using Complex = std::complex<double>;

/// A response at equal ratios of the frequency, each row with its own relative error of this deviation.
FrequencyTable table(const std::function<Complex(Complex s)>& response, double from, double to, int rows,
                     double noise = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise > 0 ? noise : 1);
  FrequencyTable made;
  for (int i = 0; i < rows; ++i) {
    made.hertz.push_back(from * std::pow(to / from, i / (rows - 1.0)));
    const Complex off = noise > 0 ? Complex(error(random), error(random)) : 0;
    made.value.push_back(response({0, 2 * std::numbers::pi * made.hertz.back()}) * (1.0 + off));
  }
  return made;
}

const FittedParameter& of(const RationalOutcome& outcome, const std::string& name) {
  for (const FittedNumber& one : outcome.numbers)
    if (one.name == name) return one.number;
  throw std::runtime_error("no " + name);
}

/// A mass on a spring and a damper with a real pole and a real zero: 30 Hz, damping ratio 0.03.
Complex mechanism(Complex s) {
  const double w = 2 * std::numbers::pi * 30;
  return 2e-11 * (1.0 + s / 600.0) / (1.0 + s / 9000.0) / (s * s / (w * w) + 0.06 * s / w + 1.0);
}

TEST(Rational, FindsPolesAndZeros) {
  const RationalOutcome found = fit_rational(table(mechanism, 0.02, 5000, 60), {3, 1}, 200);
  EXPECT_EQ(found.ending, FitEnding::converged);
  EXPECT_TRUE(found.stable);
  EXPECT_LT(found.error, 1e-9);
  EXPECT_NEAR(of(found, "at rest").value, 2e-11, 1e-8 * 2e-11);
  EXPECT_NEAR(of(found, "pole 1, frequency").value, 30, 1e-8 * 30);
  EXPECT_NEAR(of(found, "pole 1, damping ratio").value, 0.03, 1e-8);
  EXPECT_NEAR(of(found, "pole 2, frequency").value, 9000 / (2 * std::numbers::pi), 1e-5);
  EXPECT_NEAR(of(found, "zero 1, frequency").value, 600 / (2 * std::numbers::pi), 1e-7);
  EXPECT_EQ(found.numbers.size(), 5u); // no damping ratio of what is real
  // Its coefficients are those in powers of s, the highest first.
  const Complex s(0, 100);
  Complex above = 0, below = 0;
  for (const double c : found.numerator) above = above * s + c;
  for (const double c : found.denominator) below = below * s + c;
  EXPECT_NEAR(std::abs(above / below / mechanism(s) - 1.0), 0, 1e-8);
  EXPECT_EQ(found.denominator.front(), 1);
}

TEST(Rational, TellsAPoleThatIsNotStable) {
  const auto grows = [](Complex s) { return 1.0 / (1.0 - s / 100.0); };
  EXPECT_FALSE(fit_rational(table(grows, 0.1, 1000, 20), {1, 0}, 200).stable);
}

// A capacitor's impedance has no value at rest, and its pole at zero is not unstable.
TEST(Rational, KnowsAnIntegrator) {
  const RationalOutcome found =
      fit_rational(table([](Complex s) { return 1.0 / (2e-9 * s); }, 0.1, 1000, 30), {1, 0}, 200);
  EXPECT_EQ(found.ending, FitEnding::converged);
  EXPECT_TRUE(found.stable);
  EXPECT_THROW(of(found, "at rest"), std::runtime_error);
}

TEST(Rational, TellsAZeroInTheRightHalfPlaneFromOneInTheLeft) {
  const auto with_zero_at = [](double at) {
    return fit_rational(
        table([at](Complex s) { return (1.0 - s / at) / (1.0 + s / 50.0) / (1.0 + s / 2000.0); }, 0.1, 1000,
              40),
        {2, 1}, 200);
  };
  const RationalOutcome right = with_zero_at(300), left = with_zero_at(-300);
  EXPECT_NEAR(of(right, "zero 1, frequency").value, of(left, "zero 1, frequency").value, 1e-6);
  EXPECT_NEAR(of(right, "zero 1, damping ratio").value, -1, 1e-9);
  EXPECT_EQ(right.numbers.size(), left.numbers.size() + 1);
}

constexpr double Rs = 202e3, Rp = 6.1e9, C = 0.561e-9;

Complex impedance(Complex s) { return Rs + 1.0 / (1 / Rp + s * C); }

TEST(Rational, FindsTheElementsOfACircuit) {
  for (const bool admittance : {false, true}) {
    const auto seen = [&](Complex s) { return admittance ? 1.0 / impedance(s) : impedance(s); };
    const RationalOutcome found =
        fit_circuit(table(seen, 0.02, 5000, 25), {{true, true, true}, admittance}, 200);
    EXPECT_EQ(found.ending, FitEnding::converged);
    EXPECT_NEAR(of(found, "resistance").value, Rs, 1e-7 * Rs);
    EXPECT_NEAR(of(found, "leakage_resistance").value, Rp, 1e-7 * Rp);
    EXPECT_NEAR(of(found, "capacitance").value, C, 1e-7 * C);
    const Complex s(0, 300), made = (found.numerator[0] * s + found.numerator[1]) /
                                    (found.denominator[0] * s + found.denominator[1]);
    EXPECT_NEAR(std::abs(made / seen(s) - 1.0), 0, 1e-6);
  }
  const auto ideal = [](Complex s) { return 1.0 / (s * C); };
  const RationalOutcome found = fit_circuit(table(ideal, 1, 100, 5), {{false, false, true}, false}, 200);
  EXPECT_NEAR(of(found, "capacitance").value, C, 1e-9 * C);
}

// An interval of 95 % holds the truth 38 of 40 times; 35 or fewer happen once in 20 such counts.
TEST(Rational, IntervalsHoldTheTruth) {
  std::map<std::string, int> held;
  const std::map<std::string, double> truth{{"at rest", 2e-11},
                                            {"pole 1, frequency", 30},
                                            {"pole 1, damping ratio", 0.03},
                                            {"zero 1, frequency", 600 / (2 * std::numbers::pi)},
                                            {"resistance", Rs},
                                            {"leakage_resistance", Rp},
                                            {"capacitance", C}};
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const RationalOutcome circuit =
        fit_circuit(table(impedance, 0.02, 5000, 25, 0.01, seed), {{true, true, true}, false}, 200);
    const RationalOutcome motion = fit_rational(table(mechanism, 0.02, 5000, 60, 0.01, seed), {3, 1}, 200);
    for (const RationalOutcome* outcome : {&circuit, &motion}) {
      EXPECT_EQ(outcome->ending, FitEnding::converged);
      EXPECT_NEAR(outcome->deviation, 0.01, 0.004);
      for (const FittedNumber& one : outcome->numbers)
        if (const auto true_value = truth.find(one.name); true_value != truth.end())
          held[one.name] += one.number.low <= true_value->second && true_value->second <= one.number.high;
    }
  }
  for (const auto& [name, value] : truth) EXPECT_GE(held[name], 35) << name;
}

// More poles than there are cannot be told from zeros beside them.
TEST(Rational, TellsWhatIsNotIdentifiable) {
  const RationalOutcome found = fit_rational(table(mechanism, 0.02, 5000, 60), {4, 2}, 200);
  EXPECT_FALSE(
      std::ranges::all_of(found.numbers, [](const FittedNumber& one) { return one.number.determined(); }));
}

class RationalFile : public test::ScratchTest {
 protected:
  std::string message(const std::string& keys) const {
    write("fit.toml", "[[rational]]\n" + keys);
    try {
      read_rational_fits(directory / "fit.toml");
    } catch (const CaseError& error) {
      const std::string text = error.what();
      return text.substr(text.find("error: "));
    }
    return "";
  }
};

// The measured models of the hung stack: the mechanics' pole pair and the circuit's pole, and the circuit.
TEST_F(RationalFile, FindsTheHungStack) {
  const RationalFits asked =
      read_rational_fits(test::source_folder / "cases/gallery/hung_stack/rational.toml");
  const std::vector<RationalOutcome> found = solve_rational_fits(asked);
  ASSERT_EQ(found.size(), 4u);
  const std::array frequency{23.08, 32.44}, damping{0.03527, 0.03163}, rest{2.2793e-11, 1.2483e-11},
      series{202e3, 82.5e3}, leak{6.10e9, 17.6e9}, capacitance{0.561e-9, 0.461e-9};
  for (std::size_t i : {0u, 1u}) {
    const RationalOutcome &motion = found[2 * i], &circuit = found[2 * i + 1];
    EXPECT_EQ(motion.ending, FitEnding::converged);
    EXPECT_NEAR(of(motion, "pole 1, frequency").value, frequency[i], 5e-4 * frequency[i]);
    EXPECT_NEAR(of(motion, "pole 1, damping ratio").value, damping[i], 5e-4 * damping[i]);
    EXPECT_NEAR(of(motion, "at rest").value, rest[i], 1e-3 * rest[i]);
    EXPECT_NEAR(of(circuit, "resistance").value, series[i], 1e-3 * series[i]);
    EXPECT_NEAR(of(circuit, "leakage_resistance").value, leak[i], 1e-3 * leak[i]);
    EXPECT_NEAR(of(circuit, "capacitance").value, capacitance[i], 1e-3 * capacitance[i]);
  }
}

TEST_F(RationalFile, TellsWhatIsWrong) {
  write("z.csv", "frequency[Hz],magnitude[Ohm],phase[deg]\n1,1,0\n10,1,0\n");
  const std::string z = "file = \"z.csv\"\nresponse = \"impedance\"\n";
  EXPECT_EQ(message(z + "poles = 1"), "");
  EXPECT_EQ(message(z + "poles = 3\nzeros = 1"), "error: rational[1]: there are 5 unknowns, and z.csv has 4 "
                                                 "numbers; more are needed");
  write("z.csv", "frequency[Hz],magnitude[Ohm],phase[deg]\n0,1,0\n10,1,0\n");
  EXPECT_EQ(message(z + "poles = 1"), "error: a response is above 0, at a frequency above 0");
  for (const char* unit : {"dB", "mm", "Ohms_"}) {
    write("z.csv", fmt::format("frequency[Hz],magnitude[{}],phase[deg]\n1,1,0\n10,1,0\n", unit));
    EXPECT_EQ(
        message(z + "poles = 1"),
        fmt::format("error: found \"magnitude[{0}]\", whose unit \"{0}\" is none of magnitude; without a "
                    "unit the numbers are in Ohm",
                    unit));
  }
  write("z.csv", "frequency[Hz],magnitude[Ohm],phase\n1,1,0\n10,1,0\n");
  EXPECT_EQ(message(z + "poles = 1"),
            "error: found \"phase\" without a unit; write \"phase[deg]\" or \"phase[rad]\"");
  write("z.csv", "frequency[Hz],magnitude[Ohm],phase (%)\n1,1,0\n10,1,0\n");
  EXPECT_EQ(message(z + "poles = 1"), "error: found \"phase (%)\", whose unit \"%\" is none of phase");
}

} // namespace
} // namespace dielast::cases::rational_test
