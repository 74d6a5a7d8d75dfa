// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/material_point.hpp"

#include <cmath>
#include <limits>

namespace dielast::materials {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double close = 1e-5; ///< logarithmic stretch

} // namespace

MaterialPoint::MaterialPoint(const Material& material, Mode mode)
    : material_(with_dashpot(material)), mode_(mode), now_(material_.branches.size(), undeformed()),
      before_(now_) {}

AxisymmetricPotential MaterialPoint::potential(double l, double across, const TimeScheme& scheme) const {
  AxisymmetricPotential sum =
      std::visit([&](const auto& law) { return axisymmetric_potential(law, Dielectric{}, l, across, 0); },
                 material_.law);
  for (std::size_t b = 0; b < now_.size(); ++b) {
    const AxisymmetricPotential one =
        axisymmetric_branch_potential(material_.branches[b], l, across, scheme, now_[b], before_[b]);
    sum.value += one.value;
    for (std::size_t i = 0; i < 2; ++i) sum.first[i] += one.first[i];
    for (std::size_t i = 0; i < 3; ++i) sum.second[i] += one.second[i];
  }
  return sum;
}

/// Damped Newton for the stretch across that minimises the potential, from `start`, in its logarithm. Close
/// to the minimum its slope tells of descent: over a short time step a dashpot's energy is a small
/// difference.
double MaterialPoint::free_width(double l, double start, const TimeScheme& scheme) const {
  double across = start;
  AxisymmetricPotential at = potential(l, across, scheme);
  for (int iteration = 0; iteration < 60 && std::isfinite(at.value); ++iteration) {
    const double slope = across * at.first[1];
    const double curvature = across * (across * at.second[1] + at.first[1]);
    double step = -slope / std::abs(curvature);
    if (!std::isfinite(step)) break;
    const bool last = curvature > 0 && std::abs(step) <= 1e-8; // one more step reaches the last digits
    const double noise = 1e-14 * std::abs(curvature);
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      const double wider = across * std::exp(step);
      const AxisymmetricPotential trial = potential(l, wider, scheme);
      const bool flatter =
          curvature > 0 && std::abs(step) <= close && std::abs(wider * trial.first[1]) < std::abs(slope);
      if (!(trial.value <= at.value + noise) && !flatter) continue;
      across = wider;
      at = trial;
      break;
    }
    if (last) return across;
  }
  return not_a_number;
}

double MaterialPoint::across(double l, const TimeScheme& scheme) {
  if (mode_ == Mode::pure_shear) return 1;
  if (mode_ == Mode::equal_biaxial) return l;
  double width = free_width(l, narrowing_ / std::sqrt(l), scheme);
  if (std::isnan(width)) width = free_width(l, 1 / std::sqrt(l), scheme);
  if (!std::isnan(width)) narrowing_ = width * std::sqrt(l);
  return width;
}

double MaterialPoint::stress(double l, const TimeScheme& scheme) {
  const double width = across(l, scheme);
  if (std::isnan(width)) return not_a_number;
  const AxisymmetricPotential at = potential(l, width, scheme);
  // Beyond the limit of a law the energy is not a number, but its derivative may be one.
  if (!std::isfinite(at.value)) return not_a_number;
  return mode_ == Mode::equal_biaxial ? (at.first[0] + at.first[1]) / 2 : at.first[0];
}

void MaterialPoint::accept(double l, const TimeScheme& scheme) {
  const double width = across(l, scheme);
  const InPlaneC<double> C{l * l, width * width, 0};
  for (std::size_t b = 0; b < now_.size(); ++b) {
    const Internal next = advance(material_.branches[b], C, scheme, now_[b], before_[b]);
    before_[b] = now_[b];
    now_[b] = next;
  }
}

} // namespace dielast::materials
