// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/cases/scratch.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <sstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <vector>

namespace dielast::test {

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

/// Rows of a CSV table without commas in its cells.
inline std::vector<std::vector<std::string>> table_of(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : lines_of(text_of(file))) {
    auto& row = rows.emplace_back();
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) row.push_back(cell);
  }
  return rows;
}

struct Ended {
  int exit_code = 0; ///< minus the signal that ended it
  std::string out, err;
};

/// The program as a user starts it, with a scratch directory as its working directory.
class CommandTest : public ScratchTest {
 protected:
  /// Called in the new process before the program: limits of resources.
  using Prepare = std::function<void()>;

  nlohmann::json json_of(const std::string& file) const {
    return nlohmann::json::parse(content(file), nullptr, false);
  }

  pid_t start(const std::vector<std::string>& arguments, const Prepare& prepare = {}) const {
    return start_in(directory, arguments, prepare);
  }
  Ended wait_for(pid_t process) const {
    int status = 0;
    waitpid(process, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content(".out"), content(".err")};
  }
  Ended dielast(const std::vector<std::string>& arguments, const Prepare& prepare = {}) const {
    return wait_for(start(arguments, prepare));
  }
  Ended dielast_in(const std::filesystem::path& folder, const std::vector<std::string>& arguments) const {
    return wait_for(start_in(folder, arguments, {}));
  }

  /// Waits until a condition holds; false after two minutes, longer than anything here takes on a busy
  /// machine.
  static bool until(const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!holds() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return holds();
  }

 private:
  pid_t start_in(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                 const Prepare& prepare) const {
    std::vector<const char*> words{DIELAST_PROGRAM};
    for (const std::string& argument : arguments) words.push_back(argument.c_str());
    words.push_back(nullptr);
    const std::string out = directory / ".out", err = directory / ".err";
    std::fflush(nullptr); // or the child would print it again
    const pid_t process = fork();
    if (process != 0) return process;
    if (chdir(folder.c_str()) != 0 || !std::freopen(out.c_str(), "w", stdout) ||
        !std::freopen(err.c_str(), "w", stderr))
      _exit(126);
    if (prepare) prepare();
    execv(words[0], const_cast<char**>(words.data()));
    _exit(127);
  }
};

inline void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

} // namespace dielast::test
