// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/contact_sums.hpp"
#include "fem/contact/surface_sliders.hpp"
#include "fem/model/contact_block.hpp"
#include "meshing/mesh.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace dielast::fem {

/// What the contacts of two surfaces share: points on faces (or sides) of Nodes nodes that meet faces of the
/// other surface, and friction. `Contact`: FaceContact or SurfaceContact; `Shape`: a face in some state.
template<class Contact, int Nodes, class Shape>
class TwoSurfaces : public ContactBlock {
 public:
  void claim_dofs(DofMap& /*those of the solids*/, Dimension /*dimension*/) override {}
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  bool is_between(std::string_view place) const override {
    return std::ranges::find(contact_.places, place) != contact_.places.end();
  }
  double contact_force(const State& state) const override {
    double sum = 0;
    for_each_touching(state, [&](const Pair& pair, std::size_t q, const Touching& touching) {
      sum -= touching.share * area(pair, q) * touching.energy.slope;
    });
    return sum;
  }
  void add_pressure(const State& state, NodalPressure& pressure) const override {
    for_each_point([&](const Pair& pair, std::size_t q) { share(pair, q, area(pair, q), pressure.area); });
    for_each_touching(state, [&](const Pair& pair, std::size_t q, const Touching& touching) {
      // A point that counts little is held off by little: it may be very near.
      const double counts = std::min(1.0, touching.share / share_[pair.surface]);
      share(pair, q, -counts * area(pair, q) * touching.energy.slope, pressure.force);
      share(pair, q, (counts - 1) * touching.factor * area(pair, q), pressure.area);
    });
  }
  void add_energies(const State& state, EnergyParts& parts) const override {
    for_each_touching(state, [&](const Pair& pair, std::size_t q, const Touching& touching) {
      parts.elastic += touching.share * area(pair, q) * touching.energy.value;
    });
    parts.elastic += sliders_.energy(state);
  }
  bool has_friction() const override { return sliders_.any(); }
  bool is_pressed_first(const State& state) const override {
    return sliders_.any() && sliders_.is_pressed_first(*state.history, pressed(state));
  }
  void bound_friction(const State& state, bool solved, double eased,
                      std::vector<double>& all) const override {
    if (sliders_.any()) sliders_.bound(pressed(state), solved, eased, all);
  }
  double friction_in_use(const State& state) const override { return sliders_.in_use(state); }
  double friction_heat(const State& state) const override { return sliders_.heat(state); }
  int history_size() const override { return sliders_.history_size(); }
  void place_history(int first) override { sliders_.place_history(first); }
  void start_history(std::vector<double>& all) const override {
    if (sliders_.any()) sliders_.start(pressed(as_drawn()), nearest(as_drawn()), all);
  }
  void advance_history(const State& state, std::vector<double>& all) const override {
    if (sliders_.any()) sliders_.advance(state, pressed(state), nearest(state), all);
  }

 protected:
  using Sliders = SurfaceSliders<Nodes>;
  /// A face that is integrated, of the surface 0 or 1, and one of the other surface.
  struct Pair {
    std::size_t surface;
    int own, other;
    auto operator<=>(const Pair&) const = default;
  };
  /// All faces in a state.
  struct Moved {
    std::array<std::vector<Shape>, 2> faces;
    const Shape& of(const Pair& pair, std::size_t k) const {
      return faces[k == 0 ? pair.surface : 1 - pair.surface]
                  [static_cast<std::size_t>(k == 0 ? pair.own : pair.other)];
    }
  };

  /// What a point feels of a face or, where what faces have in common is taken off, of an edge.
  struct Touching {
    BarrierEnergy energy;   ///< as often as it counts
    Eigen::Vector3d normal; ///< unit vector towards the point
    double factor, share;   ///< how often; of this surface's integral there
  };

  /// `points`: at which a face is integrated.
  TwoSurfaces(const meshing::Mesh& mesh, Contact contact, std::size_t points)
      : contact_(std::move(contact)), drawn_(mesh.nodes), points_(points) {}

  virtual Shape face(const State& state, std::span<const int> nodes) const = 0;
  /// The part that a node of a face takes of what lies at a point: linear between neighbours.
  virtual double part_of_node(int node, std::size_t point) const = 0;
  /// use(pair, point, what it feels) for all that touches.
  virtual void
  for_each_touching(const State& state,
                    const std::function<void(const Pair&, std::size_t, const Touching&)>& use) const = 0;
  /// Of each slider's node.
  virtual std::vector<typename Sliders::Nearest> nearest(const State& state) const = 0;

  /// What presses each slider's node, N.
  typename Sliders::Forces pressed(const State& state) const {
    typename Sliders::Forces forces(static_cast<std::size_t>(sliders_.count()), Eigen::Vector3d::Zero());
    for_each_touching(state, [&](const Pair& pair, std::size_t q, const Touching& touching) {
      const double size = -touching.share * area(pair, q) * touching.energy.slope;
      for (int a = 0; a < Nodes; ++a)
        forces[static_cast<std::size_t>(sliders_.number(pair.surface, pair.own, a))] +=
            part_of_node(a, q) * size * touching.normal;
    });
    return forces;
  }

  /// Of the pair's own face, k = 0, or the other one.
  std::span<const int> nodes(const Pair& pair, std::size_t k) const {
    return k == 0 ? contact_.surfaces[pair.surface].cell(pair.own)
                  : contact_.surfaces[1 - pair.surface].cell(pair.other);
  }
  Moved moved(const State& state) const {
    Moved all;
    for (std::size_t k = 0; k < 2; ++k)
      for (int i = 0; i < contact_.surfaces[k].size(); ++i)
        all.faces[k].push_back(face(state, contact_.surfaces[k].cell(i)));
    return all;
  }
  Eigen::Vector3d position(const State& state, int node) const {
    const auto n = static_cast<std::size_t>(node);
    return drawn_[n] + state.displacement[n];
  }
  State as_drawn() const {
    State state;
    state.displacement.assign(drawn_.size(), Eigen::Vector3d::Zero());
    return state;
  }
  /// What a point of the pair's own face stands for, m^2.
  double area(const Pair& pair, std::size_t point) const {
    return areas_[pair.surface][static_cast<std::size_t>(pair.own) * points_ + point];
  }
  /// Adds what lies at a point to the nodes of the pair's own face.
  void share(const Pair& pair, std::size_t point, double amount, std::vector<double>& of_nodes) const {
    const auto own = nodes(pair, 0);
    for (int a = 0; a < Nodes; ++a)
      of_nodes[static_cast<std::size_t>(own[static_cast<std::size_t>(a)])] += part_of_node(a, point) * amount;
  }
  /// use(face with any other one, point) for all that are integrated.
  template<class Use>
  void for_each_point(const Use& use) const {
    for (std::size_t k = 0; k < 2; ++k)
      for (int i = 0; i < contact_.surfaces[k].size(); ++i)
        for (std::size_t q = 0; q < points_; ++q) use(Pair{k, i, 0}, q);
  }

  Contact contact_;
  std::vector<Eigen::Vector3d> drawn_;
  std::size_t points_;
  Sliders sliders_;
  std::array<double, 2> share_{};            ///< of the two integrals: the finer surface has the greater one
  std::array<std::vector<double>, 2> areas_; ///< of all points of the surfaces' faces
};

} // namespace dielast::fem
