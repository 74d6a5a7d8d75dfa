// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/paths/continuation.hpp"
#include "fem/paths/energy_balance.hpp"
#include "fem/paths/ramp.hpp"
#include "post/files/checkpoint_file.hpp"

#include <nlohmann/json.hpp>

namespace dielast::post {

/// How long the parts of a model's states are.
struct StateSizes {
  std::size_t nodes = 0, equations = 0, free = 0, held = 0; ///< held: equations that are prescribed
  std::size_t ports = 0;
  std::size_t internal_variables = 0, sheet_points = 0, scalars = 0;

  static StateSizes of(const fem::Model& model);
};

/// States and progress as JSON whose numbers are kept bit for bit (arrays of doubles as binary): written as
/// CBOR it is the state part of a checkpoint.
nlohmann::json archive(const fem::State& state);
nlohmann::json archive(const std::vector<fem::PathPoint>& points);
nlohmann::json archive(const fem::RampProgress& progress);
nlohmann::json archive(const fem::ContinuationProgress& progress);
nlohmann::json archive(const fem::EnergyBalance::Record& record);

/// What was archived. Throws CheckpointError when it is something else, or does not fit a model whose states
/// have these sizes.
fem::State restore_state(const nlohmann::json& archived, const StateSizes& sizes);
std::vector<fem::PathPoint> restore_points(const nlohmann::json& archived, const StateSizes& sizes);
fem::RampProgress restore_ramp(const nlohmann::json& archived, const StateSizes& sizes);
fem::ContinuationProgress restore_continuation(const nlohmann::json& archived, const StateSizes& sizes);
fem::EnergyBalance::Record restore_energy(const nlohmann::json& archived, const StateSizes& sizes);

/// Doubles as binary JSON and back. `unpack` throws CheckpointError for anything else and, where a size is
/// given, for another number of them.
nlohmann::json pack(std::span<const double> values);
std::vector<double> unpack(const nlohmann::json& packed);
std::vector<double> unpack(const nlohmann::json& packed, std::size_t size);

} // namespace dielast::post
