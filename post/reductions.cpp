// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/reductions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace dielast::post {

namespace {

constexpr int widest_field = 6;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double weight(const fem::MembraneSample& sample) { return sample.volume; }
double weight(const fem::BeamSample& sample) { return sample.length; }
int layer_of(const fem::MembraneSample& sample) { return sample.layer; }
int layer_of(const fem::BeamSample&) { return 0; }
int electrode_of(const fem::MembraneSample& sample) { return sample.electrode; }
int electrode_of(const fem::BeamSample&) { return -1; }

/// Averages are over the samples of one layer.
template<class Sample, class Point>
std::vector<CellValues> all_cell_values(std::span<const Sample> samples, std::span<const Field<Point>> fields,
                                        int cell_count, int layer = 0) {
  const auto cells = static_cast<std::size_t>(cell_count);
  std::vector<CellValues> result;
  std::size_t row = 0; // values of all fields at a point
  for (const auto& field : fields) {
    row += static_cast<std::size_t>(field.width());
    result.push_back({{}, std::vector<double>(field.worst ? cells : 0, not_a_number)});
  }
  std::vector<double> values(row), weights(cells), sums(cells * row), zero(cells * fields.size());
  for (const Sample& sample : samples) {
    const Point point(sample);
    const auto cell = static_cast<std::size_t>(sample.cell);
    const double counts = layer_of(sample) == layer ? weight(sample) : 0;
    weights[cell] += counts;
    double* value = values.data();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      fields[i].evaluate(point, value);
      if (fields[i].worst) {
        double& known = result[i].worst[cell];
        known = *fields[i].worst == Extreme::minimum ? std::fmin(known, *value) : std::fmax(known, *value);
      }
      if (fields[i].of_electrodes && *value == 0) zero[cell * fields.size() + i] += counts;
      value += fields[i].width();
    }
    double* const sum = &sums[cell * row];
    for (std::size_t c = 0; c < row; ++c) sum[c] += counts * values[c];
  }
  std::size_t first = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto width = static_cast<std::size_t>(fields[i].width());
    std::vector<double>& average = result[i].average;
    average.reserve(cells * width);
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const double beside = zero[cell * fields.size() + i];
      const double looked_at = beside < weights[cell] ? weights[cell] - beside : weights[cell];
      for (std::size_t c = first; c < first + width; ++c)
        average.push_back(looked_at > 0 ? sums[cell * row + c] / looked_at : not_a_number);
    }
    first += width;
  }
  return result;
}

template<class Point>
std::string scalar_name(const Field<Point>& field, std::size_t component) {
  if (field.components.empty()) return std::string(field.name);
  return std::string(field.name) + "." + std::string(field.components[component]);
}

/// Calls `use(samples, fields, field, component)` with the part, row and component that `name` addresses.
template<class Use>
auto with_scalar(const fem::Samples& samples, std::string_view name, Use&& use) {
  for (const auto& field : film_fields())
    for (int c = 0; c < field.width(); ++c)
      if (scalar_name(field, static_cast<std::size_t>(c)) == name)
        return use(std::span(samples.film), field, c, Part::film);
  for (const auto& field : wall_fields())
    for (int c = 0; c < field.width(); ++c)
      if (scalar_name(field, static_cast<std::size_t>(c)) == name)
        return use(std::span(samples.walls), field, c, Part::walls);
  throw std::invalid_argument("unknown field '" + std::string(name) + "'");
}

/// Corners of a cell, or ends of a line.
std::span<const int> corners(const meshing::CellBlock& block, int cell) {
  return block.cell(cell).first(static_cast<std::size_t>(meshing::corners_per_cell(block.type)));
}

/// The cell and those next to it: triangles with a common side, tetrahedra with a common face; lines and
/// meridians whose common end has no third.
std::vector<char> neighbourhood(const meshing::CellBlock& block, int cell) {
  const std::span<const int> own = corners(block, cell);
  const auto is_own = [&](int node) { return std::ranges::count(own, node) > 0; };
  std::vector<char> near(static_cast<std::size_t>(block.size()));
  std::array<int, 2> lines_at_end{};
  for (int other = 0; other < block.size(); ++other) {
    const std::span<const int> nodes = corners(block, other);
    near[static_cast<std::size_t>(other)] = std::ranges::count_if(nodes, is_own) + 1 >= std::ssize(own);
    if (own.size() == 2)
      for (std::size_t end = 0; end < 2; ++end) lines_at_end[end] += std::ranges::count(nodes, own[end]) > 0;
  }
  for (int other = 0; own.size() == 2 && other < block.size(); ++other)
    for (std::size_t end = 0; end < 2; ++end)
      if (other != cell && lines_at_end[end] > 2 && std::ranges::count(corners(block, other), own[end]) > 0)
        near[static_cast<std::size_t>(other)] = 0;
  return near;
}

} // namespace

double rise_at(const Extremum& extremum, const fem::Samples& samples, const meshing::Mesh& mesh,
               std::span<const int> film_parts, std::string_view scalar) {
  const bool film = extremum.part == Part::film;
  const auto cell = static_cast<std::size_t>(extremum.cell);
  std::vector<char> near = neighbourhood(film ? *mesh.film() : *mesh.walls(), extremum.cell);
  for (std::size_t other = 0; film && other < near.size(); ++other)
    if (film_parts[other] != film_parts[cell]) near[other] = 0;
  return with_scalar(samples, scalar,
                     [&]<class Sample, class Point>(std::span<const Sample> points, const Field<Point>& field,
                                                    int component, Part) {
                       std::array<double, widest_field> values;
                       double rise = 0;
                       for (const Sample& sample : points) {
                         if (!near[static_cast<std::size_t>(sample.cell)] ||
                             layer_of(sample) != extremum.layer || electrode_of(sample) != extremum.electrode)
                           continue;
                         field.evaluate(Point(sample), values.data());
                         rise = std::max(
                             rise, std::abs(values[static_cast<std::size_t>(component)] - extremum.value));
                       }
                       return rise;
                     });
}

