// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>

namespace dielast::post {

/// A file could not be written; the message has the path and the system's reason.
struct WriteError : std::runtime_error {
  WriteError(const std::filesystem::path& path, int error_number);
};

/// Writes all bytes to an open descriptor. Throws WriteError naming `path`.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path);

/// Replaces a file's content atomically: a reader, or a run killed at any moment, sees the old or the new
/// file, never half of one. Throws WriteError and leaves the old file as it was.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace dielast::post
