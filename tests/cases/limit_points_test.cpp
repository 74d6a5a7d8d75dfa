// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/material_point.hpp"
#include "tests/campaign.hpp"
#include "tests/cases/limit_cases.hpp"

#include <functional>
#include <optional>

// Limit points of random homogeneous films: each is found, none is invented, and where the film ends does not
// depend on the number of increments. The truth comes from the path itself, walked through in the stretch,
// and where dashpots flow in time from an integration of its own.

namespace dielast::cases::limit_points_test {
namespace {

constexpr double thickness = 1e-3, side = 1e-2, permittivity = 4e-11;

/// A neo-Hookean branch with a logarithmic dashpot.
struct SimpleBranch {
  double modulus = 0, time = 0; ///< Pa, s
};

/// A film in equal-biaxial tension that has relaxed at the stretch l under a dead stress, whose field then
/// grows from 0 to `field` within 1 s while its branches flow. `elastic`: nominal stress of all but the
/// branches. Classical Runge-Kutta method, in ever smaller steps where no equilibrium follows.
template<class Elastic>
End in_time(const Elastic& elastic, const std::vector<SimpleBranch>& branches, double stress, double field,
            double l) {
  using Viscous = Eigen::ArrayXd;
  constexpr double longest = 1.0 / 4000, shortest = 1e-10, near = 0.02;
  const auto surplus = [&](double at, const Viscous& v, double t) {
    double sum = elastic(at) - stress - permittivity * std::pow(field * t, 2) * at * at * at;
    for (std::size_t b = 0; b < branches.size(); ++b) {
      const double a = at / v[static_cast<Eigen::Index>(b)];
      sum += branches[b].modulus * (a - std::pow(a, -5)) / v[static_cast<Eigen::Index>(b)];
    }
    return sum;
  };
  const auto stretch = [&](double start, const Viscous& v, double t) -> std::optional<double> {
    double at = start;
    for (int i = 0; i < 40; ++i) {
      constexpr double d = 1e-6;
      const double slope = (surplus(at + d, v, t) - surplus(at - d, v, t)) / (2 * d);
      if (!(slope > 0)) return std::nullopt;
      const double step = -surplus(at, v, t) / slope;
      at += step;
      if (!(std::abs(at - start) < near)) return std::nullopt;
      if (std::abs(step) < 1e-13) return at;
    }
    return std::nullopt;
  };
  const auto rate = [&](double at, const Viscous& v) {
    Viscous change(v.size());
    for (Eigen::Index b = 0; b < v.size(); ++b) {
      const double a = at / v[b];
      change[b] = v[b] * (a * a - std::pow(a, -4)) / (6 * branches[static_cast<std::size_t>(b)].time);
    }
    return change;
  };
  Viscous v = Viscous::Constant(std::ssize(branches), l);
  double t = 0, h = longest;
  while (t < 1 - shortest) {
    h = std::min(h, 1 - t);
    const Viscous k1 = rate(l, v);
    const auto l2 = stretch(l, v + h / 2 * k1, t + h / 2);
    const Viscous k2 = l2 ? rate(*l2, v + h / 2 * k1) : k1;
    const auto l3 = stretch(l, v + h / 2 * k2, t + h / 2);
    const Viscous k3 = l3 ? rate(*l3, v + h / 2 * k2) : k2;
    const auto l4 = stretch(l, v + h * k3, t + h);
    const Viscous k4 = l4 ? rate(*l4, v + h * k3) : k3;
    const Viscous next = v + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    const auto end = stretch(l, next, t + h);
    if (!l2 || !l3 || !l4 || !end) {
      h /= 2;
      if (h < shortest) return {t, l};
      continue;
    }
    v = next, l = *end, t += h;
  }
  return {1, l};
}

/// A film, what is done to it, and where that ends.
struct Draw {
  std::string text;
  End truth;
  bool timed = false, flows = false; ///< dashpots do, in time

