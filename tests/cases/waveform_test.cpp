// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/waveform.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::cases::waveform_test {
namespace {

using Kind = Waveform::Kind;
using Times = std::vector<double>;

Waveform trapezoid() {
  return {.kind = Kind::trapezoid, .from = 1, .to = 3, .start = 1, .rise = 1, .hold = 2, .fall = 0.5};
}

TEST(Waveform, ConstantAndRampAndStep) {
  EXPECT_TRUE(Waveform::constant_at(2).constant());
  EXPECT_EQ(Waveform::constant_at(2).at(7), 2);
  const Waveform ramp{.kind = Kind::ramp, .from = 1, .to = 5, .start = 2, .duration = 4};
  EXPECT_EQ(ramp.at(0), 1);
  EXPECT_EQ(ramp.at(3), 2);
  EXPECT_EQ(ramp.at(9), 5);
  EXPECT_EQ(ramp.kinks(0, 10), (Times{2, 6}));
  EXPECT_EQ(ramp.kinks(2, 6), Times{}); // strictly between
  const Waveform step{.kind = Kind::step, .to = 5, .start = 0.1};
  EXPECT_EQ(step.before(0.1), 0);
  EXPECT_EQ(step.at(0.1), 5);
  EXPECT_EQ(step.kinks(0, 1), Times{0.1});
  EXPECT_TRUE(std::isinf(step.period()));
}

TEST(Waveform, TrapezoidOnceAndAgain) {
  Waveform wave = trapezoid();
  for (const auto& [t, value] :
       {std::pair{0.5, 1.0}, {1.5, 2.0}, {2.0, 3.0}, {3.9, 3.0}, {4.25, 2.0}, {5.0, 1.0}})
    EXPECT_DOUBLE_EQ(wave.at(t), value) << t;
  EXPECT_EQ(wave.kinks(0, 10), (Times{1, 2, 4, 4.5}));
  wave.repeat = 5;
  EXPECT_DOUBLE_EQ(wave.at(1006.5), 2);
  EXPECT_DOUBLE_EQ(wave.at(0.5), 1);
  EXPECT_EQ(wave.kinks(4, 8), (Times{4.5, 6, 7}));
  EXPECT_EQ(wave.period(), 5);
}

TEST(Waveform, JumpsHaveTwoSides) {
  Waveform wave = trapezoid();
  wave.rise = wave.fall = 0;
  EXPECT_EQ(wave.before(1), 1);
  EXPECT_EQ(wave.at(1), 3);
  EXPECT_EQ(wave.before(3), 3);
  EXPECT_EQ(wave.at(3), 1);
  const Waveform square{.kind = Kind::square, .from = -1, .to = 4, .frequency = 3, .duty = 0.25};
  for (int n = 1; n < 1000; ++n) { // n / 3 is never exact
    EXPECT_EQ(square.before(n / 3.0), -1) << n;
    EXPECT_EQ(square.at(n / 3.0), 4) << n;
    EXPECT_EQ(square.before(n / 3.0 + 0.25 / 3), 4) << n;
    EXPECT_EQ(square.at(n / 3.0 + 0.25 / 3), -1) << n;
  }
  EXPECT_EQ(square.kinks(0, 1).size(), 5u);
  const Waveform same{.kind = Kind::square, .to = 1, .frequency = 10};
  EXPECT_EQ(same.kinks(0, 100).size(), 1999u);
}

TEST(Waveform, SinesAndTheirPeriods) {
  const Waveform sine{
      .kind = Kind::sine, .mean = 1, .amplitude = 2, .frequency = 0.5, .phase = std::acos(-1) / 2};
  EXPECT_DOUBLE_EQ(sine.at(0), 3);
  EXPECT_DOUBLE_EQ(sine.at(1), -1);
  EXPECT_EQ(sine.period(), 2);
  const Waveform unipolar{.kind = Kind::unipolar_sine, .amplitude = 4, .frequency = 0.5};
  EXPECT_DOUBLE_EQ(unipolar.at(0), 0);
  EXPECT_DOUBLE_EQ(unipolar.at(1), 4);
  EXPECT_TRUE(unipolar.kinks(0, 100).empty());
  const Waveform sweep{
      .kind = Kind::sweep, .amplitude = 1, .frequency = 1, .end_frequency = 3, .duration = 2};
  EXPECT_NEAR(sweep.at(2), 0, 1e-12);            // four cycles in two seconds
  EXPECT_NEAR(sweep.at(2 + 1 / 12.0), 1, 1e-12); // then at 3 Hz
  EXPECT_DOUBLE_EQ(sweep.period(), 1 / 3.0);
}

TEST(Waveform, SamplesAreJoinedByLines) {
  const Waveform wave{.kind = Kind::file, .samples = {{0, 1}, {2, 5}, {3, 5}}};
  EXPECT_EQ(wave.at(-1), 1);
  EXPECT_EQ(wave.at(0.5), 2);
  EXPECT_EQ(wave.at(2), 5);
  EXPECT_EQ(wave.at(30), 5);
  EXPECT_EQ(wave.kinks(0, 30), (Times{2, 3}));
}

TEST(Waveform, AffineMapsEveryForm) {
  const std::vector<Waveform> forms{
      Waveform::constant_at(2),
      trapezoid(),
      {.kind = Kind::ramp, .from = 1, .to = 5, .duration = 4},
      {.kind = Kind::step, .to = 5, .start = 0.1},
      {.kind = Kind::sine, .mean = 1, .amplitude = 2, .frequency = 0.5},
      {.kind = Kind::unipolar_sine, .from = 1, .amplitude = 2, .frequency = 0.5},
      {.kind = Kind::square, .from = 1, .to = 2, .frequency = 0.5},
      {.kind = Kind::sweep, .mean = 1, .amplitude = 2, .frequency = 1, .end_frequency = 2, .duration = 3},
      {.kind = Kind::file, .samples = {{0, 1}, {2, 5}}}};
  for (const Waveform& wave : forms)
    for (const double t : {0.0, 0.3, 1.7, 4.2})
      EXPECT_NEAR(wave.affine(-2, 3).at(t), 3 - 2 * wave.at(t), 1e-12) << static_cast<int>(wave.kind);
}

} // namespace
} // namespace dielast::cases::waveform_test
