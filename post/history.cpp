#include "post/history.hpp"

#include "post/file_output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <unistd.h>

namespace dielast::post {

namespace {

std::string header_of(const std::vector<Column>& columns) {
  std::string header = "step";
  for (const Column& column : columns) header += "," + csv_cell(column.name + "[" + column.unit + "]");
  return header + "\n";
}

/// The header and the first `rows` rows of an existing table.
std::string kept_part(const std::filesystem::path& path, const std::string& header, int rows) {
  std::ifstream stream(path, std::ios::binary);
  std::string table(std::istreambuf_iterator<char>(stream), {});
  if (!table.starts_with(header))
    throw std::runtime_error(path.string() + " is not the history of this case");
  std::size_t end = header.size();
  for (int row = 0; row < rows; ++row) {
    end = table.find('\n', end);
    if (end == std::string::npos)
      throw std::runtime_error(
          fmt::format("{} has {} of the {} rows to resume from", path.string(), row, rows));
    ++end;
  }
  table.resize(end);
  return table;
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

History::History(std::filesystem::path path, const std::vector<Column>& columns, int rows_to_keep)
    : path_(std::move(path)), column_count_(columns.size()) {
  const std::string header = header_of(columns);
  replace_file(path_, rows_to_keep > 0 ? kept_part(path_, header, rows_to_keep) : header);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
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