  /// In time the last state is that of the last step that was small enough; dashpots that flow add the errors
  /// of all steps.
  double load_tolerance() const { return flows ? 1e-4 : timed ? 1e-5 : 2e-6; }
  double stretch_tolerance() const {
    if (truth.load_factor < 1) return flows ? 1e-2 : timed ? 5e-3 : 2e-3;
    return flows ? 1e-4 : 1e-6;
  }
};

/// Dead stress, then a voltage or a charge; or one of these, then the stress; nothing where the film is lost
/// under the first load, or where it cannot be told how the second one ends.
std::optional<Draw> draw(Dice& dice,
                         const std::function<materials::Material(const std::string& text)>& material_of) {
  const std::string law = random_law(dice);
  const bool biaxial = dice.below(3) > 0, electric_last = dice.below(3) > 0, charged = dice.below(4) == 0;
  const bool has_branches = dice.below(3) == 0, has_spring = dice.below(5) == 0;
  const bool timed = electric_last && !charged && dice.below(4) == 0 && (biaxial || !has_branches);
  const double part = dice.between(0.3, 1.6); // of the greatest load, where there is one
  const int increments = static_cast<int>(dice.by_ratio(1, 401));
  const double pull = dice.between(0, 1.5), push = dice.between(0, 0.5);
  std::string film =
      "[film]\nthickness = \"1 mm\"\n[film.material]\n" + law + "permittivity = \"4e-11 F/m\"\n";
  const materials::Material elastic = material_of(film + "[patch]\n");
  const double mu = materials::initial_shear_modulus(elastic.law);
  std::vector<SimpleBranch> branches;
  for (int b = has_branches ? 1 + dice.below(2) : 0; b > 0; --b) {
    branches.push_back({mu * dice.between(0.1, 1.5), dice.by_ratio(0.03, 30)});
    film +=
        fmt::format("[[film.material.branch]]\nshear_modulus = \"{:.17g} Pa\"\nrelaxation_time = \"{:.17g} "
                    "s\"\n",
                    branches.back().modulus, branches.back().time);
    if (!timed && dice.below(2) == 0) film += "dashpot = \"nominal\"\n";
  }
  const materials::Material material = material_of(film + "[patch]\n");
  const bool instant_first = has_branches && !timed && dice.below(2) == 0;
  const bool instant_last = has_branches && !timed && dice.below(2) == 0;
  const double spring = has_spring ? mu * thickness * dice.between(0, 0.5) : 0; // N/m

  const auto mode = biaxial ? materials::Mode::equal_biaxial : materials::Mode::pure_shear;
  materials::MaterialPoint point(material, mode);
  const auto scheme = [](bool instant) {
    return instant ? materials::TimeScheme::frozen() : materials::TimeScheme::relaxed();
  };
  const auto spring_at = [&](double l) { return spring * (l - 1) / thickness / (biaxial ? 2 : 1); };
  const auto stress_at = [&](double l, bool instant) {
    return point.stress(l, scheme(instant)) + spring_at(l);
  };
  // Of the field as drawn, squared, that the voltage or the charge would make.
  const auto pull_at = [&](double l) {
    const double det = biaxial ? std::pow(l, 4) : l * l;
    return permittivity * (biaxial ? l * l * l : l) / (charged ? det * det : 1);
  };
  const double field_before = electric_last ? 0 : push * std::sqrt(mu / permittivity) + 1e3;
  const double stress_before = electric_last ? pull * mu + 1 : 0;
  const auto begin_with = [&](bool instant) {
    return walk(
        [&](double l) {
          return electric_last ? stress_at(l, instant) / stress_before
                               : stress_at(l, instant) / pull_at(l) / (field_before * field_before);
        },
        1);
  };
  End begin = begin_with(instant_first);
  if (begin.load_factor < 1) return std::nullopt;
  if (instant_first && !instant_last) { // what the branches carried is taken away, at the first load
    const End flown = begin_with(false);
    if (flown.load_factor < 1) return std::nullopt;
    constexpr int parts = 200;
    double carried = -1e300;
    for (int i = 0; i <= parts; ++i) {
      const double l = begin.stretch + (flown.stretch - begin.stretch) * i / parts;
      const double now = stress_at(l, false) - pull_at(l) * field_before * field_before;
      if (now < carried) return std::nullopt;
      carried = now;
    }
    begin = flown;
  }
  if (!instant_first) point.accept(begin.stretch, scheme(false));
  // The load that goes last, in a power in which the path is known, as a function of the stretch.
  const auto load = [&](double l) {
    return electric_last ? (stress_at(l, instant_last) - stress_before) / pull_at(l)
                         : stress_at(l, instant_last) - pull_at(l) * field_before * field_before;
  };
  double greatest = 0; // until it falls, or far on
  for (double l = begin.stretch + 1e-3; l < begin.stretch + 2 && load(l) > greatest; l += 1e-3)
    greatest = load(l);
  const double target = electric_last ? std::sqrt(greatest) * part : greatest * part;
  if (!(target > 0) || greatest * (electric_last ? permittivity : 1) > 1e3 * mu) return std::nullopt;
  const double field = electric_last ? target : field_before;
  const double stress = electric_last ? stress_before : target;
  if (field * thickness > 1e6) return std::nullopt; // no voltage

  Draw drawn{.timed = timed, .flows = timed && has_branches};
  if (drawn.flows) {
    materials::MaterialPoint spine(elastic, mode);
    drawn.truth = in_time([&](double l) { return spine.stress(l, scheme(true)) + spring_at(l); }, branches,
                          stress, field, begin.stretch);
  } else {
    drawn.truth =
        walk([&](double l) { return (electric_last ? std::sqrt(std::max(0.0, load(l))) : load(l)) / target; },
             begin.stretch);
  }
  constexpr double far_away = 5; // where the load comes to no maximum but to the end of the law
  if (drawn.truth.load_factor == 0 || drawn.truth.stretch > far_away) return std::nullopt;
  std::string& text = drawn.text;
  text = film + fmt::format("[patch]\nmode = \"{}\"\nstress_x = \"{:.17g} Pa\"\n[output]\nfields = false\n"
                            "error_estimate = false\n",
                            biaxial ? "equal-biaxial" : "pure-shear", stress);
  if (has_spring)
    text += fmt::format(
        "[[spring]]\nbetween = [\"left\", \"right\"]\nalong = \"x\"\nstiffness = \"{:.17g} N/m\"\n"
        "free_length = \"10 mm\"\n",
        spring);
  if (timed)
    text +=
        fmt::format("[drive]\nvoltage = {{ wave = \"trapezoid\", to = \"{:.17g} V\", rise = \"1 s\", hold = "
                    "\"1 s\", fall = \"1 s\" }}\n",
                    field * thickness);
  else if (charged)
    text += fmt::format("[drive]\ncharge = \"{:.17g} C\"\n", field * permittivity * side * side);
  else
    text += fmt::format("[drive]\nvoltage = \"{:.17g} V\"\n", field * thickness);
  const auto step = [&](bool is_electric, bool instant) {
    const char* electric = charged ? "charge" : "voltage";
    text += fmt::format("[[step]]\nkind = \"{}\"\n", is_electric ? electric : "force");
    if (!is_electric && charged && !electric_last) text += "control = \"charge\"\n";
    if (instant) text += "response = \"instantaneous\"\n";
  };
  step(!electric_last, instant_first);
  if (timed)
    text += "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n";
  else
    step(electric_last, instant_last);
  text += fmt::format("increments = {}\n", increments);
  return drawn;
}

class LimitPoints : public test::ScratchTest {
 protected:
  struct Run {
    Outcome outcome;
    double load_factor = 0, stretch = 0;
  };
  Case read(const std::string& text) const {
    write("limit.toml", text);
    return read_case(directory / "limit.toml");
  }
  Run run(const std::string& text) {
    const Case one = read(text);
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
  const int drawn = test::drawn_cases("DIELAST_LIMIT_CASES", 400);
  Dice dice(20261121);
  int limits = 0, films = 0;
  for (int number = 0; films < drawn; ++number) {
    const auto film =
        draw(dice, [&](const std::string& text) { return read(text).parts.front().film->material; });
    if (!film) continue;
    ++films;
    const End& truth = film->truth;
    SCOPED_TRACE(
        fmt::format("draw {}:\n{}truth: {} at {}", number, film->text, truth.load_factor, truth.stretch));
    const Run found = run(film->text);
    const bool limit = truth.load_factor < 1;
    limits += limit;
    EXPECT_EQ(found.outcome.ending == Ending::gave_up, limit) << found.outcome.message;
    EXPECT_EQ(found.outcome.kind, limit ? "limit point" : "") << found.outcome.message;
    EXPECT_NEAR(found.load_factor, truth.load_factor, film->load_tolerance());
    EXPECT_NEAR(found.stretch, truth.stretch, film->stretch_tolerance() * truth.stretch);
  }
  EXPECT_GT(limits, drawn / 6);
  RecordProperty("limits", limits);
}

} // namespace
} // namespace dielast::cases::limit_points_test
