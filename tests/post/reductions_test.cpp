// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/reductions.hpp"

#include "tests/post/samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dielast::post::reductions_test {
namespace {

fem::Samples two_points_in_cell_one() {
  fem::Samples samples;
  for (const double voltage : {1000.0, 4000.0}) {
    auto sample = film_sample(stretched(1, 1), Eigen::Matrix2d::Zero());
    sample.cell = 1;
    sample.volume = voltage == 1000 ? 3 : 1;
    sample.voltage = voltage;
    samples.film.push_back(sample);
  }
  samples.walls = {wall_sample(0, 1, 10), wall_sample(0, 3, -2), wall_sample(2, 1, 5)};
  return samples;
}

TEST(Reductions, AverageIsWeightedByVolumeAndLength) {
  const fem::Samples samples = two_points_in_cell_one();
  const auto voltage = average(samples, "voltage", 2);
  EXPECT_TRUE(std::isnan(voltage[0]));
  EXPECT_DOUBLE_EQ(voltage[1], 1750);
  const auto force = average(samples, "axial_force", 3);
  EXPECT_DOUBLE_EQ(force[0], 1);
  EXPECT_TRUE(std::isnan(force[1]));
  EXPECT_DOUBLE_EQ(force[2], 5);
  EXPECT_DOUBLE_EQ(average(samples, "bending_moment.3", 3)[2], 6);
}

// A rod's cell is its section, of which an electrode covers a part.
TEST(Reductions, AveragesOfElectrodesFieldsAreThoseUnderThem) {
  fem::Samples samples = two_points_in_cell_one();
  samples.film[0].voltage = 0;
  EXPECT_DOUBLE_EQ(average(samples, "voltage", 2)[1], 4000);
  EXPECT_DOUBLE_EQ(average(samples, "electric_field", 2)[1], 4e6);
  EXPECT_DOUBLE_EQ(average(samples, "thickness", 2)[1], 1e-3);
  samples.film[1].voltage = 0;
  EXPECT_EQ(average(samples, "voltage", 2)[1], 0);
}

TEST(Reductions, AveragesAreTheFilmsAndExtremesThoseOfAllLayers) {
  fem::Samples samples = two_points_in_cell_one();
  samples.film[1].layer = 1;
  EXPECT_DOUBLE_EQ(average(samples, "voltage", 2)[1], 1000);
  const auto field = Extremes(samples).find("electric_field", Extreme::maximum);
  ASSERT_TRUE(field);
  EXPECT_DOUBLE_EQ(field->value, 4e6);
  EXPECT_EQ(field->layer, 1);
}

// The frame of a membrane bears compression, which is no loss of tension.
TEST(Reductions, ExtremesOfTensionAreThoseOfMembranesWhereThereAreAny) {
  fem::Samples samples;
  for (const double stress : {-800e3, 20e3, 30e3})
    samples.film.push_back(film_sample(stretched(1, 1), stress * Eigen::Matrix2d::Identity()));
  samples.film[0].bears_compression = true;
  const auto least = [&] { return Extremes(samples).find("min_principal_stress", Extreme::minimum)->value; };
  EXPECT_DOUBLE_EQ(least(), 20e3);
  for (fem::MembraneSample& sample : samples.film) sample.bears_compression = true;
  EXPECT_DOUBLE_EQ(least(), -800e3);
}

TEST(Reductions, AveragesOfAllFieldsLieCellByCell) {
  const auto arrays = cell_values(two_points_in_cell_one().walls, wall_fields(), 3);
  ASSERT_EQ(arrays.size(), wall_fields().size());
  ASSERT_EQ(arrays[1].average.size(), 6u); // shear_force
  EXPECT_DOUBLE_EQ(arrays[1].average[4], 2);
  EXPECT_DOUBLE_EQ(arrays[1].average[5], 3);
}

TEST(Reductions, ExtremeFindsThePoint) {
  const fem::Samples samples = two_points_in_cell_one();
  const auto field = Extremes(samples).find("electric_field", Extreme::maximum);
  ASSERT_TRUE(field);
  EXPECT_DOUBLE_EQ(field->value, 4e6);
  EXPECT_EQ(field->cell, 1);
  EXPECT_EQ(field->part, Part::film);
  const auto force = Extremes(samples).find("axial_force", Extreme::minimum);
  ASSERT_TRUE(force);
  EXPECT_DOUBLE_EQ(force->value, -2);
  EXPECT_EQ(force->part, Part::walls);
}

/// One point in each cell, thick where it is not stretched.
fem::Samples points_at(std::initializer_list<std::pair<int, double>> cells_and_voltages) {
  fem::Samples samples;
  for (const auto& [cell, voltage] : cells_and_voltages) {
    auto sample = film_sample(stretched(1, 1));
    sample.cell = cell;
    sample.voltage = voltage;
    sample.electrode = 0;
    samples.film.push_back(sample);
  }
  return samples;
}

double rise_of(const fem::Samples& samples, const meshing::Mesh& mesh, const char* scalar,
               std::vector<int> parts = {0, 0, 0}) {
  return rise_at(*Extremes(samples).find(scalar, Extreme::maximum), samples, mesh, parts, scalar);
}

TEST(Reductions, RiseIsTheChangeOverTheCellAndItsNeighbours) {
  const meshing::Mesh mesh = square_mesh();
  EXPECT_DOUBLE_EQ(rise_of(points_at({{0, 1000}, {0, 4000}, {1, 3500}}), mesh, "electric_field"), 3e6);
  EXPECT_DOUBLE_EQ(rise_of(points_at({{0, 4000}, {1, 3500}}), mesh, "electric_field"), 0.5e6);
}

// The field ends at an electrode's edge: that is no error.
TEST(Reductions, RiseDoesNotLeaveTheElectrode) {
  fem::Samples samples = points_at({{0, 4000}, {0, 3900}, {1, 0}});
  samples.film.back().electrode = -1;
  EXPECT_DOUBLE_EQ(rise_of(samples, square_mesh(), "electric_field"), 0.1e6);
}

// Nor are two films' fields of one drive.
TEST(Reductions, RiseDoesNotLeaveTheFilm) {
  const fem::Samples samples = points_at({{0, 4000}, {0, 3900}, {1, 0}});
  EXPECT_DOUBLE_EQ(rise_of(samples, square_mesh(), "electric_field", {0, 1}), 0.1e6);
  EXPECT_DOUBLE_EQ(rise_of(samples, square_mesh(), "electric_field", {1, 1}), 4e6);
}

TEST(Reductions, RiseNeedsACommonSide) {
  meshing::Mesh fan; // 0 and 2 have one corner in common
  fan.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}};
  fan.blocks = {{meshing::CellType::triangle3, {0, 1, 2, 0, 2, 3, 0, 3, 4}}};
  EXPECT_DOUBLE_EQ(rise_of(points_at({{0, 4000}, {1, 3000}, {2, 0}}), fan, "electric_field"), 1e6);
}

