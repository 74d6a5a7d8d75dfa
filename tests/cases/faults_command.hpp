// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/cases/command.hpp"
#include "tests/sanitized.hpp"

#include <algorithm>
#include <iostream>
#include <map>
#include <random>

namespace dielast::test {

/// The program with faults.cpp loaded before it: killed at a given call that changes a file, or with a disk
/// that is full after so many bytes.
class FaultTest : public CommandTest {
 protected:
  using Words = std::vector<std::string>;

  void SetUp() override {
    if (sanitized) GTEST_SKIP();
    CommandTest::SetUp();
    write("run.toml", small_honeycomb + "[output]\nerror_estimate = false\n");
    write("study.toml", "case = \"small.toml\"\n[study]\n"
                        "vary = { \"drive.voltage\" = [\"4 kV\", \"6 kV\"] }\ncollect = [\"eps_x\"]\n");
    write("pull.csv", "stretch,P_kPa\n1.2,7.7\n1.5,16.2\n2,26.1\n3,43.1\n4,58.4\n5,74.9\n6,90.1\n");
    write("fit.toml",
          "[film.material]\nlaw = \"gent\"\nshear_modulus = \"20 kPa\"\nstretch_limit = 100\n"
          "relative_permittivity = 3\n[fit]\nparameters = [\"shear_modulus\", \"stretch_limit\"]\n"
          "[[test]]\nfile = \"pull.csv\"\nkind = \"uniaxial\"\nequilibrium = true\n");
  }

  static Words words(const std::string& command, const std::string& folder, bool resume = false) {
    Words all{command, command + ".toml", "-o", folder};
    if (command == "study") all.insert(all.end(), {"-j", "1"});
    if (resume) all.emplace_back("--resume");
    return all;
  }
  Ended with_fault(const char* fault, long at, const Words& all) const {
    return dielast(all, [&] {
      setenv("LD_PRELOAD", DIELAST_FAULTS, 1);
      setenv(fault, std::to_string(at).c_str(), 1);
    });
  }
  Ended killed_at(long call, const Words& all) const { return with_fault("DIELAST_KILL_AT", call, all); }
  Ended with_disk(long bytes, const Words& all) const { return with_fault("DIELAST_DISK", bytes, all); }

