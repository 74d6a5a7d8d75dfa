// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/results_folder.hpp"

#include "post/file_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <sstream>
#include <stdexcept>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace dielast::post {

namespace {

namespace fs = std::filesystem;

constexpr const char* manifest_name = "manifest.txt";
constexpr std::string_view mark = "dielast results 1 ", file_mark = "file ", complete_mark = "complete ";
constexpr const char* choose = "choose another with -o";

std::string line_of(const std::string& name) { return fmt::format("{}{}\n", file_mark, name); }

/// A name that leads nowhere but into its folder, on one line.
bool is_plain(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name != manifest_name &&
         name.find_first_of(std::string_view("/\n\0", 3)) == std::string_view::npos;
}

void make(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw std::runtime_error(fmt::format("{}: is not a directory; {}", folder.string(), choose));
  fs::create_directories(folder, error);
  if (error)
    throw std::runtime_error(
        fmt::format("{}: cannot make the output directory: {}", folder.string(), error.message()));
  if (::access(folder.c_str(), W_OK) != 0)
    throw std::runtime_error(
        fmt::format("{}: cannot write to the output directory; {}", folder.string(), choose));
}

/// Opens a folder's manifest and locks it.
int open_locked(const fs::path& folder) {
  const std::string path = folder / manifest_name;
  // The points of a study that was killed end a moment after it.
  for (int attempt = 0; attempt < 100; ++attempt) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) throw WriteError(path, errno);
    struct stat status {};
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
      if (::fstat(descriptor, &status) == 0 && status.st_nlink > 0) return descriptor;
    } else if (errno != EWOULDBLOCK && errno != EINTR) {
      const int error = errno;
      ::close(descriptor);
      throw std::runtime_error(
          fmt::format("{}: cannot be locked: {}; {}", folder.string(), std::strerror(error), choose));
    }
    ::close(descriptor);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw FolderInUse(
      fmt::format("{}: in use by another run; wait until it has ended or {}", folder.string(), choose));
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 65536> part;
  for (ssize_t got = 0; (got = ::pread(descriptor, part.data(), part.size(), off_t(text.size()))) > 0;)
    text.append(part.data(), static_cast<std::size_t>(got));
  return text;
}

void cut(int descriptor, std::size_t size, const fs::path& folder) {
  if (::ftruncate(descriptor, static_cast<off_t>(size)) != 0) throw WriteError(folder / manifest_name, errno);
}

struct Manifest {
  std::string command; ///< empty: nothing was begun
  std::vector<std::string> names;
  std::optional<int> exit_code;
};

/// Nothing for what is no manifest. `text`: whole lines.
std::optional<Manifest> parse(const std::string& text) {
  Manifest manifest;
  std::istringstream lines(text);
  std::string line;
  if (!std::getline(lines, line)) return manifest;
  if (!line.starts_with(mark)) return std::nullopt;
  manifest.command = line.substr(mark.size());
  while (std::getline(lines, line)) {
    const std::string value = line.substr(line.find(' ') + 1);
    int code = 0;
    if (line.starts_with(file_mark) && is_plain(value))
      manifest.names.push_back(value);
    else if (line.starts_with(complete_mark) &&
             std::from_chars(value.data(), value.data() + value.size(), code).ec == std::errc())
      manifest.exit_code = code;
    else
      return std::nullopt;
  }
  return manifest;
}

/// Cuts off a last line that a full disk has left: nothing was made of it.
Manifest read_manifest(int descriptor, const fs::path& folder) {
  const std::string text = read_all(descriptor);
  const std::size_t whole = text.rfind('\n') + 1;
  auto manifest = parse(text.substr(0, whole));
  const bool begun = whole > 0 || mark.starts_with(text.substr(0, mark.size()));
  if (!manifest || !begun)
    throw std::runtime_error(fmt::format("{}: not the manifest of this version; remove the folder or {}",
                                         (folder / manifest_name).string(), choose));
  if (whole < text.size()) cut(descriptor, whole, folder);
  return *std::move(manifest);
}

/// Removes what replace_file() leaves where it is killed.
void remove_part(const fs::path& path) {
  std::error_code gone;
  fs::remove(path.string() + ".part", gone);
}

/// Removes a file, or an inner folder of results with what its manifest lists.
void remove_results(const fs::path& path) {
  std::error_code gone;
  if (!fs::is_directory(fs::symlink_status(path, gone))) {
    fs::remove(path, gone);
    remove_part(path);
    return;
  }
  if (!fs::exists(path / manifest_name, gone)) return;
  const int descriptor = open_locked(path);
  for (const std::string& name : read_manifest(descriptor, path).names) remove_results(path / name);
  ::unlink((path / manifest_name).c_str());
  ::close(descriptor);
  ::rmdir(path.c_str()); // stays where something foreign is in it
}

} // namespace

ResultsFolder::ResultsFolder(fs::path path, std::string_view command)
    : path_(std::move(path)), head_(fmt::format("{}{}\n", mark, command)) {
  make(path_);
  manifest_ = open_locked(path_);
  try {
    Manifest found = read_manifest(manifest_, path_);
    if (found.command.empty())
      write_all(manifest_, head_, path_ / manifest_name);
    else if (found.command != command)
      throw std::runtime_error(
          fmt::format("{}: holds the results of \"dielast {}\"; {}", path_.string(), found.command, choose));
    names_ = std::move(found.names);
    listed_.insert(names_.begin(), names_.end());
    exit_code_ = found.exit_code;
  } catch (...) {
    ::close(manifest_);
    throw;
  }
}

ResultsFolder::~ResultsFolder() { ::close(manifest_); }

void ResultsFolder::begin(std::vector<std::string> kept) {
  exit_code_.reset();
  listed_ = {kept.begin(), kept.end()};
  for (const std::string& name : names_) {
    if (!listed_.contains(name)) remove_results(path_ / name);
    remove_part(path_ / name);
  }
  names_ = std::move(kept);
  std::string text = head_;
  for (const std::string& name : names_) text += line_of(name);
  // What stays is not written again: the manifest of a run that goes on lists its files at every moment.
  const std::string before = read_all(manifest_);
  const auto same =
      std::mismatch(text.begin(), text.end(), before.begin(), before.end()).first - text.begin();
  cut(manifest_, static_cast<std::size_t>(same), path_);
  write_all(manifest_, std::string_view(text).substr(static_cast<std::size_t>(same)), path_ / manifest_name);
}

void ResultsFolder::add(const std::string& name) {
  if (!is_plain(name))
    throw std::runtime_error(fmt::format("\"{}\" cannot be the name of a file of results", name));
  if (listed_.contains(name)) return;
  std::error_code unknown;
  const fs::file_status there = fs::symlink_status(path_ / name, unknown);
  if (fs::exists(there) && !fs::is_directory(there) && !is_adopted_)
    throw std::runtime_error(
        fmt::format("{}: is none of these results, and would be overwritten; move it or {}",
                    (path_ / name).string(), choose));
  listed_.insert(name);
  write_all(manifest_, line_of(name), path_ / manifest_name);
  names_.push_back(name);
}

void ResultsFolder::write(const std::string& name, std::string_view bytes) {
  add(name);
  replace_file(path_ / name, bytes);
}

void ResultsFolder::set_complete(int exit_code) {
  write_all(manifest_, fmt::format("{}{}\n", complete_mark, exit_code), path_ / manifest_name);
  exit_code_ = exit_code;
}

} // namespace dielast::post
