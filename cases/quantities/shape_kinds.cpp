// SPDX-License-Identifier: GPL-3.0-or-later
// Where places are and how they lie to each other.
#include "cases/quantities/film_values.hpp"
#include "cases/quantities/positions.hpp"
#include "cases/quantities/probing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

namespace dielast::cases {
namespace {

double difference(double now, double then) { return now - then; }

/// Positive as drawn; negative when the places have passed each other.
Shape distance(const Probing& probing) {
  const auto between = [&device = probing.device, &quantity = probing.quantity](const fem::State& at) {
    return component(centroid(device, quantity.between[1], at) - centroid(device, quantity.between[0], at),
                     quantity.along);
  };
  const bool turned = between(probing.device.model.initial_state()) < 0;
  return [between, turned](const fem::State& at) { return turned ? -between(at) : between(at); };
}

/// A distance whose relative change is asked for: as drawn there is one.
Shape relative_distance(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const fem::State drawn = probing.device.model.initial_state();
  const Eigen::Vector3d apart = centroid(probing.device, quantity.between[1], drawn) -
                                centroid(probing.device, quantity.between[0], drawn);
  const double nothing = 1e-9 * probing.device.mesh.bounds().diagonal().norm();
  if (apart.norm() <= nothing)
    probing.refuse("between", "as drawn the two have one centroid: there is no length to compare with");
  if (std::abs(component(apart, quantity.along)) <= nothing)
    probing.refuse("along", "as drawn the two lie across this axis: there is no length to compare with");
  return distance(probing);
}

Shape size(const Probing& probing) {
  return [&mesh = probing.device.mesh, &quantity = probing.quantity](const fem::State& state) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const int n : mesh.node_sets.at(quantity.of)) {
      const Eigen::Vector3d x = position(mesh, n, state);
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    return component(high - low, quantity.along);
  };
}

/// The prestretch along an axis of the films that meet both places, of parts' places their own; nothing: they
/// differ, or there are none.
std::optional<double> prestretch_between(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const auto prestretches_at = [&](const std::string& place) {
    std::set<double> found;
    const std::vector<char> near = film_at(place, probing.one, probing.device);
    for (std::size_t cell = 0; cell < near.size(); ++cell)
      if (near[cell])
        found.insert(probing.one.parts[static_cast<std::size_t>(probing.device.film_parts[cell])]
                         .film->prestretch[static_cast<std::size_t>(*quantity.along)]);
    return found;
  };
  std::vector<double> common;
  std::ranges::set_intersection(prestretches_at(quantity.between[0]), prestretches_at(quantity.between[1]),
                                std::back_inserter(common));
  return common.size() == 1 ? std::optional(common.front()) : std::nullopt;
}

/// Against the prestretch of the film between the places, which must have one.
Shape stretch(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const auto prestretch = prestretch_between(probing);
  if (!prestretch)
    throw CaseError(
        {{{probing.one.source.string()},
          "quantity.between",
          fmt::format("quantity \"{}\": \"{}\" and \"{}\" have no film of one prestretch in common",
                      quantity.name, quantity.between[0], quantity.between[1])}});
  const Shape length = relative_distance(probing);
  return [length, drawn = length(probing.device.model.initial_state()),
          by = *prestretch](const fem::State& state) { return length(state) / drawn * by; };
}

ElementPoint element_at_point(const Probing& probing) {
  const Eigen::Vector3d point(probing.quantity.point->data());
  const auto found = elements_at(point, probing.device.mesh);
  if (found.empty()) probing.refuse("point", no_element_text(probing.one, point));
  const auto first = probing.device.mesh.film()->cell(found.front().cell);
  for (const ElementPoint& at : found) { // neighbours have nodes in common
    const auto own = probing.device.mesh.film()->cell(at.cell);
    if (std::ranges::find_first_of(own, first) == own.end())
      probing.refuse("point", "films of two parts lie on one another there; ask for a place of one of them");
  }
  return found.front();
}

Shape displacement(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const auto towards = [&quantity, down = probing.one.gravity.down()](const Eigen::Vector3d& moved) {
    return quantity.along == along_gravity ? moved.dot(down) : component(moved, quantity.along);
  };
  const meshing::Mesh& mesh = probing.device.mesh;
  if (quantity.point)
    return [&mesh, towards, at = element_at_point(probing),
            turn = turn_to(Eigen::Vector3d(quantity.point->data()), mesh)](const fem::State& state) {
      Eigen::Vector3d moved = Eigen::Vector3d::Zero();
      const auto nodes = mesh.film()->cell(at.cell);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        moved += at.shape[static_cast<int>(a)] * state.displacement[static_cast<std::size_t>(nodes[a])];
      return towards(turn * moved);
    };
  const Device& device = probing.device;
  return [&device, &quantity, towards, drawn = centroid(device, quantity.of, device.model.initial_state())](
             const fem::State& state) { return towards(centroid(device, quantity.of, state) - drawn); };
}

Shape swelling(const Probing& probing) {
  return [&mesh = probing.device.mesh, &quantity = probing.quantity](const fem::State& state) {
    double largest = -std::numeric_limits<double>::infinity();
    for (const int n : mesh.node_sets.at(quantity.of))
      largest = std::max(largest, state.displacement[static_cast<std::size_t>(n)][*quantity.along]);
    return largest;
  };
}

Shape angle(const Probing& probing) {
  const auto master = static_cast<std::size_t>(probing.device.mesh.node_sets.at(probing.quantity.of).front());
  return [master, along = *probing.quantity.along](const fem::State& state) {
    return state.angle[master][along];
  };
}

Shape radius(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const meshing::Mesh& mesh = probing.device.mesh;
  if (mesh.cells_of(quantity.of, mesh.film()))
    probing.refuse(
        "of",
        fmt::format("found \"{}\": an area has no radius; give its edge, whose nodes have one", quantity.of));
  const Device& device = probing.device;
  if (probing.one.dimension == fem::Dimension::axisymmetric)
    return [&device, &quantity](const fem::State& state) { return centroid(device, quantity.of, state).x(); };
  return [&device, &quantity](const fem::State& state) {
    const Eigen::Vector3d centre = centroid(device, quantity.of, state);
    const auto& nodes = device.mesh.node_sets.at(quantity.of);
    const std::vector<double>& shares = device.shares.at(quantity.of).of_nodes;
    double mean = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      mean += shares[n] * (position(device.mesh, nodes[n], state) - centre).norm();
    return mean;
  };
}

/// How a rotation vector goes with a small rotation that follows it, about axes that stay.
Eigen::Matrix3d spin_per_turn(const Eigen::Vector3d& spin) {
  const double angle = spin.norm();
  Eigen::Matrix3d cross;
  cross << 0, -spin.z(), spin.y(), spin.z(), 0, -spin.x(), -spin.y(), spin.x(), 0;
  const double factor =
      angle < 1e-3 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() - cross / 2 + factor * cross * cross;
}

Eigen::VectorXd angle_gradient(const Probing& probing, const fem::State& state) {
  const fem::DofMap& dofs = probing.device.model.dofs;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(dofs.count());
  const int master = probing.device.mesh.node_sets.at(probing.quantity.of).front();
  const Eigen::Matrix3d turns = spin_per_turn(state.angle[static_cast<std::size_t>(master)]);
  for (int c = 0; c < 3; ++c)
    if (const int e = dofs.equation(master, 3 + c); e != fem::DofMap::absent)
      row[e] = turns(*probing.quantity.along, c);
  return row;
}

/// A row over the equations that grows by what nodes and places count.
struct Row {
  explicit Row(const Probing& probing)
      : device(probing.device), values(Eigen::VectorXd::Zero(device.model.dofs.count())) {}
  void add(int node, const Eigen::Vector3d& gradient) {
    for (int c = 0; c < 3; ++c)
      if (const int e = device.model.dofs.equation(node, c); e != fem::DofMap::absent)
        values[e] += gradient[c];
  }
  void add_mean(const std::string& place, const Eigen::Vector3d& gradient) {
    const auto& nodes = device.mesh.node_sets.at(place);
    const std::vector<double>& shares = device.shares.at(place).of_nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) add(nodes[n], shares[n] * gradient);
  }
  const Device& device;
  Eigen::VectorXd values;
};

