// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/checkpoint_file.hpp"

#include "post/file_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

namespace dielast::post {

namespace {

constexpr std::string_view mark = "dielast checkpoint ";

/// The first line of a checkpoint with this content.
std::string head_of(std::string_view content) {
  return fmt::format("{}{} {} {:016x}\n", mark, checkpoint_format, content.size(), checksum(content));
}

} // namespace

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return hash;
}

void write_checkpoint(const std::filesystem::path& path, const nlohmann::json& content) {
  std::string bytes;
  nlohmann::json::to_cbor(content, bytes);
  replace_file(path, head_of(bytes) + bytes);
}

nlohmann::json read_checkpoint(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string_view whole = text;
  if (!whole.starts_with(fmt::format("{}{} ", mark, checkpoint_format)))
    throw CheckpointError("not a checkpoint of this version");
  // The head is made anew of what stands behind it: any bit that changed in either shows.
  const std::string_view content = whole.substr(std::min(whole.find('\n'), whole.size() - 1) + 1);
  if (!whole.starts_with(head_of(content))) throw CheckpointError("damaged: its checksum is another");
  try {
    return nlohmann::json::from_cbor(content);
  } catch (const nlohmann::json::exception&) {
    throw CheckpointError("damaged");
  }
}

} // namespace dielast::post
