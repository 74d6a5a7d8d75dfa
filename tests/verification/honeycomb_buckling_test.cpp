// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/triangle.hpp"
#include "tests/verification/honeycomb_model.hpp"

#include <Eigen/SparseCholesky>

#include <array>
#include <cmath>
#include <tuple>

// The wall height below which the released actuator leaves its plane, by another way: the planar model's
// forces act on straight bars and on a taut film, and what small motion out of the plane costs is a quadratic
// form of the deflection w of all nodes and of the walls' rotation vector, phi along a bar and theta across
// it:
//   film  1/2 int S_ij w,i w,j dV,
//   bar   1/2 int EI2 theta'^2 + GJ phi'^2 + GA3 (w' + t)^2 ds + int N G1 + V G2 + M K3 ds,
// with N, V, M the bar's forces in the plane along the axes of its section (which are not those of its line:
// the shear V/GA2 turns them by up to 0.4 degrees, and to take N and V along the line shifts the height by
// 2.4 %) and the strains of second order on which they act,
//   G1 = -theta w' - theta t/2, G2 = phi w' + phi t/2, K3 = (theta phi' - phi theta')/2,
// where t = x1 theta - x2 phi, (x1, x2) being the slope of the line in those axes, next to (1, 0).

namespace dielast::fem::honeycomb_buckling_test {
namespace {

using test::Honeycomb;

/// Deflection and rotations of the nodes: 3 numbers for each.
class SmallMotion {
 public:
  SmallMotion(const Honeycomb& planar, const materials::BeamSection& section)
      : mesh_(planar.mesh()), state_(planar.state()), section_(section) {
    const Samples samples = planar.model().sample(state_);
    add_film(samples.film);
    add_walls(samples.walls);
  }

  /// Of the motion that is left when three deflections, and with them the rigid motion, are held.
  int unstable_modes() const {
    const int centre = node("centre"), left = node("left_apex"), top = node("top");
    std::vector<int> number(3 * mesh_.nodes.size(), -1);
    for (const auto& entry : entries_) number[static_cast<std::size_t>(entry.row())] = 0;
    for (const int a : {centre, left, top}) number[static_cast<std::size_t>(3 * a)] = -1;
    int count = 0;
    for (int& n : number)
      if (n == 0) n = count++;
    std::vector<Eigen::Triplet<double>> kept;
    for (const auto& e : entries_) {
      const int row = number[static_cast<std::size_t>(e.row())],
                column = number[static_cast<std::size_t>(e.col())];
      if (row >= 0 && column >= 0) kept.emplace_back(row, column, e.value());
    }
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(kept.begin(), kept.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    EXPECT_EQ(factor.info(), Eigen::Success);
    return static_cast<int>((factor.vectorD().array() < 0).count());
  }

  /// Largest force that a turn of the whole actuator about an axis in its plane meets, over that which film
  /// and walls resist it with one by one: zero where they are in equilibrium.
  double force_on_turn(int axis) const {
    Eigen::VectorXd turn(3 * mesh_.node_count());
    for (int a = 0; a < mesh_.node_count(); ++a) {
      const Eigen::Vector3d x = at(a);
      turn[3 * a] = axis == 0 ? x.y() : -x.x(); // the turn (1, 0, 0) lifts y, (0, 1, 0) lowers x
      turn[3 * a + 1] = axis == 0;
      turn[3 * a + 2] = axis == 1;
    }
    Eigen::VectorXd force = Eigen::VectorXd::Zero(turn.size()), size = force;
    for (const auto& e : entries_) {
      force[e.row()] += e.value() * turn[e.col()];
      size[e.row()] += std::abs(e.value() * turn[e.col()]);
    }
    return force.cwiseAbs().maxCoeff() / size.maxCoeff();
  }

 private:
  int node(const char* name) const { return mesh_.node_sets.at(name)[0]; }
  Eigen::Vector3d at(int a) const {
    return mesh_.nodes[static_cast<std::size_t>(a)] + state_.displacement[static_cast<std::size_t>(a)];
  }

  double turn(int a) const {
    const Eigen::Quaterniond& q = state_.rotation[static_cast<std::size_t>(a)];
    return 2 * std::atan2(q.z(), q.w());
  }

  void add_film(const std::vector<MembraneSample>& samples) {
    const meshing::CellBlock& film = mesh_.blocks[0];
    std::vector<Eigen::Matrix2d> force(static_cast<std::size_t>(film.size()), Eigen::Matrix2d::Zero());
    const Eigen::DiagonalMatrix<double, 2> prestretch(4.0, 2.5);
    for (const MembraneSample& sample : samples) // sums of S dV, as it acts on slopes of the drawing
      force[static_cast<std::size_t>(sample.cell)] += sample.volume * (prestretch * sample.S * prestretch);
    for (int cell = 0; cell < film.size(); ++cell) {
      const auto nodes = film.cell(cell);
      for (const auto& [xi, eta] : {std::pair{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}}) {
        const Eigen::Matrix<double, 6, 2> natural = shape_gradients<6>(xi, eta);
        Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero(); // dX/d(xi, eta)
        for (Eigen::Index a = 0; a < 6; ++a)
          jacobian += mesh_.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])].head<2>() *
                      natural.row(a);
        const Eigen::Matrix<double, 6, 2> slope = natural * jacobian.inverse();
        const Eigen::Matrix<double, 6, 6> stiffness =
            slope * force[static_cast<std::size_t>(cell)] * slope.transpose() / 3;
        for (Eigen::Index a = 0; a < 6; ++a)
          for (Eigen::Index b = 0; b < 6; ++b)
            entries_.emplace_back(3 * nodes[static_cast<std::size_t>(a)],
                                  3 * nodes[static_cast<std::size_t>(b)], stiffness(a, b));
      }
    }
  }

