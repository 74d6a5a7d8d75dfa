// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/file_checks.hpp"

#include "meshing/gmsh/gmsh_contents.hpp"
#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace dielast::meshing {

namespace {

/// gmsh's numbers of cell types that a film, a beam or a solid may have.
struct KnownType {
  int number, dimension, nodes;
};
constexpr std::array known_types{KnownType{1, 1, 2},   KnownType{2, 2, 3}, KnownType{3, 2, 4},
                                 KnownType{4, 3, 4},   KnownType{8, 1, 3}, KnownType{9, 2, 6},
                                 KnownType{11, 3, 10}, KnownType{15, 0, 1}};

const KnownType* known_type(int number) {
  const auto* found = std::ranges::find(known_types, number, &KnownType::number);
  return found == known_types.end() ? nullptr : found;
}

/// The elements of each entity, by dimension and number, in each of its physical groups: how many, and a sum
/// that tells whether they are the same ones.
class Groups {
 public:
  void add(const KnownType& type, int group, int entity, std::vector<std::uint64_t> nodes) {
    std::ranges::sort(nodes);
    std::uint64_t hash = 1469598103934665603U; // FNV-1a
    for (const std::uint64_t node : nodes) hash = (hash ^ node) * 1099511628211U;
    auto& [count, sum] = entities_[{type.dimension, entity}][group];
    ++count;
    sum += hash;
  }
  /// A cell in several groups stands in the file once for each of them.
  void require_alike() const {
    for (const auto& [entity, groups] : entities_)
      for (const auto& [group, elements] : groups)
        if (elements != groups.begin()->second)
          throw MeshError(fmt::format(
              "elements of the {} {} are in different physical groups, {} and {}, and gmsh would put each of "
              "them into both; write the group's number (an element's first tag) as that of its entity (the "
              "second one), too",
              dimension_names[static_cast<std::size_t>(entity.first)], entity.second, groups.begin()->first,
              group));
  }

 private:
  std::map<std::pair<int, int>, std::map<int, std::pair<std::size_t, std::uint64_t>>> entities_;
};

class MeshFile {
 public:
  explicit MeshFile(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  void check() {
    if (!next() || line_ != "$MeshFormat" || !next()) return;
    const bool old = line_.starts_with("2.2 ");
    binary_ = line_.find(" 1 ") != std::string::npos;
    if (binary_) file_.ignore(sizeof(std::int32_t) + 1);
    while (next()) {
      if (line_ == "$PhysicalNames") check_names();
      if (line_ == "$Entities" || (line_ == "$Nodes" && !old)) return;
      if (line_ == "$Nodes" && binary_ && next()) skip_nodes();
      if (line_ != "$Elements" || !next()) continue;
      if (binary_)
        check_binary_elements(std::strtoull(line_.c_str(), nullptr, 10));
      else
        check_elements(std::strtoull(line_.c_str(), nullptr, 10));
      return;
    }
  }

 private:
  bool next() {
    const bool found = static_cast<bool>(std::getline(file_, line_));
    if (found && line_.ends_with('\r')) line_.pop_back();
    return found;
  }
  void check_names() {
    std::set<std::pair<int, std::string>> names;
    if (!next()) return;
    while (next() && line_ != "$EndPhysicalNames") {
      int dimension = 0, tag = 0;
      std::string name;
      std::istringstream words(line_);
      if (words >> dimension >> tag && std::getline(words >> std::ws, name) &&
          !names.emplace(dimension, name).second)
        throw MeshError(
            fmt::format("two physical groups have the name {}; every place needs its own name", name));
    }
  }
  void skip_nodes() {
    constexpr std::size_t each = sizeof(std::int32_t) + 3 * sizeof(double);
    file_.ignore(static_cast<std::streamsize>(std::strtoull(line_.c_str(), nullptr, 10) * each));
  }
  void check_elements(std::size_t said) {
    Groups groups;
    std::size_t there = 0;
    while (next() && line_ != "$EndElements") {
      there += !line_.empty();
      std::vector<long long> words; // number, type, how many tags, these, nodes
      const char* at = line_.c_str();
      for (char* end = nullptr; words.push_back(std::strtoll(at, &end, 10)), end != at; at = end) {
      }
      words.pop_back();
      const KnownType* known = words.size() < 5 ? nullptr : known_type(static_cast<int>(words[1]));
      if (!known || words[2] < 2 || std::ssize(words) != 3 + words[2] + known->nodes) continue;
      groups.add(*known, static_cast<int>(words[3]), static_cast<int>(words[4]),
                 {words.end() - known->nodes, words.end()});
    }
    if (line_ == "$EndElements" && there > said)
      throw MeshError(fmt::format("it says that it has {} elements, and {} stand there; correct the number",
                                  said, there));
    groups.require_alike();
  }
  void check_binary_elements(std::size_t said) {
    Groups groups;
    for (std::size_t read = 0; read < said;) {
      std::array<std::int32_t, 3> head{}; // type, how many, tags of each
      if (!take(head)) return;
      const auto [type, count, tags] = head;
      const KnownType* known = known_type(type);
      if (!known || count < 1 || tags < 0 || tags > 1000) break;
      std::vector<std::int32_t> element(static_cast<std::size_t>(1 + tags + known->nodes));
      for (std::int32_t i = 0; i < count; ++i) {
        if (!take(element)) return;
        if (tags >= 2)
          groups.add(*known, element[1], element[2], {element.begin() + 1 + tags, element.end()});
      }
      read += static_cast<std::size_t>(count);
    }
    groups.require_alike();
  }
  template<class Numbers>
  bool take(Numbers& numbers) {
    return static_cast<bool>(file_.read(reinterpret_cast<char*>(numbers.data()),
                                        static_cast<std::streamsize>(numbers.size() * sizeof(numbers[0]))));
  }

  std::ifstream file_;
  std::string line_;
  bool binary_ = false;
};

} // namespace

void check_gmsh_file(const std::filesystem::path& path) { MeshFile(path).check(); }

} // namespace dielast::meshing
