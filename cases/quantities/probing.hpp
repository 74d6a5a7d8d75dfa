// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/quantities.hpp"
#include "cases/devices/device.hpp"
#include "cases/language/conditions.hpp"
#include "cases/language/schema.hpp"
#include "fem/paths/energy_balance.hpp"

#include <limits>
#include <string>
#include <vector>

namespace dielast::cases {

/// A state, with what is needed to measure it; that of a pinned body upright().
struct Measured {
  /// `scalars`: of which the extremes are wanted. `held`: what holds the state, where that is known. Both
  /// must outlive this.
  Measured(const Device& device, fem::Equilibrium& equilibrium, const fem::State& state,
           const fem::EnergyBalance& energy, const post::WantedScalars& scalars = post::WantedScalars::all(),
           const fem::Holding* held = nullptr);

  /// Of supports on the device at held equations (see DofMap), N and N m.
  const Eigen::VectorXd& reaction() const;

  fem::Equilibrium& equilibrium;
  bool may_rest = true; ///< asked for stiffness and vibrations, where it is at rest; not on the way in time

 private:
  std::optional<fem::State> upright_;

 public:
  const fem::State& state;
  fem::Samples samples;
  post::Extremes extremes; ///< of the scalars that are wanted
  fem::Charges charges;
  const fem::EnergyBalance& energy;

 private:
  const fem::Holding* held_;
  mutable Eigen::VectorXd reaction_; ///< empty until somebody asks
};

/// A quantity and the device that it is of. Probes keep references to what they need of both.
struct Probing {
  const Quantity& quantity;
  const Case& one;
  const Device& device;
  const fem::Samples& drawn; ///< of the initial state; only while probes are made
  std::string path;          ///< "quantity[2]", of those that the user has written

  [[noreturn]] void refuse(const std::string& key, const std::string& message) const;
  std::size_t electrode() const; ///< the number of the one it is of
  Eigen::Vector3d axis() const;  ///< of what is along an axis, or as gravity pulls
};

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// Orders of convergence of what is read in the elements next to a place.
inline constexpr std::array next_to_a_place{0.5, 2.0};

inline double component(const Eigen::Vector3d& vector, const std::optional<int>& along) {
  return along ? vector[*along] : vector.norm();
}

/// See QuantityKind::since.
inline double change(double now, double then) { return now / then - 1; }

// --- keys that several kinds have, and what all say of them

std::vector<Choice> axes_and_gravity();
Key of_key(std::string meaning);
Key place_key();
Key between_key();
Key electrode_key();
Key body_key();
Key about_key();     ///< "along", of a rotation
Key component_key(); ///< "along", or the magnitude
Key axis_key();      ///< "along"; needed
Key plane_key();     ///< "along" x or y; needed
Key since_key(std::string meaning = "step at whose end it is zero; without it the mesh as drawn");

Key extreme_key();

/// "smallest" or "largest"
const char* extreme_word(const Quantity& quantity);
/// " along x", " about x", and ", at the end of "step"", where it is so.
std::string along_words(const Quantity& quantity);
std::string about_words(const Quantity& quantity);
std::string at_words(const Quantity& quantity);
/// The step since whose end it counts, or "the mesh as drawn".
std::string since_words(const Quantity& quantity);
/// "electric_field" in words.
std::string field_words(const Quantity& quantity);

/// A refusal: bodies do not turn in a model of revolution.
std::string turns_not(const Case& one, const Quantity& quantity);

// --- the kinds, by what they are about

std::vector<QuantityKind> shape_kinds();
std::vector<QuantityKind> area_kinds();
std::vector<QuantityKind> force_kinds();
std::vector<QuantityKind> port_kinds();
std::vector<QuantityKind> stiffness_kinds();
std::vector<QuantityKind> field_kinds();
std::vector<QuantityKind> run_kinds();
std::vector<QuantityKind> fin_kinds();

} // namespace dielast::cases
