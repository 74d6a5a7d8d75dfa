// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace dielast::post {

using nlohmann::json;

namespace {

[[noreturn]] void mismatch() { throw CheckpointError("of another case or version"); }

json pack(const Eigen::VectorXd& values) {
  return post::pack({values.data(), static_cast<std::size_t>(values.size())});
}

Eigen::VectorXd vector(const json& packed, std::size_t size) {
  const std::vector<double> values = unpack(packed, size);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(size));
}

/// Doubles that may be left out altogether.
std::vector<double> unpack_optional(const json& packed, std::size_t size) {
  std::vector<double> values = unpack(packed);
  if (!values.empty() && values.size() != size) mismatch();
  return values;
}

Eigen::VectorXd optional_vector(const json& packed, std::size_t size) {
  return vector(packed, unpack_optional(packed, size).size());
}

json archive(const fem::History& history) {
  return {{"now", post::pack(history.now)},
          {"before", post::pack(history.before)},
          {"older", post::pack(history.older)},
          {"steps", {history.step, history.step_before}}};
}

json archive(const fem::Motion& motion) {
  return {{"position", pack(motion.position)},
          {"velocity", pack(motion.velocity)},
          {"acceleration", pack(motion.acceleration)},
          {"unbalanced", pack(motion.unbalanced)},
          {"acceleration_now", pack(motion.acceleration_now)},
          {"step", motion.step}};
}

} // namespace

json archive(const fem::State& state) {
  std::vector<double> rotations;
  rotations.reserve(4 * state.rotation.size());
  for (const auto& q : state.rotation)
    rotations.insert(rotations.end(), q.coeffs().begin(), q.coeffs().end());
  const auto& scheme = state.scheme;
  return {{"displacement", post::pack({state.displacement.front().data(), 3 * state.displacement.size()})},
          {"rotation", post::pack(rotations)},
          {"angle", post::pack({state.angle.front().data(), 3 * state.angle.size()})},
          {"scalar", post::pack(state.scalar)},
          {"voltage", post::pack(state.voltage)},
          {"supply", state.supply},
          {"charge", post::pack(state.charge)},
          {"source", post::pack(state.source)},
          {"sheet_drop", pack(state.sheet_drop)},
          {"dead_force", pack(state.dead_force)},
          {"time", state.time},
          {"scheme", post::pack(std::array{scheme.dt, scheme.a0, scheme.h1, scheme.h2})},
          {"history", state.history ? archive(*state.history) : json(nullptr)},
          {"motion", state.motion ? archive(*state.motion) : json(nullptr)}};
}

namespace {

std::shared_ptr<const fem::History> restore_history(const json& archived, std::size_t size) {
  if (archived.is_null() != (size == 0)) mismatch();
  if (archived.is_null()) return nullptr;
  fem::History history{unpack(archived.at("now"), size), unpack_optional(archived.at("before"), size),
                       unpack_optional(archived.at("older"), size), archived.at("steps").at(0),
                       archived.at("steps").at(1)};
  if ((history.step > 0 && history.before.empty()) || (history.step_before > 0 && history.older.empty()))
    mismatch();
  return std::make_shared<const fem::History>(std::move(history));
}

std::shared_ptr<const fem::Motion> restore_motion(const json& archived, std::size_t equations) {
  if (archived.is_null()) return nullptr;
  const auto part = [&](const char* name) { return vector(archived.at(name), equations); };
  return std::make_shared<const fem::Motion>(fem::Motion{part("position"), part("velocity"),
                                                         part("acceleration"), part("unbalanced"),
                                                         part("acceleration_now"), archived.at("step")});
}

} // namespace

fem::State restore_state(const json& archived, const StateSizes& sizes) {
  fem::State state;
  const std::vector<double> displacement = unpack(archived.at("displacement"), 3 * sizes.nodes);
  const std::vector<double> rotation = unpack(archived.at("rotation"), 4 * sizes.nodes);
  const std::vector<double> angle = unpack(archived.at("angle"), 3 * sizes.nodes);
  for (std::size_t n = 0; n < sizes.nodes; ++n) {
    state.displacement.emplace_back(&displacement[3 * n]);
    state.rotation.emplace_back(&rotation[4 * n]);
    state.angle.emplace_back(&angle[3 * n]);
  }
  state.scalar = unpack(archived.at("scalar"), sizes.scalars);
  state.voltage = unpack(archived.at("voltage"), sizes.ports);
  for (const json& supply : archived.at("supply"))
    if (const int number = supply; number < 0 || number > static_cast<int>(fem::Supply::leak)) mismatch();
  state.supply = archived.at("supply").get<std::vector<fem::Supply>>();
  if (state.supply.size() != sizes.ports) mismatch();
  state.charge = unpack(archived.at("charge"), sizes.ports);
  state.source = unpack(archived.at("source"), sizes.ports);
  state.sheet_drop = optional_vector(archived.at("sheet_drop"), sizes.sheet_points);
  state.dead_force = vector(archived.at("dead_force"), sizes.equations);
  state.time = archived.at("time");
  const std::vector<double> scheme = unpack(archived.at("scheme"), 4);
  state.scheme = {scheme[0], scheme[1], scheme[2], scheme[3]};
  state.history = restore_history(archived.at("history"), sizes.internal_variables);
  state.motion = restore_motion(archived.at("motion"), sizes.equations);
  return state;
}

