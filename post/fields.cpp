// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/fields.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>

namespace dielast::post {

namespace {

/// std::hypot minds numbers whose squares are none, at several times the cost.
double norm(double x, double y) { return std::sqrt(x * x + y * y); }

} // namespace

FilmPoint::FilmPoint(const fem::MembraneSample& at) : sample(at) {
  if (sample.solid) {
    const fem::SolidSample& solid = *sample.solid;
    C = solid.F.transpose() * solid.F;
    stretch = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C, Eigen::EigenvaluesOnly)
                  .eigenvalues()
                  .reverse()
                  .cwiseSqrt();
    thickness = solid.thickness;
    electric_field = solid.field.norm();
    return;
  }
  const auto& F = sample.F;
  C.setZero();
  C.topLeftCorner<2, 2>().noalias() = F.transpose() * F;
  const double given_stretch = F.col(0).cross(F.col(1)).norm(),
               area_stretch = given_stretch * sample.widening;
  const double radius = norm((C(0, 0) - C(1, 1)) / 2, C(0, 1));
  stretch(0) = std::sqrt((C(0, 0) + C(1, 1)) / 2 + radius);
  stretch(1) = given_stretch / stretch(0); // not the other root: it cancels when the stretches differ much
  stretch(2) = 1 / area_stretch;
  C(2, 2) = stretch(2) * stretch(2);
  thickness = sample.thickness * stretch(2);
  electric_field = std::abs(sample.voltage) * sample.field_share / thickness;
}

/// Of half the angle of ((C11 - C22)/2, C12), the larger one first: the other would cancel.
FilmPoint::Angle FilmPoint::material_angle() const {
  const double half_difference = (C(0, 0) - C(1, 1)) / 2, radius = norm(half_difference, C(0, 1));
  if (radius == 0) return {1, 0};
  const double larger = std::sqrt((1 + std::abs(half_difference) / radius) / 2);
  const double smaller = C(0, 1) / (2 * radius * larger);
  return half_difference >= 0 ? Angle{larger, smaller}
                              : Angle{std::abs(smaller), std::copysign(larger, C(0, 1))};
}

Eigen::Vector3d FilmPoint::normal() const {
  return sample.F.col(0).cross(sample.F.col(1)) / (stretch(0) * stretch(1));
}

Eigen::Matrix3d FilmPoint::direction() const {
  if (sample.solid) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> strain(C);
    return (sample.solid->F * strain.eigenvectors().rowwise().reverse()).colwise().normalized();
  }
  const auto [cosine, sine] = material_angle();
  Eigen::Matrix3d direction;
  direction.col(0) = (cosine * sample.F.col(0) + sine * sample.F.col(1)) / stretch(0);
  direction.col(2) = normal();
  direction.col(1) = direction.col(2).cross(direction.col(0));
  return direction;
}

Eigen::Matrix3d FilmPoint::cauchy() const {
  if (sample.solid) return sample.solid->cauchy;
  return sample.F * sample.S * sample.F.transpose();
}

Eigen::Vector2d FilmPoint::principal_stress() const {
  if (sample.solid) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stress(sample.solid->cauchy, Eigen::EigenvaluesOnly);
    return {stress.eigenvalues()[2], stress.eigenvalues()[0]};
  }
  const auto [cosine, sine] = material_angle();
  const auto& S = sample.S;
  const double first = stretch(0) * stretch(0) *
                       (cosine * cosine * S(0, 0) + 2 * cosine * sine * S(0, 1) + sine * sine * S(1, 1)),
               second = stretch(1) * stretch(1) *
                        (sine * sine * S(0, 0) - 2 * cosine * sine * S(0, 1) + cosine * cosine * S(1, 1)),
               shear = stretch(0) * stretch(1) *
                       (cosine * sine * (S(1, 1) - S(0, 0)) + (cosine * cosine - sine * sine) * S(0, 1));
  const double mean = (first + second) / 2, deviation = norm((first - second) / 2, shear);
  return {mean + deviation, mean - deviation};
}

