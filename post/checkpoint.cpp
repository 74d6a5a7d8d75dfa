#include "post/checkpoint.hpp"

#include <cstring>
#include <stdexcept>

namespace dielast::post {

using nlohmann::json;

namespace {

[[noreturn]] void mismatch() {
  throw std::runtime_error("the checkpoint belongs to another case or version");
}

json archive(const fem::State& state) {
  std::vector<double> rotations;
  rotations.reserve(4 * state.rotation.size());
  for (const auto& q : state.rotation)
    rotations.insert(rotations.end(), q.coeffs().begin(), q.coeffs().end());
  return {{"displacement", pack({state.displacement.front().data(), 3 * state.displacement.size()})},
          {"rotation", pack(rotations)},
          {"voltage", pack(state.voltage)},
          {"dead_force", pack({state.dead_force.data(), static_cast<std::size_t>(state.dead_force.size())})}};
}

Eigen::VectorXd vector(const json& packed, std::size_t size) {
  const std::vector<double> values = unpack(packed);
  if (values.size() != size) mismatch();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(size));
}

fem::State restore_state(const json& archived, std::size_t nodes, std::size_t equations) {
  fem::State state;
  const std::vector<double> displacement = unpack(archived.at("displacement"));
  const std::vector<double> rotation = unpack(archived.at("rotation"));
  if (displacement.size() != 3 * nodes || rotation.size() != 4 * nodes) mismatch();
  for (std::size_t n = 0; n < nodes; ++n) {
    state.displacement.emplace_back(&displacement[3 * n]);
    state.rotation.emplace_back(&rotation[4 * n]);
  }
  state.voltage = unpack(archived.at("voltage"));
  state.dead_force = vector(archived.at("dead_force"), equations);
  return state;
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

json archive(const fem::RampProgress& progress) {
  json points = json::array();
  for (const auto& point : progress.points)
    points.push_back({{"parameter", point.parameter}, {"state", archive(point.state)}});
  const auto& force = progress.start.dead_force;
  return {{"start_voltage", pack(progress.start.voltage)},
          {"start_force", pack({force.data(), static_cast<std::size_t>(force.size())})},
          {"load_factor", progress.load_factor},
          {"increment", progress.increment},
          {"negative_pivots", progress.negative_pivots},
          {"points", std::move(points)}};
}

fem::RampProgress restore(const json& archived, std::size_t nodes, std::size_t equations) {
  try {
    fem::RampProgress progress;
    progress.start = {unpack(archived.at("start_voltage")), vector(archived.at("start_force"), equations)};
    progress.load_factor = archived.at("load_factor");
    progress.increment = archived.at("increment");
    progress.negative_pivots = archived.at("negative_pivots");
    for (const json& point : archived.at("points"))
      progress.points.push_back({point.at("parameter"), restore_state(point.at("state"), nodes, equations)});
    if (progress.points.empty()) mismatch();
    return progress;
  } catch (const json::exception&) {
    mismatch();
  }
}

} // namespace dielast::post
