// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/samples.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace dielast::post {

/// The film at one integration point, with what most fields share worked out once.
///
/// Incompressible membrane: \f$ C = F^T F, \lambda_3 = 1/\sqrt{\det C}, h = \lambda_3 H, E = |\Phi|/h \f$,
/// \f$ \sigma = F S F^T \f$ (J = 1, plane stress). A solid's sample says F, sigma and E itself; its stretches
/// are sorted.
class FilmPoint {
 public:
  explicit FilmPoint(const fem::MembraneSample& sample);

  const fem::MembraneSample& sample;
  Eigen::Matrix3d C;         ///< right Cauchy-Green tensor, w.r.t. the unstretched film; Z through it
  Eigen::Vector3d stretch;   ///< lambda1 >= lambda2 in the plane, lambda3 through the thickness
  double thickness = 0;      ///< h, m
  double electric_field = 0; ///< true field E, V/m

  /// Columns: unit vectors of the stretches in space; the third is normal().
  Eigen::Matrix3d direction() const;
  /// Unit vector in space; not of a solid.
  Eigen::Vector3d normal() const;
  /// sigma in space, Pa.
  Eigen::Matrix3d cauchy() const;
  /// In the plane, larger first, of a solid largest and smallest, Pa.
  Eigen::Vector2d principal_stress() const;

 private:
  struct Angle {
    double cosine, sine;
  };
  /// From X to the direction of the larger stretch in the unstretched film.
  Angle material_angle() const;
};

enum class Extreme { minimum, maximum };

/// One output field: the row from which files, extremes and documentation are made.
template<class Point>
struct Field {
  std::string_view name;
  std::string_view unit;                    ///< SI; "1" when it has none
  std::vector<std::string_view> components; ///< names; empty for a scalar
  std::string_view meaning;
  void (*evaluate)(const Point&, double* values);
  std::optional<Extreme> worst{}; ///< of a scalar: the end of its range that breaks a device
  bool in_space = false;          ///< a symmetric tensor (xx, yy, zz, xy, yz, xz) that turns with the film
  bool of_electrodes = false;     ///< a scalar that is 0 beside electrodes, where its averages do not look
  bool of_membranes = false;      ///< where there are any, its extremes do not look at what bears compression

  int width() const { return components.empty() ? 1 : static_cast<int>(components.size()); }
};
using FilmField = Field<FilmPoint>;
using WallField = Field<fem::BeamSample>;

/// The tables of all output fields. A new field is one row there.
std::span<const FilmField> film_fields();
std::span<const WallField> wall_fields();

} // namespace dielast::post
