// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/beam_block.hpp"

#include "fem/elements/beam_kinematics.hpp"
#include "fem/elements/lower_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace dielast::fem {

namespace {

Eigen::Vector4d coefficients(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// Derivative of q -> exp(spin) q in the spin, at spin = 0; the second derivative is -q/4 times the unit
/// matrix.
Eigen::Matrix<double, 4, 3> spin_gradient(const Eigen::Vector4d& q) {
  Eigen::Matrix<double, 4, 3> g;
  g << -q[1], -q[2], -q[3], //
      q[0], q[3], -q[2],    //
      -q[3], q[0], q[1],    //
      q[2], -q[1], q[0];
  return 0.5 * g;
}

template<int Nodes>
struct LinePoint {
  std::array<double, Nodes> value, slope; // slope: d/dxi, xi in -1..1
  double weight;
};

template<int Nodes>
LinePoint<Nodes> line_point(double xi, double weight) {
  if constexpr (Nodes == 2)
    return {{(1 - xi) / 2, (1 + xi) / 2}, {-0.5, 0.5}, weight};
  else
    return {{xi * (xi - 1) / 2, xi * (xi + 1) / 2, 1 - xi * xi}, {xi - 0.5, xi + 0.5, -2 * xi}, weight};
}

template<int Nodes>
std::array<LinePoint<Nodes>, Nodes - 1> line_rule() {
  if constexpr (Nodes == 2)
    return {line_point<2>(0, 2)};
  else
    return {line_point<3>(-1 / std::sqrt(3.0), 1), line_point<3>(1 / std::sqrt(3.0), 1)};
}

/// Tangent of the drawn centreline at node a (not normalised).
template<int Nodes>
Eigen::Vector3d nodal_tangent(const std::array<Eigen::Vector3d, Nodes>& X, int a) {
  if constexpr (Nodes == 2) {
    return X[1] - X[0];
  } else {
    const double xi = a == 0 ? -1 : a == 1 ? 1 : 0;
    return (xi - 0.5) * X[0] + (xi + 0.5) * X[1] - 2 * xi * X[2];
  }
}

/// The section's axes at node a, as drawn. Throws std::invalid_argument for line `number`.
template<int Nodes>
Eigen::Matrix3d drawn_axes(const std::array<Eigen::Vector3d, Nodes>& X, int a, const Eigen::Vector3d& normal,
                           int number) {
  const Eigen::Vector3d tangent = nodal_tangent<Nodes>(X, a).normalized();
  const Eigen::Vector3d second = normal.cross(tangent);
  if (!(tangent.norm() > 0.5) || second.norm() < 1e-6 * normal.norm())
    throw std::invalid_argument("line " + std::to_string(number) +
                                " has no length or runs along the section's normal");
  Eigen::Matrix3d axes;
  axes.col(0) = tangent;
  axes.col(1) = second.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

template<int Nodes>
class BeamBlock final : public ElementBlock {
 public:
  BeamBlock(const meshing::Mesh& mesh, const meshing::CellBlock& lines, const materials::BeamSection& section,
            const Eigen::Vector3d& normal, std::vector<int> numbers);

  int element_count() const override { return static_cast<int>(elements_.size()); }
  int dofs_per_element() const override { return dofs; }
  void claim_dofs(DofMap& dofs, Dimension dimension) override;
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override;
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override;
  void sample(const State& state, Samples& samples) const override;
  void add_mass(int element, std::span<double> packed) const override;

 private:
  static constexpr int dofs = 6 * Nodes;
  static constexpr int points = Nodes - 1;
  using Vector6 = Eigen::Vector<double, 6>;

  struct Point {
    std::array<double, Nodes> value, slope; // of the shape functions, d/ds
    double length;                          // ds that the point stands for
    Vector6 rest;                           // strain measures as drawn
  };
  struct Element {
    std::array<int, Nodes> node;
    std::array<Eigen::Vector3d, Nodes> X;        // as drawn
    std::array<Eigen::Quaterniond, Nodes> triad; // the section's axes as drawn
    std::array<Point, points> point;
  };
  /// Positions and quaternions of an element's nodes.
  struct Nodal {
    std::array<Eigen::Vector3d, Nodes> x;
    std::array<Eigen::Vector4d, Nodes> q;
  };

  static Nodal nodal(const Element& element, const State& state);
  static BeamKinematics kinematics(const Point& point, const Nodal& nodal);
  template<int spins>
  void accumulate_tangent(const Point& point, const BeamKinematics& kinematics, const Vector6& stress,
                          const Nodal& nodal, Eigen::Matrix<double, dofs, dofs>& tangent) const;

  std::vector<Element> elements_;
  materials::BeamSection section_;
  std::vector<int> numbers_; ///< of the lines, in the mesh's block
  Vector6 stiffness_;
  bool spins_about_z_ = false; ///< alone: in a plane
};

template<int Nodes>
BeamBlock<Nodes>::BeamBlock(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                            const materials::BeamSection& section, const Eigen::Vector3d& normal,
                            std::vector<int> numbers)
    : section_(section), numbers_(std::move(numbers)) {
  stiffness_ << section.EA, section.GA2, section.GA3, section.GJ, section.EI2, section.EI3;
  const auto rule = line_rule<Nodes>();
  elements_.resize(static_cast<std::size_t>(lines.size()));
  for (int e = 0; e < lines.size(); ++e) {
    Element& element = elements_[static_cast<std::size_t>(e)];
    Nodal drawn;
    for (int a = 0; a < Nodes; ++a) {
      element.node[a] = lines.cell(e)[static_cast<std::size_t>(a)];
      element.X[a] = drawn.x[a] = mesh.nodes[static_cast<std::size_t>(element.node[a])];
    }
    for (int a = 0; a < Nodes; ++a) {
      element.triad[a] = Eigen::Quaterniond(drawn_axes<Nodes>(element.X, a, normal, e));
      if (element.triad[a].dot(element.triad[0]) < 0) element.triad[a].coeffs() *= -1;
      drawn.q[a] = coefficients(element.triad[a]);
    }
    for (int p = 0; p < points; ++p) {
      const auto& at = rule[static_cast<std::size_t>(p)];
      Eigen::Vector3d dx = Eigen::Vector3d::Zero();
      for (int a = 0; a < Nodes; ++a) dx += at.slope[a] * element.X[a];
      Point& point = element.point[p];
      point.value = at.value;
      for (int a = 0; a < Nodes; ++a) point.slope[a] = at.slope[a] / dx.norm();
      point.length = at.weight * dx.norm();
      point.rest = kinematics(point, drawn).strain();
    }
  }
}

template<int Nodes>
void BeamBlock<Nodes>::claim_dofs(DofMap& dof_map, Dimension dimension) {
  spins_about_z_ = dimension == Dimension::planar;
  for (const Element& element : elements_)
    for (const int n : element.node)
      for (int c = 0; c < DofMap::components; ++c)
        if (moves(dimension, c)) dof_map.add(n, c);
}

template<int Nodes>
void BeamBlock<Nodes>::element_equations(int element, const DofMap& dof_map, std::span<int> equations) const {
  for (int a = 0; a < Nodes; ++a)
    for (int c = 0; c < 6; ++c)
      equations[static_cast<std::size_t>(6 * a + c)] =
          dof_map.equation(elements_[static_cast<std::size_t>(element)].node[a], c);
}

template<int Nodes>
void BeamBlock<Nodes>::add_mass(int element, std::span<double> packed) const {
  const auto& X = elements_[static_cast<std::size_t>(element)].X;
  const double outer = std::sqrt(0.6); // Gauss, three points
  for (const auto& [xi, weight] : {std::pair{-outer, 5.0 / 9}, {0.0, 8.0 / 9}, {outer, 5.0 / 9}}) {
    const LinePoint<Nodes> at = line_point<Nodes>(xi, weight);
    Eigen::Vector3d dx = Eigen::Vector3d::Zero();
    for (int a = 0; a < Nodes; ++a) dx += at.slope[a] * X[a];
    const double mass = section_.line_density * weight * dx.norm();
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b <= a; ++b)
        for (int c = 0; c < 3; ++c) {
          const int row = 6 * a + c, column = 6 * b + c;
          packed[static_cast<std::size_t>(row * (row + 1) / 2 + column)] += mass * at.value[a] * at.value[b];
        }
  }
}

template<int Nodes>
typename BeamBlock<Nodes>::Nodal BeamBlock<Nodes>::nodal(const Element& element, const State& state) {
  Nodal n;
  for (int a = 0; a < Nodes; ++a) {
    const auto node = static_cast<std::size_t>(element.node[a]);
    n.x[a] = element.X[a] + state.displacement[node];
    n.q[a] = coefficients(state.rotation[node] * element.triad[a]);
  }
  return n;
}

template<int Nodes>
BeamKinematics BeamBlock<Nodes>::kinematics(const Point& point, const Nodal& nodal) {
  BeamKinematics::Vector11 y = BeamKinematics::Vector11::Zero();
  for (int a = 0; a < Nodes; ++a) {
    y.segment<3>(BeamKinematics::slope) += point.slope[a] * nodal.x[a];
    y.segment<4>(BeamKinematics::quaternion) += point.value[a] * nodal.q[a];
    y.segment<4>(BeamKinematics::quaternion_slope) += point.slope[a] * nodal.q[a];
  }
  return BeamKinematics(y);
}

/// Chain rule y -> (x_a, q_a) -> (x_a, spin_a), lower blocks; the curvature of the rotation group adds
/// -(g_a.q_a)/4 per node, where g_a is the gradient in q_a. Blocks of derivatives in y that are zero, and
/// what nodes share, are left out of the products, and where only `spins` = 1 about z is asked for, the
/// others.
template<int Nodes>
template<int spins>
void BeamBlock<Nodes>::accumulate_tangent(const Point& point, const BeamKinematics& kinematics,
                                          const Vector6& stress, const Nodal& nodal,
                                          Eigen::Matrix<double, dofs, dofs>& tangent) const {
  using OfSpins3 = Eigen::Matrix<double, 3, spins>;
  using OfSpins4 = Eigen::Matrix<double, 4, spins>;
  const auto spun = [](int a) { return 6 * a + 6 - spins; };
  const auto d = kinematics.gradient();
  const auto h = kinematics.power_hessian(stress);
  const BeamKinematics::Vector11 g = point.length * kinematics.power_gradient(stress);
  const Eigen::Matrix3d forces = // of changes of R^T x', in space
      d.stretch_slope.transpose() * (point.length * stiffness_.template head<3>()).asDiagonal();
  const Eigen::Matrix3d slopes = forces.lazyProduct(d.stretch_slope);
  const Eigen::Vector3d turning = point.length * stiffness_.template tail<3>();
  struct OfNode {
    OfSpins3 stretch, turn, moment, force; // moment, force: of spins, in the section's axes and in space
    OfSpins4 G, value, slope;
  };
  std::array<OfNode, Nodes> nodes;
  for (int a = 0; a < Nodes; ++a) {
    OfNode& n = nodes[a];
    n.G = spin_gradient(nodal.q[a]).template rightCols<spins>();
    n.stretch = point.value[a] * d.stretch_quaternion.lazyProduct(n.G);
    n.turn = (point.value[a] * d.turn_quaternion + point.slope[a] * d.turn_quaternion_slope).lazyProduct(n.G);
    n.moment = turning.asDiagonal() * n.turn;
    n.force =
        forces.lazyProduct(n.stretch) + (point.length * point.value[a]) * h.slope_quaternion.lazyProduct(n.G);
    n.value =
        point.length *
        (point.value[a] * h.quaternion + point.slope[a] * h.quaternion_quaternion_slope).lazyProduct(n.G);
    n.slope = (point.length * point.value[a]) * h.quaternion_quaternion_slope.transpose().lazyProduct(n.G);
  }
  for (int a = 0; a < Nodes; ++a) {
    const OfNode& n = nodes[a];
    const OfSpins3 stretching = (point.length * stiffness_.template head<3>()).asDiagonal() * n.stretch;
    for (int b = 0; b <= a; ++b) {
      const OfNode& other = nodes[b];
      tangent.template block<3, 3>(6 * a, 6 * b) += (point.slope[a] * point.slope[b]) * slopes;
      if (b < a) tangent.template block<3, spins>(6 * a, spun(b)) += point.slope[a] * other.force;
      tangent.template block<spins, 3>(spun(a), 6 * b) += point.slope[b] * n.force.transpose();
      const OfSpins4 curved = point.value[a] * other.value + point.slope[a] * other.slope;
      tangent.template block<spins, spins>(spun(a), spun(b)) +=
          stretching.transpose().lazyProduct(other.stretch) + n.turn.transpose().lazyProduct(other.moment) +
          n.G.transpose().lazyProduct(curved);
    }
    const double curvature = -0.25 * (point.value[a] * g.segment<4>(BeamKinematics::quaternion) +
                                      point.slope[a] * g.segment<4>(BeamKinematics::quaternion_slope))
                                         .dot(nodal.q[a]);
    tangent.template block<spins, spins>(spun(a), spun(a)).diagonal().array() += curvature;
  }
}

template<int Nodes>
Evaluation BeamBlock<Nodes>::evaluate(const State& state, int first, int last, const Scatter& scatter) const {
  Evaluation result;
  for (int e = first; e < last; ++e) {
    const Element& element = elements_[static_cast<std::size_t>(e)];
    const Nodal n = nodal(element, state);
    Eigen::Vector<double, dofs> residual = Eigen::Vector<double, dofs>::Zero();
    Eigen::Matrix<double, dofs, dofs> tangent;
    if (scatter.tangent) tangent.setZero();
    for (const Point& point : element.point) {
      const BeamKinematics k = kinematics(point, n);
      if (!(k.N > 0.1)) { // quaternions more than 140 degrees apart, nodes 280: no interpolation
        result.feasible = false;
        continue;
      }
      const Vector6 strain = k.strain() - point.rest;
      const Vector6 stress = stiffness_.cwiseProduct(strain);
      result.energy += 0.5 * point.length * stress.dot(strain);
      if (scatter.residual) {
        const BeamKinematics::Vector11 g = point.length * k.power_gradient(stress);
        for (int a = 0; a < Nodes; ++a) {
          residual.template segment<3>(6 * a) += point.slope[a] * g.template head<3>();
          residual.template segment<3>(6 * a + 3) +=
              spin_gradient(n.q[a]).transpose() *
              (point.value[a] * g.template segment<4>(BeamKinematics::quaternion) +
               point.slope[a] * g.template segment<4>(BeamKinematics::quaternion_slope));
        }
      }
      if (!scatter.tangent) continue;
      spins_about_z_ ? accumulate_tangent<1>(point, k, stress, n, tangent)
                     : accumulate_tangent<3>(point, k, stress, n, tangent);
    }
    if (scatter.residual) scatter.add_residual(e, {residual.data(), dofs});
    if (scatter.tangent) scatter.add_tangent(e, lower_triangle<dofs>(tangent));
  }
  return result;
}

/// Of the section's fibres, by axial force and bending.
double largest_fibre_strain(const Eigen::Vector<double, 6>& strain, const materials::BeamSection& section) {
  return std::abs(strain[0]) + std::abs(strain[5]) * section.half_width +
         std::abs(strain[4]) * section.half_height;
}

template<int Nodes>
void BeamBlock<Nodes>::sample(const State& state, Samples& samples) const {
  constexpr std::size_t points = Nodes - 1;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Nodal n = nodal(elements_[e], state);
    std::array<Vector6, points> strains;
    for (std::size_t p = 0; p < points; ++p)
      strains[p] = kinematics(elements_[e].point[p], n).strain() - elements_[e].point[p].rest;
    const Vector6 middle = (strains.front() + strains.back()) / 2;
    for (std::size_t p = 0; p < points; ++p) {
      const Vector6& strain = strains[p];
      const Vector6 end = middle + std::sqrt(3.0) * (strain - middle); // of the element
      const Vector6 stress = stiffness_.cwiseProduct(strain);
      BeamSample s;
      s.cell = numbers_[e];
      s.length = elements_[e].point[p].length;
      s.force = stress.head<3>();
      s.moment = stress.tail<3>();
      s.strain = strain.head<3>();
      s.curvature = strain.tail<3>();
      s.fibre_strain = std::max(largest_fibre_strain(middle, section_), largest_fibre_strain(end, section_));
      s.yield_strain = section_.yield_strain;
      samples.walls.push_back(s);
    }
  }
}

template<int Nodes>
void add_rotary(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                const materials::BeamSection& section, const Eigen::Vector3d& normal,
                RotaryInertia& inertia) {
  const std::array<double, 3> shares =
      Nodes == 2 ? std::array{0.5, 0.5, 0.0} : std::array{1.0 / 6, 1.0 / 6, 2.0 / 3};
  for (int e = 0; e < lines.size(); ++e) {
    std::array<Eigen::Vector3d, Nodes> X;
    for (int a = 0; a < Nodes; ++a)
      X[a] = mesh.nodes[static_cast<std::size_t>(lines.cell(e)[static_cast<std::size_t>(a)])];
    for (int a = 0; a < Nodes; ++a) {
      const Eigen::Matrix3d axes = drawn_axes<Nodes>(X, a, normal, e);
      const double length = 2 * nodal_tangent<Nodes>(X, a).norm() / (Nodes == 2 ? 2 : 1);
      auto& arms = inertia[lines.cell(e)[static_cast<std::size_t>(a)]];
      for (const auto& [axis, moment] : {std::pair{1, section.rotary3}, {2, section.rotary2}}) {
        if (moment == 0) continue;
        const Eigen::Vector3d arm = std::sqrt(moment / section.line_density) * axes.col(axis);
        const double mass = shares[static_cast<std::size_t>(a)] * length * section.line_density;
        const auto alike = std::ranges::find_if(arms, [&](const auto& other) {
          return std::min((other.first - arm).norm(), (other.first + arm).norm()) <= 1e-9 * arm.norm();
        });
        if (alike == arms.end())
          arms.emplace_back(arm, mass);
        else
          alike->second += mass;
      }
    }
  }
}

} // namespace

void add_rotary_inertia(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                        const materials::BeamSection& section, const Eigen::Vector3d& normal,
                        RotaryInertia& inertia) {
  if (section.line_density == 0) return;
  if (lines.type == meshing::CellType::line3)
    add_rotary<3>(mesh, lines, section, normal, inertia);
  else
    add_rotary<2>(mesh, lines, section, normal, inertia);
}

std::unique_ptr<ElementBlock> make_beam_block(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                                              const materials::BeamSection& section,
                                              const Eigen::Vector3d& normal, std::vector<int> numbers) {
  if (numbers.empty()) {
    numbers.resize(static_cast<std::size_t>(lines.size()));
    std::iota(numbers.begin(), numbers.end(), 0);
  }
  if (lines.type == meshing::CellType::line3)
    return std::make_unique<BeamBlock<3>>(mesh, lines, section, normal, std::move(numbers));
  return std::make_unique<BeamBlock<2>>(mesh, lines, section, normal, std::move(numbers));
}

} // namespace dielast::fem
