// SPDX-License-Identifier: GPL-3.0-or-later
// What is read from the fields of the film.
#include "cases/language/conditions.hpp"
#include "cases/quantities/film_values.hpp"
#include "cases/quantities/probing.hpp"
#include "meshing/solids/sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace dielast::cases {
namespace {

/// Scalars before the components of tensors, in messages too.
std::vector<Choice> fields(bool of_film_alone) {
  std::vector<Choice> all;
  for (const post::Scalar& field : post::scalars())
    if (!of_film_alone || field.part == post::Part::film)
      all.emplace_back(field.name, std::string(field.meaning));
  std::stable_partition(all.begin(), all.end(),
                        [](const Choice& field) { return field.word.find('.') == std::string::npos; });
  return all;
}

std::string unit_of_field(const Quantity& quantity, const std::vector<Quantity>&) {
  for (const post::Scalar& field : post::scalars())
    if (field.name == quantity.of) return std::string(field.unit);
  return "1";
}

std::vector<Key> value_keys() {
  return {
      word("of", fields(true), to(&Quantity::of), "the field"),
      text("place", to(&Quantity::place),
           "the place: a part of the film (mean by volume), or nodes (mean, by their shares in it, of what "
           "the elements continue to them)")
          .refers_to(Reference::place),
      measure("point", "m", to(&Quantity::point), "the point of the film, as drawn")
          .values(3, 3)
          .replacing("place")};
}

std::string value_words(const Quantity& q) {
  if (q.point)
    return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}) m as drawn{}", field_words(q), (*q.point)[0],
                       (*q.point)[1], (*q.point)[2], at_words(q));
  return fmt::format("mean {} at {}{}", field_words(q), q.place, at_words(q));
}

/// The part with its electrode that a reading is of.
std::pair<int, int> film_of(const Probing& probing, const FilmReading& reading) {
  return {probing.device.film_parts[static_cast<std::size_t>(reading.cell)],
          probing.drawn.film[static_cast<std::size_t>(reading.points.front())].electrode};
}

constexpr const char* two_values =
    "the edge of an electrode or of a film is there, where a field has two values";

/// Where a value of a field is read.
std::vector<FilmReading> readings_of(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const Device& device = probing.device;
  const char* key = quantity.point ? "point" : "place";
  std::vector<FilmReading> readings;
  if (quantity.point) {
    readings = readings_at(Eigen::Vector3d(quantity.point->data()), device.mesh, probing.drawn);
  } else {
    readings = readings_in(quantity.place, device.mesh, probing.drawn);
    if (!readings.empty()) return readings;
    readings = readings_at(quantity.place, device.mesh, probing.drawn);
    weigh_by_shares(readings, quantity.place, device);
  }
  if (readings.empty())
    probing.refuse(key, no_element_text(probing.one, quantity.point ? Eigen::Vector3d(quantity.point->data())
                                                                    : Eigen::Vector3d::Zero()));
  for (const FilmReading& reading : readings)
    if (film_of(probing, reading) != film_of(probing, readings[0]))
      probing.refuse(key, fmt::format("{}; give a point beside it, or a part of the film", two_values));
  return readings;
}

std::array<double, 3> coordinates(const Eigen::Vector3d& x) { return {x.x(), x.y(), x.z()}; }

/// What is said of film in space, turned with it; a film of revolution is no solid.
fem::MembraneSample turned(fem::MembraneSample sample, const Eigen::Matrix3d& turn) {
  sample.F = turn * sample.F;
  return sample;
}

/// Film under an electrode and beside it may be in one element, of a rod: a scalar of electrodes is that
/// under them.
void look_under_electrodes(std::vector<FilmReading>& readings, const Probing& probing) {
  const auto fields = post::film_fields();
  const auto field = std::ranges::find(fields, probing.quantity.of, &post::FilmField::name);
  if (field == fields.end() || !field->of_electrodes ||
      probing.device.mesh.film()->type != meshing::CellType::rod2)
    return;
  for (FilmReading& reading : readings) {
    const auto is_covered = [&](int p) {
      return probing.drawn.film[static_cast<std::size_t>(p)].electrode >= 0;
    };
    if (std::ranges::none_of(reading.points, is_covered)) continue;
    for (std::size_t p = 0; p < reading.points.size(); ++p)
      if (!is_covered(reading.points[p])) reading.weight[static_cast<Eigen::Index>(p)] = 0;
  }
}