std::vector<CellValues> cell_values(std::span<const fem::MembraneSample> samples,
                                    std::span<const FilmField> fields, int cell_count) {
  return all_cell_values(samples, fields, cell_count);
}

std::vector<CellValues> cell_values(std::span<const fem::BeamSample> samples,
                                    std::span<const WallField> fields, int cell_count) {
  return all_cell_values(samples, fields, cell_count);
}

std::vector<Scalar> scalars() {
  std::vector<Scalar> all;
  const auto add = [&](const auto& table, Part part) {
    for (const auto& field : table)
      for (std::size_t c = 0; c < static_cast<std::size_t>(field.width()); ++c)
        all.push_back({scalar_name(field, c), part, field.unit, field.meaning});
  };
  add(film_fields(), Part::film);
  add(wall_fields(), Part::walls);
  return all;
}

WantedScalars::WantedScalars(std::vector<std::string> names) : names_(std::move(names)) {
  std::size_t known = 0;
  const auto add = [&](auto& rows, const auto& fields) {
    for (const auto& field : fields)
      for (std::size_t c = 0; c < static_cast<std::size_t>(field.width()); ++c)
        for (std::size_t n = 0; n < names_.size(); ++n)
          if (scalar_name(field, c) == names_[n]) rows.push_back({&field, c, n});
    known += rows.size();
  };
  add(film_, film_fields());
  add(walls_, wall_fields());
  if (known != names_.size()) throw std::invalid_argument("extremes of an unknown field");
}

const WantedScalars& WantedScalars::all() {
  static const WantedScalars all([] {
    std::vector<std::string> names;
    for (const Scalar& scalar : scalars()) names.push_back(scalar.name);
    return names;
  }());
  return all;
}

Extremes::Extremes(const fem::Samples& samples, const WantedScalars& wanted)
    : wanted_(wanted), ends_(wanted.names_.size()) {
  std::array<double, widest_field> values;
  const bool any_membrane =
      std::ranges::any_of(samples.film, std::logical_not{}, &fem::MembraneSample::bears_compression);
  const auto look = [&](const auto& point, const auto& rows, const auto& sample, Part part, bool is_frame) {
    const void* evaluated = nullptr; // components of a field follow one another
    for (const auto& row : rows) {
      if (is_frame && row.field->of_membranes) continue;
      if (row.field != evaluated) row.field->evaluate(point, values.data());
      evaluated = row.field;
      auto& [low, high] = ends_[row.number];
      const double value = values[row.component];
      const auto here = [&] {
        return Extremum{value, sample.cell, part, layer_of(sample), electrode_of(sample)};
      };
      if (!low || value < low->value) low = here();
      if (!high || value > high->value) high = here();
    }
  };
  if (!wanted.film_.empty())
    for (const auto& sample : samples.film)
      look(FilmPoint(sample), wanted.film_, sample, Part::film, any_membrane && sample.bears_compression);
  if (!wanted.walls_.empty())
    for (const auto& sample : samples.walls) look(sample, wanted.walls_, sample, Part::walls, false);
}

double film_value(const fem::MembraneSample& sample, std::string_view scalar) {
  std::array<double, widest_field> values;
  for (const FilmField& field : film_fields())
    for (int c = 0; c < field.width(); ++c)
      if (scalar_name(field, static_cast<std::size_t>(c)) == scalar) {
        field.evaluate(FilmPoint(sample), values.data());
        return values[static_cast<std::size_t>(c)];
      }
  throw std::invalid_argument("unknown field '" + std::string(scalar) + "' of the film");
}

std::optional<Extremum> Extremes::find(std::string_view scalar, Extreme which) const {
  const auto found = std::ranges::find(wanted_.names_, scalar);
  if (found == wanted_.names_.end())
    throw std::invalid_argument("field '" + std::string(scalar) + "' is unknown, or was not wanted");
  const Ends& ends = ends_[static_cast<std::size_t>(found - wanted_.names_.begin())];
  return which == Extreme::minimum ? ends.low : ends.high;
}

std::vector<double> average(const fem::Samples& samples, std::string_view scalar, int cell_count, int layer) {
  return with_scalar(samples, scalar,
                     [&]<class Sample, class Point>(std::span<const Sample> points, const Field<Point>& field,
                                                    int component, Part) {
                       const auto all = all_cell_values(points, std::span<const Field<Point>>(&field, 1),
                                                        cell_count, layer);
                       std::vector<double> one(static_cast<std::size_t>(cell_count));
                       for (std::size_t cell = 0; cell < one.size(); ++cell)
                         one[cell] = all[0].average[cell * static_cast<std::size_t>(field.width()) +
                                                    static_cast<std::size_t>(component)];
                       return one;
                     });
}

std::vector<double> largest_average(const fem::Samples& samples, std::string_view scalar, int cell_count) {
  std::vector<double> largest(static_cast<std::size_t>(cell_count), not_a_number);
  int last = -1;
  for (const fem::MembraneSample& sample : samples.film) last = std::max(last, sample.layer);
  for (int layer = 0; layer <= last; ++layer) {
    const std::vector<double> averages = average(samples, scalar, cell_count, layer);
    for (std::size_t cell = 0; cell < largest.size(); ++cell)
      largest[cell] = std::fmax(largest[cell], averages[cell]);
  }
  return largest;
}

} // namespace dielast::post
