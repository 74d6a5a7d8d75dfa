#include "cases/reader.hpp"
#include "cases/simulation.hpp"
#include "materials/material_point.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

// Limit points of random homogeneous films: each is found, none is invented, and where the film ends does not
// depend on the number of increments. The truth comes from the path itself, walked through in the stretch.

namespace dielast::cases {
namespace {

#ifndef DIELAST_LIMIT_CASES
#define DIELAST_LIMIT_CASES 400
#endif

constexpr double thickness = 1e-3, permittivity = 4e-11;

/// Where a path ends: at a load factor below 1, at its first greatest load, or at 1.
struct End {
  double load_factor = 0, stretch = 0;
};

/// Random numbers that are alike with every standard library.
class Dice {
 public:
  explicit Dice(unsigned seed) : bits_(seed) {}
  double between(double low, double high) { return low + (high - low) * (bits_() / 4294967296.0); }
  int below(int n) { return static_cast<int>(between(0, n)); }
  double by_ratio(double low, double high) { return low * std::pow(high / low, between(0, 1)); }

 private:
  std::mt19937 bits_;
};

std::string random_law(Dice& dice) {
  const double mu = dice.between(10, 200);
  switch (dice.below(6)) {
  case 0:
    return fmt::format("law = \"neo-hookean\"\nshear_modulus = \"{} kPa\"\n", mu);
  case 1:
    return fmt::format("law = \"mooney-rivlin\"\nc1 = \"{} kPa\"\nc2 = \"{} kPa\"\n", mu / 2,
                       mu * dice.between(0, 0.1));
  case 2:
    return fmt::format("law = \"yeoh\"\nc1 = \"{} kPa\"\nc2 = \"{} kPa\"\nc3 = \"{} kPa\"\n", mu / 2,
                       -mu * dice.between(0, 0.01), mu * dice.by_ratio(1e-5, 1e-3));
  case 3:
    return fmt::format("law = \"ogden\"\nmoduli = [\"{} kPa\", \"{} kPa\"]\nexponents = [{}, {}]\n", mu,
                       mu * dice.by_ratio(1e-3, 1e-1), dice.between(1.2, 2.2), dice.between(4, 7));
  case 4:
    return fmt::format("law = \"gent\"\nshear_modulus = \"{} kPa\"\nstretch_limit = {}\n", mu,
                       dice.by_ratio(8, 200));
  default:
    return fmt::format("law = \"arruda-boyce\"\nshear_modulus = \"{} kPa\"\nlocking_stretch = {}\n", mu,
                       dice.by_ratio(2, 8));
  }
}

/// Walks along the stretch from `start`, where the load factor is 0, to where it is 1 or falls again; not far
/// enough to find out: 0.
template<class LoadFactor>
End walk(const LoadFactor& load_factor, double start) {
  constexpr double step = 1e-4;
  double l = start, s = load_factor(l);
  while (l < 30) {
    const double next = l + step, there = load_factor(next);
    if (!std::isfinite(there) || (there < s && there < -1)) return {}; // beyond the law's last stretch
    if (there >= 1) {
      double low = l, high = next;
      for (int i = 0; i < 60; ++i) (load_factor((low + high) / 2) < 1 ? low : high) = (low + high) / 2;
      return {1, low};
    }
    if (!(there > s)) { // the greatest load lies between the neighbours: golden section
      double low = l - step, high = next;
      constexpr double golden = 0.6180339887498949;
      for (int i = 0; i < 80; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (load_factor(a) > load_factor(b) ? high : low) = load_factor(a) > load_factor(b) ? b : a;
      }
      return {load_factor(low), low};
    }
    l = next, s = there;
  }
  return {};
}

class LimitPoints : public test::ScratchTest {
 protected:
  struct Run {
    Outcome outcome;
    double load_factor = 0, stretch = 0;
  };
  Run run(const std::string& text) {
    write("limit.toml", text);
    const Case one = read_case(directory / "limit.toml");
    std::size_t x = 0;
    while (one.quantities[x].name != "stretch_x") ++x;
    Simulation simulation(one, 1);
    Run result;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      result.load_factor = frame.record.load_factor;
      result.stretch = frame.values[x];
      return true;
    };
    result.outcome = simulation.run(observer);
    return result;
  }
};

TEST_F(LimitPoints, of_random_films_are_found_whatever_the_increments) {
  Dice dice(20261121);
  int limits = 0;
  for (int number = 0; number < DIELAST_LIMIT_CASES; ++number) {
    const std::string law = random_law(dice);
    const bool biaxial = dice.below(3) > 0;
    const bool voltage_last = dice.below(3) > 0;
    const bool timed = voltage_last && dice.below(4) == 0;
    const double part = dice.between(0.3, 1.6); // of the greatest load, where there is one
    const int increments = static_cast<int>(dice.by_ratio(1, 401));
    const double pull = dice.between(0, 1.5), push = dice.between(0, 0.5);
    const std::string film =
        "[film]\nthickness = \"1 mm\"\n[film.material]\n" + law + "permittivity = \"4e-11 F/m\"\n";
    write("law.toml", film + "[patch]\n");
    const materials::Material material = read_case(directory / "law.toml").film.material;
    materials::MaterialPoint point(material,
                                   biaxial ? materials::Mode::equal_biaxial : materials::Mode::pure_shear);
    const auto stress_at = [&](double l) { return point.stress(l, materials::TimeScheme::frozen()); };
    const auto pull_at = [&](double l) { return permittivity * (biaxial ? l * l * l : l); };
    const double mu = materials::initial_shear_modulus(material.law);
    const double field_before = voltage_last ? 0 : push * std::sqrt(mu / permittivity) + 1e3;
    const double stress_before = voltage_last ? pull * mu + 1 : 0;
    // The load that goes last, in a power in which the path is known, as a function of the stretch.
    const auto load = [&](double l) {
      return voltage_last ? (stress_at(l) - stress_before) / pull_at(l)
                          : stress_at(l) - pull_at(l) * field_before * field_before;
    };
    const auto first_load = [&](double l) {
      return voltage_last ? stress_at(l) / stress_before
                          : stress_at(l) / pull_at(l) / (field_before * field_before);
    };
    const End begin = walk(first_load, 1);
    if (begin.load_factor < 1) continue; // lost under the first load alone
    double greatest = 0;                 // until it falls, or far on
    for (double l = begin.stretch + 1e-3; l < begin.stretch + 2 && load(l) > greatest; l += 1e-3)
      greatest = load(l);
    const double target = voltage_last ? std::sqrt(greatest) * part : greatest * part;
    const auto factor = [&](double l) {
      return (voltage_last ? std::sqrt(std::max(0.0, load(l))) : load(l)) / target;
    };
    if (!(target > 0)) continue;
    const End truth = walk(factor, begin.stretch);
    if (truth.load_factor == 0 || greatest * (voltage_last ? permittivity : 1) > 1e3 * mu) continue;
    const double field = voltage_last ? target : field_before;
    const double stress = voltage_last ? stress_before : target;
    if (field * thickness > 1e6) continue; // no voltage
    std::string text =
        film + fmt::format("[patch]\nmode = \"{}\"\nstress_x = \"{:.17g} Pa\"\n[output]\nfields = false\n"
                           "error_estimate = false\n",
                           biaxial ? "equal-biaxial" : "pure-shear", stress);
    text +=
        fmt::format("[drive]\nvoltage = {}\n",
                    timed ? fmt::format("{{ wave = \"trapezoid\", to = \"{:.17g} V\", rise = \"1 s\", hold = "
                                        "\"1 s\", fall = \"1 s\" }}",
                                        field * thickness)
                          : fmt::format("\"{:.17g} V\"", field * thickness));
    const std::string force = "[[step]]\nkind = \"force\"\n", voltage = "[[step]]\nkind = \"voltage\"\n";
    const std::string last = fmt::format("increments = {}\n", increments);
    if (timed)
      text += force + "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n" + last;
    else
      text += voltage_last ? force + voltage + last : voltage + force + last;
    SCOPED_TRACE(fmt::format("case {}:\n{}truth: {} at {}", number, text, truth.load_factor, truth.stretch));
    const Run found = run(text);
    const bool limit = truth.load_factor < 1;
    limits += limit;
    EXPECT_EQ(found.outcome.ending == Ending::gave_up, limit) << found.outcome.message;
    EXPECT_EQ(found.outcome.kind, limit ? "limit point" : "") << found.outcome.message;
    // in time the last state is that of the last step that was small enough
    EXPECT_NEAR(found.load_factor, truth.load_factor, timed ? 1e-5 : 2e-6);
    EXPECT_NEAR(found.stretch, truth.stretch, (limit ? timed ? 5e-3 : 2e-3 : 1e-6) * truth.stretch);
  }
  EXPECT_GT(limits, DIELAST_LIMIT_CASES / 5);
}

} // namespace
} // namespace dielast::cases
