// SPDX-License-Identifier: GPL-3.0-or-later
// The table of rooms in docs/architecture.md against every #include and every library that CMake links.
#include "tests/structure/sources.hpp"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace dielast::test::rooms_test {
namespace {

using Names = std::set<std::string>;

/// Libraries by the words with which their headers and their CMake targets begin.
const std::map<std::string, std::vector<std::string>> libraries{
    {"Eigen", {"Eigen/", "unsupported/Eigen/", "Eigen3::"}},
    {"CGAL", {"CGAL/", "CGAL::"}},
    {"TetGen", {"tetgen.h", "${TETGEN_LIBRARY}"}},
    {"gmsh", {"gmsh.h", "${GMSH_LIBRARY}"}},
    {"fmt", {"fmt/", "fmt::"}},
    {"nlohmann-json", {"nlohmann/", "nlohmann_json::"}},
    {"CHOLMOD", {"cholmod.h", "${CHOLMOD_LIBRARY}"}},
    {"MUMPS",
     {"mumps_c_types.h", "dmumps_c.h", "zmumps_c.h", "${MUMPS_LIBRARY}", "${MUMPS_COMPLEX_LIBRARY}"}},
    {"TBB", {"tbb/", "TBB::"}},
    {"OpenMP", {"omp.h", "gomp"}},
    {"LAPACK", {"LAPACK::"}},
    {"VTK", {"vtk", "SMP/", "VTK::"}},
    {"Cairo", {"cairo", "PkgConfig::cairo"}},
    {"libdeflate", {"libdeflate.h", "PkgConfig::libdeflate"}},
    {"toml++", {"toml++/", "PkgConfig::tomlplusplus"}},
    {"udunits", {"udunits2.h", "PkgConfig::udunits"}},
    {"muparser", {"muParser", "PkgConfig::muparser"}},
    {"CLI11", {"CLI/", "CLI11::"}},
    {"spdlog", {"spdlog/", "spdlog::"}},
    {"Ceres", {"ceres/", "Ceres::"}},
    {"Boost", {"boost/", "Boost::"}}};

/// The library of a header or a CMake target; empty where it is none.
std::string library_of(const std::string& word) {
  for (const auto& [name, beginnings] : libraries)
    for (const std::string& beginning : beginnings)
      if (word.starts_with(beginning)) return name;
  return "";
}

bool is_of_the_system(const std::string& header) {
  static const Names without_folder{"cblas.h",   "dlfcn.h", "fcntl.h", "malloc.h",
                                    "pthread.h", "sched.h", "spawn.h", "unistd.h"};
  return header.find('.') == std::string::npos || header.starts_with("sys/") ||
         header.starts_with("linux/") || without_folder.contains(header);
}

bool includes_library(const std::string& room, const std::string& library) {
  return std::ranges::any_of(files_below(room, is_source), [&](const auto& file) {
    const std::string text = text_of(source_folder / file);
    return std::ranges::any_of(libraries.at(library), [&](const std::string& beginning) {
      return text.find("#include <" + beginning) != std::string::npos;
    });
  });
}

/// What the table says that a room may use: rooms, single headers of rooms, libraries.
struct Room {
  Names uses;
  bool uses_all_rooms = false;

  bool may_use(const std::string& name) const { return uses.contains(name); }
};

std::map<std::string, Room> table_of_rooms() {
  std::map<std::string, Room> rooms;
  std::istringstream lines(text_of(source_folder / "docs/architecture.md"));
  const std::regex row(R"(\| `([a-z]+)/` \|.*\| ([^|]*) \|)");
  std::smatch found;
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_match(line, found, row)) continue;
    Room& room = rooms[found[1]];
    std::string uses = std::regex_replace(found[2].str(), std::regex(R"(\([^)]*\)|`)"), "");
    std::ranges::replace(uses, ';', ',');
    std::istringstream words(uses);
    for (std::string word; std::getline(words, word, ',');) {
      word = std::regex_replace(word, std::regex("^ +| +$"), "");
      if (word == "all rooms")
        room.uses_all_rooms = true;
      else
        room.uses.insert(word);
    }
  }
  for (auto& [name, room] : rooms)
    if (room.uses_all_rooms)
      for (const auto& [other, of_other] : rooms)
        if (other != name && other != "tests") room.uses.insert(other);
  rooms.erase("tests");
  return rooms;
}

const std::map<std::string, Room> rooms = table_of_rooms();

TEST(Rooms, AreThoseOfTheTable) {
  Names names;
  for (const auto& [name, room] : rooms) names.insert(name);
  EXPECT_EQ(names, (Names{"materials", "meshing", "fem", "post", "cases"}));
}

