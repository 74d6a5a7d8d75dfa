// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"

#include "cases/loads/step_loads.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "meshing/mesh_error.hpp"
#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace dielast::cases::device_test {
namespace {

const std::filesystem::path valid = std::filesystem::path(DIELAST_SOURCE_DIR) / "tests/cases/valid";
const std::vector<std::string> small{"honeycomb.columns=[2, 1, 2]", "mesh.wall_elements=2",
                                     "step.voltage.increments=2"};

Case honeycomb(std::vector<std::string> overrides = {}) {
  overrides.insert(overrides.begin(), small.begin(), small.end());
  return read_case(valid / "honeycomb.toml", overrides);
}

TEST(Device, PlacesAreThoseOfTheMesh) {
  const Device device = build_device(honeycomb());
  const auto places = places_of(device.mesh);
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
  for (const char* place :
       {"film", "walls", "left_apex", "right_apex", "corner_top", "corner_bottom", "centre"})
    EXPECT_TRUE(std::binary_search(places.begin(), places.end(), place)) << place;
  EXPECT_EQ(device.bars.widths.at(0), 0.0008);
}

TEST(Device, OwnMeshThatIsBrokenIsAMeshError) {
  EXPECT_THROW(build_device(read_case(valid / "own_mesh.toml")), meshing::MeshError);
}

TEST(FreeBody, IsPinnedAgainstRigidMotionOnly) {
  for (const auto& [model, pins] : {std::pair{"model=planar", 3}, {"model=3d", 6}}) {
    const Device device = build_device(honeycomb({model}));
    EXPECT_TRUE(device.free_body);
    EXPECT_EQ(device.model.dofs.count() - device.model.dofs.free_count(), pins) << model;
  }
  EXPECT_FALSE(build_device(read_case(valid / "disc.toml")).free_body);
}

TEST(FreeBody, ItsPinsExertNoForce) {
  for (const char* model : {"model=planar", "model=3d"}) {
    const Case one = honeycomb({model, "drive.voltage=5 kV"});
    Simulation simulation(one, 1);
    const fem::DofMap& dofs = simulation.device().model.dofs;
    double pins = 0, forces = 0;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      if (frame.ends_step) {
        pins = std::max(pins, frame.measured.reaction().tail(dofs.count() - dofs.free_count()).norm());
        forces = 45e3 * 1e-3 * 8e-3; // mu H L
      }
      return true;
    };
    EXPECT_EQ(simulation.run(observer).ending, Ending::complete);
    EXPECT_GT(forces, 0);
    EXPECT_LT(pins, 1e-6 * forces) << model;
  }
}

/// The state at the end of the first step, a ramp.
fem::State led_to(const Case& one, const Device& device) {
  fem::State state = device.model.initial_state();
  const Signals signals = signals_of(one);
  const StepLoads loads(one, device, one.steps, signals, state.dead_force);
  loads.path(0, fem::Loads::of(state, device.model.dofs)).apply(state, 1);
  return state;
}

TEST(Loads, AreSpreadEvenlyOverTheirPlace) {
  const Case one =
      read_case(valid / "disc.toml",
                {"load=[{place='electrode_edge', force=['6 mN', '0 N', '0 N']}]", "step=[{kind='force'}]"});
  const Device device = build_device(one);
  const Eigen::VectorXd forces = led_to(one, device).dead_force;
  EXPECT_NEAR(forces.sum(), 6e-3, 1e-15);
  const auto& nodes = device.mesh.node_sets.at("electrode_edge");
  const double side = 6e-3 / (static_cast<double>(nodes.size()) / 2); // a corner has 1/6 of two of them
  const meshing::CellBlock& film = *device.mesh.film();
  std::set<int> corners;
  for (int cell = 0; cell < film.size(); ++cell)
    for (const int n : film.cell(cell).first(3)) corners.insert(n);
  for (const int n : nodes)
    EXPECT_NEAR(forces[device.model.dofs.equation(n, 0)], side * (corners.contains(n) ? 1 : 2) / 3,
                1e-3 * side);
}