Eigen::VectorXd distance_gradient(const Probing& probing, const fem::State& state) {
  const Quantity& quantity = probing.quantity;
  Row row(probing);
  const auto apart = [&, &device = probing.device](const fem::State& at) -> Eigen::Vector3d {
    return centroid(device, quantity.between[1], at) - centroid(device, quantity.between[0], at);
  };
  Eigen::Vector3d along = apart(state).normalized();
  if (quantity.along) // positive as drawn
    along = Eigen::Vector3d::Unit(*quantity.along) *
            (apart(probing.device.model.initial_state())[*quantity.along] < 0 ? -1 : 1);
  row.add_mean(quantity.between[1], along);
  row.add_mean(quantity.between[0], -along);
  return row.values;
}

Eigen::VectorXd radius_gradient(const Probing& probing, const fem::State& state) {
  const Device& device = probing.device;
  const std::string& place = probing.quantity.of;
  Row row(probing);
  if (probing.one.dimension == fem::Dimension::axisymmetric) {
    row.add_mean(place, Eigen::Vector3d::UnitX());
    return row.values;
  }
  const Eigen::Vector3d middle = centroid(device, place, state);
  const auto& nodes = device.mesh.node_sets.at(place);
  const std::vector<double>& shares = device.shares.at(place).of_nodes;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Eigen::Vector3d outwards =
        shares[n] * (position(device.mesh, nodes[n], state) - middle).normalized();
    row.add(nodes[n], outwards);
    sum += outwards;
  }
  row.add_mean(place, -sum); // the middle moves with the nodes
  return row.values;
}

