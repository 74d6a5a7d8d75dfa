// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace dielast::cases {

/// The bytes of a file that a user names, e.g. "a case file". Throws FileError: there is none, a directory or
/// whatever else is no file on a disk and may never end, more than `most` bytes, not readable.
std::string read_input(const std::filesystem::path& path, const std::string& noun, std::size_t most);

} // namespace dielast::cases
