// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/case_tree.hpp"

#include "cases/case/fastest_rate.hpp"
#include "cases/case/quantities.hpp"
#include "cases/language/section_reader.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/idle_keys.hpp"
#include "cases/readers/rules.hpp"
#include "cases/tables/patch.hpp"
#include "cases/tables/regions.hpp"
#include "cases/tables/templates.hpp"
#include "cases/text/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

template<class List, class Name>
std::vector<std::string> names_of(const List& list, Name name) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.*name);
  return names;
}

void require_known(SectionReader& reader, Reference kind, const std::string& noun,
                   const std::vector<std::string>& known) {
  for (const Mention& mention : reader.mentions(kind))
    // what a template brings can only miss something that the user is told about anyway
    if (mention.source.is_written() && std::find(known.begin(), known.end(), mention.name) == known.end())
      reader.report(mention.source, mention.key,
                    fmt::format("found {}: no such {}{}{}", toml_string(mention.name), noun,
                                known.empty() ? "; the case has none" : ", allowed " + listed(known),
                                did_you_mean(mention.name, known)));
}

/// Exactly one geometry must be given at the top of the file, with parts at most one.
void require_one_geometry(SectionReader& reader, const Node& tree) {
  std::vector<std::string> allowed;
  for (const Template& device : templates())
    if (device.with.empty())
      allowed.push_back(device.name == "file" ? "[mesh] file = \"...\"" : fmt::format("[{}]", device.name));
  const auto found = geometries_of(tree);
  if (found.empty() && !tree.find("part"))
    reader.report(tree.source, "",
                  fmt::format("there is no geometry; add one of {}", fmt::join(allowed, ", ")));
  else if (found.size() > 1)
    for (std::size_t i = 1; i < found.size(); ++i)
      reader.report(
          found[i]->key_source, "",
          fmt::format("there are {} geometries; keep one of {}", found.size(), fmt::join(allowed, ", ")));
}

/// Makes the path of a part's mesh file independent of the working directory.
void locate_mesh(SectionReader& reader, const Node& tree, const Case& one, Part& part) {
  auto* file = std::get_if<MeshFile>(&part.geometry);
  const Node* top = part.name.empty() ? &tree : tree.find("part")->find(part.name);
  const Node* mesh = top->find("mesh");
  const Node* written = file && mesh ? mesh->find("file") : nullptr;
  if (!written) return;
  const std::string name = file->path.string();
  file->path = std::filesystem::absolute(one.source.parent_path() / file->path).lexically_normal();
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file->path, failure))
    reader.report(
        written->source, part.name.empty() ? "mesh.file" : fmt::format("part.{}.mesh.file", part.name),
        fmt::format("found {}: no such file; the path starts at the case file's folder", toml_string(name)));
}

/// The body "bar" has the mass of [weight].
void hang_weight(SectionReader& reader, const Node& tree, Case& one) {
  if (!one.weight) return;
  const Node& written = *tree.find("weight");
  const auto bar = std::ranges::find(one.bodies, "bar", &Body::name);
  if (bar == one.bodies.end())
    reader.report(written.source, "weight",
                  "there is no body \"bar\" whose mass it would be: it hangs from a [strip]");
  else if (bar->mass > 0 && bar->mass != one.weight->mass)
    reader.report(written.source, "weight.mass", "given twice: the [[body]] \"bar\" has another mass");
  else
    bar->mass = one.weight->mass;
}

/// A quantity of the user's that has the name and the kind of a standard one takes its place. Returns how
/// many standard ones are left, in front of the user's.
int give_way(Node& tree, int standard) {
  Node* list = tree.find("quantity");
  if (!list || !list->is(Node::Kind::list)) return standard;
  const std::vector<Node> users(list->items.begin() + standard, list->items.end());
  const auto replaced = [&](const Node& own) {
    return std::ranges::any_of(users, [&](const Node& written) {
      return text_at(written, "name") == text_at(own, "name") &&
             text_at(written, "kind") == text_at(own, "kind");
    });
  };
  const auto left = std::remove_if(list->items.begin(), list->items.begin() + standard, replaced);
  list->items.erase(left, list->items.begin() + standard);
  return static_cast<int>(list->items.size() - users.size());
}

} // namespace