Eigen::VectorXd displacement_gradient(const Probing& probing, const fem::State&) {
  const Quantity& quantity = probing.quantity;
  const meshing::Mesh& mesh = probing.device.mesh;
  Row row(probing);
  Eigen::Vector3d along = probing.axis();
  if (quantity.point) {
    along = turn_to(Eigen::Vector3d(quantity.point->data()), mesh).transpose() * along;
    const ElementPoint at = element_at_point(probing);
    for (Eigen::Index a = 0; a < at.shape.size(); ++a)
      row.add(mesh.film()->cell(at.cell)[static_cast<std::size_t>(a)], at.shape[a] * along);
  } else {
    row.add_mean(quantity.of, along);
  }
  return row.values;
}

std::vector<Key> displacement_keys() {
  return {place_key(),
          measure("point", "m", to(&Quantity::point), "instead of a place: the point of the film, as drawn")
              .values(3, 3)
              .replacing("of"),
          word("along", axes_and_gravity(), to(&Quantity::along), "component; without it the magnitude")
              .optional()
              .only_with(when::moves_along_it()),
          since_key()};
}

constexpr std::array outermost{1.0, 2.0}; // whichever node is outermost

} // namespace

std::vector<QuantityKind> shape_kinds() {
  return {
      {.word = "displacement",
       .meaning = "of the centroid of a place: the mean over its volume, area or length as drawn (m)",
       .unit = "m",
       .keys = displacement_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("displacement of {}{}{}{}",
                                q.point ? fmt::format("the point ({} m)", fmt::join(*q.point, ", ")) : q.of,
                                along_words(q), q.since.empty() ? "" : ", since \"" + q.since + "\"",
                                at_words(q));
           },
       .shape = displacement,
       .since = difference,
       .gradient = displacement_gradient,
       .shares = true,
       .directed = true},
      {.word = "angle",
       .meaning = "rotation of a body about an axis: the part of its rotation vector; within 60 degrees of "
                  "full turns these, about the axis so far, and what is left (rad)",
       .unit = "rad",
       .keys =
           [] {
             return std::vector<Key>{body_key(), about_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("rotation of {}{}{}", q.of, about_words(q), at_words(q));
           },
       .shape = angle,
       .gradient = angle_gradient,
       .refusal = turns_not},
      {.word = "radius",
       .meaning = "mean distance of a place from its centroid (m)",
       .unit = "m",
       .keys = [] { return std::vector<Key>{place_key()}; },
       .in_words = [](const Quantity& q) { return fmt::format("mean radius of {}{}", q.of, at_words(q)); },
       .shape = radius,
       .gradient = radius_gradient,
       .shares = true},
      {.word = "distance",
       .meaning =
           "between the centroids of two places (m); in a model of revolution of what lies in the half "
           "plane y = 0: along x the difference of mean radii",
       .unit = "m",
       .keys =
           [] {
             return std::vector<Key>{between_key(), component_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("distance of {} and {}{}{}", q.between[0], q.between[1], along_words(q),
                                at_words(q));
           },
       .shape = distance,
       .gradient = distance_gradient},
      {.word = "elongation",
       .meaning = "relative change of the distance between two places (-)",
       .unit = "1",
       .keys =
           [] {
             return std::vector<Key>{between_key(), component_key(), since_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("elongation from {} to {}{}, since {}{}", q.between[0], q.between[1],
                                along_words(q), since_words(q), at_words(q));
           },
       .shape = relative_distance,
       .since = change,
       .relative = true},
      {.word = "stretch",
       .meaning = "distance between two places over that of the unstretched film (-)",
       .unit = "1",
       .keys =
           [] {
             return std::vector<Key>{between_key(), plane_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("stretch between {} and {}{}{}", q.between[0], q.between[1], along_words(q),
                                at_words(q));
           },
       .shape = stretch,
       .of_solids = false},
      {.word = "size",
       .meaning =
           "of the box around a place (m); in a model of revolution around what of it lies in the half "
           "plane y = 0: along x from the smallest to the largest radius",
       .unit = "m",
       .keys =
           [] {
             return std::vector<Key>{place_key(), component_key()};
           },
       .in_words =
           [](const Quantity& q) { return fmt::format("size of {}{}{}", q.of, along_words(q), at_words(q)); },
       .shape = size,
       .orders = outermost},
      {.word = "growth",
       .meaning = "relative change of the size of a place (-)",
       .unit = "1",
       .keys =
           [] {
             return std::vector<Key>{place_key(), component_key(), since_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("growth of {}{}, since {}{}", q.of, along_words(q), since_words(q),
                                at_words(q));
           },
       .shape = size,
       .since = change,
       .relative = true,
       .orders = outermost},
      {.word = "swelling",
       .meaning = "largest displacement along an axis among the nodes of a place (m)",
       .unit = "m",
       .keys =
           [] {
             return std::vector<Key>{place_key(), axis_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("largest displacement of {}{}{}", q.of, along_words(q), at_words(q));
           },
       .shape = swelling},
  };
}

} // namespace dielast::cases
