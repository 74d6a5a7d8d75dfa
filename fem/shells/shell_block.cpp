// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/shells/shell_elements.hpp"

#include <Eigen/LU>

#include <numeric>
#include <stdexcept>
#include <string>

namespace dielast::fem {

namespace {

/// Of unit quaternions x, y, z, w.
void rotation_matrix(const Lanes (&q)[4], Lanes (&R)[3][3]) {
  const auto &x = q[0], &y = q[1], &z = q[2], &w = q[3];
  const Lanes matrix[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                              {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                              {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R[i][j] = matrix[i][j];
}

using Potential = materials::MembranePotential<Lanes>;

/// Adds factor g g^T to the second derivatives of `psi`, g the first ones of `other`.
void add_square(Potential& psi, const Lanes& factor, const Potential& other) {
  for (std::size_t p = 0; p < 6; ++p) {
    const auto [i, j] = materials::component_pairs[p];
    psi.second[p] +=
        factor * other.first[static_cast<std::size_t>(i)] * other.first[static_cast<std::size_t>(j)];
  }
}

/// 1/r with its first derivatives.
Potential reciprocal(const Potential& r) {
  Potential inverse{.value = 1.0 / r.value};
  const Lanes slope = -1.0 / (r.value * r.value);
  for (std::size_t i = 0; i < 3; ++i) inverse.first[i] = r.first[i] * slope;
  return inverse;
}

} // namespace

Matrix32 axes(const Matrix32& tangents) {
  const Eigen::Vector3d normal = tangents.col(0).cross(tangents.col(1)).normalized();
  const int along = std::abs(normal.x()) < 0.9 ? 0 : 1;
  Matrix32 axes;
  axes.col(0) = (Eigen::Vector3d::Unit(along) - normal[along] * normal).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

Matrix36 directors(const Matrix36& X) {
  Matrix36 D;
  for (int a = 0; a < ShellTables::nodes; ++a) {
    const Matrix32 t = X * matrix(shell_tables().node[static_cast<std::size_t>(a)]);
    D.col(a) = t.col(0).cross(t.col(1)).normalized();
  }
  return D;
}

ShellBlock::ShellBlock(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                       const ShellSection& section, std::vector<std::vector<int>> electrodes,
                       std::vector<int> numbers)
    : prestretch_(section.prestretch), drilling_(section.drilling), count_(cells.size()), nodes_(cells.nodes),
      numbers_(std::move(numbers)), reference_(mesh.nodes) {
  const int packs = (count_ + lanes - 1) / lanes;
  for (int e = count_; e < packs * lanes; ++e)
    for (int a = 0; a < Nodes; ++a) nodes_.push_back(node(count_ - 1, a));
  section.for_each_layer([&](const ShellLayer& layer, double middle) {
    const double H = section.depth_of(layer);
    std::vector<int>& over = electrodes[layers_.size()];
    over.resize(static_cast<std::size_t>(packs * lanes), over.back());
    const bool charged = std::ranges::any_of(over, [](int electrode) { return electrode != passive; });
    layers_.push_back({FilmLayer(layer), layer.thickness, H, middle - section.offset,
                       section.extra_stretch(layer), layer.number, std::move(over), charged});
    shear_.add_layer(layer.material, H, section.extra_stretch(layer));
    height_ += H;
  });
  lever_ = section.offset / (prestretch_[0] * prestretch_[1]);
  geometry_.assign(static_cast<std::size_t>(packs * points), ShellPoint{});
  areas_.assign(static_cast<std::size_t>(packs), Lanes{});
  for (int e = 0; e < packs * lanes; ++e) place_element(e);
}

void ShellBlock::place_element(int element) {
  const int pack = element / lanes, lane = element % lanes;
  const Matrix36 X = drawn(element), D = directors(X), at = X + lever_ * D; // of the strains
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument("triangle " + std::to_string(numbers_[static_cast<std::size_t>(element)]) +
                                what);
  };
  const Eigen::Vector3d corner = at.col(0);
  const double slenderness = std::sqrt((X.col(1) - X.col(0)).cross(X.col(2) - X.col(0)).norm()) / height_,
               stiffness = std::min(1.0, std::pow(slenderest / slenderness, 2)); // see make_shell_block()
  for (int p = 0; p < points; ++p) {
    const ShellTables::Point& table = shell_tables().point[static_cast<std::size_t>(p)];
    ShellPoint& place = geometry_[static_cast<std::size_t>(pack * points + p)];
    const Matrix32 t = X * matrix(table.gradient), T = axes(t);
    const Eigen::Matrix2d jacobian = T.transpose() * t;
    const double det = jacobian.determinant();
    if (!(det > 0)) fail(" is inverted or degenerate as drawn");
    const bool flat = std::abs(T(2, 0)) + std::abs(T(2, 1)) < 1e-9;
    if (flat && T(1, 1) < 0) fail(" is inverted as drawn");
    if (!flat && is_prestretched()) fail(": a prestretched shell must be drawn parallel to the xy plane");
    const Eigen::Matrix2d G =
        jacobian.inverse() * Eigen::Vector2d(prestretch_[0], prestretch_[1]).asDiagonal(); // r, s per metre
    Eigen::Matrix3d map;
    map << G(0, 0) * G(0, 0), G(1, 0) * G(1, 0), 2 * G(0, 0) * G(1, 0), //
        G(0, 1) * G(0, 1), G(1, 1) * G(1, 1), 2 * G(0, 1) * G(1, 1),    //
        G(0, 0) * G(0, 1), G(1, 0) * G(1, 1), G(0, 0) * G(1, 1) + G(1, 0) * G(0, 1);
    Eigen::Vector3d metric, curvature;
    const Matrix32 d = D * matrix(table.gradient), along = at * matrix(table.gradient);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (int a = 0; a < Nodes; ++a)
        for (int b = 0; b < Nodes; ++b)
          sum += table.metric[c][static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] *
                 (at.col(a) - corner).dot(at.col(b) - corner);
      metric[static_cast<Eigen::Index>(c)] = sum;
    }
    curvature << along.col(0).dot(d.col(0)), along.col(1).dot(d.col(1)),
        (along.col(0).dot(d.col(1)) + along.col(1).dot(d.col(0))) / 2;
    const Eigen::Vector3d unity(prestretch_[0] * prestretch_[0], prestretch_[1] * prestretch_[1], 0),
        a0 = unity - map * metric, b0 = -map * curvature;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) place.T[i][j][lane] = map(i, j);
      place.a[i][lane] = a0[i];
      place.b[i][lane] = b0[i];
      for (int axis = 0; axis < 2; ++axis)
        place.shear[axis][i][lane] = stiffness * G(i % 2, axis) * G(i < 2 ? i : 1, axis);
    }
    for (std::size_t c = 0; c < 2; ++c) {
      double sum = 0;
      for (int a = 0; a < Nodes; ++a)
        for (int b = 0; b < Nodes; ++b)
          sum += table.shear[c][static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] *
                 (at.col(a) - corner).dot(D.col(b));
      place.gamma[c][lane] = sum;
    }
    place.area[lane] = element < count_ ? table.weight * det / (prestretch_[0] * prestretch_[1]) : 0.0;
    areas_[static_cast<std::size_t>(pack)][lane] += place.area[lane];
  }
}

void ShellBlock::claim_dofs(DofMap& dof_map, Dimension /*only space will do*/) {
  for (int e = 0; e < count_; ++e) {
    const Matrix36 D = directors(drawn(e));
    for (int a = 0; a < Nodes; ++a) {
      for (int c = 0; c < 3; ++c) dof_map.add(node(e, a), c);
      dof_map.add_director(node(e, a), D.col(a));
    }
  }
  tilt_axes_ = dof_map.tilt_axes();
}

/// In the order of ShellSum.
void ShellBlock::element_equations(int element, const DofMap& dof_map, std::span<int> equations) const {
  using Sum = ShellSum<true, 3>;
  const auto at = [&](int place) -> int& { return equations[static_cast<std::size_t>(place)]; };
  if (dof_map.tilt_axes() != tilt_axes_) throw std::logic_error("a shell asks for unknowns of another model");
  for (int a = 0; a < Nodes; ++a) {
    const int n = node(element, a);
    for (int c = 0; c < 3; ++c) at(Sum::moved(a, c)) = dof_map.equation(n, c);
    for (int k = 0; k < 3; ++k)
      at(Sum::spun(a, k)) = !dof_map.tilts(n) ? dof_map.equation(n, 3 + k)
                            : k < 2           ? dof_map.equation(n, DofMap::tilt + k)
                                              : DofMap::absent;
  }
}

ShellNodes ShellBlock::gather(const State& state, int pack) const {
  ShellNodes nodes;
  const auto axes_of = [&](int n) -> const TiltAxes& { return (*tilt_axes_)[static_cast<std::size_t>(n)]; };
  const auto first = nodes_.begin() + pack * lanes * Nodes;
  nodes.tilt = std::all_of(first, first + lanes * Nodes, [&](int n) { return !axes_of(n).isZero(0); });
  for (int l = 0; l < lanes; ++l) {
    const int element = pack * lanes + l;
    const auto corner = static_cast<std::size_t>(node(element, 0));
    for (int a = 0; a < Nodes; ++a) {
      const auto n = static_cast<std::size_t>(node(element, a));
      const Eigen::Vector3d x =
          reference_[n] - reference_[corner] + (state.displacement[n] - state.displacement[corner]);
      for (int c = 0; c < 3; ++c) nodes.x[a][c][l] = x[c];
    }
  }
  std::array<Matrix36, lanes> middle; // as drawn, where nodes may have three spins
  for (int l = 0; l < lanes && lever_ != 0 && !nodes.tilt; ++l) {
    const Matrix36 X = drawn(pack * lanes + l);
    middle[static_cast<std::size_t>(l)] = X + lever_ * directors(X);
  }
  for (int a = 0; a < Nodes; ++a) {
    Lanes q[4], A[2][3], R[3][3];
    for (int l = 0; l < lanes; ++l) {
      const int n = node(pack * lanes + l, a);
      for (int i = 0; i < 4; ++i) q[i][l] = state.rotation[static_cast<std::size_t>(n)].coeffs()[i];
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 2; ++k) A[k][c][l] = axes_of(n)(c, k);
    }
    rotation_matrix(q, R);
    for (int k = 0; k < 2; ++k) times(R, A[k], nodes.axis[a][k]);
    cross(nodes.axis[a][0], nodes.axis[a][1], nodes.d[a]);
    for (int c = 0; c < 3; ++c) nodes.axis[a][2][c] = Lanes{};
    if (!nodes.tilt) turn(pack, a, R, middle, nodes);
  }
  nodes.lever = lever_;
  for (int a = Nodes - 1; lever_ != 0 && a >= 0; --a)
    for (int c = 0; c < 3; ++c) nodes.x[a][c] += lever_ * (nodes.d[a][c] - nodes.d[0][c]);
  multiply_nodes(nodes);
  return nodes;
}

