#include "cases/resolved.hpp"

#include "cases/convert.hpp"

#include <fmt/ostream.h>

#include <sstream>

namespace dielast::cases {
namespace {

std::string geometry_name(const Case& one) {
  for (const Section& section : case_schema().sections)
    if (section.presence == Section::Presence::geometry && !section.access.entries(&one).empty())
      return section.name;
  return "file";
}

void write_section(const Section& section, const void* object, const std::string& path,
                   const std::string& geometry, std::ostream& out) {
  const std::string selected = section.selector == "geometry" ? geometry : section.selected_in(object);
  for (const Key& key : section.keys)
    if (key.applies_to(selected) && key.binding.get)
      if (const auto value = key.binding.get(object))
        fmt::print(out, "{} = {}\n", key.name, toml_text(key, *value));
  for (const Section& inner : section.sections) {
    if (inner.presence == Section::Presence::separate) continue;
    for (const Access::Entry& entry : inner.access.entries(object)) {
      const std::string inner_path =
          (path.empty() ? "" : path + ".") + inner.name + (entry.name.empty() ? "" : "." + entry.name);
      fmt::print(out, "\n{}\n", inner.heading(inner_path));
      write_section(inner, entry.object, inner_path, geometry, out);
    }
  }
}

} // namespace

void write_resolved(const Case& one, std::ostream& out) {
  fmt::print(out, "# every setting of this run, defaults included; written by dielast {}\n", DIELAST_VERSION);
  write_section(case_schema(), &one, "", geometry_name(one), out);
  fmt::print(out, "\n# standard quantities of this geometry:");
  for (const Quantity& quantity : one.quantities)
    if (quantity.standard) fmt::print(out, " {}", quantity.name);
  fmt::print(out, "\n");
}

std::string resolved_text(const Case& one) {
  std::ostringstream text;
  write_resolved(one, text);
  return text.str();
}

} // namespace dielast::cases
