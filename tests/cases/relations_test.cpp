// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "fem/algebra/dense_algebra.hpp"
#include "meshing/rings.hpp"
#include "tests/cases/own_mesh.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <random>

namespace dielast::cases::relations_test {
namespace {

/// Random cases that one device answers in two ways: what is true of one must be true of the other. Seeds are
/// fixed: a case that fails fails again.
class Relations : public test::ScratchTest {
 protected:
  static constexpr int draws = 20;

  double draw(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }

  struct Run {
    Case one;
    Outcome outcome;
    std::vector<double> times;
    std::vector<std::vector<double>> rows; ///< values of the quantities
    std::vector<double> voltage;           ///< of the first electrode
    std::vector<Analysis> analyses;

    std::size_t column(const std::string& name) const {
      return static_cast<std::size_t>(std::ranges::find(one.quantities, name, &Quantity::name) -
                                      one.quantities.begin());
    }
    double last(const std::string& name) const { return rows.back().at(column(name)); }
  };

  Run run(const std::string& text) {
    write("case.toml", text + "[output]\nerror_estimate = false\nfields = false\n");
    Run run{read_case(directory / "case.toml"), {}, {}, {}, {}, {}};
    Simulation simulation(run.one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      run.times.push_back(frame.record.time);
      run.rows.push_back(frame.values);
      run.voltage.push_back(frame.record.voltages.at(0));
      return true;
    };
    observer.on_analysis = [&](const Analysis& found, const fem::State&) { run.analyses.push_back(found); };
    run.outcome = simulation.run(observer);
    EXPECT_EQ(run.outcome.ending, Ending::complete) << run.outcome.message << "\n" << text;
    return run;
  }

  /// A film of a random law with J m^-3 of the order of 40 kPa; `branch`: with one Maxwell branch.
  std::string film(double prestretch, bool branch) {
    const double mu = draw(20e3, 80e3);
    const bool gent = draw(0, 1) < 0.5;
    std::string text = fmt::format("[film]\nthickness = {}\nprestretch = {}\n[film.material]\nlaw = \"{}\"\n"
                                   "shear_modulus = {}\npermittivity = 4e-11\n",
                                   draw(0.2e-3, 1e-3), prestretch, gent ? "gent" : "neo-hookean", mu);
    if (gent) text += fmt::format("stretch_limit = {}\n", draw(60, 150));
    if (branch)
      text += fmt::format("[[film.material.branch]]\nshear_modulus = {}\nrelaxation_time = {}\n",
                          draw(0.2, 1) * mu, draw(0.1, 3));
    return text;
  }
  /// A voltage at which a free film of that text is far from pull-in: Phi/H = share sqrt(mu/eps).
  double voltage(const std::string& text, double share) {
    write("case.toml", text + "[patch]\n");
    const Film read = *read_case(directory / "case.toml").parts.front().film;
    return share * read.thickness *
           std::sqrt(materials::initial_shear_modulus(read.material.law) /
                     read.material.dielectric.permittivity);
  }

