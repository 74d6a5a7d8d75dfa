// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/campaign.hpp"
#include "tests/cases/patch_oracle.hpp"
#include "tests/cases/scratch.hpp"
#include "tests/cases/sheet_oracle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

// Works and heat of random transients of patches and of discs with resistive electrodes, row by row, against
// an independent integration: every wave, jumps, kinks beside the ends of increments, dashpots, circuits,
// leaks, given charges.

namespace dielast::cases::works_test {
namespace {

using test::PatchOracle, test::SheetOracle;

struct Row {
  double time, electrical, mechanical, dissipated, source, leak;
};

class RandomTransient {
 public:
  RandomTransient(std::filesystem::path directory, unsigned seed)
      : directory_(std::move(directory)), random_(seed) {}

  /// A case file's text.
  std::string of_patch() {
    duration_ = std::pow(10, uniform(-1, 1.3));
    increments_ = integer(26, 120);
    std::string film = fmt::format(
        "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = {}\npermittivity = \"4e-11 F/m\"\n",
        uniform(25e3, 60e3));
    for (int b = integer(0, 2); b > 0; --b)
      film += fmt::format(
          "[[film.material.branch]]\nshear_modulus = {}\nrelaxation_time = {}\ndashpot = \"{}\"\n",
          uniform(5e3, 60e3), duration_ * std::pow(10, uniform(-1.5, 0.5)), chance(0.25) ? "nominal" : "log");
    static constexpr const char* modes[] = {"equal-biaxial", "pure-shear", "biaxial", "pure-shear"};
    const int mode = integer(0, 3);
    std::string patch = fmt::format("[patch]\nmode = \"{}\"\n", modes[mode]);
    if (mode >= 2)
      patch += "stretch_x = " + (chance(0.3) ? fmt::format("{}", uniform(1.05, 1.6)) : wave(1.05, 1.6, ""));
    else if (chance(0.7))
      patch += "stress_x = " + wave(0, uniform(1e3, 8e3), " Pa");
    std::string electric;
    const double choice = uniform(0, 1);
    std::string control;
    if (choice < 0.12) {
      electric = "[drive]\ncharge = " + wave(0, uniform(1e-9, 3e-8), " C");
      control = "control = \"charge\"\n";
    } else {
      electric = "[drive]\nvoltage = " + wave(chance(0.2) ? -2e3 : 0, uniform(500, 7e3), " V");
    }
    if (choice > 0.75) {
      const double resistance = duration_ * std::pow(10, uniform(-1.7, -0.3)) / 4e-12;
      electric += fmt::format("\n[circuit]\nresistance = {}\n", resistance);
      if (chance(0.5)) electric += fmt::format("leakage_resistance = {}\n", resistance * uniform(3, 50));
      if (chance(0.3)) electric += fmt::format("current_limit = {}\n", 5e3 / resistance * uniform(0.2, 1));
    }
    return film + patch + "\n" + electric + "\n" + transient(control);
  }

