// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/quantities/film_values.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/films/meridian.hpp"
#include "fem/films/triangle.hpp"
#include "fem/solids/tetrahedron.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace dielast::cases {
namespace {

using meshing::CellType;

constexpr double close_by = 1e-3;   ///< of an element's size
constexpr double no_further = 0.02; ///< of I1 - 3, that a law at its limit does not let grow
/// Permittivity over that of undeformed film below which film is taken to have none.
constexpr double least_permittivity = 1e-9;
constexpr double most_at_once = 1.25; ///< growth of wrinkled film's area in an increment

const Part& part_at(const Case& one, const Device& device, const fem::MembraneSample& at) {
  return one.parts[static_cast<std::size_t>(device.film_parts[static_cast<std::size_t>(at.cell)])];
}

const materials::Material& material_at(const Case& one, const Device& device, const fem::MembraneSample& at) {
  const Film& film = *part_at(one, device, at).film;
  if (at.layer == 0 || film.further_layers.empty()) return film.material; // of covers, too
  return film.further_layers[static_cast<std::size_t>(at.layer) - 1].material;
}

/// Values of the shape functions at a place in an element and their derivatives there.
struct LocalShape {
  Eigen::VectorXd value;
  Eigen::MatrixXd slope; ///< one column per local coordinate
};

int local_dimension(CellType type) {
  return meshing::is_tetrahedron(type) ? 3 : meshing::is_triangle(type) ? 2 : 1;
}

LocalShape shape(CellType type, const Eigen::VectorXd& local) {
  switch (type) {
  case CellType::triangle3:
    return {fem::shape_values<3>(local[0], local[1]), fem::shape_gradients<3>(local[0], local[1])};
  case CellType::triangle6:
    return {fem::shape_values<6>(local[0], local[1]), fem::shape_gradients<6>(local[0], local[1])};
  case CellType::tetrahedron10:
    return {fem::tetrahedron_shape<10>(local), fem::tetrahedron_slope<10>(local)};
  case CellType::meridian2:
  case CellType::rod2:
    return {fem::meridian_shape<2>(local[0]), fem::meridian_slope<2>(local[0])};
  default:
    return {fem::meridian_shape<3>(local[0]), fem::meridian_slope<3>(local[0])};
  }
}

/// Local coordinates of the nodes, one per row: (xi, eta), of tetrahedra (xi, eta, zeta), of meridians and
/// rods xi.
Eigen::MatrixXd local_nodes(CellType type) {
  if (meshing::is_tetrahedron(type))
    return (Eigen::MatrixXd(10, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0,
            0, 0, 0.5, 0.5, 0, 0.5, 0, 0.5, 0.5)
        .finished();
  if (!meshing::is_triangle(type)) return Eigen::Vector3d(-1, 1, 0);
  return (Eigen::MatrixXd(6, 2) << 0, 0, 1, 0, 0, 1, 0.5, 0, 0.5, 0.5, 0, 0.5).finished();
}

/// Those of the integration points.
Eigen::MatrixXd local_points(CellType type, int points) {
  Eigen::MatrixXd local(points, local_dimension(type));
  for (int p = 0; p < points; ++p) {
    const auto i = static_cast<std::size_t>(p);
    if (meshing::is_tetrahedron(type))
      local.row(p) = fem::tetrahedron_rule().at(i).local.transpose();
    else if (!meshing::is_triangle(type))
      local(p, 0) = fem::meridian_rule(points)[i].xi;
    else
      local.row(p) << fem::triangle_rule(points)[i].xi, fem::triangle_rule(points)[i].eta;
  }
  return local;
}

/// What a linear function through the values at the integration points has at these local coordinates: one
/// row of weights for each. One point tells a constant.
Eigen::MatrixXd continued(CellType type, int points, const Eigen::MatrixXd& local) {
  const auto basis = [points](const Eigen::MatrixXd& at) {
    Eigen::MatrixXd linear(at.rows(), points > 1 ? 1 + at.cols() : 1);
    linear.col(0).setOnes();
    if (points > 1) linear.rightCols(at.cols()) = at;
    return linear;
  };
  return basis(local) *
         fem::least_squares(basis(local_points(type, points)), Eigen::MatrixXd::Identity(points, points));
}

/// The integration points of the elements, by their numbers among the samples; films of a case may have
/// different rules, and those of rods are in several blocks.
std::vector<std::vector<int>> points_of_cells(const meshing::CellBlock& film, const fem::Samples& samples) {
  std::vector<std::vector<int>> points(static_cast<std::size_t>(film.size()));
  for (std::size_t i = 0; i < samples.film.size(); ++i)
    points[static_cast<std::size_t>(samples.film[i].cell)].push_back(static_cast<int>(i));
  return points;
}

Eigen::VectorXd volumes_of(const std::vector<int>& points, const fem::Samples& samples) {
  Eigen::VectorXd volumes(points.size());
  std::ranges::transform(points, volumes.begin(),
                         [&](int p) { return samples.film[static_cast<std::size_t>(p)].volume; });
  return volumes;
}

/// Weights of an element's points at local coordinates, a row for each. Those of a rod are of film side by
/// side, under its electrode and beside it, all along the rod.
Eigen::MatrixXd weights_at(CellType type, const std::vector<int>& points, const fem::Samples& samples,
                           const Eigen::MatrixXd& local) {
  if (type != CellType::rod2) return continued(type, static_cast<int>(points.size()), local);
  const Eigen::VectorXd volumes = volumes_of(points, samples);
  return (volumes / volumes.sum()).transpose().replicate(local.rows(), 1);
}

/// Whether local coordinates are in the element, or as good as in it.
bool is_inside(CellType type, const Eigen::VectorXd& local) {
  if (local_dimension(type) == 1) return std::abs(local[0]) <= 1 + close_by;
  return std::min(local.minCoeff(), 1 - local.sum()) >= -close_by;
}

} // namespace

std::vector<FilmReading> readings_at(const std::string& place, const meshing::Mesh& mesh,
                                     const fem::Samples& samples) {
  const meshing::CellBlock& film = *mesh.film();
  const auto all = points_of_cells(film, samples);
  std::vector<FilmReading> readings;
  std::map<std::size_t, Eigen::MatrixXd> to_nodes; // by number of points
  const auto& nodes = mesh.node_sets.at(place);
  for (int cell = 0; cell < film.size(); ++cell) {
    const auto own = film.cell(cell);
    const std::vector<int>& points = all[static_cast<std::size_t>(cell)];
    for (std::size_t a = 0; a < own.size(); ++a) {
      if (!std::binary_search(nodes.begin(), nodes.end(), own[a])) continue;
      Eigen::MatrixXd& weights = to_nodes[points.size()];
      if (weights.size() == 0 || film.type == CellType::rod2)
        weights = weights_at(film.type, points, samples, local_nodes(film.type));
      readings.push_back({cell, points, mesh.nodes[static_cast<std::size_t>(own[a])],
                          weights.row(static_cast<Eigen::Index>(a)).transpose(), own[a]});
    }
  }
  return readings;
}

std::vector<ElementPoint> elements_at(const Eigen::Vector3d& point, const meshing::Mesh& mesh) {
  const meshing::CellBlock& film = *mesh.film();
  const bool of_revolution = meshing::is_meridian(film.type);
  const Eigen::Vector3d wanted =
      of_revolution ? Eigen::Vector3d(point.head<2>().norm(), 0, point.z()) : point;
  std::vector<ElementPoint> found;
  for (int cell = 0; cell < film.size(); ++cell) {
    const auto nodes = film.cell(cell);
    Eigen::Matrix3Xd x(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t a = 0; a < nodes.size(); ++a)
      x.col(static_cast<Eigen::Index>(a)) = mesh.nodes[static_cast<std::size_t>(nodes[a])];
    const double size = (x.colwise() - x.col(0)).colwise().norm().maxCoeff();
    if ((x.col(0) - wanted).norm() > 2 * size) continue;
    // The nearest point of the element, by the Gauss-Newton method from its middle.
    const int local_count = local_dimension(film.type);
    Eigen::VectorXd local =
        Eigen::VectorXd::Constant(local_count, local_count > 1 ? 1.0 / (local_count + 1) : 0.0);
    Eigen::Vector3d away;
    constexpr int iterations = 20; // sides are straight or nearly so: a few are enough
    for (int i = 0; i < iterations; ++i) {
      const LocalShape at = shape(film.type, local);
      const Eigen::MatrixXd tangent = x * at.slope;
      away = wanted - x * at.value;
      local += (tangent.transpose() * tangent).inverse() * (tangent.transpose() * away);
    }
    if (is_inside(film.type, local) && away.norm() <= close_by * size)
      found.push_back({cell, local, shape(film.type, local).value});
  }
  return found;
}

std::string no_element_text(const Case& one, const Eigen::Vector3d& point) {
  const bool beside = one.dimension == fem::Dimension::axisymmetric && point.y() != 0 &&
                      one.any_film([](const Film& film) { return film.is_solid(); });
  return beside
             ? "there is no film: points of a solid of revolution are told in the half plane y = 0, x being "
               "the radius"
             : "there is no film; coordinates are those of the film as drawn";
}

Eigen::Matrix3d turn_to(const Eigen::Vector3d& point, const meshing::Mesh& mesh) {
  const double radius = point.head<2>().norm();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (radius > 0 && meshing::is_meridian(mesh.film()->type))
    turn.topLeftCorner<2, 2>() << point.x() / radius, -point.y() / radius, point.y() / radius,
        point.x() / radius;
  return turn;
}

std::vector<FilmReading> readings_at(const Eigen::Vector3d& point, const meshing::Mesh& mesh,
                                     const fem::Samples& samples) {
  const meshing::CellBlock& film = *mesh.film();
  const auto all = points_of_cells(film, samples);
  std::vector<FilmReading> readings;
  for (const ElementPoint& at : elements_at(point, mesh)) {
    const std::vector<int>& points = all[static_cast<std::size_t>(at.cell)];
    readings.push_back(
        {at.cell, points, point, weights_at(film.type, points, samples, at.local.transpose()).transpose()});
  }
  return readings;
}

void weigh_by_shares(std::vector<FilmReading>& readings, const std::string& place, const Device& device) {
  const auto& nodes = device.mesh.node_sets.at(place);
  const std::vector<double>& shares = device.shares.at(place).of_nodes;
  std::map<int, double> times;
  for (const FilmReading& reading : readings) ++times[reading.node];
  for (FilmReading& reading : readings)
    reading.weight *=
        shares[static_cast<std::size_t>(std::ranges::lower_bound(nodes, reading.node) - nodes.begin())] /
        times[reading.node];
}

std::vector<FilmReading> readings_in(const std::string& place, const meshing::Mesh& mesh,
                                     const fem::Samples& samples) {
  const meshing::CellBlock& film = *mesh.film();
  const std::vector<int>* cells = mesh.cells_of(place, &film);
  if (!cells) return {};
  const auto all = points_of_cells(film, samples);
  std::vector<FilmReading> readings;
  for (const int cell : *cells) {
    const std::vector<int>& points = all[static_cast<std::size_t>(cell)];
    readings.push_back({cell, points, mesh.nodes[static_cast<std::size_t>(film.cell(cell)[0])],
                        volumes_of(points, samples)});
  }
  return readings;
}

const Part* part_with(const std::string& place, const Case& one) {
  if (std::ranges::find(one.bodies, place, &Body::name) != one.bodies.end()) return nullptr;
  const auto found = std::ranges::find_if(one.parts, [&](const Part& part) {
    return part.has_mesh() && !part.name.empty() &&
           (place == part.name || place.starts_with(part.name + "."));
  });
  return found != one.parts.end() ? &*found : one.unnamed();
}

std::vector<char> film_at(const std::string& place, const Case& one, const Device& device) {
  const meshing::Mesh& mesh = device.mesh;
  const meshing::CellBlock& film = *mesh.film();
  std::vector<char> near(static_cast<std::size_t>(film.size()), 0);
  if (const std::vector<int>* cells = mesh.cells_of(place, &film)) {
    for (const int cell : *cells) near[static_cast<std::size_t>(cell)] = 1;
    return near;
  }
  const auto& nodes = mesh.node_sets.at(place);
  for (int cell = 0; cell < film.size(); ++cell)
    near[static_cast<std::size_t>(cell)] = std::ranges::any_of(
        film.cell(cell), [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); });
  const Part* part = part_with(place, one);
  const std::vector<int>* own = part && part->film ? mesh.cells_of(part->called("film"), &film) : nullptr;
  if (!own) return near;
  std::vector<char> both(near.size(), 0);
  for (const int cell : *own) both[static_cast<std::size_t>(cell)] = near[static_cast<std::size_t>(cell)];
  return both;
}

