// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/plane_contact_block.hpp"

#include "fem/contact/slider.hpp"
#include "fem/elements/lower_triangle.hpp"
#include "fem/films/triangle.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

namespace dielast::fem {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int size = 3;
constexpr double least_share =
    1e-3; ///< of a side or face: on the axis and at corners the rule has none, and the barrier must hold

class PlaneContactBlock final : public ContactBlock {
 public:
  PlaneContactBlock(const meshing::Mesh& mesh, PlaneContact contact)
      : contact_(std::move(contact)),
        along_(Matrix3d::Identity() - contact_.normal * contact_.normal.transpose()) {
    for (const int node : contact_.nodes) drawn_.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    for (int e = 0; e < element_count(); ++e) like_.push_back(e);
    const auto element = [&](int node) {
      return static_cast<std::size_t>(std::ranges::lower_bound(contact_.nodes, node) -
                                      contact_.nodes.begin());
    };
    for (const auto& [node, other] : contact_.kept) like_[element(node)] = static_cast<int>(element(other));
    for (std::array<int, 2>& pair : contact_.corners)
      for (int& node : pair) node = static_cast<int>(element(node));
  }

  int element_count() const override { return static_cast<int>(contact_.nodes.size()); }
  int dofs_per_element() const override { return size; }
  void claim_dofs(DofMap& /*those of the surface*/, Dimension /*dimension*/) override {}
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    for (int i = 0; i < size; ++i) equations[static_cast<std::size_t>(i)] = dofs.equation(node(element), i);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Evaluation result;
    for (int e = first; e < last; ++e) {
      const double gap = this->gap(state, e);
      if (!(gap > 0)) {
        result.feasible = false;
        continue;
      }
      const BarrierEnergy barrier = contact_.barrier.at(gap);
      const Slider::Response slider =
          friction() ? this->slider(state, e).pulled(stretched(state, e), along_) : Slider::Response{};
      result.energy += area(e) * barrier.value + slider.energy;
      if (scatter.residual) {
        const Vector3d force = area(e) * barrier.slope * contact_.normal + slider.force;
        scatter.add_residual(e, std::span(force.data(), size));
      }
      if (scatter.tangent)
        scatter.add_tangent(e, lower_triangle<size>(Matrix3d(area(e) * barrier.curvature * contact_.normal *
                                                                 contact_.normal.transpose() +
                                                             slider.tangent)));
    }
    return result;
  }
  double free_way(const State& from, const State& to) const override {
    double part = 1;
    for (int e = 0; e < element_count(); ++e) {
      const double before = gap(from, e), after = gap(to, e);
      if (after < Barrier::kept * before)
        part = std::min(part, (1 - Barrier::kept) * before / (before - after));
    }
    return part;
  }
  double contact_force(const State& state) const override {
    double sum = 0;
    for (int e = 0; e < element_count(); ++e) sum += pressing(state, e);
    return sum;
  }
  bool is_between(std::string_view place) const override { return place == contact_.place; }
  void add_pressure(const State& state, NodalPressure& pressure) const override {
    const auto add = [&](int e, double part, int from) {
      pressure.force[static_cast<std::size_t>(node(e))] += part * pressing(state, from);
      pressure.area[static_cast<std::size_t>(node(e))] += part * area(from);
    };
    for (int e = 0; e < element_count(); ++e) add(e, 1, e);
    for (const auto& [corner, midside] : contact_.corners) add(corner, 0.5, midside);
  }
  bool has_friction() const override { return friction(); }
  bool is_pressed_first(const State& state) const override {
    return friction() &&
           fem::is_pressed_first(
               element_count(), [&](int e) { return state.history->now[place(e, normal)]; },
               [&](int e) { return normal_force(state, e); }, [&](int e) { return force_unit(e); });
  }
  void bound_friction(const State& state, bool solved, double eased,
                      std::vector<double>& all) const override {
    if (!friction()) return;
    bound_sliders(
        element_count(), [&](int e) -> double& { return all[place(e, normal)]; },
        [&](int e) { return eased * normal_force(state, e) / force_unit(e); }, solved);
  }
  double friction_in_use(const State& state) const override {
    double held = 0, most = 0;
    bool touches = false;
    for (int e = 0; e < element_count() && friction(); ++e) {
      held += stiffness(e) * stretched(state, e).norm();
      most += contact_.friction * normal_force(state, e);
      touches = touches || state.history->now[place(e, normal)] > 0;
    }
    return most > 0 ? held / most : touches ? 1 : 0;
  }
  double friction_heat(const State& state) const override {
    double sum = 0;
    for (int e = 0; e < element_count() && friction(); ++e)
      sum += state.history->now[place(e, heat)] * energy_unit(e);
    return sum;
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_energies(const State& state, EnergyParts& parts) const override {
    for (int e = 0; e < element_count(); ++e) {
      parts.elastic += area(e) * contact_.barrier.at(gap(state, e)).value;
      if (friction()) parts.elastic += stiffness(e) * stretched(state, e).squaredNorm() / 2;
    }
  }
  int history_size() const override { return friction() ? element_count() * per_node : 0; }
  void place_history(int first) override { first_ = first; }
  void start_history(std::vector<double>& all) const override {
    if (!friction()) return;
    for (int e = 0; e < element_count(); ++e) {
      for (int i = 0; i < per_node; ++i) all[place(e, i)] = 0;
      const double gap = (drawn_[static_cast<std::size_t>(e)] - contact_.origin).dot(contact_.normal);
      if (contact_.barrier.touches(gap)) all[place(e, normal)] = Slider::light;
    }
  }
  void advance_history(const State& state, std::vector<double>& all) const override {
    if (!friction()) return;
    for (int e = 0; e < element_count(); ++e) {
      const double now = normal_force(state, e);
      const Vector3d stretched = this->stretched(state, e),
                     kept = slider(state, e).kept(stretched, along_, contact_.friction * now),
                     slid = stretched - kept / stiffness(e);
      for (int i = 0; i < size; ++i) all[place(e, i)] += slid[i] / length_unit();
      double& then = all[place(e, pressed_then)];
      all[place(e, heat)] +=
          Slider::heat_of(then, state.history->now[place(e, normal)]) * kept.dot(slid) / energy_unit(e);
      then = now / force_unit(e);
      all[place(e, normal)] = std::max(then, contact_.barrier.touches(gap(state, e)) ? Slider::light : 0.0);
    }
  }

 private:
  /// Internal variables of a node: the anchor's displacement over length_unit(), the normal force that bounds
  /// it, the heat, and the normal force of the last accepted state likewise.
  static constexpr int normal = 3, heat = 4, pressed_then = 5, per_node = 6;
  bool friction() const { return contact_.friction > 0; }
  int node(int element) const { return contact_.nodes[static_cast<std::size_t>(element)]; }
  double area(int element) const { return contact_.areas[static_cast<std::size_t>(element)]; }
  double stiffness(int element) const { return Slider::stick * contact_.barrier.stiffness * area(element); }
  double length_unit() const { return contact_.barrier.thickness; }
  double energy_unit(int element) const {
    return contact_.barrier.stiffness * area(element) * length_unit() * length_unit();
  }
  double force_unit(int element) const { return energy_unit(element) / length_unit(); }
  std::size_t place(int element, int variable) const {
    return static_cast<std::size_t>(first_ + element * per_node + variable);
  }
  const Vector3d& displacement(const State& state, int element) const {
    return state.displacement[static_cast<std::size_t>(node(element))];
  }
  double gap(const State& state, int element) const {
    return (drawn_[static_cast<std::size_t>(element)] + displacement(state, element) - contact_.origin)
        .dot(contact_.normal);
  }
  double normal_force(const State& state, int element) const {
    return -area(element) * contact_.barrier.at(gap(state, element)).slope;
  }
  /// Also where something else takes a part of it up.
  double pressing(const State& state, int element) const {
    const int like = like_[static_cast<std::size_t>(element)];
    return area(element) / area(like) * normal_force(state, like);
  }
  /// From its anchor, along the plane.
  Vector3d stretched(const State& state, int element) const {
    const std::vector<double>& now = state.history->now;
    const Vector3d anchor(now[place(element, 0)], now[place(element, 1)], now[place(element, 2)]);
    return along_ * displacement(state, element) - length_unit() * anchor;
  }
  Slider slider(const State& state, int element) const {
    const double force = state.history->now[place(element, normal)];
    return Slider::of(stiffness(element), contact_.friction, force, force_unit(element),
                      state.scheme.is_frozen());
  }

  PlaneContact contact_;
  Matrix3d along_; ///< projects on the plane
  std::vector<Vector3d> drawn_;
  std::vector<int> like_; ///< the element itself, or that which presses as it does (PlaneContact::kept)
  int first_ = 0;
};

PlaneContact of_nodes(const std::map<int, double>& areas) {
  PlaneContact surface;
  for (const auto& [node, area] : areas) {
    surface.nodes.push_back(node);
    surface.areas.push_back(area);
  }
  return surface;
}

} // namespace

