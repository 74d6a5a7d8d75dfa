// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/file_output.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace dielast::post {

WriteError::WriteError(const std::filesystem::path& path, int error_number)
    : std::runtime_error("cannot write " + path.string() + ": " + std::strerror(error_number)) {}

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      throw WriteError(path, errno);
  }
}

void replace_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::string part = path.string() + ".part";
  // A new file, never what a link of that name leads to; a killed run may have left one.
  ::unlink(part.c_str());
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) throw WriteError(path, errno);
  try {
    write_all(descriptor, bytes, path);
  } catch (...) {
    ::close(descriptor);
    ::unlink(part.c_str());
    throw;
  }
  // Network file systems report a full disk only here.
  if (::close(descriptor) != 0 || ::rename(part.c_str(), path.c_str()) != 0) {
    const int error_number = errno;
    ::unlink(part.c_str());
    throw WriteError(path, error_number);
  }
}

} // namespace dielast::post
