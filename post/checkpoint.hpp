#pragma once

#include "fem/ramp.hpp"

#include <nlohmann/json.hpp>

namespace dielast::post {

/// A ramp's progress as JSON whose numbers are kept bit for bit (arrays of doubles as binary): written as
/// CBOR it is the state part of a checkpoint.
nlohmann::json archive(const fem::RampProgress& progress);

/// The progress that was archived. Throws std::runtime_error when it does not fit a model with so many nodes
/// and equations.
fem::RampProgress restore(const nlohmann::json& archived, std::size_t nodes, std::size_t equations);

/// Doubles as binary JSON and back. `unpack` throws std::runtime_error for anything else.
nlohmann::json pack(std::span<const double> values);
std::vector<double> unpack(const nlohmann::json& packed);

} // namespace dielast::post