PlaneContact surface_of(const meshing::Mesh& mesh, const meshing::CellBlock& sides,
                        std::optional<double> width) {
  const auto at = [&](int node) -> const Vector3d& { return mesh.nodes[static_cast<std::size_t>(node)]; };
  std::map<int, double> areas;
  std::vector<std::array<int, 2>> corners;
  for (int side = 0; side < sides.size(); ++side) {
    const auto own = sides.cell(side); // ends, and a middle
    const double length = (at(own[1]) - at(own[0])).norm();
    const auto across = [&](int node) { return width.value_or(2 * std::numbers::pi * at(node).x()); };
    const double end_share = own.size() == 3 ? 1.0 / 6 : 1.0 / 2,
                 mean = (across(own[0]) + across(own[1])) / 2;
    for (std::size_t i = 0; i < own.size(); ++i)
      areas[own[i]] += length * std::max((i == 2 ? 4.0 / 6 : end_share) * across(own[i]), least_share * mean);
    for (std::size_t end = 0; end < 2 && own.size() == 3; ++end)
      if (across(own[end]) < least_share * mean) corners.push_back({own[end], own[2]});
  }
  PlaneContact surface = of_nodes(areas);
  surface.corners = std::move(corners);
  return surface;
}

PlaneContact surface_of(const meshing::Mesh& mesh, const meshing::CellBlock& faces) {
  std::map<int, double> areas;
  std::set<std::array<int, 2>> corners;
  for (int face = 0; face < faces.size(); ++face) {
    const auto own = faces.cell(face);
    for (std::size_t side = 0; side < 3; ++side)
      for (const std::size_t corner : {side, (side + 1) % 3}) corners.insert({own[corner], own[3 + side]});
    Eigen::Matrix<double, 3, 6> x;
    for (int a = 0; a < 6; ++a)
      x.col(a) = mesh.nodes[static_cast<std::size_t>(own[static_cast<std::size_t>(a)])];
    Eigen::Vector<double, 6> share = Eigen::Vector<double, 6>::Zero();
    for (const TrianglePoint& at : triangle_rule(6)) {
      const Eigen::Matrix<double, 3, 2> slope = x * shape_gradients<6>(at.xi, at.eta);
      share += at.weight * slope.col(0).cross(slope.col(1)).norm() * shape_values<6>(at.xi, at.eta);
    }
    for (int a = 0; a < 6; ++a)
      areas[own[static_cast<std::size_t>(a)]] += std::max(share[a], least_share * share.sum() / 6);
  }
  PlaneContact surface = of_nodes(areas);
  surface.corners.assign(corners.begin(), corners.end());
  return surface;
}

std::unique_ptr<ElementBlock> make_plane_contact_block(const meshing::Mesh& mesh, PlaneContact contact) {
  return std::make_unique<PlaneContactBlock>(mesh, std::move(contact));
}

} // namespace dielast::fem