  /// That of a disc held at its rim, of 3-node triangles, whose electrode resists the current along it.
  std::string of_sheet() {
    duration_ = std::pow(10, uniform(-1, 1.3));
    increments_ = integer(26, 120);
    const double stretch = uniform(1.5, 2.5);
    std::string film = fmt::format("[film]\nthickness = \"1 mm\"\nprestretch = {}\n[film.material]\n"
                                   "shear_modulus = {}\npermittivity = \"4e-11 F/m\"\n",
                                   stretch, uniform(25e3, 60e3));
    for (int b = integer(0, 1); b > 0; --b)
      film += fmt::format("[[film.material.branch]]\nshear_modulus = {}\nrelaxation_time = {}\n",
                          uniform(5e3, 60e3), duration_ * std::pow(10, uniform(-1.5, 0.5)));
    constexpr double electrode = 15e-3; // m
    const int rings = integer(2, 3);
    const double capacitance = 4e-11 / 1e-3 * 3.14 * electrode * electrode * std::pow(stretch, 2);
    const double resistance = duration_ * std::pow(10, uniform(-2, 0)) / capacitance;
    const std::string disc = fmt::format(
        "[disc]\nradius = {}\nelectrode_radius = {}\n[mesh]\nrings = {}\norder = 1\n[[electrode]]\nname = "
        "\"film\"\nplace = \"electrode\"\nsheet_resistance = {}\nterminal = \"{}\"\n",
        electrode * rings / (rings - 1), electrode, rings, resistance,
        chance(0.5) ? "centre" : "electrode_edge");
    const double choice = uniform(0, 1);
    const double volts = uniform(500, 6e3) / stretch;
    if (choice < 0.15)
      return film + disc + "[drive]\ncharge = " + wave(0, volts * capacitance, " C") + "\n" +
             transient("control = \"charge\"\n");
    std::string electric = "[drive]\nvoltage = " + wave(chance(0.2) ? -volts / 3 : 0, volts, " V") + "\n";
    if (choice > 0.5) {
      const double series = resistance * std::pow(10, uniform(-1, 0.5));
      electric += fmt::format("[circuit]\nresistance = {}\n", series);
      if (chance(0.7)) electric += fmt::format("leakage_resistance = {}\n", resistance * uniform(3, 50));
      if (chance(0.3)) electric += fmt::format("current_limit = {}\n", volts / series * uniform(0.1, 0.5));
    }
    return film + disc + electric + transient("");
  }

 private:
  std::string transient(const std::string& control) const {
    std::string text = fmt::format("[output]\nfields = false\nerror_estimate = false\n[[step]]\nkind = "
                                   "\"transient\"\nduration = {}\nincrements = {}\n{}",
                                   duration_, increments_, control);
    for (const char* part : {"source_work", "leak_heat"})
      text += fmt::format("[[quantity]]\nname = \"{0}\"\nkind = \"energy\"\nof = \"{0}\"\n", part);
    return text;
  }
  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  int integer(int from, int to) { return std::uniform_int_distribution(from, to)(random_); }
  bool chance(double part) { return uniform(0, 1) < part; }

  /// A time: any, or beside the end of an increment.
  double moment(double least, double most) {
    const double t = uniform(least, most) * duration_, h = duration_ / increments_;
    if (chance(0.6)) return t;
    const double end = h * std::max(1.0, std::round(t / h));
    return end * (1 + (chance(0.5) ? 0 : std::pow(10, uniform(-16, -5)) * (chance(0.5) ? 1 : -1)));
  }
  std::string wave(double from, double to, const std::string& unit) {
    const auto value = [&](double v) {
      return unit.empty() ? fmt::format("{}", v) : fmt::format("\"{}{}\"", v, unit);
    };
    const std::string ends = fmt::format("from = {}, to = {}", value(from), value(to));
    const double swing = (to - from) / 2, mean = (to + from) / 2;
    const auto frequency = [&] { return uniform(0.3, 6) / duration_; };
    switch (integer(0, 8)) {
    case 0:
      return fmt::format("{{ wave = \"step\", {}, at = {} }}", ends, chance(0.3) ? 0 : moment(0.1, 0.8));
    case 1: {
      const double start = chance(0.3) ? 0 : moment(0.1, 0.4);
      return fmt::format("{{ wave = \"ramp\", {}, at = {}, duration = {} }}", ends, start, moment(0.05, 0.8));
    }
    case 2: {
      const double rise = chance(0.3) ? 0 : moment(0.01, 0.1), fall = chance(0.3) ? 0 : moment(0.01, 0.1);
      const double hold = moment(0.05, 0.3);
      return fmt::format(
          "{{ wave = \"trapezoid\", {}, at = {}, rise = {}, hold = {}, fall = {}, period = {} }}", ends,
          chance(0.5) ? 0 : moment(0.01, 0.3), rise, hold, fall,
          chance(0.4) ? 0 : (rise + hold + fall) * uniform(1, 2));
    }
    case 3:
      return fmt::format("{{ wave = \"sine\", mean = {}, amplitude = {}, frequency = {} }}", value(mean),
                         value(swing), frequency());
    case 4:
      return fmt::format("{{ wave = \"unipolar sine\", from = {}, amplitude = {}, frequency = {} }}",
                         value(from), value(2 * swing), frequency());
    case 5:
    case 6:
      return fmt::format("{{ wave = \"square\", {}, frequency = {}, duty = {} }}", ends,
                         chance(0.3) ? increments_ / (integer(4, 9) * duration_) : frequency(),
                         uniform(0.1, 0.9));
    case 7:
      return fmt::format("{{ wave = \"sweep\", mean = {}, amplitude = {}, frequency = {}, end_frequency = "
                         "{}, duration = {} }}",
                         value(mean), value(swing), 1 / duration_, frequency(),
                         duration_ * uniform(0.5, 1.2));
    default: {
      const std::string file = fmt::format("wave{}.csv", files_++);
      std::ofstream table(directory_ / file);
      table << "time_s,value" << (unit.empty() ? "" : "_" + unit.substr(1)) << "\n";
      const int rows = integer(3, 40), decimals = integer(4, 12);
      double last = -1;
      for (int row = 0; row <= rows; ++row) {
        const double t = std::stod(fmt::format("{:.{}f}", duration_ * row / rows, decimals));
        if (t <= last) continue;
        table << fmt::format("{},{}\n", t, uniform(from, to));
        last = t;
      }
      return fmt::format("{{ wave = \"file\", file = \"{}\" }}", file);
    }
    }
  }

