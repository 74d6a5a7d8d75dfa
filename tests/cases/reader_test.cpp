// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/text/overrides.hpp"
#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

namespace dielast::cases::reader_test {
namespace {

const std::filesystem::path valid = std::filesystem::path(DIELAST_SOURCE_DIR) / "tests/cases/valid";

Case honeycomb(const std::vector<std::string>& overrides = {}) {
  return read_case(valid / "honeycomb.toml", overrides);
}

std::vector<std::string> quantity_names(const Case& one) {
  std::vector<std::string> names;
  for (const Quantity& quantity : one.quantities) names.push_back(quantity.name);
  return names;
}

TEST(Reader, HoneycombInSI) {
  const Case one = honeycomb();
  EXPECT_EQ(one.title, "Unidirectional honeycomb actuator");
  EXPECT_EQ(one.dimension, fem::Dimension::planar);
  EXPECT_EQ(one.parts.front().film->thickness, 0.001);
  EXPECT_EQ(one.parts.front().film->prestretch, (std::array{4.0, 2.5}));
  EXPECT_EQ(std::get<0>(one.parts.front().film->material.law).shear_modulus, 45e3);
  EXPECT_EQ(one.parts.front().film->material.dielectric.permittivity, 4e-11);
  const auto& lattice = *one.geometry<Honeycomb>();
  EXPECT_DOUBLE_EQ(lattice.angle, 150 * std::numbers::pi / 180);
  EXPECT_EQ(lattice.wall.width, 0.0008);
  EXPECT_EQ(one.drives, (std::map<std::string, Drive>{{"film", {Waveform::constant_at(7500), {}}}}));
}

TEST(Reader, HoneycombDefaults) {
  const Case one = honeycomb();
  const auto& lattice = *one.geometry<Honeycomb>();
  EXPECT_EQ(lattice.columns, (std::vector{7, 6, 7, 6, 7}));
  EXPECT_EQ(lattice.wall.material_name, "TPU 78 MPa");
  EXPECT_EQ(lattice.wall.material.youngs_modulus, 78e6);
  EXPECT_EQ(one.parts.front().mesh.order, 2);
  EXPECT_EQ(one.parts.front().mesh.wall_elements, 8);
  EXPECT_EQ(one.parts.front().mesh.grading, 3);
  EXPECT_EQ(one.parts.front().mesh.quadrature, 3);
  ASSERT_EQ(one.electrodes.size(), 1u);
  EXPECT_EQ(one.electrodes[0].place, "electrode");
  EXPECT_TRUE(one.supports.empty());
  ASSERT_EQ(one.steps.size(), 2u);
  EXPECT_EQ(one.steps[0].kind, StepKind::release);
  EXPECT_EQ(one.steps[0].increments, 1);
  EXPECT_EQ(one.steps[1].name, "voltage");
  EXPECT_EQ(one.steps[1].increments, 10);
  EXPECT_EQ(one.solver.tolerance, 1e-9);
  EXPECT_EQ(one.solver.max_iterations, 25);
  EXPECT_TRUE(one.error_estimate && one.fields);
  EXPECT_EQ(quantity_names(one),
            (std::vector<std::string>{"eps_x", "eps_y", "released_length_x", "released_length_y", "max_field",
                                      "breakdown_ratio", "min_principal_stress", "yield_ratio",
                                      "electrical_work", "mechanical_work", "stored_energy",
                                      "dissipated_energy", "energy_error", "capacitance"}));
  EXPECT_EQ(one.quantities[0].since, "release");
  EXPECT_EQ(one.quantities[0].along, 0);
  EXPECT_TRUE(one.quantities[0].standard);
  EXPECT_EQ(one.quantities[2].at, "release");
  EXPECT_EQ(unit_of(one.quantities[4], one.quantities), "V/m");
}

TEST(Reader, DiscDefaults) {
  const Case one = read_case(valid / "disc.toml");
  EXPECT_EQ(one.title, "disc");
  EXPECT_EQ(one.parts.front().film->prestretch, (std::array{3.0, 3.0}));
  EXPECT_EQ(one.electrodes.at(0).place, "electrode");
  EXPECT_EQ(one.supports.at(0).place, "rim");
  EXPECT_EQ(one.supports.at(0).fixed, (std::array{true, true, true, false, false, false}));
  EXPECT_EQ(one.parts.front().mesh.rings, 24);
  EXPECT_EQ(one.parts.front().mesh.quadrature, 6);
  EXPECT_EQ(one.drives.at("film"), Drive{}); // not driven
  EXPECT_EQ(one.quantities.at(0).name, "electrode_radius");
}

TEST(Reader, SeveralElectrodesOfAnAnnulus) {
  const Case one = read_case(valid / "annulus.toml");
  EXPECT_EQ(one.dimension, fem::Dimension::spatial);
  EXPECT_DOUBLE_EQ(one.parts.front().film->material.dielectric.permittivity, 4.7 * 8.8541878128e-12);
  EXPECT_EQ(one.drives,
            (std::map<std::string, Drive>{{"left", {Waveform::constant_at(5000), {}}}, {"right", {}}}));
  EXPECT_EQ(one.supports.size(), 2u);
  EXPECT_EQ(one.loads.at(0).force, (std::array{Waveform::constant_at(1e-3), Waveform::constant_at(0),
                                               Waveform::constant_at(-2.5e-3)}));
  EXPECT_EQ(one.steps.at(1).name, "pull");
  EXPECT_EQ(one.checks.at(0).value, 0.05588);
  EXPECT_EQ(one.checks.at(0).tolerance, 1e-4);
  const auto names = quantity_names(one);
  EXPECT_EQ(std::count(names.begin(), names.end(), "capacitance_right"), 1);
}

TEST(Reader, OwnMeshIsFoundBesideTheCase) {
  const Case one = read_case(valid / "own_mesh.toml");
  EXPECT_EQ(one.geometry<MeshFile>()->path, valid / "own.msh");
  EXPECT_EQ(one.drives.at("film").voltage, Waveform::constant_at(3000));
}

TEST(Reader, WithoutAReleaseElongationsStartAtTheMesh) {
  const Case one = honeycomb({"step=[{kind='voltage'}]"});
  EXPECT_EQ(one.quantities.at(0).name, "eps_x");
  EXPECT_EQ(one.quantities.at(0).since, "");
  const auto names = quantity_names(one);
  EXPECT_EQ(std::count(names.begin(), names.end(), "released_length_x"), 0);
}

TEST(Reader, StandardQuantitiesFollowTheNameOfTheRelease) {
  const Case one = honeycomb({"step=[{kind='release', name='cut'}, {kind='voltage'}]"});
  EXPECT_EQ(one.quantities.at(0).since, "cut");
  EXPECT_EQ(one.quantities.at(2).at, "cut");
}

TEST(Reader, PercentOfACheckIsOfItsValue) {
  const Case one = honeycomb({"check=[{quantity='eps_x', value=-0.04, tolerance='2 %', source='here'}]"});
  EXPECT_DOUBLE_EQ(one.checks.at(0).tolerance, 0.0008);
}

TEST(Reader, NamedMaterialCanBeChangedInPart) {
  const Case one = honeycomb({"film.material.shear_modulus=47 kPa"});
  EXPECT_EQ(one.parts.front().film->material_name, "VHB 4910 (honeycomb)");
  EXPECT_EQ(std::get<0>(one.parts.front().film->material.law).shear_modulus, 47e3);
  EXPECT_EQ(one.parts.front().film->material.dielectric.permittivity, 4e-11);
}

TEST(Reader, PatchWithBranchesWavesSpringsAndTimedSteps) {
  const Case one = read_case(valid / "patch.toml");
  EXPECT_TRUE(one.parts.front().film->tension_field);
  const materials::Material& material = one.parts.front().film->material;
  EXPECT_EQ(std::get<materials::Ogden>(material.law).moduli, (std::vector{20e3, -1e3}));
  EXPECT_EQ(std::get<materials::Ogden>(material.law).exponents, (std::vector{2.0, -2.0}));
  EXPECT_EQ(material.dielectric.electrostriction, -0.05);
  EXPECT_EQ(material.dielectric.breakdown_exponent, 1.1);
  ASSERT_EQ(material.branches.size(), 2u);
  EXPECT_EQ(std::get<materials::Gent>(material.branches[0].law).stretch_limit, 100);
  EXPECT_DOUBLE_EQ(material.branches[0].viscosity, 3 * 10e3);
  EXPECT_EQ(material.branches[1].dashpot, materials::Dashpot::nominal);
  EXPECT_EQ(material.branches[1].directions, (std::array{true, false}));

  const Waveform& voltage = *one.drives.at("film").voltage;
  EXPECT_DOUBLE_EQ(voltage.at(5), 2000);
  EXPECT_EQ(voltage.kinks(0, 100), (std::vector{10.0, 20.0}));
  EXPECT_EQ(one.drives.at("film").charge, Waveform::constant_at(1e-9));
  ASSERT_EQ(one.springs.size(), 1u);
  EXPECT_EQ(one.springs[0].between, (std::array<std::string, 2>{"left", "right"}));
  EXPECT_EQ(one.springs[0].stiffness, 180);
  ASSERT_EQ(one.linkages.size(), 1u);
  EXPECT_DOUBLE_EQ(one.linkages[0].offset, 0.0473);

  ASSERT_EQ(one.steps.size(), 3u);
  EXPECT_EQ(one.steps[0].kind, StepKind::charge);
  EXPECT_EQ(one.steps[0].response, Response::instantaneous);
  EXPECT_EQ(one.steps[0].on_instability, OnInstability::follow);
  EXPECT_EQ(one.steps[0].on_bifurcation, OnBifurcation::switch_branch);
  EXPECT_FALSE(one.steps[0].duration);
  EXPECT_EQ(one.steps[1].record, 0.5);
  EXPECT_EQ(one.steps[1].on_instability, OnInstability::jump);
  EXPECT_EQ(one.steps[2].duration, 60);
  EXPECT_EQ(one.steps[2].control, Control::charge);
  EXPECT_EQ(one.solver.time_tolerance, 1e-6);
  EXPECT_EQ(quantity_names(one),
            (std::vector<std::string>{"stretch_x", "stretch_y", "stress_x", "stress_y", "thickness_stretch",
                                      "max_field", "breakdown_ratio", "min_principal_stress",
                                      "electrical_work", "mechanical_work", "stored_energy",
                                      "dissipated_energy", "energy_error", "capacitance", "charge"}));
}

TEST(Reader, SidesOfAPatchBecomeSupportsAndLoads) {
  const Case one = read_case(valid / "patch.toml");
  ASSERT_EQ(one.supports.size(), 3u);
  EXPECT_EQ(one.supports[0].place, "left");
  EXPECT_EQ(one.supports[1].fixed, (std::array{false, true, false, false, false, false}));
  EXPECT_EQ(one.supports[2].place, "right");
  EXPECT_NEAR(one.supports[2].motion[0]->at(0), 0, 1e-17);         // drawn at the stretch 1.5
  EXPECT_DOUBLE_EQ(one.supports[2].motion[0]->at(2), 0.5 * 20e-3); // held at the stretch 2
  ASSERT_EQ(one.loads.size(), 1u);
  EXPECT_EQ(one.loads[0].place, "top");
  EXPECT_DOUBLE_EQ(one.loads[0].force[1].at(0), 10e3 * 0.5e-3 * 20e-3);
}

/// Kinds of the steps of a patch that has none of its own.
std::vector<StepKind> patch_steps(const std::string& patch, const std::string& drive,
                                  const std::vector<std::string>& overrides = {}) {
  const test::ScratchFolder folder;
  const auto path = folder / "patch_steps.toml";
  std::ofstream(path) << "[film]\nmaterial = \"VHB 4910 (diaphragm)\"\nthickness = \"1 mm\"\n[patch]\n"
                      << patch << "\n[drive]\n"
                      << drive;
  std::vector<StepKind> kinds;
  for (const Step& step : read_case(path, overrides).steps) kinds.push_back(step.kind);
  return kinds;
}

TEST(Reader, APatchTakesOneStepForEachThatIsGiven) {
  using enum StepKind;
  using Kinds = std::vector<StepKind>;
  EXPECT_EQ(patch_steps("", ""), Kinds{voltage});
  EXPECT_EQ(patch_steps("stretch_x = 2\nstress_y = \"1 kPa\"", "voltage = \"1 kV\""),
            (Kinds{move, force, voltage}));
  EXPECT_EQ(patch_steps("mode = \"equal-biaxial\"", "charge = \"1 nC\""), Kinds{charge});
  EXPECT_EQ(patch_steps("stress_x = \"1 kPa\"", "[drive.film]\nvoltage = \"1 kV\""), (Kinds{force, voltage}));
  EXPECT_EQ(patch_steps("", "[drive.film]\ncharge = \"1 nC\""), Kinds{charge});
  EXPECT_EQ(patch_steps("", "voltage = \"1 kV\"", {"patch.stress_x=1 kPa"}), (Kinds{force, voltage}));
  EXPECT_EQ(patch_steps("", "",
                        {"drive.voltage={wave=\"sine\", amplitude=\"1 kV\", frequency=\"1 Hz\"}",
                         "step=[{kind=\"transient\", duration=\"1 s\"}]"}),
            Kinds{transient});
}

TEST(Reader, WavesOfMotionsAndForces) {
  const Case one = read_case(valid / "moved.toml");
  EXPECT_EQ(one.supports.at(1).fixed,
            (std::array{true, true, false, false, false, false})); // what is moved is held
  EXPECT_DOUBLE_EQ(one.supports.at(1).motion[0]->at(0.25), 2e-3);
  EXPECT_FALSE(one.supports.at(1).motion[1]);
  EXPECT_EQ(one.loads.at(0).force[1], Waveform::constant_at(1e-3));
  EXPECT_DOUBLE_EQ(one.loads.at(0).force[2].at(0.5), 0.5e-3);
}

TEST(Reader, WrittenBranchesReplaceThoseOfTheNamedMaterial) {
  const Case one = honeycomb({"film.material={name='VHB 4910 (honeycomb)', branch=[{shear_modulus='1 kPa', "
                              "relaxation_time='2 s'}]}"});
  ASSERT_EQ(one.parts.front().film->material.branches.size(), 1u);
  EXPECT_DOUBLE_EQ(one.parts.front().film->material.branches[0].viscosity, 2e3);
}

TEST(Overrides, ReachEverything) {
  const Case one = honeycomb({"honeycomb.angle=140 deg", "honeycomb.wall_height=\"4 mm\"",
                              "film.prestretch=[3, 3]", "drive.voltage=5 kV", "mesh.wall_elements=5",
                              "mesh.order=1", "step.voltage.increments=4", "step[1].increments=2",
                              "title=plain words", "output.fields=false", "honeycomb.columns=[1]"});
  EXPECT_DOUBLE_EQ(one.geometry<Honeycomb>()->angle, 140 * std::numbers::pi / 180);
  EXPECT_EQ(one.geometry<Honeycomb>()->wall.height, 0.004);
  EXPECT_EQ(one.parts.front().film->prestretch, (std::array{3.0, 3.0}));
  EXPECT_EQ(one.drives.at("film").voltage, Waveform::constant_at(5000));
  EXPECT_EQ(one.parts.front().mesh.wall_elements, 5);
  EXPECT_EQ(one.parts.front().mesh.order, 1);
  EXPECT_EQ(one.steps[0].increments, 2);
  EXPECT_EQ(one.steps[1].increments, 4);
  EXPECT_EQ(one.title, "plain words");
  EXPECT_FALSE(one.fields);
}

TEST(Overrides, AValueCannotBringAnotherKey) { EXPECT_EQ(honeycomb({"title=a\nb = 2"}).title, "a\nb = 2"); }

TEST(Overrides, TheLastOneWins) {
  EXPECT_EQ(honeycomb({"mesh.order=1", "mesh.order=2"}).parts.front().mesh.order, 2);
}

TEST(Overrides, OddTextsAreErrorsNotAccidents) {
  for (const char* assignment : {"", "=", "=5", "a=\xff", "film.prestretch[=3", "film[1]=2",
                                 "film.thickness='''", "mesh.order=", "film..thickness.=[", "[0]=1", "\"=1"})
    EXPECT_THROW(honeycomb({assignment}), CaseError) << assignment;
}

TEST(Resolved, ReadingItGivesTheSameCase) {
  for (const char* name :
       {"honeycomb.toml", "disc.toml", "annulus.toml", "own_mesh.toml", "patch.toml", "moved.toml"}) {
    const Case one = read_case(valid / name);
    const test::ScratchFolder folder;
    const auto path = folder / name;
    std::ofstream(path) << resolved_text(one);
    const Case again = read_case(path);
    EXPECT_EQ(resolved_text(again), resolved_text(one)) << name;
    EXPECT_EQ(quantity_names(again), quantity_names(one));
    EXPECT_EQ(again.parts.front().geometry.index(), one.parts.front().geometry.index());
    EXPECT_EQ(again.drives, one.drives);
    EXPECT_EQ(again.parts.front().film->prestretch, one.parts.front().film->prestretch);
    EXPECT_EQ(again.supports.size(), one.supports.size());
    EXPECT_EQ(again.loads.size(), one.loads.size());
    if (const auto* lattice = one.geometry<Honeycomb>()) {
      EXPECT_EQ(again.geometry<Honeycomb>()->angle, lattice->angle);
    }
  }
}

TEST(Files, ThoseThatCannotBeReadAreFileErrors) {
  EXPECT_THROW(read_case(valid / "nowhere.toml"), FileError);
  EXPECT_THROW(read_case(valid), FileError);
  EXPECT_THROW(read_case(""), FileError);
  const test::ScratchFolder folder;
  const auto huge = folder / "huge.toml";
  std::ofstream(huge) << "a";
  std::filesystem::resize_file(huge, 17u << 20); // sparse: takes no space
  EXPECT_THROW(read_case(huge), FileError);
}

TEST(Places, UnknownOnesAreReportedWhereTheyWereWritten) {
  const Case one = read_case(valid / "annulus.toml");
  EXPECT_NO_THROW(check_places(one, {"film", "inner", "outer", "sector[0]", "sector[1]"}));
  try {
    check_places(one, {"film", "inner", "outer", "sector[0]"});
    FAIL();
  } catch (const CaseError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics()[0].source.line, 22);
    EXPECT_EQ(error.diagnostics()[0].key, "electrode[2].place");
    EXPECT_EQ(error.diagnostics()[0].message,
              "found \"sector[1]\": the mesh has no such place, allowed \"film\", \"inner\", \"outer\", "
              "\"sector[0]\"; did you mean \"sector[0]\"?");
  }
}

TEST(Places, ThoseThatNobodyWroteAreCalledDefaults) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "case.toml") << R"([film]
thickness = "1 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[disc]
radius = "20 mm"
electrode_radius = "10 mm"
[plate]
mass = "1 g"
)";
  try {
    check_places(read_case(folder / "case.toml"),
                 {"centre", "electrode", "electrode_edge", "film", "passive", "rim"});
    FAIL();
  } catch (const CaseError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics()[0].key, "plate.at (default)");
  }
}

// Smaller increments lead to the same state: what is checked there holds.
TEST(Reader, ChecksStayWhereOnlyTheWayThereIsSet) {
  const std::filesystem::path file =
      std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/honeycomb/case.toml";
  EXPECT_EQ(read_case(file, {"step[2].increments=3"}).skipped_checks, 0);
  EXPECT_GT(read_case(file, {"drive.voltage=3 kV"}).skipped_checks, 0);
}

} // namespace
} // namespace dielast::cases::reader_test