namespace {

json archive(const fem::Conjugates& pair) { return {pack(pair.force), pack(pair.coordinate)}; }

fem::Conjugates restore_conjugates(const json& archived, std::size_t size) {
  return {vector(archived.at(0), size), vector(archived.at(1), size)};
}

json archive(const fem::EnergyPoint& point) {
  const fem::EnergyParts& e = point.energy;
  return {{"place", post::pack(std::array{point.length, point.time})},
          {"moves", point.moves},
          {"mechanical", archive(point.mechanical)},
          {"electrical", archive(point.electrical)},
          {"resistance", archive(point.resistance)},
          {"sheet", archive(point.sheet)},
          {"power", post::pack(point.power)},
          {"friction", point.friction},
          {"energy", post::pack(std::array{e.elastic, e.branches, e.electric, e.kinetic, e.regularised,
                                           e.dissipation})}};
}

fem::EnergyPoint restore_point(const json& archived, const StateSizes& sizes) {
  fem::EnergyPoint point;
  const std::vector<double> place = unpack(archived.at("place"), 2),
                            power = unpack(archived.at("power"), point.power.size()),
                            energy = unpack(archived.at("energy"), 6);
  point.length = place[0];
  point.time = place[1];
  point.moves = archived.at("moves");
  point.friction = archived.at("friction");
  point.mechanical = restore_conjugates(archived.at("mechanical"), sizes.equations + sizes.ports);
  point.electrical = restore_conjugates(archived.at("electrical"), sizes.ports);
  point.resistance = restore_conjugates(archived.at("resistance"), sizes.ports);
  point.sheet = restore_conjugates(archived.at("sheet"), sizes.sheet_points);
  std::ranges::copy(power, point.power.begin());
  point.energy = {energy[0], energy[1], energy[2], energy[3], energy[4], energy[5]};
  return point;
}

} // namespace

json pack(std::span<const double> values) {
  std::vector<std::uint8_t> bytes(values.size_bytes());
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return json::binary(std::move(bytes));
}

std::vector<double> unpack(const json& packed) {
  if (!packed.is_binary() || packed.get_binary().size() % sizeof(double) != 0) mismatch();
  std::vector<double> values(packed.get_binary().size() / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), packed.get_binary().data(), packed.get_binary().size());
  return values;
}

std::vector<double> unpack(const json& packed, std::size_t size) {
  std::vector<double> values = unpack(packed);
  if (values.size() != size) mismatch();
  return values;
}

StateSizes StateSizes::of(const fem::Model& model) {
  const fem::State drawn = model.initial_state();
  return {drawn.displacement.size(),
          static_cast<std::size_t>(model.dofs.count()),
          static_cast<std::size_t>(model.dofs.free_count()),
          static_cast<std::size_t>(model.dofs.held_count()),
          model.ports.size(),
          drawn.history ? drawn.history->now.size() : 0,
          model.ports.sheet_points().size(),
          drawn.scalar.size()};
}

json archive(const std::vector<fem::PathPoint>& points) {
  json all = json::array();
  for (const auto& [parameter, state] : points)
    all.push_back({{"parameter", parameter}, {"state", archive(state)}});
  return all;
}

std::vector<fem::PathPoint> restore_points(const json& archived, const StateSizes& sizes) {
  std::vector<fem::PathPoint> points;
  for (const json& point : archived)
    points.push_back({point.at("parameter"), restore_state(point.at("state"), sizes)});
  return points;
}

json archive(const fem::RampProgress& progress) {
  return {{"start",
           {post::pack(progress.start.voltage), post::pack(progress.start.charge),
            post::pack(progress.start.source), pack(progress.start.dead_force), pack(progress.start.held)}},
          {"load_factor", progress.load_factor},
          {"increment", progress.increment},
          {"at_break", progress.at_break},
          {"turns", progress.turns},
          {"beside", progress.beside},
          {"unstable_modes", progress.unstable_modes},
          {"slope", progress.slope ? pack(*progress.slope) : json(nullptr)},
          {"points", archive(progress.points)}};
}