TEST(Loads, OfAFreeBodyMustBalanceAtAllTimes) {
  const auto loads = [](const std::string& right) {
    return honeycomb({"load=[{place='left_apex', force=['-1 mN', 0, 0]}, {place='right_apex', force=[" +
                          right + ", 0, 0]}]",
                      "step=[{kind='release'}, {kind='transient', duration='1 s'}]"});
  };
  EXPECT_NO_THROW(build_device(loads("'1 mN'")));
  EXPECT_THROW(build_device(loads("{wave='ramp', from='1 mN', to='2 mN', duration='1 s'}")), CaseError);
  EXPECT_THROW(build_device(loads("{wave='trapezoid', from='1 mN', to='2 mN', at='0.2 s', rise='0.1 s', "
                                  "hold='0.1 s', fall='0.1 s'}")),
               CaseError);
}

Case patch(const std::string& lines) {
  const test::ScratchFolder folder;
  const auto path = folder / "patch.toml";
  std::ofstream(path) << "[film]\nthickness = \"0.5 mm\"\nprestretch = 2\n[film.material]\n"
                         "shear_modulus = \"30 kPa\"\nrelative_permittivity = 4\n[patch]\n"
                      << lines;
  return read_case(path);
}

// What leaks through the film leaks under the sheet: the circuit's conductance is spread over its points.
TEST(Sheet, WithACircuitThatLeaksItLeaks) {
  const test::ScratchFolder folder;
  const auto path = folder / "sheet.toml";
  std::ofstream(path)
      << "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"30 kPa\"\n"
         "relative_permittivity = 4\n[disc]\nradius = 0.03\nelectrode_radius = 0.01\n[mesh]\n"
         "rings = 4\n[[electrode]]\nname = \"film\"\nplace = \"electrode\"\nsheet_resistance = "
         "1e6\nterminal = \"centre\"\n[drive]\nvoltage = 100\n[circuit]\nresistance = 1e5\n"
         "leakage_resistance = 5e8\n[[step]]\nkind = \"hold\"\nduration = 1\n";
  const Device device = build_device(read_case(path));
  double leakage = 0;
  for (const fem::SheetPoint& point : device.model.ports.sheet_points()) leakage += point.leakage;
  EXPECT_NEAR(leakage, 1 / 5e8, 1e-12 / 5e8);
}

TEST(Patch, HasOneUnknownForEachStretch) {
  const Device free = build_device(patch(""));
  EXPECT_EQ(free.model.dofs.free_count(), 2);
  EXPECT_FALSE(free.free_body);
  EXPECT_EQ(free.mesh.nodes[2], Eigen::Vector3d(0.02, 0.02, 0)); // drawn prestretched
  EXPECT_EQ(build_device(patch("mode = \"equal-biaxial\"")).model.dofs.free_count(), 1);
  EXPECT_EQ(build_device(patch("mode = \"pure-shear\"")).model.dofs.free_count(), 1);
  EXPECT_EQ(build_device(patch("stretch_x = 3")).model.dofs.free_count(), 1);
  EXPECT_EQ(build_device(patch("stretch_x = 3\nstretch_y = 1")).model.dofs.free_count(), 0);
}

TEST(Patch, StretchesAndStressesBecomeDisplacementsAndForces) {
  const Case pulled = patch("length = \"20 mm\"\nwidth = \"10 mm\"\nstress_x = \"10 kPa\"");
  const Device device = build_device(pulled);
  EXPECT_NEAR(led_to(pulled, device).dead_force[device.model.dofs.equation(1, 0)], 10e3 * 0.5e-3 * 10e-3,
              1e-15);
  const Case stretched = patch("length = \"20 mm\"\nwidth = \"10 mm\"\nstretch_x = 3");
  const fem::State state = led_to(stretched, build_device(stretched));
  for (const int n : {1, 2})
    EXPECT_DOUBLE_EQ(state.displacement[static_cast<std::size_t>(n)].x(), (3 - 2) * 20e-3);
}

TEST(Patch, InEqualBiaxialTensionBothSidesCarryTheStress) {
  const Case one = patch("mode = \"equal-biaxial\"\nstress_x = \"10 kPa\"");
  const Device device = build_device(one);
  EXPECT_EQ(device.model.dofs.equation(1, 0), device.model.dofs.equation(2, 1));
  EXPECT_NEAR(led_to(one, device).dead_force[device.model.dofs.equation(1, 0)], 2 * 10e3 * 0.5e-3 * 10e-3,
              1e-15);
}

} // namespace
} // namespace dielast::cases::device_test
