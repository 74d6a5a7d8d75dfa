// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/resolved.hpp"

#include "cases/language/convert.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/text/tree.hpp"
#include "post/files/checkpoint_file.hpp"

#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace dielast::cases {

std::string geometry_name(const Part& part) {
  if (!part.has_mesh()) return "";
  for (const Section& section : case_schema().find_section("part")->sections)
    if (section.presence == Section::Presence::geometry && !section.access.entries(&part).empty())
      return section.name;
  return "file";
}

namespace {

void write_section(const Section& section, const void* object, const std::string& path, std::ostream& out) {
  const std::string selected = section.selector == "geometry"
                                   ? geometry_name(*static_cast<const Part*>(object))
                                   : section.selected_in(object);
  for (const Key& key : section.keys)
    if (key.applies_to(selected) && key.binding.get)
      if (const auto value = key.binding.get(object))
        fmt::print(out, "{} = {}\n", key.name, toml_text(key, *value));
  for (const Section& inner : section.sections) {
    if (inner.presence == Section::Presence::separate) continue;
    for (const Access::Entry& entry : inner.access.entries(object)) {
      std::string inner_path = joined(path, inner.name);
      if (!entry.name.empty()) inner_path = joined(inner_path, entry.name);
      fmt::print(out, "\n{}\n", inner.heading(inner_path));
      write_section(inner, entry.object, inner_path, out);
    }
  }
}

/// A branch by its relaxation time where that is what the fit keeps.
void write_what_branches_keep(Section& film, const Fit& fit) {
  Section& material = *std::ranges::find(film.sections, "material", &Section::name);
  Section& branch = *std::ranges::find(material.sections, "branch", &Section::name);
  const auto get = [&fit](bool viscosity) {
    return [&fit, viscosity](const void* object) -> std::optional<Value> {
      const auto& one = *static_cast<const materials::Branch*>(object);
      const auto b = static_cast<std::size_t>(&one - fit.film.material.branches.data());
      if (fit.keeps_viscosity[b] != viscosity) return std::nullopt;
      return Value{
          {viscosity ? one.viscosity : one.viscosity / materials::initial_shear_modulus(one.law), ""}};
    };
  };
  std::ranges::find(branch.keys, "relaxation_time", &Key::name)->binding.get = get(false);
  std::ranges::find(branch.keys, "viscosity", &Key::name)->binding.get = get(true);
}

std::string text_in(const std::filesystem::path& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return content.str();
}

void write_head(std::ostream& out) {
  fmt::print(out, "# every setting of this run, defaults included; written by dielast {}\n", DIELAST_VERSION);
}

void write_checksum(const std::string& key, const std::filesystem::path& file, std::ostream& out) {
  fmt::print(out, "# content of {}: checksum {:016x}\n", key, post::checksum(text_in(file)));
}

/// A comment for every file that a key "file" below `node` names: the case is also what stands in them.
void write_checksums(const Node& node, const std::string& path, std::ostream& out) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const Node& item = node.items[i];
    const std::string key = node.is(Node::Kind::list) ? fmt::format("{}[{}]", path, i + 1)
                            : path.empty()            ? node.keys[i]
                                                      : path + "." + node.keys[i];
    write_checksums(item, key, out);
    if (item.is(Node::Kind::text) && key.ends_with(".file") && std::filesystem::is_regular_file(item.text))
      write_checksum(key, item.text, out);
  }
}

/// Keys with their sections, and values, of a resolved text; a comment is taken for a key as well.
std::map<std::string, std::string> settings_of(const std::string& resolved) {
  std::map<std::string, std::string> settings;
  std::map<std::string, int> counts; // of sections in double brackets
  std::istringstream lines(resolved);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[[")) {
      const std::string name = line.substr(2, line.find(']') - 2);
      section = fmt::format("{}[{}].", name, ++counts[name]);
    } else if (line.starts_with('[')) {
      section = line.substr(1, line.find(']') - 1) + ".";
    } else if (line.starts_with("# ")) {
      const std::size_t end = std::min(line.find(": "), line.rfind(' '));
      settings[line.substr(2, end - 2)] = line.substr(line.find(' ', end) + 1);
    } else if (const std::size_t end = line.find(" = "); end != std::string::npos) {
      settings[section + line.substr(0, end)] = line.substr(end + 3);
    }
  }
  return settings;
}

} // namespace

std::string resolved_text(const Case& one) {
  std::ostringstream out;
  write_head(out);
  write_section(case_schema(), &one, "", out);
  fmt::print(out, "\n# standard quantities of this geometry:");
  for (const Quantity& quantity : one.quantities)
    if (quantity.standard) fmt::print(out, " {}", quantity.name);
  fmt::print(out, "\n");
  write_checksums(parse_tree(out.str(), "resolved.toml"), "", out);
  return out.str();
}

std::string resolved_text(const Fit& fit) {
  std::ostringstream out;
  write_head(out);
  Section schema = fit_schema();
  Section& film = *std::ranges::find(schema.sections, "film", &Section::name);
  film.keys.clear(); // only its material is read
  write_what_branches_keep(film, fit);
  write_section(schema, &fit, "", out);
  fmt::print(out, "\n");
  for (std::size_t t = 0; t < fit.tests.size(); ++t)
    write_checksum(fmt::format("test[{}].file", t + 1), fit.source.parent_path() / fit.tests[t].file, out);
  return out.str();
}

std::string resolved_changes(const std::string& before, const std::string& now) {
  if (before == now) return "";
  constexpr std::size_t most = 4;
  const auto was = settings_of(before), is = settings_of(now);
  std::vector<std::string> changes;
  for (const auto& [key, value] : is)
    if (const auto found = was.find(key); found != was.end() && found->second != value)
      changes.push_back(fmt::format("{} is {}, it was {}", key, value, found->second));
  for (const auto& [key, value] : is)
    if (!was.contains(key)) changes.push_back(fmt::format("{} is new: {}", key, value));
  for (const auto& [key, value] : was)
    if (!is.contains(key)) changes.push_back(fmt::format("{} is gone, it was {}", key, value));
  if (changes.empty()) return "resolved.toml is not as it was written";
  const std::string more = changes.size() > most ? fmt::format("; and {} more", changes.size() - most) : "";
  changes.resize(std::min(changes.size(), most));
  return fmt::format("{}{}", fmt::join(changes, "; "), more);
}

void require_unchanged(const std::filesystem::path& folder, const std::string& resolved) {
  const std::string before = text_in(folder / resolved_name);
  if (before.empty()) return;
  if (const std::string changes = resolved_changes(before, resolved); !changes.empty())
    throw FileError(fmt::format("{}: the case has changed since: {}; run it again without --resume",
                                folder.string(), changes));
}

} // namespace dielast::cases
