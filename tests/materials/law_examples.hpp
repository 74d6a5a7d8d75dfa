// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/dual.hpp"
#include "materials/laws/elastic_law.hpp"
#include "materials/laws/plane_stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <random>
#include <string>
#include <tuple>
#include <variant>

namespace dielast::materials::test {

/// One example of every law: a new law adds its own here, and all contracts hold for it.
inline const std::tuple examples{NeoHookean{45e3},
                                 MooneyRivlin{16e3, 5e3},
                                 Yeoh{10e3, -50, 2},
                                 Ogden{{30e3, 100, -5e3}, {1.3, 5.0, -2.0}},
                                 Gent{20e3, 110},
                                 ArrudaBoyce{15.36e3, 5.99},
                                 StVenantKirchhoff{60e3, 0.4}};

template<class Variant>
struct AlternativesOf;
template<class... Laws>
struct AlternativesOf<std::variant<Laws...>> {
  using Types = testing::Types<Laws...>;
};

struct LawName {
  template<class Law>
  static std::string GetName(int) {
    std::string name(Law::name);
    std::ranges::replace(name, '-', '_');
    return name;
  }
};

constexpr int states = 100;

template<class Law>
class LawTest : public testing::Test {
 protected:
  const Law law = std::get<Law>(examples);
  std::mt19937 random{1};

  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random); }
  static Eigen::Matrix2d rotation(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }
  /// Principal stretches along any axes, their ratio at least 1.05: the oracles in principal values lose
  /// their digits where these are equal.
  Eigen::Matrix2d random_C(double from = 0.5, double to = 3.5) {
    Eigen::Vector2d stretch;
    do stretch = {uniform(from, to), uniform(from, to)};
    while (stretch.maxCoeff() < 1.05 * stretch.minCoeff());
    const Eigen::Matrix2d Q = rotation(uniform(0, 3.2));
    return Q * stretch.cwiseAbs2().asDiagonal() * Q.transpose();
  }
  static InPlaneC<double> in_plane(const Eigen::Matrix2d& C) { return {C(0, 0), C(1, 1), C(0, 1)}; }
  static Eigen::Matrix2d stress(const MembranePotential<double>& p) {
    return Eigen::Matrix2d{{2 * p.first[0], p.first[2]}, {p.first[2], 2 * p.first[1]}};
  }
  double modulus() const { return law.initial_shear_modulus(); }
};

/// Components (C11, C22, C12) as variables of dual numbers.
inline InPlaneC<Dual<3>> variables(const InPlaneC<double>& C) {
  return {Dual<3>::variable(C.C11, 0), Dual<3>::variable(C.C22, 1), Dual<3>::variable(C.C12, 2)};
}

} // namespace dielast::materials::test
