// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/shells/shell_shear.hpp"

#include <algorithm>

namespace dielast::fem {

namespace {

constexpr double correction = 5.0 / 6;

using Stiffness = ShellShear::Stiffness;

/// Second derivatives of a point's energy in shear, rr, ss or rs, J.
Lanes resisted(const Stiffness& stiffness, const ShellPoint& here, int i) {
  return here.area * (stiffness[0] * here.shear[0][i] + stiffness[1] * here.shear[1][i]);
}

/// The strain and what it costs with a stiffness.
struct Sheared {
  Lanes strain[2];

  Lanes stress(const Stiffness& stiffness, const ShellPoint& here, Lanes (&gamma)[2]) const {
    Lanes metric[3];
    for (int i = 0; i < 3; ++i) metric[i] = resisted(stiffness, here, i);
    gamma[0] = metric[0] * strain[0] + metric[2] * strain[1];
    gamma[1] = metric[2] * strain[0] + metric[1] * strain[1];
    return 0.5 * (gamma[0] * strain[0] + gamma[1] * strain[1]);
  }
};

Sheared sheared(const ShellPoint& here, const ShellDeformation& f) {
  return {{f.gamma[0] - here.gamma[0], f.gamma[1] - here.gamma[1]}};
}

} // namespace

void ShellShear::add_layer(const materials::Material& material, double H,
                           const std::array<double, 2>& extra_stretch) {
  const auto add = [&](Stiffness& to, double mu) {
    for (std::size_t i = 0; i < 2; ++i) to[i] += correction * H * mu * extra_stretch[i] * extra_stretch[i];
  };
  add(stiffness_, materials::initial_shear_modulus(material.law));
  for (const materials::Branch& branch : materials::with_dashpot(material).branches) {
    const double mu = materials::initial_shear_modulus(branch.law), rate = mu / branch.viscosity;
    auto alike = std::ranges::find(branches_, rate, &Branch::rate);
    if (alike == branches_.end()) alike = branches_.insert(alike, {{}, rate});
    add(alike->stiffness, mu);
  }
}

Lanes ShellShear::evaluate(const State& state, const std::array<int, lanes>& points, int count,
                           const ShellPoint& here, const ShellDeformation& f, ShellStress& stress) const {
  const Sheared g = sheared(here, f);
  for (int i = 0; i < 3; ++i) stress.shear[i] = resisted(stiffness_, here, i);
  Lanes energy = g.stress(stiffness_, here, stress.gamma);
  const materials::TimeScheme& scheme = state.scheme;
  if (branches_.empty() || scheme.is_relaxed()) return energy;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const auto& [k, rate] = branches_[b];
    const double flow = scheme.dt * rate, part = scheme.a0 / (scheme.a0 + flow);
    Sheared spring{};
    for (std::size_t i = 0; i < 2; ++i) {
      Lanes h{};
      for (int l = 0; l < count; ++l) {
        const std::size_t at = place(points[static_cast<std::size_t>(l)], b) + i;
        h[l] = scheme.h1 * state.history->now[at];
        if (scheme.h2 != 0) h[l] += scheme.h2 * state.history->before[at];
      }
      spring.strain[i] = part * (g.strain[i] - h / scheme.a0);
    }
    Lanes gamma[2];
    energy += (1 / part) * spring.stress(k, here, gamma);
    for (int i = 0; i < 2; ++i) stress.gamma[i] += gamma[i];
    for (int i = 0; i < 3; ++i) stress.shear[i] += part * resisted(k, here, i);
  }
  return energy;
}

void ShellShear::add_relaxation(const RateWeight& weight, const ShellPoint& here, ShellStress& stress) const {
  for (const auto& [k, rate] : branches_) {
    const double factor = weight(rate);
    for (int i = 0; i < 3; ++i) stress.shear[i] += factor * resisted(k, here, i);
  }
}

void ShellShear::add_energies(const State& state, const std::array<int, lanes>& points, int count,
                              const ShellPoint& here, const ShellDeformation& f, EnergyParts& parts) const {
  const Sheared g = sheared(here, f);
  Lanes unused[2];
  const Lanes elastic = g.stress(stiffness_, here, unused);
  for (int l = 0; l < count; ++l) parts.elastic += elastic[l];
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    Sheared spring = g;
    for (int l = 0; l < count; ++l)
      for (std::size_t i = 0; i < 2; ++i)
        spring.strain[i][l] -= state.history->now[place(points[static_cast<std::size_t>(l)], b) + i];
    const Lanes stored = spring.stress(branches_[b].stiffness, here, unused);
    for (int l = 0; l < count; ++l) {
      parts.branches += stored[l];
      parts.dissipation += 2 * branches_[b].rate * stored[l];
    }
  }
}

void ShellShear::start_history(int points, std::vector<double>& all) const {
  std::fill_n(all.begin() + first_, history_size(points), 0.0);
}

void ShellShear::advance_history(const State& state, const std::array<int, lanes>& points, int count,
                                 const ShellPoint& here, const ShellDeformation& f,
                                 std::vector<double>& all) const {
  const Sheared g = sheared(here, f);
  const materials::TimeScheme& scheme = state.scheme;
  for (std::size_t b = 0; b < branches_.size(); ++b)
    for (int l = 0; l < count; ++l)
      for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t at = place(points[static_cast<std::size_t>(l)], b) + i;
        double h = scheme.h1 * state.history->now[at];
        if (scheme.h2 != 0) h += scheme.h2 * state.history->before[at];
        const double flow = scheme.dt * branches_[b].rate;
        all[at] = scheme.is_relaxed() ? g.strain[i][l] : (h + flow * g.strain[i][l]) / (scheme.a0 + flow);
      }
}

} // namespace dielast::fem
