// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face_contact_block.hpp"

#include "fem/contact/face.hpp"
#include "fem/contact/face_gap.hpp"
#include "fem/contact/face_motion.hpp"
#include "fem/contact/surface_ends.hpp"
#include "fem/contact/two_surfaces.hpp"
#include "fem/films/triangle.hpp"

#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace dielast::fem {

namespace {

using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

constexpr int dofs = 36;       ///< of a face's nodes, then of the other surface's face
constexpr double margin = 0.3; ///< of the finer faces' size, up to which pairs are elements
constexpr double closest =
    1e-3;                      ///< of the barrier's thickness: nearer faces are not told from ones that cross
constexpr double nearly = 0.1; ///< of it: how near edges are that meet
constexpr int few_tests = 100; ///< that are cheaper than looking at points
constexpr double ramp_sizes = 0.5; ///< of the coarser surface's faces: so far from an end both count

const std::vector<FacePoint>& rule = face_rule();

using Tree = Eigen::KdBVH<double, 3, int>;
Tree tree_of(const std::vector<Box>& boxes) {
  std::vector<int> numbers(boxes.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return {numbers.begin(), numbers.end(), boxes.begin(), boxes.end()};
}

/// The face of a tree that is nearest to a point.
struct NearestFace {
  using Scalar = double;
  Vector3d point;
  const std::vector<FaceNodes>& faces;
  FacePlace place;
  int face;
  double minimumOnVolume(const Box& volume) const { return volume.exteriorDistance(point); }
  double minimumOnObject(int number) {
    const FacePlace at = nearest_place(faces[static_cast<std::size_t>(number)], {}, point);
    if (face < 0 || at.distance < place.distance) {
      place = at;
      face = number;
    }
    return at.distance;
  }
};

/// Numbers of the boxes of a tree that meet another one.
struct Meeting {
  const Box& box;
  const std::vector<Box>& boxes;
  std::vector<int> found;
  bool intersectVolume(const Box& volume) const { return volume.intersects(box); }
  bool intersectObject(int number) {
    if (boxes[static_cast<std::size_t>(number)].intersects(box)) found.push_back(number);
    return false;
  }
};

class FaceContactBlock final : public TwoSurfaces<FaceContact, 6, FaceNodes> {
 public:
  FaceContactBlock(const meshing::Mesh& mesh, FaceContact contact)
      : TwoSurfaces(mesh, std::move(contact), rule.size()) {
    std::array<double, 2> mean{};
    for (std::size_t k = 0; k < 2; ++k) {
      const meshing::CellBlock& faces = contact_.surfaces[k];
      if (faces.type != meshing::CellType::triangle6)
        throw std::invalid_argument("surfaces in contact in space are made of 6-node triangles");
      add_areas(k);
      parts_[k] = parts_beside(faces);
      mean[k] = std::accumulate(areas_[k].begin(), areas_[k].end(), 0.0) / faces.size();
    }
    require_apart(contact_.surfaces[0], contact_.surfaces[1]);
    share_ = {mean[1] / (mean[0] + mean[1]), mean[0] / (mean[0] + mean[1])};
    margin_ = margin * std::sqrt(std::min(mean[0], mean[1]));
    const double over = ramp_sizes * std::sqrt(2 * std::max(mean[0], mean[1]));
    for (std::size_t k = 0; k < 2; ++k)
      ends_[k] = FaceEnds(contact_.surfaces[k], drawn_, contact_.mirrored, over);
    std::vector<double> areas(drawn_.size(), 0);
    for_each_point([&](const Pair& pair, std::size_t q) {
      share(pair, q, share_[pair.surface] * area(pair, q), areas);
    });
    sliders_ = Sliders(contact_.friction, contact_.barrier, contact_.surfaces, areas, drawn_);
    FaceContactBlock::choose_elements(as_drawn());
  }

  int element_count() const override { return static_cast<int>(pairs_.size()); }
  int dofs_per_element() const override { return dofs; }
  void element_equations(int element, const DofMap& map, std::span<int> equations) const override {
    const Pair& pair = pairs_[static_cast<std::size_t>(element)];
    std::size_t at = 0;
    for (std::size_t k = 0; k < 2; ++k)
      for (const int node : nodes(pair, k))
        for (int i = 0; i < 3; ++i) equations[at++] = map.equation(node, i);
  }
  std::size_t choose_elements(const State& state) override {
    const auto for_each_rubbing = [&](const auto& use) {
      if (sliders_.any() && state.history)
        sliders_.for_each_pair(*state.history, [&](std::size_t surface, int own, int other) {
          use(Pair{surface, own, other});
        });
    };
    bool are_elements = true;
    for_each_rubbing(
        [&](const Pair& pair) { are_elements = are_elements && std::ranges::binary_search(pairs_, pair); });
    if (choice_ > 0 && are_elements && covers(state)) return choice_;
    chosen_ = moved(state);
    std::vector<Pair> pairs = meeting(chosen_, chosen_, contact_.barrier.thickness + margin_);
    if (sliders_.any()) {
      for_each_rubbing([&](const Pair& pair) { pairs.push_back(pair); });
      std::ranges::sort(pairs);
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }
    if (choice_ == 0 || pairs != pairs_) {
      pairs_ = std::move(pairs);
      ++choice_;
    }
    return choice_;
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    if (first == 0 && !covers(state))
      throw std::logic_error("a contact's elements are those of another state");
    Evaluation result;
    for (int e = first; e < last; ++e) {
      const Pair& pair = pairs_[static_cast<std::size_t>(e)];
      const FaceNodes own = face(state, nodes(pair, 0)), other = face(state, nodes(pair, 1));
      Sums sums;
      for_each_near(pair, own, other, [&](std::size_t q, const FacePlace& place, double factor) {
        add(pair, q, other, place, factor, scatter, sums);
      });
      sliders_.add(state, pair.surface, pair.own, pair.other, scatter.residual || scatter.tangent, sums);
      sums.add_to(result, e, scatter);
    }
    return result;
  }
  double free_way(const State& from, const State& to) const override {
    const Moved before = moved(from), after = moved(to);
    const double thickness = contact_.barrier.thickness;
    double part = 1;
    for (const Pair& pair : meeting(before, after, 0)) {
      if (pair.surface == 1) continue; // both at once
      const MovingFace one = moving(before.of(pair, 0), after.of(pair, 0)),
                       other = moving(before.of(pair, 1), after.of(pair, 1));
      if (way_apart(one, other, Barrier::kept * thickness, part, few_tests) == part) continue;
      part = way_of_points(before.of(pair, 0), after.of(pair, 0), before.of(pair, 1), after.of(pair, 1),
                           Barrier::kept, part);
      part = way_of_points(before.of(pair, 1), after.of(pair, 1), before.of(pair, 0), after.of(pair, 0),
                           Barrier::kept, part);
      if (const double apart = way_apart(one, other, closest * thickness, part); apart < part)
        part = (1 - Barrier::kept) * apart;
    }
    return part;
  }
  bool edges_meet(const State& state) const override {
    const Moved now = moved(state);
    const double close = nearly * contact_.barrier.thickness;
    return std::ranges::any_of(meeting(now, now, close), [&](const Pair& pair) {
      const FaceNodes &own = now.of(pair, 0), &other = now.of(pair, 1);
      return pair.surface == 0 && way_apart(moving(own, own), moving(other, other), close, 1) < 1 &&
             std::min(gap_of_points(own, other), gap_of_points(other, own)) > 2 * close;
    });
  }

 private:
  using Sums = ContactSums<dofs>;
  FaceNodes face(const State& state, std::span<const int> own) const override {
    FaceNodes x;
    for (std::size_t a = 0; a < 6; ++a) x.col(static_cast<int>(a)) = position(state, own[a]);
    return x;
  }
  /// Whether what may touch in a state is among the elements.
  bool covers(const State& state) const {
    double way = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      double farthest = 0;
      for (int i = 0; i < contact_.surfaces[k].size(); ++i)
        farthest = std::max(farthest, way_of(chosen_.faces[k][static_cast<std::size_t>(i)],
                                             face(state, contact_.surfaces[k].cell(i))));
      way += farthest;
    }
    return way <= margin_;
  }
  /// Pairs of which boxes about the ways between two states are nearer than `reach`.
  std::vector<Pair> meeting(const Moved& from, const Moved& to, double reach) const {
    std::array<std::vector<Box>, 2> boxes;
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t i = 0; i < from.faces[k].size(); ++i) {
        Box box = box_of(from.faces[k][i]).merged(box_of(to.faces[k][i]));
        const Vector3d wider = Vector3d::Constant(reach / 2);
        boxes[k].emplace_back(box.min() - wider, box.max() + wider);
      }
    const Tree tree = tree_of(boxes[1]);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < boxes[0].size(); ++i) {
      Meeting touching{boxes[0][i], boxes[1], {}};
      Eigen::BVIntersect(tree, touching);
      for (const int j : touching.found) {
        pairs.push_back({0, static_cast<int>(i), j});
        pairs.push_back({1, j, static_cast<int>(i)});
      }
    }
    std::ranges::sort(pairs);
    return pairs;
  }
  /// use(point, place, how often) for all that the other face and its edges and corners may push.
  template<class Use>
  void for_each_near(const Pair& pair, const FaceNodes& own, const FaceNodes& other, const Use& use) const {
    const double reach = contact_.barrier.reach();
    const Box box = box_of(other);
    if (box_of(own).exteriorDistance(box) > reach) return;
    for (std::size_t q = 0; q < rule.size(); ++q) {
      const Vector3d x = own * rule[q].shape;
      if (box.exteriorDistance(x) > reach) continue;
      const FacePlace whole = nearest_place(other, {}, x);
      if (!contact_.barrier.touches(whole.distance)) continue;
      use(q, whole, 1);
      for (const auto& [part, factor] : parts_[1 - pair.surface][static_cast<std::size_t>(pair.other)])
        if (const FacePlace place = nearest_place(other, part, x); contact_.barrier.touches(place.distance))
          use(q, place, factor);
    }
  }
  void for_each_touching(
      const State& state,
      const std::function<void(const Pair&, std::size_t, const Touching&)>& use) const override {
    const Moved now = moved(state);
    for (const Pair& pair : meeting(now, now, contact_.barrier.reach()))
      for_each_near(pair, now.of(pair, 0), now.of(pair, 1),
                    [&](std::size_t q, const FacePlace& place, double factor) {
                      const BarrierEnergy energy = contact_.barrier.at(place.distance);
                      use(pair, q,
                          Touching{{factor * energy.value, factor * energy.slope},
                                   place.normal,
                                   factor,
                                   share_at(pair, q, place).value});
                    });
  }
  std::vector<Sliders::Nearest> nearest(const State& state) const override {
    std::vector<Sliders::Nearest> all(static_cast<std::size_t>(sliders_.count()));
    const Moved now = moved(state);
    std::array<std::vector<Box>, 2> boxes;
    std::array<Tree, 2> trees;
    for (std::size_t k = 0; k < 2; ++k) {
      for (const FaceNodes& face : now.faces[k]) boxes[k].push_back(box_of(face));
      trees[k] = tree_of(boxes[k]);
    }
    for (int i = 0; i < sliders_.count(); ++i) {
      const std::size_t other = 1 - sliders_.surface(i);
      NearestFace search{position(state, sliders_.node(i)), now.faces[other], {}, Sliders::none};
      Eigen::BVMinimize(trees[other], search);
      all[static_cast<std::size_t>(i)] = {search.place.distance, search.face, search.place.shape,
                                          search.place.normal};
    }
    return all;
  }
  void add(const Pair& pair, std::size_t q, const FaceNodes& other, const FacePlace& place, double factor,
           const Scatter& scatter, Sums& sums) const {
    if (!(place.distance > 0)) {
      sums.feasible = false;
      return;
    }
    add_pressed(rule[q].shape, other, place, other_end(pair), factor * area(pair, q),
                contact_.barrier.at(place.distance), share_at(pair, q, place), scatter, sums);
  }
  const Eigen::Vector<double, 6>& other_end(const Pair& pair) const {
    return ends_[1 - pair.surface].at(pair.other);
  }
  /// The part of the integral of a point's surface, with its derivatives by what other_end() is at the place.
  Ramp share_at(const Pair& pair, std::size_t q, const FacePlace& place) const {
    const double own = end_ramp(rule[q].shape.dot(ends_[pair.surface].at(pair.own))).value;
    return shared(share_[pair.surface], own, share_[1 - pair.surface],
                  end_ramp(place.shape.dot(other_end(pair))));
  }
  double part_of_node(int node, std::size_t q) const override { return rule[q].share[node]; }
  void add_areas(std::size_t k) {
    const State drawn = as_drawn();
    for (int i = 0; i < contact_.surfaces[k].size(); ++i)
      for (const FacePoint& at : rule) {
        const Eigen::Matrix<double, 3, 2> slope =
            face(drawn, contact_.surfaces[k].cell(i)) * shape_gradients<6>(at.xi, at.eta);
        areas_[k].push_back(at.weight * slope.col(0).cross(slope.col(1)).norm());
      }
  }

  std::array<std::vector<std::vector<CountedPart>>, 2> parts_; ///< of the faces, besides themselves
  std::array<FaceEnds, 2> ends_;
  double margin_ = 0;       ///< m
  std::vector<Pair> pairs_; ///< the elements
  Moved chosen_;            ///< the state that they were chosen for
  std::size_t choice_ = 0;
};

} // namespace

std::unique_ptr<ContactBlock> make_face_contact_block(const meshing::Mesh& mesh, FaceContact contact) {
  return std::make_unique<FaceContactBlock>(mesh, std::move(contact));
}

} // namespace dielast::fem