TEST(Rooms, IncludeWhatTheTableSaysAndNothingElse) {
  const std::regex include(R"re(^ *# *include ([<"])([^>"]+)[>"].*)re");
  for (const auto& [name, room] : rooms) {
    Names included;
    for (const auto& file : files_below(name, is_source)) {
      std::istringstream lines(text_of(source_folder / file));
      std::smatch found;
      for (std::string line; std::getline(lines, line);) {
        if (!std::regex_match(line, found, include)) continue;
        const std::string header = found[2], folder = header.substr(0, header.find('/'));
        if (found[1] == "\"") {
          EXPECT_TRUE(rooms.contains(folder)) << file << " includes " << header << ", which is of no room";
          EXPECT_TRUE(std::filesystem::exists(source_folder / header)) << file << " includes " << header;
          if (folder == name) continue;
          const std::string used = room.may_use(header) ? header : folder;
          EXPECT_TRUE(room.may_use(used)) << file << " includes " << header;
          included.insert(used);
        } else if (const std::string library = library_of(header); !library.empty()) {
          EXPECT_TRUE(room.may_use(library)) << file << " includes " << header;
          included.insert(library);
        } else {
          EXPECT_TRUE(is_of_the_system(header)) << file << " includes " << header << " of an unknown library";
        }
      }
    }
    for (const std::string& used : room.uses)
      EXPECT_TRUE(libraries.contains(used) || used == "gnuplot" || included.contains(used))
          << name << " does not include " << used;
  }
}

TEST(Rooms, LinkWhatTheTableSaysAndNothingElse) {
  const std::regex call(R"((dielast_room|target_link_libraries)\(([^)]*)\))");
  const Names own{"dielast_flags", "${CMAKE_DL_LIBS}"}, keywords{"PUBLIC", "PRIVATE", "INTERFACE"};
  for (const auto& [name, room] : rooms) {
    Names linked;
    for (const auto& file :
         files_below(name, [](const auto& path) { return path.filename() == "CMakeLists.txt"; })) {
      const std::string text = std::regex_replace(text_of(source_folder / file), std::regex("#[^\n]*"), "");
      for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at) {
        std::istringstream words((*at)[2].str());
        bool uses = (*at)[1] == "target_link_libraries";
        std::string word;
        words >> word; // the target
        while (words >> word) {
          if (word == "USES" || keywords.contains(word)) {
            uses = true;
            continue;
          }
          if (!uses || own.contains(word)) continue;
          const std::string used = word.starts_with("dielast::") ? word.substr(9) : library_of(word);
          EXPECT_FALSE(used.empty()) << file << " links " << word << ", an unknown library";
          EXPECT_TRUE(used == name || room.may_use(used)) << file << " links " << word;
          linked.insert(used);
        }
      }
    }
    EXPECT_FALSE(linked.empty()) << name;
    for (const std::string& used : room.uses) {
      if (!libraries.contains(used) || linked.contains(used)) continue;
      EXPECT_TRUE(includes_library(name, used)) << name << " neither links nor includes " << used;
    }
  }
}

/// The second table: folders of each room in their order, "" the room itself.
std::map<std::string, std::vector<std::string>> table_of_folders() {
  std::map<std::string, std::vector<std::string>> folders;
  const std::string text = text_of(source_folder / "docs/architecture.md");
  const std::regex row(R"(\n\| `([a-z]+)/` \| ([^|\n]*) \|(?=\n))"), folder(R"(`([a-z]+)/`|the room itself)");
  for (std::sregex_iterator at(text.begin(), text.end(), row), end; at != end; ++at) {
    const std::string cell = (*at)[2];
    for (std::sregex_iterator f(cell.begin(), cell.end(), folder); f != end; ++f)
      folders[(*at)[1]].push_back((*f)[1]);
  }
  return folders;
}

TEST(Folders, UseThoseThatStandBeforeThemInTheTable) {
  const auto table = table_of_folders();
  ASSERT_EQ(table.size(), rooms.size());
  const std::regex include(R"re(#include "(([a-z]+)/([^"]*/)?)[^"/]+")re");
  for (const auto& row : table) {
    const std::string& room = row.first; // Clang 14 captures no structured binding
    const std::vector<std::string>& folders = row.second;
    const auto place = [&](const std::filesystem::path& folder) {
      const std::string below = folder.lexically_relative(room).generic_string();
      return std::ranges::find(folders, below == "." ? "" : below) - folders.begin();
    };
    std::set<std::ptrdiff_t> found;
    for (const auto& file : files_below(room, is_source)) {
      const auto own = place(file.parent_path());
      ASSERT_LT(own, std::ssize(folders)) << file << " is in no folder of the table";
      found.insert(own);
      const std::string text = text_of(source_folder / file);
      for (std::sregex_iterator at(text.begin(), text.end(), include), end; at != end; ++at) {
        if ((*at)[2] != room) continue;
        EXPECT_LE(place(std::filesystem::path((*at)[1].str()).parent_path()), own)
            << file << " includes " << (*at)[0];
      }
    }
    EXPECT_EQ(found.size(), folders.size()) << room;
  }
}

// What the table names must be something: a room, a header, a library or a program that is started.
TEST(Rooms, UseNothingUnknown) {
  for (const auto& [name, room] : rooms)
    for (const std::string& used : room.uses)
      EXPECT_TRUE(rooms.contains(used) || libraries.contains(used) || used == "gnuplot" ||
                  (used.ends_with(".hpp") && std::filesystem::exists(source_folder / used)))
          << name << ": " << used;
}

} // namespace
} // namespace dielast::test::rooms_test
