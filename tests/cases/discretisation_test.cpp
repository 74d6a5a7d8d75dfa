// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/discretisation.hpp"

#include "cases/readers/reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace dielast::cases::discretisation_test {
namespace {

const std::filesystem::path valid = std::filesystem::path(DIELAST_SOURCE_DIR) / "tests/cases/valid";

Case honeycomb(int wall_elements) {
  return read_case(valid / "honeycomb.toml", {"mesh.wall_elements=" + std::to_string(wall_elements)});
}

TEST(OtherDiscretisations, HalveAndQuarterTheMesh) {
  const auto of_8 = other_discretisations(honeycomb(8));
  ASSERT_EQ(of_8.size(), 2u);
  EXPECT_EQ(of_8[0].one.parts.front().mesh.wall_elements, 4);
  EXPECT_EQ(of_8[1].one.parts.front().mesh.wall_elements, 2);
  EXPECT_EQ(other_discretisations(honeycomb(3)).size(), 1u);
  EXPECT_TRUE(other_discretisations(honeycomb(1)).empty());
  EXPECT_EQ(other_discretisations(read_case(valid / "disc.toml")).size(), 2u);
  EXPECT_EQ(other_discretisations(read_case(valid / "disc.toml", {"mesh.rings=7"})).size(), 1u);
  EXPECT_TRUE(other_discretisations(read_case(valid / "disc.toml", {"mesh.rings=3"})).empty());
}

// Six sides are the fewest that an edge may have.
TEST(OtherDiscretisations, MayDivideEdgesAlike) {
  const auto alike = [](const char* radius, const char* rings, const char* model) {
    const Case one = read_case(valid / "disc.toml", {fmt::format("disc.electrode_radius={}", radius),
                                                     fmt::format("mesh.rings={}", rings), model});
    return divides_edges_alike(one, other_discretisations(one).front().one);
  };
  EXPECT_TRUE(alike("10 mm", "12", "model=planar"));
  EXPECT_FALSE(alike("10 mm", "40", "model=planar"));
  EXPECT_FALSE(alike("10 mm", "12", "model=axisymmetric"));
  const Case hole = read_case(valid / "annulus.toml", {"mesh.rings=4", "annulus.inner_radius=5 mm"});
  EXPECT_TRUE(divides_edges_alike(hole, other_discretisations(hole).front().one));
  for (const auto& [radius, is_alike] :
       {std::pair{"3 mm", true}, std::pair{"15 mm", false}}) { // twelve of a region
    const Case drawn = read_case(
        valid / "disc.toml", {"disc.electrode_radius=", "mesh.rings=12", "disc.radius=25 mm",
                              fmt::format("region=[{{name='c', kind='ring', outer_radius='{}'}}]", radius)});
    EXPECT_EQ(divides_edges_alike(drawn, other_discretisations(drawn).front().one), is_alike) << radius;
  }
}

// Half of an odd number of elements is more than twice as coarse: the estimate must know by how much.
TEST(OtherDiscretisations, TellTheirSize) {
  for (const int elements : {2, 3, 5, 8})
    for (const Discretisation& other : other_discretisations(honeycomb(elements)))
      EXPECT_DOUBLE_EQ(other.size * other.one.parts.front().mesh.wall_elements, elements);
}

TEST(OtherDiscretisations, OfAnOwnMeshRefineItOrTakeBackARefinement) {
  const auto refined = [](int times) {
    return other_discretisations(
        read_case(valid / "own_mesh.toml", {"mesh.refine=" + std::to_string(times)}));
  };
  ASSERT_EQ(refined(0).size(), 1u);
  EXPECT_EQ(refined(0)[0].one.parts.front().mesh.refine, 1);
  EXPECT_EQ(refined(0)[0].size, 0.5);
  ASSERT_EQ(refined(1).size(), 1u);
  EXPECT_EQ(refined(1)[0].one.parts.front().mesh.refine, 0);
  ASSERT_EQ(refined(3).size(), 2u);
  EXPECT_EQ(refined(3)[1].one.parts.front().mesh.refine, 1);
  EXPECT_EQ(refined(3)[1].size, 4);
}

TEST(OtherDiscretisations, LengthenTimeSteps) {
  const Case patch = read_case(valid / "patch.toml");
  const auto others = other_discretisations(patch);
  ASSERT_EQ(others.size(), 2u);
  EXPECT_EQ(others[1].size, 4);
  for (std::size_t s = 0; s < patch.steps.size(); ++s) {
    if (!patch.steps[s].duration) continue;
    EXPECT_EQ(others[0].one.steps[s].increments, (patch.steps[s].increments + 1) / 2);
    EXPECT_EQ(others[1].one.steps[s].increments, (patch.steps[s].increments + 3) / 4);
  }
  EXPECT_DOUBLE_EQ(others[0].one.solver.time_tolerance, 8 * patch.solver.time_tolerance);
  EXPECT_DOUBLE_EQ(others[1].one.solver.time_tolerance, 64 * patch.solver.time_tolerance);
}

// Rows shorten the time steps that end at them, in all discretisations alike.
TEST(OtherDiscretisations, HaveRowsAsFarApartAsTheirTimeSteps) {
  Case patch = read_case(valid / "patch.toml");
  const auto timed =
      std::ranges::find_if(patch.steps, [](const Step& step) { return step.duration.has_value(); });
  ASSERT_NE(timed, patch.steps.end());
  timed->record = 0.3 * *timed->duration;
  const auto others = other_discretisations(patch);
  const auto of = [&](const Discretisation& other) {
    return *other.one.steps[static_cast<std::size_t>(timed - patch.steps.begin())].record / *timed->duration;
  };
  EXPECT_DOUBLE_EQ(of(others.at(0)), 0.6);
  EXPECT_DOUBLE_EQ(of(others.at(1)), 1);
}

TEST(OtherDiscretisations, OfAStillPatchHaveFewerIncrements) {
  Case patch = read_case(valid / "patch.toml");
  std::erase_if(patch.steps, [](const Step& step) { return step.duration.has_value(); });
  const auto others = other_discretisations(patch);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].one.steps[0].increments, (patch.steps[0].increments + 2) / 3);
  EXPECT_EQ(others[0].one.solver.time_tolerance, patch.solver.time_tolerance);
}

// With the mesh as it is, the third would be finer than the second.
TEST(OtherDiscretisations, DoNotMixMeshesWhereTimePasses) {
  const Case one = read_case(valid / "moved.toml", {"mesh.rings=7"});
  const auto others = other_discretisations(one);
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].one.parts.front().mesh.rings, 3);
}

// Longer time steps alone tell nothing of the elements' part of the error.
TEST(OtherDiscretisations, AreNoneWithTheCoarsestMeshWhereTimePasses) {
  EXPECT_TRUE(other_discretisations(read_case(valid / "moved.toml", {"mesh.rings=3"})).empty());
}

} // namespace
} // namespace dielast::cases::discretisation_test
