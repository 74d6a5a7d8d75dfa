// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace dielast::post {

/// Number of the checkpoints' format: whoever changes what a checkpoint holds adds one.
constexpr int checkpoint_format = 11;

/// A checkpoint that cannot be resumed from; the message says why, without the file's name.
struct CheckpointError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// FNV-1a of 64 bits (Fowler, Noll, Vo): any single byte that changes, changes it.
std::uint64_t checksum(std::string_view bytes);

/// Writes a checkpoint atomically: the line "dielast checkpoint <format> <bytes> <checksum>" and so many
/// bytes of CBOR. Throws WriteError.
void write_checkpoint(const std::filesystem::path& path, const nlohmann::json& content);

/// Reads a checkpoint back, every bit as it was written. Throws CheckpointError for one that is of another
/// format, cut short or changed.
nlohmann::json read_checkpoint(const std::filesystem::path& path);

} // namespace dielast::post