/// What else there is of nodes that may have three spins.
void ShellBlock::turn(int pack, int a, const Lanes (&R)[3][3], std::span<const Matrix36> middle,
                      ShellNodes& nodes) const {
  const auto& gradient = shell_tables().node[static_cast<std::size_t>(a)];
  Lanes drawn[2][3], normal[3];
  const auto turn_tangents = [&](const auto& surface) {
    for (int l = 0; l < lanes; ++l) {
      const Matrix32 t = surface(l) * matrix(gradient);
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 2; ++i) drawn[i][c][l] = t(c, i);
    }
    for (int i = 0; i < 2; ++i) times(R, drawn[i], nodes.along[i][a]);
    cross(nodes.along[0][a], nodes.along[1][a], normal);
    return Lanes(1.0 / materials::sqrt(dot(normal, normal)));
  };
  const Lanes per_area = turn_tangents([&](int l) { return this->drawn(pack * lanes + l); });
  for (int l = 0; l < lanes; ++l) {
    const bool tilts = !(*tilt_axes_)[static_cast<std::size_t>(node(pack * lanes + l, a))].isZero(0);
    nodes.per_area[a][l] = tilts ? 0 : per_area[l];
    for (int c = 0; c < 3 && !tilts; ++c) {
      nodes.d[a][c][l] = normal[c][l] * per_area[l];
      for (int k = 0; k < 3; ++k) nodes.axis[a][k][c][l] = k == c ? 1 : 0;
    }
  }
  if (lever_ != 0) {
    const Lanes at_lever = turn_tangents([&](int l) { return middle[static_cast<std::size_t>(l)]; });
    for (int l = 0; l < lanes; ++l)
      if (nodes.per_area[a][l] != 0) nodes.per_area[a][l] = at_lever[l];
  }
}

