// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/history.hpp"

#include "post/file_output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

namespace dielast::post {

namespace {

std::string header_of(const std::vector<Column>& columns) {
  std::string header = "step";
  for (const Column& column : columns) header += "," + csv_cell(column.name + "[" + column.unit + "]");
  return header + "\n";
}

} // namespace

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + '"';
}

History::History(std::filesystem::path path, const std::vector<Column>& columns)
    : path_(std::move(path)), column_count_(columns.size()) {
  replace_file(path_, header_of(columns));
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor_ < 0) throw WriteError(path_, errno);
}

History::~History() { ::close(descriptor_); }

void History::append(std::string_view step, std::span<const double> values) {
  if (values.size() != column_count_)
    throw std::invalid_argument("a history row must have one value per column");
  std::string row = csv_cell(step);
  for (const double value : values) row += std::isnan(value) ? std::string(",") : fmt::format(",{}", value);
  write_all(descriptor_, row + "\n", path_);
}

} // namespace dielast::post
