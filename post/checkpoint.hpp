#pragma once

#include "fem/continuation.hpp"
#include "fem/energy_balance.hpp"
#include "fem/ramp.hpp"

#include <nlohmann/json.hpp>

namespace dielast::post {

/// Progress as JSON whose numbers are kept bit for bit (arrays of doubles as binary): written as CBOR it is
/// the state part of a checkpoint.
nlohmann::json archive(const fem::RampProgress& progress);
nlohmann::json archive(const fem::ContinuationProgress& progress);
nlohmann::json archive(const fem::EnergyBalance::Record& record);

/// What was archived. Throws std::runtime_error when it is something else, or does not fit a model with so
/// many nodes and equations.
fem::RampProgress restore_ramp(const nlohmann::json& archived, std::size_t nodes, std::size_t equations);
fem::ContinuationProgress restore_continuation(const nlohmann::json& archived, std::size_t nodes,
                                               std::size_t equations);
fem::EnergyBalance::Record restore_energy(const nlohmann::json& archived);

/// Doubles as binary JSON and back. `unpack` throws std::runtime_error for anything else.
nlohmann::json pack(std::span<const double> values);
std::vector<double> unpack(const nlohmann::json& packed);

} // namespace dielast::post
