// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/processes.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace dielast::cases {
namespace {

struct Child {
  std::size_t number;
  pid_t process;
  int pipe;
};

void write_all(int pipe, const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = write(pipe, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// In the child: a letter for what follows, the numbers or the failure.
[[noreturn]] void answer(int pipe, std::size_t number,
                         const std::function<std::vector<double>(std::size_t)>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    const std::vector<double> values = work(number);
    write_all(pipe, "v", 1);
    write_all(pipe, values.data(), values.size() * sizeof(double));
  } catch (const std::exception& error) {
    write_all(pipe, "e", 1);
    write_all(pipe, error.what(), std::strlen(error.what()));
  }
  _exit(0);
}

Child start(std::size_t number, const std::function<std::vector<double>(std::size_t)>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "no pipe");
  std::fflush(nullptr); // or the child would print it again
  const pid_t process = fork();
  if (process < 0) throw std::system_error(errno, std::generic_category(), "no process");
  if (process == 0) {
    close(ends[0]);
    answer(ends[1], number, work);
  }
  close(ends[1]);
  return {number, process, ends[0]};
}

Computed finish(const Child& child) {
  std::string bytes;
  char part[65536];
  for (ssize_t got = 0; (got = read(child.pipe, part, sizeof part)) != 0;) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) break;
    bytes.append(part, static_cast<std::size_t>(got));
  }
  close(child.pipe);
  int status = 0;
  while (waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
  }
  const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !bytes.empty();
  if (!ended) return {{}, "the process of a run crashed"};
  if (bytes[0] == 'e') return {{}, bytes.substr(1)};
  Computed computed;
  computed.values.resize((bytes.size() - 1) / sizeof(double));
  std::memcpy(computed.values.data(), bytes.data() + 1, computed.values.size() * sizeof(double));
  return computed;
}

} // namespace

std::vector<Computed> in_processes(std::size_t count, int parallel,
                                   const std::function<std::vector<double>(std::size_t)>& work) {
  std::vector<Computed> all(count);
  std::deque<Child> running;
  for (std::size_t next = 0; next < count || !running.empty();) {
    if (next < count && static_cast<int>(running.size()) < std::max(parallel, 1)) {
      running.push_back(start(next++, work));
      continue;
    }
    const Child oldest = running.front();
    running.pop_front();
    all[oldest.number] = finish(oldest);
  }
  return all;
}

} // namespace dielast::cases