  /// Everything below a folder by name; of a run's log, and the report that shows it, only that they are
  /// there.
  std::map<std::string, std::string> results(const std::string& folder) const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::filesystem::path& file = entry.path();
      const bool timed =
          file.filename() == "run.log" ||
          (file.filename() == "report.html" && std::filesystem::exists(file.parent_path() / "run.log"));
      all[file.lexically_relative(directory / folder)] = timed ? "there" : text_of(file);
    }
    return all;
  }
  /// Names of files whose content differs, or that only one of two folders has.
  std::vector<std::string> differences(const std::string& one, const std::string& other) const {
    const auto a = results(one), b = results(other);
    std::vector<std::string> names;
    for (const auto& [name, content] : a)
      if (const auto found = b.find(name); found == b.end() || found->second != content)
        names.push_back(name);
    for (const auto& [name, content] : b)
      if (!a.contains(name)) names.push_back(name);
    return names;
  }

  /// Kills a command at every `stride`th call that changes a file, every third time its resumption, too, and
  /// expects the results of one that was not killed. Returns the number of kills.
  int kill_and_resume(const std::string& command, long first, long stride) {
    const std::string straight = command + "-straight";
    EXPECT_EQ(dielast(words(command, straight)).exit_code, 0);
    int kills = 0;
    for (long call = first;; call += stride) {
      std::filesystem::remove_all(directory / "out");
      const Ended killed = killed_at(call, words(command, "out"));
      if (killed.exit_code != -SIGKILL) {
        EXPECT_EQ(killed.exit_code, 0) << killed.err;
        break;
      }
      ++kills;
      if (kills % 3 == 0) kills += killed_at(1 + call / 2, words(command, "out", true)).exit_code == -SIGKILL;
      const Ended resumed = dielast(words(command, "out", true));
      EXPECT_EQ(resumed.exit_code, 0) << command << " killed at " << call << ": " << resumed.err;
      EXPECT_EQ(differences("out", straight), std::vector<std::string>{}) << command << " killed at " << call;
    }
    return kills;
  }

  /// Lets the disk be full after `count` different numbers of bytes, and goes on with an empty one.
  void fill_the_disk(const std::string& command, int count) {
    const std::string straight = command + "-straight";
    EXPECT_EQ(dielast(words(command, straight)).exit_code, 0);
    long enough = 1000;
    while (with_disk(enough, words(command, "out")).exit_code != 0) {
      std::filesystem::remove_all(directory / "out");
      enough *= 2;
    }
    int failed = 0;
    for (int i = 0; i < count; ++i) {
      std::filesystem::remove_all(directory / "out");
      const long bytes = enough * (2 * i + 1) / (4 * count); // up to half: that was not enough
      const Ended full = with_disk(bytes, words(command, "out"));
      failed += full.exit_code != 0;
      EXPECT_EQ(full.exit_code, 1) << bytes;
      EXPECT_NE(full.err.find("cannot write "), std::string::npos) << bytes << full.err;
      EXPECT_NE(full.err.find(": No space left on device\n"), std::string::npos) << bytes << full.err;
      for (const auto& [name, content] : results("out")) EXPECT_FALSE(name.ends_with(".part")) << name;
      const Ended resumed = dielast(words(command, "out", true));
      EXPECT_EQ(resumed.exit_code, 0) << command << " of " << bytes << " bytes: " << resumed.err;
      EXPECT_EQ(differences("out", straight), std::vector<std::string>{}) << bytes;
    }
    EXPECT_EQ(failed, count);
  }

  /// Damages the checkpoint of a killed run, or what its history or series' list has kept, `count` times: the
  /// resumed run must refuse, or end in the bytes of one that was never stopped.
  void damage_checkpoints(int count) {
    EXPECT_EQ(dielast(words("run", "straight")).exit_code, 0);
    ASSERT_EQ(killed_at(90, words("run", "killed")).exit_code, -SIGKILL);
    ASSERT_TRUE(exists("killed/checkpoint.cbor"));
    std::mt19937 random(7);
    int refused = 0, same = 0;
    for (int i = 0; i < count; ++i) {
      std::filesystem::remove_all(directory / "out");
      std::filesystem::copy(directory / "killed", directory / "out");
      const std::string file = i % 10 == 8   ? "out/history.csv"
                               : i % 10 == 9 ? "out/run.pvd"
                                             : "out/checkpoint.cbor";
      write(file, damaged(content(file), random));
      const Ended resumed = dielast(words("run", "out", true));
      const bool refuses = resumed.exit_code == 1;
      EXPECT_TRUE(refuses || resumed.exit_code == 0) << i << " " << file << " " << resumed.exit_code;
      if (refuses) {
        EXPECT_NE(resumed.err.find("run again without --resume"), std::string::npos) << resumed.err;
      } else {
        EXPECT_EQ(differences("out", "straight"), std::vector<std::string>{}) << i << " " << file;
      }
      (refuses ? refused : same) += 1;
    }
    std::cout << count << " damaged: " << refused << " refused, " << same << " with the same bytes\n";
    EXPECT_GE(refused, count * 3 / 4);
  }

 private:
  /// Bits flipped, bytes replaced, a part set to zero, left out or doubled, or the end cut off.
  static std::string damaged(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) {
      return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1));
    };
    const std::string before = bytes;
    const std::size_t at = below(bytes.size()),
                      length = 1 + below(std::min<std::size_t>(64, bytes.size() - at));
    switch (random() % 6) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      break;
    case 1:
      for (std::size_t i = at; i < at + length; ++i) bytes[i] = static_cast<char>(random());
      break;
    case 2:
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length, '\0');
      break;
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, bytes.substr(at, length));
      break;
    default:
      bytes.resize(at);
      break;
    }
    return bytes == before ? bytes + "?" : bytes;
  }
};

} // namespace dielast::test