fem::RampProgress restore_ramp(const json& archived, const StateSizes& sizes) {
  try {
    fem::RampProgress progress;
    progress.load_factor = archived.at("load_factor");
    progress.increment = archived.at("increment");
    const json& start = archived.at("start");
    if (progress.increment != 0) { // otherwise no ramp has begun
      progress.start = {unpack(start.at(0), sizes.ports), unpack(start.at(1), sizes.ports),
                        unpack(start.at(2), sizes.ports), vector(start.at(3), sizes.equations),
                        vector(start.at(4), sizes.held)};
    }
    progress.at_break = archived.at("at_break");
    progress.turns = archived.at("turns");
    progress.beside = archived.at("beside");
    progress.unstable_modes = archived.at("unstable_modes");
    if (const json& slope = archived.at("slope"); !slope.is_null())
      progress.slope = optional_vector(slope, sizes.free);
    progress.points = restore_points(archived.at("points"), sizes);
    if (progress.points.empty()) mismatch();
    return progress;
  } catch (const json::exception&) {
    mismatch();
  }
}

json archive(const fem::ContinuationProgress& progress) {
  return {{"state", archive(progress.state)},
          {"direction", pack(progress.direction)},
          {"numbers", post::pack(std::array{progress.load_factor, progress.load_direction, progress.arc,
                                            progress.last_arc, progress.way, progress.load_way,
                                            progress.newton.residual})},
          {"counts",
           {progress.steps, progress.newton.iterations, progress.newton.negative_pivots,
            progress.newton.unstable_modes}}};
}

fem::ContinuationProgress restore_continuation(const json& archived, const StateSizes& sizes) {
  try {
    const std::vector<double> numbers = unpack(archived.at("numbers"), 7);
    const json& counts = archived.at("counts");
    fem::ContinuationProgress progress{restore_state(archived.at("state"), sizes),
                                       numbers[0],
                                       vector(archived.at("direction"), sizes.free),
                                       numbers[1],
                                       numbers[2],
                                       numbers[3],
                                       numbers[4],
                                       numbers[5],
                                       counts.at(0),
                                       {}};
    progress.newton.residual = numbers[6];
    progress.newton.iterations = counts.at(1);
    progress.newton.negative_pivots = counts.at(2);
    progress.newton.unstable_modes = counts.at(3);
    return progress;
  } catch (const json::exception&) {
    mismatch();
  }
}

json archive(const fem::EnergyBalance::Record& record) {
  const fem::Work& w = record.work;
  json points = json::array();
  for (const fem::EnergyPoint& point : record.points) points.push_back(archive(point));
  std::vector<double> poor;
  for (const auto& [error, exchanged, given, told, row, step] : record.poor)
    poor.insert(poor.end(), {error, exchanged, given ? 1.0 : 0.0, told, static_cast<double>(row),
                             static_cast<double>(step)});
  return {{"work", post::pack(std::array{w.electrical, w.mechanical, w.dissipated, w.released, w.resistance,
                                         w.leak})},
          {"account",
           post::pack(std::array{record.stored_at_start, record.exchanged, record.given, record.cut,
                                 record.without_cuts, record.doubt, record.doubt_of_circuits, record.rest})},
          {"poor", post::pack(poor)},
          {"points", std::move(points)},
          {"before_jump", pack(record.before_jump)}};
}

fem::EnergyBalance::Record restore_energy(const json& archived, const StateSizes& sizes) {
  try {
    const std::vector<double> w = unpack(archived.at("work"), 6), account = unpack(archived.at("account"), 8),
                              poor = unpack(archived.at("poor"));
    fem::EnergyBalance::Record record{.work = {w[0], w[1], w[2], w[3], w[4], w[5]},
                                      .stored_at_start = account[0],
                                      .exchanged = account[1],
                                      .given = account[2],
                                      .cut = account[3],
                                      .without_cuts = account[4],
                                      .doubt = account[5],
                                      .doubt_of_circuits = account[6],
                                      .rest = account[7],
                                      .before_jump = vector(archived.at("before_jump"), sizes.ports)};
    if (poor.size() % 6 != 0) mismatch();
    const auto number = [](double count) {
      if (!(count >= 0 && count < std::numeric_limits<int>::max())) mismatch();
      return static_cast<int>(count);
    };
    for (std::size_t i = 0; i < poor.size(); i += 6)
      record.poor.push_back(
          {poor[i], poor[i + 1], poor[i + 2] != 0, poor[i + 3], number(poor[i + 4]), number(poor[i + 5])});
    for (const json& point : archived.at("points")) record.points.push_back(restore_point(point, sizes));
    if (record.points.empty() || record.points.size() > 2) mismatch();
    return record;
  } catch (const json::exception&) {
    mismatch();
  }
}

} // namespace dielast::post
