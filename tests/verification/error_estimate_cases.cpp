// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/verification/error_estimate_cases.hpp"

#include "cases/case/quantities.hpp"
#include "cases/readers/reader.hpp"
#include "cases/results/error_estimate.hpp"
#include "cases/results/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <map>

namespace dielast::test {

using namespace dielast::cases;

namespace {

constexpr double negligible = 1e-9;       ///< of the case's largest value in that unit: round-off
constexpr double smallest_printed = 1e-6; ///< of a value

/// Elements and time steps smaller by a power of two, and the barrier of contact by its square.
Case reference_of(Case one, int factor) {
  if (one.geometry<MeshFile>()) one.parts.front().mesh.refine += std::countr_zero(unsigned(factor));
  one.parts.front().mesh.wall_elements *= factor;
  one.parts.front().mesh.rings *= factor;
  one.parts.front().mesh.across *= factor;
  if (one.contact) one.contact->thickness /= factor * factor;
  for (Step& step : one.steps)
    if (step.duration) step.increments *= factor;
  one.solver.time_tolerance /= std::pow(factor, 3);
  return one;
}

std::string kind_of(const Quantity& quantity, const Case& one) {
  static const std::map<std::string, const char*> groups{
      {"extreme", "extremes of fields"},
      {"radial stretch", "stretches at an edge"},
      {"stiffness", "stiffnesses, frequencies"},
      {"natural frequency", "stiffnesses, frequencies"},
      {"energy", "works, energies"},
      {"peak", "peaks in time"},
      {"capacitance", "capacitances, charges, currents"},
      {"charge", "capacitances, charges, currents"},
      {"current", "capacitances, charges, currents"},
      {"force", "forces, pressures, stresses, volumes"},
      {"pressure", "forces, pressures, stresses, volumes"},
      {"volume", "forces, pressures, stresses, volumes"},
      {"nominal stress", "forces, pressures, stresses, volumes"}};
  if (const auto group = groups.find(quantity.kind->word); group != groups.end()) return group->second;
  return std::ranges::any_of(one.steps, [](const Step& s) { return s.duration.has_value(); })
             ? "lengths and strains in time"
             : "lengths and strains";
}

struct Run {
  explicit Run(const Case& one) : simulation(one, 1) {
    SimulationObserver observer;
    observer.on_accept = [this](const Frame& frame) {
      records.push_back(frame.record);
      return true;
    };
    outcome = simulation.run(observer);
  }