std::set<int> film_parts_at(const std::string& place, const Case& one, const Device& device) {
  const std::vector<char> near = film_at(place, one, device);
  std::set<int> parts;
  for (std::size_t cell = 0; cell < near.size(); ++cell)
    if (near[cell]) parts.insert(device.film_parts[cell]);
  return parts;
}

fem::Samples points_of(const fem::ElementBlock& film, const fem::State& state) {
  fem::Samples points;
  film.sample(state, points);
  return points;
}

std::vector<FilmElements> films_of(const std::string& place, const Case& one, const Device& device) {
  const std::set<int> parts = film_parts_at(place, one, device);
  std::vector<FilmElements> films;
  for (int b = 0; b < device.films; ++b) {
    const fem::Samples points =
        points_of(*device.model.blocks[static_cast<std::size_t>(b)], device.model.initial_state());
    FilmElements& film = films.emplace_back();
    int element = -1, last = -1, others = 0; // the points of an element stand together
    for (const fem::MembraneSample& point : points.film) {
      if (std::exchange(last, point.cell) == point.cell) continue;
      ++element;
      if (parts.contains(device.film_parts[static_cast<std::size_t>(point.cell)]))
        film.elements.push_back(element);
      else
        ++others;
    }
    film.all = others == 0;
  }
  return films;
}