// Three walls that meet carry different forces.
TEST(Reductions, RiseOfWallsEndsWhereThreeMeet) {
  meshing::Mesh star = square_mesh();
  star.blocks[0] = {meshing::CellType::line2, {1, 2, 2, 3, 3, 4, 3, 5}};
  fem::Samples samples;
  samples.walls = {wall_sample(0, 1, 4), wall_sample(1, 1, 10), wall_sample(2, 1, -50),
                   wall_sample(3, 1, -60)};
  EXPECT_DOUBLE_EQ(rise_of(samples, star, "axial_force"), 6);
}

TEST(Reductions, NothingWithoutPoints) {
  EXPECT_FALSE(Extremes(fem::Samples{}).find("thickness", Extreme::minimum));
}

TEST(Reductions, UnknownNamesAreRefused) {
  EXPECT_THROW(Extremes(fem::Samples{}).find("cauchy_stress", Extreme::minimum), std::invalid_argument);
  EXPECT_THROW(average(fem::Samples{}, "thicknes", 1), std::invalid_argument);
  EXPECT_THROW(WantedScalars({"cauchy_stress"}), std::invalid_argument);
}

TEST(Reductions, ExtremesAreThoseOfTheScalarsThatAreWanted) {
  const fem::Samples samples = two_points_in_cell_one();
  const WantedScalars wanted({"axial_force", "cauchy_stress.yy", "electric_field", "cauchy_stress.xx"});
  const Extremes some(samples, wanted), all(samples);
  for (const char* scalar : {"electric_field", "cauchy_stress.xx", "cauchy_stress.yy"})
    for (const Extreme end : {Extreme::minimum, Extreme::maximum}) {
      EXPECT_EQ(some.find(scalar, end)->value, all.find(scalar, end)->value) << scalar;
      EXPECT_EQ(some.find(scalar, end)->cell, all.find(scalar, end)->cell) << scalar;
    }
  EXPECT_EQ(some.find("axial_force", Extreme::minimum).has_value(), !samples.walls.empty());
  EXPECT_THROW(some.find("thickness", Extreme::minimum), std::invalid_argument);
}

TEST(Reductions, EveryScalarHasOneNameThatWorks) {
  std::set<std::string> names;
  for (const Scalar& scalar : scalars()) {
    EXPECT_TRUE(names.insert(scalar.name).second) << scalar.name;
    EXPECT_FALSE(scalar.unit.empty() || scalar.meaning.empty()) << scalar.name;
    const auto found = Extremes(two_points_in_cell_one()).find(scalar.name, Extreme::maximum);
    ASSERT_TRUE(found) << scalar.name;
    EXPECT_EQ(found->part, scalar.part);
  }
  EXPECT_TRUE(names.contains("principal_stretches.lambda3"));
}

} // namespace
} // namespace dielast::post::reductions_test
