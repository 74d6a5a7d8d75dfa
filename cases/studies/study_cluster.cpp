// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_cluster.hpp"

#include "cases/console/terminal.hpp"
#include "cases/text/tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace dielast::cases {

namespace {

constexpr auto pause = std::chrono::seconds(1); ///< between two looks at the cluster
constexpr int most_vain_arrays = 3;

/// As one word of a shell.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

struct Said {
  int exit_code = 0;
  std::string text; ///< of both outputs
};

Said shell(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (!pipe) throw FileError("cannot start " + command);
  Said said;
  char buffer[4096];
  while (const std::size_t read = std::fread(buffer, 1, sizeof buffer, pipe)) said.text.append(buffer, read);
  said.exit_code = ::pclose(pipe);
  while (!said.text.empty() && said.text.back() == '\n') said.text.pop_back();
  return said;
}

struct Array {
  bool has_ended = false; ///< false, too, where the cluster does not answer
  std::string waits_for;  ///< Slurm's reason why none of its tasks runs; empty: one runs, or it is new
};

Array state_of(const std::string& job) {
  const Said said = shell("squeue --noheader --format='%T %r' --jobs=" + quoted(job));
  if (said.exit_code != 0) return {said.text.find("Invalid job id") != std::string::npos, ""};
  if (said.text.empty()) return {true, ""};
  std::string reason;
  std::istringstream lines(said.text);
  for (std::string state; lines >> state;) {
    std::getline(lines >> std::ws, reason);
    if (state != "PENDING") return {};
  }
  return {false, reason == "None" ? "" : reason};
}

/// A job array, a batch of points for each of its tasks; returns its number.
std::string submit(std::span<const int> numbers, const std::filesystem::path& folder,
                   const Cluster& cluster) {
  const auto batch = static_cast<std::size_t>(cluster.batch);
  std::string script = "#!/bin/sh\ncase $SLURM_ARRAY_TASK_ID in\n";
  std::size_t tasks = 0;
  for (std::size_t first = 0; first < numbers.size(); first += batch)
    script += fmt::format("{}) points={} ;;\n", tasks++,
                          list_text(numbers.subspan(first, std::min(batch, numbers.size() - first))));
  script += "esac\nexec";
  for (const std::string& word : cluster.command) script += " " + quoted(word);
  script += " --points \"$points\"\n";
  const std::filesystem::path file = folder / "points.sh";
  if (!(std::ofstream(file) << script)) throw FileError("cannot write " + file.string());
  const Said said =
      shell(fmt::format("sbatch --parsable --job-name=dielast --array=0-{} --output={} {} {}", tasks - 1,
                        quoted((folder / "%A_%a.log").string()), cluster.options, quoted(file.string())));
  if (said.exit_code != 0) throw FileError(fmt::format("sbatch refuses: {}", said.text));
  return said.text.substr(0, said.text.find(';'));
}

int number_of(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1)
    throw std::invalid_argument(fmt::format("\"{}\" is no number of a point", text));
  return number;
}

} // namespace

std::string list_text(std::span<const int> numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (last > i) text += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

std::vector<int> list_of(const std::string& text) {
  constexpr int most = 1000000;
  std::vector<int> numbers;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    const auto dash = part.find('-');
    const int first = number_of(std::string_view(part).substr(0, dash));
    const int last = dash == std::string::npos ? first : number_of(std::string_view(part).substr(dash + 1));
    if (last < first || last > most)
      throw std::invalid_argument(fmt::format("\"{}\" is no range of points", part));
    for (int number = first; number <= last; ++number) numbers.push_back(number);
  }
  if (numbers.empty()) throw std::invalid_argument("no points");
  return numbers;
}

void run_on_cluster(const Study& study, std::span<const WaitingPoint> waiting,
                    const std::filesystem::path& directory, const Cluster& cluster, const PointEnded& ended) {
  const std::filesystem::path folder = directory / cluster_folder, remembered = folder / "job";
  std::filesystem::create_directories(folder);
  std::string job;
  std::ifstream(remembered) >> job;
  std::vector<const StudyPoint*> left;
  for (const WaitingPoint& one : waiting) left.push_back(one.point);
  bool got_on = true;
  std::string told; // why the array waits
  const auto collect = [&] {
    std::erase_if(left, [&](const StudyPoint* point) {
      const Kept kept = kept_of(study, *point, true);
      if (kept.result) ended(*point, kept.result->exit_code);
      got_on = got_on || kept.result;
      return kept.result.has_value();
    });
  };
  for (int vain = 0; !left.empty() && !interrupted(); ++vain) {
    if (vain == most_vain_arrays) {
      say(stderr, "{} points do not run to an end on the cluster: see the logs in {}\n", left.size(),
          folder.string());
      return;
    }
    if (job.empty() || state_of(job).has_ended) {
      std::vector<int> numbers;
      for (const StudyPoint* point : left) numbers.push_back(point->number);
      job = submit(numbers, folder, cluster);
      std::ofstream(remembered) << job << "\n";
      say("job array {}: {} points\n", job, left.size());
      std::fflush(stdout);
    }
    got_on = false;
    // What was written last is seen after the array has ended.
    for (bool more = true; more && !left.empty() && !interrupted();) {
      std::this_thread::sleep_for(pause);
      const Array array = state_of(job);
      more = !array.has_ended;
      if (!array.waits_for.empty() && array.waits_for != told) {
        say("job array {} waits: {}\n", job, array.waits_for);
        std::fflush(stdout);
      }
      told = array.waits_for;
      collect();
    }
    if (got_on) vain = -1;
  }
  if (interrupted() && !left.empty())
    say("job array {} goes on: collect with --resume, or stop it with scancel {}\n", job, job);
}

} // namespace dielast::cases