std::string law_limit(const Case& one, const Device& device, const fem::State& state) {
  const auto& samples = device.model.sample(state).film;
  int count = 0;
  double largest = 0;
  std::string of;
  for (const fem::MembraneSample& at : samples) {
    const materials::ElasticLaw& law = material_at(one, device, at).law;
    const Eigen::Matrix2d C = at.F.transpose() * at.F;
    const double I1 = at.solid ? at.solid->F.squaredNorm() : C.trace() + 1 / C.determinant();
    if (!std::isfinite(I1) || materials::admits(law, I1 + no_further * (I1 - 3))) continue;
    ++count;
    if (I1 - 3 <= largest) continue;
    largest = I1 - 3;
    const Part& part = part_at(one, device, at);
    of = fmt::format("law \"{}\"{}", std::visit([](const auto& it) { return it.name; }, law),
                     part.name.empty() ? "" : fmt::format(" of part \"{}\"", part.name));
  }
  if (count == 0) return "";
  return fmt::format(
      "the film is at the limit of its {}, beyond which nothing stretches it (I1 - 3 = {:.4g}; within {:g} "
      "% of the limit in {} of {} integration points). Move or load it less, prestretch it less, or take a "
      "law "
      "with a higher limit",
      of, largest, 100 * no_further, count, samples.size());
}