Lanes ShellBlock::electric_modulus(const State& state, const Layer& layer, int pack) const {
  Lanes k{};
  for (int l = 0; l < lanes; ++l) {
    const int electrode = layer.electrodes[static_cast<std::size_t>(pack * lanes + l)];
    if (electrode == passive) continue;
    const double nominal_field = state.voltage[static_cast<std::size_t>(electrode)] / layer.thickness;
    k[l] = layer.film.dielectric().permittivity * nominal_field * nominal_field;
  }
  return k;
}

template<bool with_tangent, int axes>
bool ShellBlock::evaluate_pack(const State& state, int pack, const ShellNodes& nodes, const Scatter& scatter,
                               Lanes& energy) const {
  bool feasible = true;
  ShellSum<with_tangent, axes> sum(nodes);
  for (int p = 0; p < points; ++p) {
    const ShellTables::Point& table = shell_tables().point[static_cast<std::size_t>(p)];
    const ShellPoint& here = point(pack, p);
    const ShellDeformation f = deformation(table, nodes);
    const ShellStrain strain = fem::strain(point(pack, p), f);
    const Lanes det = strain.a.det();
    SectionPotential section(strain);
    for (const Layer& layer : layers_) {
      const bool couples = with_tangent && layer.charged;
      SectionPotential elastance(strain); // int 1/r dZ, see across()
      across(state, layer, pack, p, strain, [&](const Place& place) {
        const Lanes within = place.C.det();
        for (int l = 0; l < lanes; ++l)
          if (!(within[l] > 0)) feasible = false;
        auto psi = layer.film.potential(state, place.point, lanes_of(pack), place.C, place.k);
        if (couples) {
          const auto r = layer.film.capacitance_ratio(place.C);
          add_square(psi, place.k / r.value, r);
          elastance.add(place.Z, Lanes{} + place.weight, layer.in_section(reciprocal(r)));
        }
        section.add(place.Z, Lanes{} + place.weight, layer.in_section(psi));
      });
      if (!couples) continue;
      const Lanes whole = elastance.value() / layer.depth;
      section.add_square(-electric_modulus(state, layer, pack) / (layer.depth * whole * whole * whole),
                         elastance.derivatives<false>());
    }
    for (int l = 0; l < lanes; ++l)
      if (!(f.normal[l] > 0 && det[l] > 0)) feasible = false;
    ShellStress stress = ShellStress::of<with_tangent>(here, section.derivatives<with_tangent>());
    energy += here.area * section.value() +
              shear_.evaluate(state, surface_points(pack, p), lanes_of(pack), here, f, stress);
    sum.add(table, f, stress);
  }
  if constexpr (axes == 3) energy += sum.add_drilling(drilling_stiffness(pack));
  sum.finish();
  scatter_pack(pack, sum, scatter);
  return feasible;
}

