// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/input_file.hpp"

#include "cases/text/diagnostics.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

namespace dielast::cases {

std::string read_input(const std::filesystem::path& path, const std::string& noun, std::size_t most) {
  const auto refuse = [&](const std::string& reason) {
    throw FileError(fmt::format("{}: {}", path.string(), reason));
  };
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) refuse("no such file");
  if (std::filesystem::is_directory(status)) refuse("a directory, expected " + noun);
  if (!std::filesystem::is_regular_file(status)) refuse("a device or a pipe, expected " + noun);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) refuse(fmt::format("cannot be read ({})", std::strerror(errno)));
  std::string content;
  std::vector<char> chunk(1 << 16); // files of the kernel do not tell their size
  while (content.size() <= most && stream) {
    stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    content.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) refuse(fmt::format("cannot be read ({})", std::strerror(errno)));
  if (content.size() > most) refuse(fmt::format("is too large for {}, allowed {} MB", noun, most >> 20));
  if (content.starts_with("\xff\xfe") || content.starts_with("\xfe\xff"))
    refuse("is UTF-16; save it as UTF-8");
  return content;
}

} // namespace dielast::cases