Case interpret(Node tree, const std::filesystem::path& path) {
  refuse_fit(tree);
  if (const Node* base = tree.find("case"))
    throw CaseError(
        {{base->key_source, "case", "this file is a study of another case: use `dielast study`"}});
  Case one;
  one.source = path;
  one.title = path.stem().string();
  add_inertia(tree);
  const int standard = give_way(tree, add_standard_quantities(tree));

  if (const std::string name = path.stem().string(); name.size() > longest_name)
    throw CaseError(
        {{tree.source, "",
          fmt::format("the file's name is too long: results are called after it, allowed {} letters",
                      longest_name)}});
  SectionReader reader(
      {geometry_of, path.parent_path(), [&] { return names_of(one.electrodes, &Electrode::name); },
       [&](const std::string& name) -> std::optional<std::string> {
         // where a kind was misspelt its unit, and that of means of it, are not known
         const bool all_known = std::ranges::all_of(one.quantities, &Quantity::kind);
         for (const Quantity& quantity : one.quantities)
           if (quantity.name == name && quantity.kind && (all_known || !quantity.kind->unit_by))
             return unit_of(quantity, one.quantities);
         return std::nullopt;
       }});
  require_one_geometry(reader, tree);
  reader.read_table(case_schema(), tree, &one, "");
  for (int i = 0; i < std::min<int>(standard, static_cast<int>(one.quantities.size())); ++i)
    one.quantities[static_cast<std::size_t>(i)].standard = true;
  add_patch_sides(one);
  hang_weight(reader, tree, one);
  add_pivot_support(one);
  for (Part& part : one.parts)
    if (part.mesh.rings == 0) part.mesh.rings = one.dimension == fem::Dimension::axisymmetric ? 64 : 24;
  if (one.solver.smallest_increment == 0) { // thin plates bend far under little
    const auto bends = [](const Film& film) { return film.section == FilmSection::shell || film.is_solid(); };
    one.solver.smallest_increment = one.any_film(bends) ? 1e-5 : 1e-3;
  }

  require_known(reader, Reference::electrode, "electrode", names_of(one.electrodes, &Electrode::name));
  require_known(reader, Reference::step, "step", names_of(one.steps, &Step::name));
  require_known(reader, Reference::quantity, "quantity", names_of(one.quantities, &Quantity::name));
  require_known(reader, Reference::body, "body", names_of(one.bodies, &Body::name));
  require_known(reader, Reference::fin, "fin", names_of(one.fins, &Fin::name));
  std::vector<std::string> supported = names_of(one.supports, &Support::place);
  for (const Body& body : one.bodies)
    if (body.pivot || std::ranges::count(body.fixed, true) > 0) supported.push_back(body.name);
  require_known(reader, Reference::supported_place, "supported place", supported);
  check_rules(reader, tree, one);
  tell_fastest_rate(one);
  for (Part& part : one.parts) locate_mesh(reader, tree, one, part);
  if (!reader.diagnostics().empty()) throw CaseError(reader.diagnostics());
  one.places = reader.mentions(Reference::place);
  one.keys = reader.keys();
  one.warnings = reader.warnings();
  for (Diagnostic& idle : idle_keys(tree, one)) one.warnings.push_back(std::move(idle));
  return one;
}

Node read_case_file(const std::filesystem::path& path) {
  Node tree = read_tree(path);
  add_defaults(tree);
  return tree;
}

void override_case(Node& tree, std::string_view key, std::string_view value, const Source& source) {
  apply_override(tree, key, value, source);
  add_defaults(tree);
}

void override_case(Node& tree, std::string_view assignment) {
  apply_override(tree, assignment);
  add_defaults(tree);
}

} // namespace dielast::cases
