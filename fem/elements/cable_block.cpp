// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/cable_block.hpp"

#include "fem/elements/lower_triangle.hpp"
#include "fem/films/meridian.hpp"

#include <stdexcept>
#include <string>

namespace dielast::fem {

namespace {

/// Energy per length at rest (N), tension (N), its derivative (N).
struct Tension {
  double energy = 0, force = 0, stiffness = 0;
};

Tension tension(const CableSection& section, double strain) {
  const double k = section.stiffness, crimp = section.crimp;
  if (!(strain > 0)) return {};
  if (strain < crimp)
    return {k * strain * strain * strain / (6 * crimp), k * strain * strain / (2 * crimp),
            k * strain / crimp};
  const double beyond = strain - crimp / 2;
  return {k * (beyond * beyond / 2 + crimp * crimp / 24), k * beyond, k};
}

/// `Between`: nodes that the strain depends on; `Nodes`: all of an element.
template<int Nodes, int Between = Nodes>
class CableBlock final : public ElementBlock {
 public:
  CableBlock(const meshing::Mesh& mesh, const meshing::CellBlock& lines, const CableSection& section,
             std::vector<int> numbers);

  int element_count() const override { return static_cast<int>(elements_.size()); }
  int dofs_per_element() const override { return dofs; }
  void claim_dofs(DofMap& map, Dimension dimension) override {
    for (const Element& element : elements_)
      for (const int node : element.node)
        for (int c = 0; c < 3; ++c)
          if (moves(dimension, c)) map.add(node, c);
  }
  void element_equations(int element, const DofMap& map, std::span<int> equations) const override {
    for (int i = 0; i < dofs; ++i)
      equations[static_cast<std::size_t>(i)] =
          map.equation(elements_[static_cast<std::size_t>(element)].node[i / 3], i % 3);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override;
  void sample(const State& state, Samples& samples) const override;
  void add_mass(int element, std::span<double> packed) const override;

 private:
  static constexpr int dofs = 3 * Nodes;
  static constexpr int points = Between - 1;

  struct Element {
    std::array<int, Nodes> node;
    Eigen::Matrix<double, 3, Nodes> X; ///< as drawn
    std::array<double, points> length; ///< |X'|/prestretch at the integration points, per xi
  };
  Eigen::Matrix<double, 3, Nodes> positions(const Element& element, const State& state) const {
    Eigen::Matrix<double, 3, Nodes> x = element.X;
    for (int a = 0; a < Nodes; ++a) x.col(a) += state.displacement[static_cast<std::size_t>(element.node[a])];
    return x;
  }
  static Eigen::Matrix<double, Between, 1> slope(int point) {
    return meridian_slope<Between>(meridian_rule(points)[static_cast<std::size_t>(point)].xi);
  }
  static double weight(int point) { return meridian_rule(points)[static_cast<std::size_t>(point)].weight; }

  std::vector<Element> elements_;
  CableSection section_;
  std::vector<int> numbers_; ///< of the lines, in the mesh's block
};

template<int Nodes, int Between>
CableBlock<Nodes, Between>::CableBlock(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                                       const CableSection& section, std::vector<int> numbers)
    : section_(section), numbers_(std::move(numbers)) {
  elements_.resize(static_cast<std::size_t>(lines.size()));
  for (int e = 0; e < lines.size(); ++e) {
    Element& element = elements_[static_cast<std::size_t>(e)];
    for (int a = 0; a < Nodes; ++a) {
      element.node[a] = lines.cell(e)[static_cast<std::size_t>(a)];
      element.X.col(a) = mesh.nodes[static_cast<std::size_t>(element.node[a])];
    }
    for (int p = 0; p < points; ++p) {
      element.length[p] = (element.X.template leftCols<Between>() * slope(p)).norm() / section.prestretch;
      if (!(element.length[p] > 0))
        throw std::invalid_argument("line " + std::to_string(e) + " has no length");
    }
  }
}

template<int Nodes, int Between>
Evaluation CableBlock<Nodes, Between>::evaluate(const State& state, int first, int last,
                                                const Scatter& scatter) const {
  Evaluation result;
  for (int e = first; e < last; ++e) {
    const Element& element = elements_[static_cast<std::size_t>(e)];
    const Eigen::Matrix<double, 3, Nodes> x = positions(element, state);
    Eigen::Vector<double, dofs> residual = Eigen::Vector<double, dofs>::Zero();
    Eigen::Matrix<double, dofs, dofs> tangent = Eigen::Matrix<double, dofs, dofs>::Zero();
    for (int p = 0; p < points; ++p) {
      const auto N = slope(p);
      const Eigen::Vector3d along = x.template leftCols<Between>() * N; // dx/dxi
      const double length = along.norm();
      const Tension t = tension(section_, length / element.length[p] - 1);
      result.energy += weight(p) * element.length[p] * t.energy;
      if (!(length > 0)) continue; // slack
      const Eigen::Vector3d direction = along / length;
      const Eigen::Matrix3d K =
          weight(p) * (t.stiffness / element.length[p] * direction * direction.transpose() +
                       t.force / length * (Eigen::Matrix3d::Identity() - direction * direction.transpose()));
      for (int a = 0; a < Between; ++a) {
        residual.template segment<3>(3 * a) += weight(p) * t.force * N[a] * direction;
        for (int b = 0; b <= a; ++b) tangent.template block<3, 3>(3 * a, 3 * b) += N[a] * N[b] * K;
      }
    }
    if constexpr (Nodes != Between) { // u_m - (u_1 + u_2)/2 of the middle node is none
      const Eigen::Vector3d share(-0.5, -0.5, 1);
      const double k = section_.stiffness / element.length[0];
      const Eigen::Vector3d off = (x - element.X) * share;
      result.energy += k / 2 * off.squaredNorm();
      for (int a = 0; a < Nodes; ++a) {
        residual.template segment<3>(3 * a) += k * share[a] * off;
        for (int b = 0; b <= a; ++b)
          tangent.template block<3, 3>(3 * a, 3 * b).diagonal().array() += k * share[a] * share[b];
      }
    }
    if (scatter.residual) scatter.add_residual(e, {residual.data(), dofs});
    if (scatter.tangent) scatter.add_tangent(e, lower_triangle<dofs>(tangent));
  }
  return result;
}

template<int Nodes, int Between>
void CableBlock<Nodes, Between>::sample(const State& state, Samples& samples) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const Eigen::Matrix<double, 3, Nodes> x = positions(element, state);
    for (int p = 0; p < points; ++p) {
      const double strain = (x.template leftCols<Between>() * slope(p)).norm() / element.length[p] - 1;
      BeamSample s{};
      s.cell = numbers_[e];
      s.length = weight(p) * element.length[p] * section_.prestretch;
      s.force = Eigen::Vector3d(tension(section_, strain).force, 0, 0);
      s.moment = s.curvature = Eigen::Vector3d::Zero();
      s.strain = Eigen::Vector3d(strain, 0, 0);
      s.fibre_strain = s.force[0] / section_.stiffness;
      s.yield_strain = section_.yield_strain;
      samples.walls.push_back(s);
    }
  }
}

template<int Nodes, int Between>
void CableBlock<Nodes, Between>::add_mass(int element, std::span<double> packed) const {
  const auto X = elements_[static_cast<std::size_t>(element)].X.template leftCols<Between>();
  for (const MeridianPoint& at : meridian_rule(3)) {
    const Eigen::Matrix<double, Between, 1> N = meridian_shape<Between>(at.xi);
    const double mass =
        section_.line_density * at.weight * (X * meridian_slope<Between>(at.xi)).norm() / section_.prestretch;
    for (int i = 0; i < 3 * Between; ++i)
      for (int j = i % 3; j <= i; j += 3)
        packed[static_cast<std::size_t>(i * (i + 1) / 2 + j)] += mass * N[i / 3] * N[j / 3];
  }
}

} // namespace

std::unique_ptr<ElementBlock> make_cable_block(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                                               const CableSection& section, bool straight,
                                               std::vector<int> numbers) {
  if (lines.type == meshing::CellType::line2)
    return std::make_unique<CableBlock<2>>(mesh, lines, section, std::move(numbers));
  if (straight) return std::make_unique<CableBlock<3, 2>>(mesh, lines, section, std::move(numbers));
  return std::make_unique<CableBlock<3>>(mesh, lines, section, std::move(numbers));
}

} // namespace dielast::fem