  Simulation simulation;
  std::vector<post::StepRecord> records;
  Outcome outcome;
};

/// Largest value of the case in a unit.
double scale(const Case& one, const std::vector<double>& values, const std::string& unit) {
  double largest = 0;
  for (std::size_t q = 0; q < values.size(); ++q)
    if (unit_of(one.quantities[q], one.quantities) == unit) largest = std::max(largest, std::abs(values[q]));
  return largest;
}

} // namespace

double EstimatedValue::error() const { return std::abs(value - reference); }

std::vector<EstimatedCase> estimated_cases() {
  return {
      {"honeycomb", {"mesh.wall_elements=8"}},
      {"honeycomb", {"honeycomb.angle=130 deg"}},
      {"honeycomb", {"honeycomb.angle=110 deg", "drive.voltage=7.5 kV", "mesh.wall_elements=8"}},
      {"honeycomb", {"honeycomb.angle=90 deg"}},
      {"honeycomb", {"honeycomb.angle=120 deg", "drive.voltage=7 kV"}},
      {"honeycomb", {"honeycomb.angle=160 deg"}},
      {"honeycomb", {"honeycomb.angle=140 deg", "film.prestretch=3", "mesh.wall_elements=6"}},
      {"honeycomb", {"honeycomb.angle=150 deg", "mesh.order=1", "mesh.wall_elements=8"}},
      {"honeycomb", {"honeycomb.angle=120 deg", "mesh.order=1"}},
      {"honeycomb", {"honeycomb.angle=90 deg", "mesh.order=1", "mesh.wall_elements=6"}},
      {"honeycomb", {"honeycomb.angle=110 deg", "mesh.grading=1", "model=3d"}},
      {"disc", {"mesh.rings=24"}},
      {"disc", {"mesh.rings=12", "disc.electrode_radius=50 mm"}},
      {"disc", {"mesh.rings=8", "mesh.order=1"}},
      {"disc", {"mesh.rings=16", "mesh.order=1", "disc.electrode_radius=15 mm"}},
      {"disc", {"mesh.rings=9", "mesh.order=1", "film.prestretch=[3, 2]"}},
      {"disc", {"mesh.rings=10", "film.prestretch=2", "drive.voltage=4 kV", "model=3d"}},
      {"disc", {"mesh.rings=24", "model=axisymmetric"}},
      {"disc", {"mesh.rings=16", "mesh.order=1", "model=axisymmetric", "disc.electrode_radius=60 mm"}},
      {"annulus", {"mesh.rings=12"}},
      {"annulus", {"mesh.rings=8", "mesh.order=1"}},
      {"annulus", {"mesh.rings=6", "annulus.inner_radius=30 mm"}},
      {"annulus", {"mesh.rings=6"}},
      {"annulus", {"mesh.rings=14", "annulus.inner_radius=5 mm"}},
      {"disc", {"mesh.rings=6", "disc.electrode_radius=15 mm"}},
      {"diaphragm", {"mesh.rings=16", "plate.mass=50 g"}},
      {"diaphragm", {"mesh.rings=12", "mesh.order=1"}},
      {"diaphragm", {"mesh.rings=24", "mesh.order=1", "film.prestretch=2.5"}},
      {"diaphragm", {"mesh.rings=8", "plate.mass=200 g", "drive.voltage=3 kV"}},
      {"diaphragm", {"mesh.rings=32", "mesh.order=1", "annulus.inner_radius=5 mm", "plate.mass=30 g"}},
      {"diaphragm", {"mesh.rings=24", "annulus.inner_radius=5 mm", "plate.mass=30 g"}},
      {"diaphragm", {"mesh.rings=6", "mesh.order=1", "model=3d"}},
      {"diaphragm", {"mesh.rings=5", "model=3d", "drive.voltage=3 kV"}},
      {"balloon", {"mesh.rings=32"}},
      {"balloon", {"mesh.rings=24", "mesh.order=1", "chamber.volume=90 ml"}},
      {"balloon", {"mesh.rings=40", "mesh.order=1", "film.prestretch=1.05"}},
      {"weighted_in_time", {}},
      {"weighted_in_time", {"mesh.order=1", "step.transient.increments=50", "drive.voltage.to=3 kV"}},
      {"shell_disc", {}},
      {"shell_disc", {"film.prestretch=2", "film.thickness=0.02 mm", "mesh.rings=12"}},
      {"slab_on_table", {}},
      {"slab_on_table", {"contact.thickness=50 um", "table.friction=0.1"}},
      {"creeping_disc", {}},
      {"creeping_disc",
       {"model=axisymmetric", "mesh.order=1", "mesh.rings=16", "solver.time_tolerance=1e-4"}},
      {"creeping_patch", {}},
      {"creeping_patch", {"solver.time_tolerance=1e-6", "patch.stress_x=30 kPa"}},
      {"creeping_patch", {"step.transient.increments=30", "drive.voltage.frequency=0.3 Hz"}},
      {"own_mesh", {}},
      {"own_mesh", {"mesh.file=notched.msh", "film.prestretch=2"}},
      {"own_mesh", {"mesh.file=notched.msh", "mesh.refine=2", "drive.voltage=2 kV"}},
      {"own_mesh", {"mesh.refine=2", "film.prestretch=2"}},
  };
}

std::vector<EstimatedCase> quick_estimated_cases() {
  return {{"honeycomb", {"honeycomb.angle=110 deg", "drive.voltage=7.5 kV"}},
          {"honeycomb", {"honeycomb.angle=140 deg", "mesh.order=1"}},
          {"disc", {"mesh.rings=8", "mesh.order=1"}},
          {"annulus", {"mesh.rings=8"}},
          {"diaphragm", {"mesh.rings=12", "mesh.order=1"}},
          {"balloon", {"mesh.rings=32"}},
          {"creeping_patch", {}},
          {"own_mesh", {}}};
}

void add_estimates(const EstimatedCase& from, EstimateCount& count) {
  const std::string label = fmt::format("{} {}", from.file, fmt::join(from.overrides, " "));
  const Case one = read_case(std::filesystem::path(DIELAST_SOURCE_DIR) /
                                 "tests/verification/error_estimates" / (from.file + ".toml"),
                             from.overrides);
  const Case finer = reference_of(one, from.finer);
  const Run own(one), reference(finer);
  for (const Run* run : {&own, &reference})
    if (run->outcome.ending != Ending::complete) {
      count.without.push_back(fmt::format("{}: {}", label, run->outcome.message));
      return;
    }
  const Estimates estimates = estimate_errors(one, own.simulation, own.outcome, own.records, {}, 1);
  if (!estimates.reason.empty()) count.without.push_back(fmt::format("{}: {}", label, estimates.reason));
  for (std::size_t q = 0; q < estimates.quantities.size(); ++q) {
    const Quantity& quantity = one.quantities[q];
    const ErrorEstimate& estimate = estimates.quantities[q];
    EstimatedValue value{.label = label,
                         .quantity = quantity.name,
                         .kind = kind_of(quantity, one),
                         .value = own.simulation.results()[q],
                         .reference = reference.simulation.results()[q]};
    if (quantity.kind->word == "energy" && quantity.of == "error") continue;
    if (quantity.of == "breakdown_ratio") continue; // the largest field again
    const double size = scale(one, own.simulation.results(), unit_of(quantity, one.quantities));
    if (!(value.error() > negligible * size)) continue;
    if (!estimate.error) {
      count.without.push_back(fmt::format("{}: {} {:.6g} ({:.6g} on the finer mesh): {}", label,
                                          quantity.name, value.value, value.reference, estimate.remark));
      continue;
    }
    value.printed = std::max(*estimate.error, smallest_printed * std::abs(value.value));
    count.values.push_back(std::move(value));
  }
}

double share(const std::vector<EstimatedValue>& values) {
  const auto held = std::ranges::count_if(values, &EstimatedValue::holds);
  return static_cast<double>(held) / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

double median_ratio(const std::vector<EstimatedValue>& values) {
  std::vector<double> ratios;
  for (const EstimatedValue& value : values) ratios.push_back(value.printed / value.error());
  if (ratios.empty()) return 0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

std::string exceptions(const EstimateCount& count) {
  std::string text;
  for (const EstimatedValue& value : count.values)
    if (!value.holds())
      text += fmt::format("above: {}: {} {:.8g}, error {:.3g}, printed {:.3g}\n", value.label, value.quantity,
                          value.value, value.error(), value.printed);
  for (const std::string& line : count.without) text += fmt::format("without: {}\n", line);
  return text;
}

std::string table(const EstimateCount& count) {
  std::map<std::string, std::vector<EstimatedValue>> kinds;
  for (const EstimatedValue& value : count.values) kinds[value.kind].push_back(value);
  std::string text =
      "| quantities | number | error below the printed one | median printed / true |\n|---|---|---|---|\n";
  const auto add_row = [&](const std::string& name, const std::vector<EstimatedValue>& values) {
    text += fmt::format("| {} | {} | {:.0f} % | {:.1f} |\n", name, values.size(), 100 * share(values),
                        median_ratio(values));
  };
  for (const auto& [kind, values] : kinds) add_row(kind, values);
  add_row("all", count.values);
  return text;
}

} // namespace dielast::test
