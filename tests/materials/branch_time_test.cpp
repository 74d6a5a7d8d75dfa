// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/branch.hpp"
#include "materials/branches/neo_hookean_branch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace dielast::materials::branch_time_test {
namespace {

/// A film that is pulled along axes which turn.
InPlaneC<double> pulled(double t) {
  const double s = 1 - std::cos(2 * t); // smooth from rest
  return {1 + 0.6 * s, 1 - 0.15 * s, 0.2 * s * std::sin(t)};
}

Internal at_end(const Branch& branch, int steps, bool bdf2) {
  const double end = 1.5, dt = end / steps; // s
  Internal now = undeformed(), before{};
  for (int n = 1; n <= steps; ++n) {
    const TimeScheme scheme = bdf2 && n > 1 ? TimeScheme::bdf2(dt, dt) : TimeScheme::backward_euler(dt);
    const Internal next = advance(branch, pulled(n * dt), scheme, now, before);
    before = now;
    now = next;
  }
  return now;
}

double observed_order(const Branch& branch, bool bdf2) {
  const Internal coarse = at_end(branch, 100, bdf2), fine = at_end(branch, 200, bdf2),
                 finest = at_end(branch, 400, bdf2);
  return std::log2(std::abs(coarse[0] - fine[0]) / std::abs(fine[0] - finest[0]));
}

const ElasticLaw laws[] = {NeoHookean{1.0}, Gent{1.0, 50}, MooneyRivlin{0.3, 0.2}, Ogden{{1, 0.1}, {1.5, 4}}};

TEST(BranchTime, backward_euler_is_of_first_order_and_bdf2_of_second) {
  for (const ElasticLaw& law : laws)
    for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal}) {
      const Branch branch{law, dashpot, 0.5};
      EXPECT_NEAR(observed_order(branch, false), 1, 0.1) << law.index();
      EXPECT_NEAR(observed_order(branch, true), 2, 0.1) << law.index();
    }
}

// dW_b/dt = dW_b/dC : C' - dissipation, over a whole path.
TEST(BranchTime, work_is_stored_or_dissipated) {
  for (const ElasticLaw& law : laws)
    for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal}) {
      const Branch branch{law, dashpot, 0.5};
      const int steps = 4000;
      const double end = 1.5, dt = end / steps;
      Internal now = undeformed(), before{};
      double work = 0, dissipated = 0, power = 0;
      std::array<double, 3> slope{};
      for (int n = 1; n <= steps; ++n) {
        const TimeScheme scheme = n > 1 ? TimeScheme::bdf2(dt, dt) : TimeScheme::backward_euler(dt);
        const InPlaneC<double> C = pulled(n * dt), last = pulled((n - 1) * dt);
        const Internal next = advance(branch, C, scheme, now, before);
        before = now;
        now = next;
        const auto first = branch_potential(branch, C, TimeScheme::frozen(), now, now).first;
        const std::array<double, 3> change{C.C11 - last.C11, C.C22 - last.C22, C.C12 - last.C12};
        for (std::size_t i = 0; i < 3; ++i) work += (slope[i] + first[i]) / 2 * change[i]; // trapezoids
        const BranchPower at = branch_power(branch, C, now);
        dissipated += (power + at.dissipation) / 2 * dt;
        power = at.dissipation;
        slope = first;
      }
      const double stored = branch_power(branch, pulled(end), now).stored;
      EXPECT_GT(dissipated, 0.1 * work);
      EXPECT_NEAR(stored + dissipated, work, 1e-5 * work) << law.index();
    }
}

// A spring ten thousand times as stiff as what it stands beside hardly strains: its power is quadratic in
// that.
TEST(BranchTime, the_power_of_a_stiff_spring_is_not_lost_in_round_off) {
  for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal}) {
    const Branch branch{NeoHookean{5e8}, dashpot, 50};
    const InPlaneC<double> rest = pulled(0.7);
    const Internal at_rest = advance(branch, rest, TimeScheme::relaxed(), undeformed(), {});
    const auto power = [&](double strain) {
      return branch_power(branch, {rest.C11 * (1 + strain), rest.C22, rest.C12}, at_rest).dissipation;
    };
    EXPECT_NEAR(power(1e-9) / power(1e-7), 1e-4, 1e-3 * 1e-4);
  }
}

TEST(BranchTime, a_history_that_cannot_be_extrapolated_is_continued_by_backward_euler) {
  const TimeScheme bdf2 = TimeScheme::bdf2(1, 0.5);
  const InPlaneC<double> C{1.5, 1.2, 0.1};
  const Internal now{0.6, 0.6, 0}, before{3, 3, 0};
  for (const ElasticLaw& law : laws)
    for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal}) {
      const Branch branch{law, dashpot, 0.5};
      const Internal end = advance(branch, C, bdf2, now, before);
      const Internal euler = advance(branch, C, TimeScheme::backward_euler(1), now, before);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(end[i], euler[i]);
    }
}

TEST(BranchTime, packs_of_the_closed_form_compute_what_single_numbers_do) {
  const Branch branch{NeoHookean{26e3}, Dashpot::log, 16e3};
  const double dt = 0.3;
  const Internal now{1.3, 0.9, 0.1};
  InPlaneC<Pack> C{};
  for (int l = 0; l < pack_lanes; ++l) {
    const auto one = pulled(0.3 * l + 0.1);
    C.C11[l] = one.C11;
    C.C22[l] = one.C22;
    C.C12[l] = one.C12;
  }
  const Pack none{};
  const ViscousHistory<Pack> H{{now[0] + none, now[1] + none, now[2] + none},
                               1 / (now[0] * now[1] - now[2] * now[2]) + none};
  const auto together = neo_hookean_branch(26e3, 16e3, dt, C, H);
  for (int l = 0; l < pack_lanes; ++l) {
    const auto alone =
        branch_potential(branch, pulled(0.3 * l + 0.1), TimeScheme::backward_euler(dt), now, {});
    EXPECT_NEAR(together.value[l], alone.value, 1e-9);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(together.first[i][l], alone.first[i], 1e-9);
    for (std::size_t p = 0; p < 6; ++p) EXPECT_NEAR(together.second[p][l], alone.second[p], 1e-9);
  }
}

} // namespace
} // namespace dielast::materials::branch_time_test