  /// Each 3-node line is two straight bars, whose forces vary linearly as its two points say.
  void add_walls(const std::vector<BeamSample>& samples) {
    const meshing::CellBlock& walls = mesh_.blocks[1];
    for (int line = 0; line < walls.size(); ++line) {
      const auto nodes = walls.cell(line);
      const BeamSample &first = samples[static_cast<std::size_t>(2 * line)],
                       &second = samples[static_cast<std::size_t>(2 * line + 1)];
      ASSERT_EQ(first.cell, line);
      const auto forces = [&](double xi) -> Eigen::Vector3d { // N, V, M
        const double t = (1 + std::sqrt(3.0) * xi) / 2;
        const auto of = [](const BeamSample& s) {
          return Eigen::Vector3d(s.force[0], s.force[1], s.moment[2]);
        };
        return (1 - t) * of(first) + t * of(second);
      };
      add_bar(nodes[0], nodes[2], forces(-1), forces(0));
      add_bar(nodes[2], nodes[1], forces(0), forces(1));
    }
  }

  void add_bar(int from, int to, const Eigen::Vector3d& forces_from, const Eigen::Vector3d& forces_to) {
    using Form = Eigen::Vector<double, 6>; // of (w, theta_x, theta_y) of both ends
    const Eigen::Vector2d drawn =
        (mesh_.nodes[static_cast<std::size_t>(to)] - mesh_.nodes[static_cast<std::size_t>(from)]).head<2>();
    const double length = drawn.norm();
    const Eigen::Vector2d normal = Eigen::Rotation2Dd((turn(from) + turn(to)) / 2) * (drawn / length);
    const double c = normal.x(), s = normal.y();
    const Eigen::Vector2d tangent = Eigen::Rotation2Dd(-std::atan2(s, c)) * (at(to) - at(from)).head<2>() /
                                    length; // x', in the section's axes
    Form slope, phi, theta, twist, bend;
    slope << -1 / length, 0, 0, 1 / length, 0, 0;
    phi << 0, c / 2, s / 2, 0, c / 2, s / 2;
    theta << 0, -s / 2, c / 2, 0, -s / 2, c / 2;
    twist << 0, -c / length, -s / length, 0, c / length, s / length;
    bend << 0, s / length, -c / length, 0, -s / length, c / length;
    const Form turned = tangent.x() * theta - tangent.y() * phi; // by how much the rotation lowers x'
    Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
    const auto add = [&](double factor, const Form& u, const Form& v) {
      stiffness += length * factor / 2 * (u * v.transpose() + v * u.transpose());
    };
    const auto [N, V, M] =
        std::tuple((forces_from[0] + forces_to[0]) / 2, (forces_from[1] + forces_to[1]) / 2,
                   (forces_from[2] + forces_to[2]) / 2);
    add(section_.EI2, bend, bend);
    add(section_.GJ, twist, twist);
    add(section_.GA3, slope + turned, slope + turned);
    add(-2 * N, theta, slope);
    add(-N, theta, turned);
    add(2 * V, phi, slope);
    add(V, phi, turned);
    add(M, theta, twist);
    add(-M, phi, bend);
    const std::array<int, 6> place{3 * from, 3 * from + 1, 3 * from + 2, 3 * to, 3 * to + 1, 3 * to + 2};
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        entries_.emplace_back(place[a], place[b],
                              stiffness(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
  }

  const meshing::Mesh& mesh_;
  const State& state_;
  materials::BeamSection section_;
  std::vector<Eigen::Triplet<double>> entries_;
};

/// Of the released actuator, by the forces in its plane.
int unstable_modes(double wall_height) {
  Honeycomb planar(2, 6, true, wall_height);
  planar.ramp_to(0);
  const SmallMotion motion(planar, Honeycomb::section(wall_height));
  for (const int axis : {0, 1}) EXPECT_LT(motion.force_on_turn(axis), 1e-3);
  return motion.unstable_modes();
}

int unstable_modes_in_space(double wall_height) {
  Honeycomb spatial(2, 6, false, wall_height);
  spatial.ramp_to(0);
  return spatial.unstable_modes();
}

// It twists below 1.902 mm in space and below 1.909 mm by these forces; with elements half as long the latter
// is 1.9035 mm, which leads on to 1.9017 mm.
TEST(HoneycombActuator, low_walls_let_it_twist_as_the_forces_in_its_plane_say) {
  EXPECT_EQ(unstable_modes(1.895e-3), 1);
  EXPECT_EQ(unstable_modes(1.915e-3), 0);
  EXPECT_EQ(unstable_modes_in_space(1.895e-3), 1);
  EXPECT_EQ(unstable_modes_in_space(1.915e-3), 0);
}

} // namespace
} // namespace dielast::fem::honeycomb_buckling_test