 private:
  std::mt19937 random_{20261121};
};

TEST_F(Relations, ChargeControlFindsTheStatesOfVoltageControl) {
  for (int i = 0; i < draws; ++i) {
    const bool patch = i % 2 == 0;
    const std::string text = film(patch ? 1 : draw(1.5, 3), false);
    const std::string device =
        patch ? "[patch]\nmode = \"equal-biaxial\"\n[drive]\n"
              : "[disc]\nradius = 0.05\nelectrode_radius = 0.02\n[mesh]\nrings = 6\n[[quantity]]\nname = "
                "\"charge\"\nkind = \"charge\"\nof = \"film\"\n[drive]\n";
    const Run driven = run(text + device +
                           fmt::format("voltage = {}\n[[step]]\nkind = \"voltage\"\n",
                                       voltage(text, patch ? draw(0.1, 0.6) : draw(0.05, 0.15))));
    const Run charged =
        run(text + device +
            fmt::format("charge = {:.17g}\n[[step]]\nkind = \"charge\"\n", driven.last("charge")));
    const double grown = driven.last("capacitance") - driven.rows.front()[driven.column("capacitance")];
    EXPECT_GT(grown, 0);
    EXPECT_NEAR(charged.last("capacitance"), driven.last("capacitance"), 1e-6 * grown) << text << device;
    EXPECT_NEAR(charged.voltage.back(), driven.voltage.back(), 1e-6 * driven.voltage.back()) << text;
  }
}

TEST_F(Relations, AMoveNeedsTheForceThatMovesAsFar) {
  for (int i = 0; i < draws; ++i) {
    const std::string text = film(1, false), patch = "[patch]\n";
    const double stress = draw(0.1, 0.8) * 40e3;
    const Run pulled = run(text + patch + fmt::format("stress_x = {}\n", stress));
    const Run moved = run(text + patch + fmt::format("stretch_x = {:.17g}\n", pulled.last("stretch_x")));
    EXPECT_NEAR(moved.last("stress_x"), stress, 1e-6 * stress) << text;
    EXPECT_NEAR(moved.last("stretch_y"), pulled.last("stretch_y"), 1e-8) << text;
  }
}

TEST_F(Relations, IncrementsChangeNoStaticResult) {
  for (int i = 0; i < draws; ++i) {
    const std::string text = film(1, false);
    const double volts = voltage(text, draw(0.1, 0.55)), stress = draw(0, 10e3);
    std::vector<double> found;
    for (const int increments : {1, 3, 17, 60})
      found.push_back(
          run(text + fmt::format("[patch]\nstress_x = {}\n[drive]\nvoltage = {}\n[[step]]\nkind = "
                                 "\"force\"\nincrements = {}\n[[step]]\nkind = \"voltage\"\n"
                                 "increments = {}\n",
                                 stress, volts, increments, increments))
              .last("stretch_x"));
    for (const double other : found) EXPECT_NEAR(other, found.back(), 1e-7) << text;
  }
}

TEST_F(Relations, RecordAndIncrementsChangeNoResultInTime) {
  for (int i = 0; i < draws; ++i) {
    const std::string text = film(1, true);
    const double volts = voltage(text, draw(0.2, 0.5)), duration = draw(0.5, 3);
    const std::vector<std::string> waves{
        fmt::format("wave = \"step\", to = {}, at = {}", volts, draw(0, 0.5) * duration),
        fmt::format("wave = \"ramp\", to = {}, duration = {}", volts, draw(0.2, 0.9) * duration),
        fmt::format("wave = \"trapezoid\", to = {}, rise = {}, hold = {}", volts, draw(0, 0.3) * duration,
                    draw(0.1, 0.4) * duration),
        fmt::format("wave = \"square\", to = {}, frequency = {}, duty = {}", volts, 1.5 / duration,
                    draw(0.2, 0.8)),
        fmt::format("wave = \"sine\", amplitude = {}, frequency = {}", volts, draw(0.5, 2) / duration)};
    const std::string& wave = waves[static_cast<std::size_t>(i) % waves.size()];
    std::vector<double> stretch;
    double swing = 0; // largest change of the stretch on the way: what comes back to 1 has no size of its own
    for (const auto& [increments, record] : {std::pair{60, 0.0}, {60, 0.37}, {60, 1.0}, {200, 0.0}}) {
      const Run found =
          run(text + fmt::format("[patch]\n[drive]\nvoltage = {{ {} }}\n[[step]]\nkind = \"transient\"\n"
                                 "duration = {}\nincrements = {}\n{}",
                                 wave, duration, increments,
                                 record > 0 ? fmt::format("record = {}\n", record * duration) : ""));
      stretch.push_back(found.last("stretch_x"));
      for (const auto& row : found.rows)
        swing = std::max(swing, std::abs(row[found.column("stretch_x")] - 1));
    }
    for (const double other : stretch)
      EXPECT_NEAR(other, stretch.back(), 2e-4 * swing) << wave << "\n" << text;
  }
}

// The own mesh is the disc's of 3-node triangles: the same numbers. Curved triangles and the meridian have no
// mesh in common: the same device.
TEST_F(Relations, MeridianSpaceAndOwnMeshAreOneDisc) {
  for (int i = 0; i < draws; ++i) {
    const std::string text = film(draw(1.5, 3), false);
    const double radius = draw(30e-3, 90e-3), inner = draw(0.3, 0.6) * radius;
    const std::string drive = fmt::format(
        "[drive]\nvoltage = {}\n[[step]]\nkind = \"voltage\"\nincrements = 2\n", voltage(text, 0.05));
    const std::string disc = fmt::format(
        "[disc]\nradius = {:.17g}\nelectrode_radius = {:.17g}\n[mesh]\nrings = 10\n", radius, inner);
    write("disc.msh", test::gmsh_text(meshing::disc_mesh(radius, inner, 10, 1, false), "electrode", "rim"));
    const Run space = run(text + disc + drive), straight = run(text + disc + "order = 1\n" + drive);
    const Run meridian = run("model = \"axisymmetric\"\n" + text + disc + drive);
    const Run own = run(text +
                        "[mesh]\nfile = \"disc.msh\"\nunit = \"1 mm\"\n[[electrode]]\nname = \"film\"\n"
                        "place = \"electrode\"\n[[support]]\nplace = \"rim\"\nfix = [\"x\", \"y\"]\n" +
                        drive);
    const auto change_of = [](const Run& one) {
      return one.last("capacitance") - one.rows.front()[one.column("capacitance")];
    };
    EXPECT_GT(change_of(space), 0);
    EXPECT_NEAR(change_of(meridian), change_of(space), 5e-3 * change_of(space)) << text << disc;
    EXPECT_NEAR(change_of(own), change_of(straight), 1e-7 * change_of(straight)) << text << disc;
    EXPECT_NEAR(own.last("capacitance"), straight.last("capacitance"), 1e-9 * straight.last("capacitance"));
  }
}

/// Complex amplitude of exp(i omega t) in the rows of the last period.
std::complex<double> amplitude(const std::vector<double>& times, const std::vector<double>& values,
                               double omega) {
  const double from = times.back() - 2 * std::numbers::pi / omega;
  std::vector<std::array<double, 4>> rows;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (times[i] > from)
      rows.push_back({1, std::cos(omega * times[i]), std::sin(omega * times[i]), values[i]});
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rows.size()), 3);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index r = 0; r < A.rows(); ++r) {
    for (Eigen::Index c = 0; c < 3; ++c)
      A(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    b[r] = rows[static_cast<std::size_t>(r)][3];
  }
  const Eigen::VectorXd x = fem::least_squares(A, b);
  return {x[1], -x[2]};
}

