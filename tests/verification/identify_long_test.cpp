// SPDX-License-Identifier: GPL-3.0-or-later
// The intervals of an identification hold what they promise: responses with 1 % of noise, forty times.
#include "cases/fits/device_model.hpp"
#include "cases/fits/identify.hpp"
#include "cases/readers/identify_reader.hpp"

#include <gtest/gtest.h>

#include <random>

namespace dielast::cases::identify_long_test {
namespace {

TEST(Identification, IntervalsHoldTheTruth) {
  Identification asked = read_identification(std::filesystem::path(DIELAST_SOURCE_DIR) /
                                             "cases/gallery/hung_stack/identify.toml");
  for (DeviceTest& test : asked.tests) test.settings = {"mesh.across=2"};
  const std::vector<double> truth{0.55, 270, 2.2, 14, 200, 6};
  const std::vector<double> exact = DeviceModel(asked).run(0, truth);
  for (std::size_t i = 0; i < truth.size(); ++i) asked.unknowns[i].start = 1.2 * truth[i];
  std::vector<int> inside(truth.size());
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.01);
    std::size_t at = 0;
    for (DeviceTest& test : asked.tests)
      for (auto& value : test.measured) {
        const std::complex<double> one(exact[at], exact[at + 1]);
        at += 2;
        value = one * std::complex<double>(1 + noise(random), noise(random));
      }
    const IdentifyOutcome found = solve_identification(asked, 2, {});
    EXPECT_EQ(found.ending, FitEnding::converged) << seed;
    for (std::size_t i = 0; i < truth.size(); ++i)
      inside[i] += found.unknowns[i].low <= truth[i] && truth[i] <= found.unknowns[i].high;
  }
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_GE(inside[i], 35) << asked.unknowns[i].key;
}

} // namespace
} // namespace dielast::cases::identify_long_test