  std::filesystem::path directory_;
  std::mt19937 random_;
  double duration_ = 0;
  int increments_ = 0, files_ = 0;
};

/// Branches and what drives the electrode, from the case.
template<class Oracle>
Oracle driven_oracle(const Case& one) {
  Oracle oracle;
  oracle.modulus = materials::initial_shear_modulus(one.parts.front().film->material.law);
  oracle.permittivity = one.parts.front().film->material.dielectric.permittivity;
  oracle.thickness = one.parts.front().film->thickness;
  if (one.drives.begin()->second.charge) oracle.supply = Oracle::Supply::charge;
  if (!one.circuits.empty() && !one.drives.begin()->second.charge) {
    oracle.supply = Oracle::Supply::circuit;
    const auto& circuit = one.circuits.begin()->second;
    oracle.resistance = circuit.resistance;
    if (circuit.leakage_resistance) oracle.leakage = 1 / *circuit.leakage_resistance;
    if (circuit.current_limit) oracle.current_limit = *circuit.current_limit;
  }
  for (const materials::Branch& branch : one.parts.front().film->material.branches) {
    const double modulus = materials::initial_shear_modulus(branch.law);
    oracle.branches.push_back({modulus, branch.viscosity / modulus});
  }
  return oracle;
}

PatchOracle patch_oracle(const Case& one) {
  const auto& patch = *one.geometry<Patch>();
  auto oracle = driven_oracle<PatchOracle>(one);
  for (std::size_t b = 0; b < oracle.branches.size(); ++b)
    oracle.branches[b].nominal =
        one.parts.front().film->material.branches[b].dashpot == materials::Dashpot::nominal;
  oracle.alike = patch.mode == PatchMode::equal_biaxial;
  oracle.held = {patch.stretch_x.has_value(), patch.mode == PatchMode::pure_shear};
  oracle.begin();
  return oracle;
}

SheetOracle sheet_oracle(const Case& one) {
  auto oracle = driven_oracle<SheetOracle>(one);
  oracle.prestretch = one.parts.front().film->prestretch[0];
  const Electrode& electrode = one.electrodes.front();
  oracle.sheet_resistance = *electrode.sheet_resistance;
  oracle.begin(build_mesh(one), electrode.place, electrode.terminal, "rim");
  return oracle;
}

/// What an oracle says at the times of `rows`.
template<class Oracle>
std::vector<Row> reference(const Case& one, Oracle oracle, const std::vector<Row>& rows) {
  const Drive& drive = one.drives.begin()->second;
  std::vector<const Waveform*> waves{drive.charge ? &*drive.charge : &*drive.voltage};
  const auto* patch = one.geometry<Patch>();
  if (patch && patch->stretch_x) waves.push_back(&*patch->stretch_x);
  if (patch && patch->stress_x) waves.push_back(&*patch->stress_x);
  const double duration = *one.steps.front().duration;
  const bool alike = patch && patch->mode == PatchMode::equal_biaxial;
  const bool held_across = patch && patch->mode == PatchMode::pure_shear;
  const auto loads = [&](auto value) {
    PatchOracle::Loads all{{0, held_across ? 1.0 : 0.0}, value(*waves.front())};
    if (waves.size() > 1) {
      all.along[0] = value(*waves[1]);
      if (alike) all.along[1] = all.along[0];
    }
    return all;
  };
  const auto at = [&](double t) { return loads([t](const Waveform& wave) { return wave.at(t); }); };
  const auto before = [&](double t) { return loads([t](const Waveform& wave) { return wave.before(t); }); };

  const auto row_at = [&](double t) {
    const test::Account& a = oracle.account;
    return Row{t, a.electrical, a.mechanical, a.dissipated, a.electrical + a.resistance + a.leak, a.leak};
  };
  std::vector<double> times{0, duration};
  for (const Waveform* wave : waves)
    for (const double t : wave->kinks(0, duration)) times.push_back(t);
  for (const Row& row : rows) times.push_back(std::min(row.time, duration));
  std::ranges::sort(times);
  const auto same = [&](double a, double b) { return std::abs(b - a) <= 1e-9 * duration; };

  std::vector<Row> found{row_at(0)};
  const PatchOracle::Loads none{{patch && patch->stretch_x ? 1.0 : 0.0, held_across ? 1.0 : 0.0}, 0};
  oracle.jump(none, at(0));
  std::size_t next = 1;
  if (rows.size() > 1 && rows[1].time == 0) found.push_back(row_at(0)), ++next;
  double t = 0;
  PatchOracle::Loads behind = at(0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (same(times[i], t)) continue;
    const double end = times[i];
    std::size_t last = i; // of the kinks that are as good as one
    while (last + 1 < times.size() && same(times[last + 1], end)) ++last;
    const auto inside = [&](double when) {
      const double beside = 1e-6 * (end - t); // of rounding, and of what a wave takes for the same time
      return when <= t + beside ? behind : when >= end - beside ? before(end) : at(when);
    };
    oracle.pass(inside, t, end, std::max(8, static_cast<int>(3000 * (end - t) / duration)));
    const Row left = row_at(end);
    t = end;
    behind = at(times[last]);
    const bool ends = same(end, duration);
    if (!ends) oracle.jump(before(end), behind);
    const bool twice = next + 1 < rows.size() && same(rows[next].time, end) && same(rows[next + 1].time, end);
    if (twice) found.push_back(left), ++next;
    if (next < rows.size() && same(rows[next].time, end)) found.push_back(ends ? left : row_at(end)), ++next;
  }
  return found;
}

class Works : public test::ScratchTest {};

/// The time tolerance bounds the errors of a sheet's charges over their largest of the whole run. Rows at its
/// very beginning, which have exchanged 1e-8 to 1e-4 of what the run exchanges, miss 1 % in two of 125 draws
/// (184: 1.9 %, 268: 1.5 %); with a tenth of the tolerance they miss 0.3 %, with a hundredth 0.07 %: so it is
/// the run's tolerance that shows there, not the independent integration's.
struct Draw {
  unsigned seed;
  bool fine = false; ///< with a tenth of the time tolerance, and compared from the first row on
};

const int drawn = test::drawn_cases("DIELAST_WORKS_CASES", 60);

std::vector<Draw> all_draws() {
  std::vector<Draw> draws{{184, true}, {268, true}};
  for (int seed = 1; seed <= drawn; ++seed) draws.push_back({static_cast<unsigned>(seed)});
  return draws;
}

TEST_F(Works, of_random_transients_agree_with_an_independent_integration) {
  int poor = 0, not_complete = 0;
  double worst = 0;
  for (const auto& [seed, fine] : all_draws()) {
    const bool sheet = seed % 4 == 0;
    RandomTransient random(directory, seed);
    std::string text = sheet ? random.of_sheet() : random.of_patch();
    if (fine) text += "[solver]\ntime_tolerance = 1e-7\n";
    write("case.toml", text);
    SCOPED_TRACE(fmt::format("seed {}\n{}", seed, text));
    Case one;
    ASSERT_NO_THROW(one = read_case(directory / "case.toml"));
    const auto place = [&](const char* name) {
      return static_cast<std::size_t>(std::ranges::find(one.quantities, name, &Quantity::name) -
                                      one.quantities.begin());
    };
    const std::size_t electrical = place("electrical_work"), mechanical = place("mechanical_work"),
                      dissipated = place("dissipated_energy"), source = place("source_work"),
                      leak = place("leak_heat");
    std::vector<Row> rows;
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      const auto& v = frame.values;
      rows.push_back({frame.record.time, v[electrical], v[mechanical], v[dissipated], v[source], v[leak]});
      return true;
    };
    if (simulation.run(observer).ending != Ending::complete) {
      ++not_complete;
      continue;
    }
    for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_GE(rows[i].dissipated, rows[i - 1].dissipated) << i;
    if (simulation.energy().worst().is_poor()) {
      ++poor;
      continue;
    }
    const std::vector<Row> expected =
        sheet ? reference(one, sheet_oracle(one), rows) : reference(one, patch_oracle(one), rows);
    ASSERT_EQ(rows.size(), expected.size());
    double exchanged = 1e-15, off = 0;
    // See Draw: of a sheet, rows that have exchanged less than 1 % of the run's work are compared with that.
    if (sheet && !fine)
      for (const Row& b : expected)
        exchanged = std::max({exchanged, 0.01 * std::abs(b.electrical), 0.01 * std::abs(b.source)});
    std::size_t where = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Row &a = rows[i], &b = expected[i];
      for (const double energy : {b.electrical, b.mechanical, b.dissipated, b.source, b.leak})
        exchanged = std::max(exchanged, std::abs(energy));
      for (const double difference : {a.electrical - b.electrical, a.mechanical - b.mechanical,
                                      a.dissipated - b.dissipated, a.source - b.source, a.leak - b.leak})
        if (std::abs(difference) > off * exchanged) off = std::abs(difference) / exchanged, where = i;
    }
    const auto text_of = [](const Row& row) {
      return fmt::format(
          "t = {:.9g}: electrical {:.4e}, mechanical {:.4e}, dissipated {:.4e}, source {:.4e}, "
          "leak {:.4e}",
          row.time, row.electrical, row.mechanical, row.dissipated, row.source, row.leak);
    };
    EXPECT_LT(off, 0.01) << text_of(rows[where]) << "\nshould be " << text_of(expected[where])
                         << "\nestimate " << simulation.energy().worst().error << " of "
                         << simulation.energy().worst().exchanged;
    worst = std::max(worst, off);
  }
  fmt::print("{} cases: largest difference {:.2e}, {} told to be poor, {} not complete\n", drawn, worst, poor,
             not_complete);
  EXPECT_LE(poor, drawn / 20);
  EXPECT_LE(not_complete, drawn / 20);
}

} // namespace
} // namespace dielast::cases::works_test