TEST_F(Relations, AHarmonicResponseIsThatOfASmallSine) {
  for (int i = 0; i < draws; ++i) {
    const std::string text = film(draw(1.3, 2.2), i % 2 == 1);
    const double bias = voltage(text, draw(0.05, 0.15)), frequency = draw(1, 8), swing = 0.005 * bias;
    const double length = std::ceil(std::max(4.0, 1.5 * frequency)) / frequency;
    const std::string device =
        "[annulus]\ninner_radius = \"12.7 mm\"\nouter_radius = \"68.58 mm\"\n[mesh]\nrings = 4\n[plate]\n" +
        fmt::format("mass = {}\ndamping = {}\n", draw(0.02, 0.1), draw(1, 4)) +
        (draw(0, 1) < 0.5 ? fmt::format("[circuit]\nresistance = {}\n", draw(1e5, 1e7)) : "");
    const auto drive = [&](const std::string& wave) {
      return "[drive]\nvoltage = " + wave + "\n[[step]]\nkind = \"weight\"\n[[step]]\nkind = \"voltage\"\n";
    };
    const Run linear = run(text + device + drive(fmt::format("{}", bias)) +
                           fmt::format("[[step]]\nkind = \"harmonic\"\nfrom = {}\nto = {}\npoints = 2\n",
                                       frequency, 2 * frequency));
    const Run timed =
        run(text + device +
            drive(fmt::format("{{ wave = \"sine\", mean = {}, amplitude = {}, frequency = {} }}", bias, swing,
                              frequency)) +
            fmt::format("[[step]]\nkind = \"transient\"\nduration = {}\nincrements = {}\n", length,
                        static_cast<int>(std::ceil(length * frequency * 60))));
    ASSERT_EQ(linear.analyses.size(), 1u);
    std::vector<double> times, drop;
    for (std::size_t r = 0; r < timed.times.size(); ++r)
      if (timed.times[r] > 0)
        times.push_back(timed.times[r]), drop.push_back(timed.rows[r][timed.column("drop")]);
    // the sine is the imaginary part of exp(i omega t)
    const auto found =
        amplitude(times, drop, 2 * std::numbers::pi * frequency) * std::complex<double>(0, 1) / swing;
    const auto& row = linear.analyses[0].rows[0];
    const auto expected = std::polar(row[1], row[2] * std::numbers::pi / 180);
    EXPECT_LT(std::abs(found - expected), 0.02 * std::abs(expected))
        << found << " instead of " << expected << " of\n"
        << text << device << bias << " V, " << frequency << " Hz";
  }
}

} // namespace
} // namespace dielast::cases::relations_test