namespace {

/// Film that may wrinkle and has no load across it lies between taut and wrinkled: rounding of its forces
/// widens it by less than 1e-8, and that is no loss of tension.
double tension_state(const fem::MembraneSample& sample) {
  const double wider = sample.widening - 1; // 0 where film carries its compression
  return wider != 0 && std::abs(wider) < 1e-8 ? 0 : static_cast<double>(sample.tension);
}

/// 0 where no limit is known, so that it can be drawn.
double utilisation(double value, double limit) { return limit > 0 ? value / limit : 0; }

/// xx, yy, zz, xy, yz, xz: VTK's order of symmetric tensors.
void symmetric_components(const Eigen::Matrix3d& tensor, double* values) {
  values[0] = tensor(0, 0), values[1] = tensor(1, 1), values[2] = tensor(2, 2);
  values[3] = tensor(0, 1), values[4] = tensor(1, 2), values[5] = tensor(0, 2);
}

const std::vector<FilmField> film_table{
    {"principal_stretches",
     "1",
     {"lambda1", "lambda2", "lambda3"},
     "stretches from the unstretched film: the two in its plane, larger first, and through the thickness; of "
     "a "
     "solid largest first",
     [](const FilmPoint& p, double* v) { Eigen::Map<Eigen::Vector3d>{v} = p.stretch; }},
    {"log_strain",
     "1",
     {"xx", "yy", "zz", "xy", "yz", "xz"},
     "logarithmic (Hencky) strain in space, from the unstretched film; of revolution in the half plane y = "
     "0, y around, of films in ParaView turned with them",
     [](const FilmPoint& p, double* v) {
       const Eigen::Vector3d principal = p.stretch.array().log();
       const Eigen::Matrix3d direction = p.direction();
       symmetric_components(direction * principal.asDiagonal() * direction.transpose(), v);
     },
     std::nullopt,
     true},
    {"green_lagrange_strain",
     "1",
     {"XX", "YY", "ZZ", "XY", "YZ", "XZ"},
     "Green-Lagrange strain from the unstretched film: X and Y those of the film as drawn (of revolution "
     "along the meridian and around), Z through the thickness; of a solid along x, y and z as drawn, of "
     "revolution along the radius, the hoop and the axis",
     [](const FilmPoint& p, double* v) { symmetric_components((p.C - Eigen::Matrix3d::Identity()) / 2, v); }},
    {"cauchy_stress",
     "Pa",
     {"xx", "yy", "zz", "xy", "yz", "xz"},
     "true stress in space, elastic and electrostatic; of a stack with covers, and of a rod under its "
     "electrode and beside it, the mean over its section; of "
     "revolution in the half plane y = 0, y around, of films in ParaView turned with them",
     [](const FilmPoint& p, double* v) { symmetric_components(p.cauchy(), v); },
     std::nullopt,
     true},
    {"min_principal_stress",
     "Pa",
     {},
     "smaller principal true stress in the film's plane; negative: the film has lost its tension; of a stack "
     "with covers of the mean stress over its section, of a solid the smallest; extremes where there are "
     "membranes beside shells or solids, which bear compression, are those of the membranes",
     [](const FilmPoint& p, double* v) { *v = p.principal_stress()(1); },
     Extreme::minimum,
     false,
     false,
     true},
    {"max_principal_stress",
     "Pa",
     {},
     "larger principal true stress in the film's plane; of a solid the largest",
     [](const FilmPoint& p, double* v) { *v = p.principal_stress()(0); }},
    {"thickness",
     "m",
     {},
     "thickness of the deformed film, or of a solid's layers",
     [](const FilmPoint& p, double* v) { *v = p.thickness; },
     Extreme::minimum},
    {"slope",
     "rad",
     {},
     "angle between the film and the plane across z, in which flat films are drawn; at most pi/2; of solids "
     "0",
     [](const FilmPoint& p, double* v) {
       if (p.sample.solid) {
         *v = 0; // it has no middle surface
         return;
       }
       const Eigen::Vector3d normal = p.normal();
       const double across = norm(normal.x(), normal.y());
       *v = across == 0 ? 0 : std::atan2(across, std::abs(normal.z()));
     }},
    {"electric_field",
     "V/m",
     {},
     "true electric field: voltage over the deformed thickness; of a rod that under its electrode",
     [](const FilmPoint& p, double* v) { *v = p.electric_field; },
     Extreme::maximum,
     false,
     true},
    {"breakdown_ratio",
     "1",
     {},
     "true electric field over the field at which the film breaks down",
     [](const FilmPoint& p, double* v) { *v = utilisation(p.electric_field, p.sample.breakdown_field); },
     Extreme::maximum,
     false,
     true},
    {"tension_state",
     "1",
     {},
     "number of compressive principal stresses: 0 taut, 1 wrinkled, 2 slack; of solids, which bear "
     "compression, 0; extremes beside membranes as of min_principal_stress",
     [](const FilmPoint& p, double* v) { *v = tension_state(p.sample); },
     std::nullopt,
     false,
     false,
     true},
    {"voltage",
     "V",
     {},
     "voltage across the film; in a solid with a potential the potential",
     [](const FilmPoint& p, double* v) { *v = p.sample.voltage; },
     std::nullopt,
     false,
     true},
};

const std::vector<WallField> wall_table{
    {"axial_force",
     "N",
     {},
     "force along the wall, tension positive",
     [](const fem::BeamSample& s, double* v) { *v = s.force(0); }},
    {"shear_force",
     "N",
     {"2", "3"},
     "force across the wall: 2 in the film's plane, 3 normal to it",
     [](const fem::BeamSample& s, double* v) { v[0] = s.force(1), v[1] = s.force(2); }},
    {"torsion_moment",
     "N m",
     {},
     "moment about the wall's axis",
     [](const fem::BeamSample& s, double* v) { *v = s.moment(0); }},
    {"bending_moment",
     "N m",
     {"2", "3"},
     "moment about the axis across the wall (2) and about the film's normal (3, bending in the plane)",
     [](const fem::BeamSample& s, double* v) { v[0] = s.moment(1), v[1] = s.moment(2); }},
    {"curvature",
     "1/m",
     {"1", "2", "3"},
     "change of twist (1) and of curvature about 2 and 3",
     [](const fem::BeamSample& s, double* v) { Eigen::Map<Eigen::Vector3d>{v} = s.curvature; }},
    {"axial_strain",
     "1",
     {},
     "strain of the wall's axis",
     [](const fem::BeamSample& s, double* v) { *v = s.strain(0); }},
    {"fibre_strain",
     "1",
     {},
     "largest strain magnitude of the cross-section's fibres, by axial force and bending: without shear and "
     "torsion",
     [](const fem::BeamSample& s, double* v) { *v = s.fibre_strain; },
     Extreme::maximum},
    {"yield_ratio",
     "1",
     {},
     "largest fibre strain over the yield strain of the wall's material; without shear and torsion",
     [](const fem::BeamSample& s, double* v) { *v = utilisation(s.fibre_strain, s.yield_strain); },
     Extreme::maximum},
};

} // namespace

std::span<const FilmField> film_fields() { return film_table; }
std::span<const WallField> wall_fields() { return wall_table; }

} // namespace dielast::post