Probe value(const Probing& probing) {
  const Quantity& quantity = probing.quantity;
  const Eigen::Matrix3d turn = quantity.point
                                   ? turn_to(Eigen::Vector3d(quantity.point->data()), probing.device.mesh)
                                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  std::vector<FilmReading> readings = readings_of(probing);
  look_under_electrodes(readings, probing);
  const auto value_in = [readings = std::move(readings), &quantity, turn](const fem::Samples& samples) {
    return mean(readings, samples, [&](const fem::MembraneSample& sample, const auto&) {
      return post::film_value(turned(sample, turn), quantity.of);
    });
  };
  if (std::isnan(value_in(probing.drawn)))
    probing.refuse("of",
                   fmt::format("{} has no value there: a solid with a potential has no layers", quantity.of));
  return [value_in](const Measured& measured) { return value_in(measured.samples); };
}

/// Of the film of the place's own part, along the radius about where that was drawn; there itself, where all
/// directions lead away, the root of their mean square. At an edge of the mesh what lies side by side is
/// taken together, inside it film on either side has stretches of its own.
Probe radial_stretch(const Probing& probing) {
  const Device& device = probing.device;
  const meshing::Mesh& mesh = device.mesh;
  if (mesh.film()->type == meshing::CellType::rod2 || probing.one.any_geometry<Roll>())
    probing.refuse("of", "film that is rolled, or lies along a line, has no stretch along a radius");
  std::vector<FilmReading> readings = readings_at(probing.quantity.of, mesh, probing.drawn);
  const std::vector<char> own = film_at(probing.quantity.of, probing.one, device);
  std::erase_if(readings, [&own](const FilmReading& at) { return !own[static_cast<std::size_t>(at.cell)]; });
  std::set<std::array<double, 3>> edge;
  for (const meshing::OuterSide& side : meshing::outer_sides(*mesh.film()))
    for (const int node : side.nodes()) edge.insert(coordinates(mesh.nodes[static_cast<std::size_t>(node)]));
  weigh_by_shares(readings, probing.quantity.of, device);
  std::map<std::array<double, 3>, std::pair<int, int>> films;
  for (const FilmReading& at : readings) {
    const auto film = film_of(probing, at);
    if (!edge.contains(coordinates(at.drawn)) &&
        films.try_emplace(coordinates(at.drawn), film).first->second != film)
      probing.refuse("of", fmt::format("{}; ask for a \"value\" beside it", two_values));
  }
  for (FilmReading& at : readings) {
    const Part& part = probing.one.parts[static_cast<std::size_t>(film_of(probing, at).first)];
    if (part.has_mesh()) at.drawn -= Eigen::Vector3d(part.at.data());
  }
  const double at_origin = 1e-9 * mesh.bounds().sizes().norm();
  return [readings = std::move(readings), at_origin](const Measured& measured) {
    return mean(readings, measured.samples,
                [at_origin](const fem::MembraneSample& sample, const FilmReading& reading) {
                  const Eigen::Vector2d radius = reading.drawn.head<2>();
                  return radius.norm() > at_origin ? (sample.F * radius.normalized()).norm()
                                                   : sample.F.norm() / std::sqrt(2.0);
                });
  };
}

Probe extreme(const Probing& probing) {
  return [&quantity = probing.quantity](const Measured& measured) {
    const auto extremum = measured.extremes.find(quantity.of, quantity.extreme);
    return extremum ? extremum->value : no_value;
  };
}

std::string without_bars(const Case& one, const Quantity& quantity) {
  const std::vector<post::Scalar> all = post::scalars();
  const auto field = std::ranges::find(all, quantity.of, &post::Scalar::name);
  if (field == all.end() || field->part != post::Part::walls || std::ranges::any_of(one.parts, has_bars))
    return "";
  return fmt::format("there are no beams, cables or walls, whose {} it would be", quantity.of);
}

} // namespace

std::vector<QuantityKind> field_kinds() {
  return {
      {.word = "radial stretch",
       .meaning =
           "stretch of the film along the radius about the origin of its geometry, mean at an edge (-)",
       .unit = "1",
       .keys = [] { return std::vector<Key>{place_key()}; },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("stretch along the radius at {}{}", q.of, at_words(q));
           },
       .probe = radial_stretch,
       .shares = true,
       .fields = true,
       .of_shells = false,
       .of_solids = false,
       .orders = next_to_a_place},
      {.word = "value",
       .meaning = "of a field of the film: at a point, or its mean over a place",
       .keys = value_keys,
       .in_words = value_words,
       .probe = value,
       .unit_by = unit_of_field,
       .shares = true,
       .fields = true,
       .of_shells = false,
       .orders = next_to_a_place},
      {.word = "extreme",
       .meaning = "smallest or largest value of a field",
       .keys =
           [] {
             return std::vector<Key>{word("of", fields(false), to(&Quantity::of), "the field"),
                                     extreme_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("{} {} anywhere{}", extreme_word(q), field_words(q), at_words(q));
           },
       .probe = extreme,
       .unit_by = unit_of_field,
       .refusal = without_bars,
       .fields = true,
       .extreme = true,
       .orders = {{0.5, 1}}},
  };
}

} // namespace dielast::cases
