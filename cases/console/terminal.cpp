// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/console/terminal.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dielast::cases {

namespace {

std::atomic<bool> interrupt_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free); // or a signal could not set it

void interrupt(int signal) {
  if (!interrupt_requested.exchange(true)) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal); // acts when this returns
}

} // namespace

void show(const std::string& text) {
  struct winsize window {};
  if (::isatty(STDOUT_FILENO) == 1) {
    constexpr int usual_rows = 24;
    const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_row > 0;
    const auto rows = known ? window.ws_row : usual_rows;
    const char* chosen = std::getenv("PAGER");
    const std::string pager = chosen && *chosen != '\0' ? chosen : "less -R";
    if (std::ranges::count(text, '\n') >= rows)
      if (std::FILE* pipe = ::popen(pager.c_str(), "w")) {
        std::fwrite(text.data(), 1, text.size(), pipe);
        constexpr int no_such_command = 127;
        if (const int status = ::pclose(pipe); !WIFEXITED(status) || WEXITSTATUS(status) != no_such_command)
          return;
      }
  }
  say("{}", text);
}

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0)
      (void)!::open("/dev/null", O_RDWR); // takes the lowest number that is free
}

void close_standard_output() { (void)!std::freopen("/dev/null", "w", stdout); }

ExitCode finish_output(ExitCode code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  struct stat status {};
  if (::fstat(STDOUT_FILENO, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode)))
    return code;
  say(stderr, "error: cannot write to the standard output\n");
  return code == ExitCode::ok ? ExitCode::usage_or_file : code;
}

void catch_signals() {
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  struct sigaction action {
  }, before{};
  action.sa_handler = interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, &before);
  if (before.sa_handler == SIG_IGN) sigaction(SIGHUP, &before, nullptr); // as nohup wants it
}

bool interrupted() { return interrupt_requested; }

} // namespace dielast::cases