template<bool with_tangent>
Evaluation ShellBlock::evaluate_packs(const State& state, int first, int last, const Scatter& scatter) const {
  Evaluation result;
  Lanes energy{};
  for (int pack = first / lanes; pack * lanes < last; ++pack) {
    const ShellNodes nodes = gather(state, pack);
    const bool feasible = nodes.tilt ? evaluate_pack<with_tangent, 2>(state, pack, nodes, scatter, energy)
                                     : evaluate_pack<with_tangent, 3>(state, pack, nodes, scatter, energy);
    result.feasible = result.feasible && feasible;
  }
  for (int l = 0; l < lanes; ++l) result.energy += energy[l];
  if (!std::isfinite(result.energy)) result.feasible = false; // beyond a stretch limit
  return result;
}

Evaluation ShellBlock::evaluate(const State& state, int first, int last, const Scatter& scatter) const {
  return scatter.tangent ? evaluate_packs<true>(state, first, last, scatter)
                         : evaluate_packs<false>(state, first, last, scatter);
}

std::unique_ptr<ElementBlock> make_shell_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                               const ShellSection& section,
                                               std::vector<std::vector<int>> electrodes,
                                               std::vector<int> numbers) {
  if (cells.type != meshing::CellType::triangle6 || cells.size() == 0)
    throw std::invalid_argument("a shell is made of 6-node triangles (gmsh -order 2)");
  if (section.layers.empty() || electrodes.size() != section.layers.size())
    throw std::invalid_argument("a shell needs layers, and the electrodes of each");
  for (const auto& layer : electrodes)
    if (static_cast<int>(layer.size()) != cells.size())
      throw std::invalid_argument("a layer of a shell needs one electrode number for each element");
  if (numbers.empty()) {
    numbers.resize(static_cast<std::size_t>(cells.size()));
    std::iota(numbers.begin(), numbers.end(), 0);
  }
  return std::make_unique<ShellBlock>(mesh, cells, section, std::move(electrodes), std::move(numbers));
}

} // namespace dielast::fem