std::string permittivity_limit(const Case& one, const Device& device, const fem::State& state) {
  if (std::ranges::none_of(one.film_materials(),
                           [](const auto* material) { return material->dielectric.electrostriction != 0; }))
    return "";
  double smallest = std::numeric_limits<double>::infinity(), electrostriction = 0;
  for (const fem::MembraneSample& at : device.model.sample(state).film) {
    if (at.electrode < 0) continue;
    const materials::Dielectric& dielectric = material_at(one, device, at).dielectric;
    const Eigen::Matrix2d C = at.F.transpose() * at.F;
    const double det = C.determinant() * at.widening * at.widening;
    const double left = dielectric.permittivity_at(C.trace(), det) / dielectric.permittivity;
    if (left < smallest) electrostriction = dielectric.electrostriction;
    smallest = std::min(smallest, left);
  }
  if (smallest > least_permittivity) return "";
  return fmt::format("electrostriction = {:.6g} would make the permittivity of film under an electrode "
                     "negative, {:.3g} of the undeformed film's",
                     electrostriction, smallest);
}

std::string snap_of_wrinkles(const Device& device, const fem::State& before, const fem::State& state) {
  if (!device.tension_field) return "";
  const auto from = device.model.sample(before).film, to = device.model.sample(state).film;
  int count = 0;
  double first = 0, then = 0, farthest = most_at_once;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i].tension == materials::Tension::taut && from[i].tension == materials::Tension::taut) continue;
    const auto area = [](const fem::MembraneSample& at) {
      return std::sqrt((at.F.transpose() * at.F).determinant()) * at.widening;
    };
    const double a = area(from[i]), b = area(to[i]), change = std::max(a, b) / std::min(a, b);
    if (change > most_at_once) ++count;
    if (change <= farthest) continue;
    farthest = change;
    first = a;
    then = b;
  }
  if (count == 0) return "";
  return fmt::format("wrinkled film snaps: its area would go from {:.3g} to {:.3g} times the "
                     "unstretched one at once (in {} of {} integration points). Lower the drive or stretch "
                     "the film more; where loads only change very fast, a smaller solver.smallest_increment "
                     "helps",
                     first, then, count, to.size());
}

} // namespace dielast::cases
