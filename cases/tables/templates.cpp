// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/tables/templates.hpp"

#include "cases/language/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace dielast::cases {
namespace {

/// Of every device, and of those with a chamber.
constexpr std::string_view quantities_of_all = R"(
[[quantity]]
name = "max_field"
kind = "extreme"
of = "electric_field"
extreme = "maximum"
[[quantity]]
name = "breakdown_ratio"
kind = "extreme"
of = "breakdown_ratio"
extreme = "maximum"
[[quantity]]
name = "min_principal_stress"
kind = "extreme"
of = "min_principal_stress"
extreme = "minimum"
[[quantity]]
name = "electrical_work"
kind = "energy"
of = "electrical_work"
[[quantity]]
name = "mechanical_work"
kind = "energy"
of = "mechanical_work"
[[quantity]]
name = "stored_energy"
kind = "energy"
of = "stored"
[[quantity]]
name = "dissipated_energy"
kind = "energy"
of = "dissipated"
[[quantity]]
name = "energy_error"
kind = "energy"
of = "error"
)";

constexpr std::string_view chamber_quantities = R"(
[[quantity]]
name = "pressure"
kind = "pressure"
[[quantity]]
name = "volume"
kind = "volume"
)";

Node parse_default(std::string_view toml, const Node& tree) {
  Node parsed = parse_tree(toml, "");
  // They carry the file's name but no line: the user did not write them.
  parsed.relocate({tree.source.file, 0, 0});
  return parsed;
}

std::string text_at(const Node& table, std::string_view key) {
  const Node* node = table.find(key);
  return node && node->is(Node::Kind::text) ? node->text : "";
}

Node text_node(std::string text, const Source& source) {
  Node node;
  node.kind = Node::Kind::text;
  node.text = std::move(text);
  node.source = node.key_source = source;
  return node;
}

/// Items of a list at the top of the tree.
std::vector<Node> items_of(const Node& tree, std::string_view key) {
  const Node* node = tree.find(key);
  return node && node->is(Node::Kind::list) ? node->items : std::vector<Node>{};
}

/// Name of the first step of that kind; empty when there is none.
std::string name_of_step(const Node& tree, const std::string& kind) {
  for (const Node& step : items_of(tree, "step"))
    if (text_at(step, "kind") == kind) return step.find("name") ? text_at(step, "name") : kind;
  return "";
}

/// A quantity of the electrode, or one for each of several: "charge", or "charge_<electrode>".
std::vector<Node> of_each_electrode(const Node& tree, const std::string& kind, const Source& source) {
  std::vector<Node> quantities;
  std::set<std::string> seen; // a second electrode of the same name is reported elsewhere
  const auto electrodes = items_of(tree, "electrode");
  for (const Node& electrode : electrodes) {
    const std::string name = text_at(electrode, "name");
    Node quantity;
    quantity.source = source;
    quantity.add("name", text_node(electrodes.size() > 1 ? kind + "_" + name : kind, source));
    quantity.add("kind", text_node(kind, source));
    quantity.add("of", text_node(name, source));
    if (!name.empty() && seen.insert(name).second) quantities.push_back(std::move(quantity));
  }
  return quantities;
}

bool is_wave(const Node& node) { return node.find("wave") || std::ranges::any_of(node.items, is_wave); }

/// Kinds of the steps that a patch takes: one for whatever is given, in this order.
std::vector<std::string> patch_steps(const Node& tree) {
  const Node none;
  const Node* const patch = tree.find("patch") ? tree.find("patch") : &none;
  const Node* const drive = tree.find("drive") ? tree.find("drive") : &none;
  if (is_wave(*patch) || is_wave(*drive)) return {"transient"};
  std::vector<std::string> kinds;
  if (patch->find("stretch_x") || patch->find("stretch_y")) kinds.emplace_back("move");
  if (patch->find("stress_x") || patch->find("stress_y")) kinds.emplace_back("force");
  if (drive->find("charge")) kinds.emplace_back("charge");
  if (drive->find("voltage") || kinds.empty()) kinds.emplace_back("voltage");
  return kinds;
}

/// Adds the default steps of a patch; to default steps those that an override has made necessary.
void add_patch_steps(Node& tree) {
  const Source source{tree.source.file, 0, 0};
  Node* steps = tree.find("step");
  if (!steps) {
    Node list;
    list.kind = Node::Kind::list;
    list.source = source;
    steps = &tree.add("step", list);
  }
  const bool written = steps->source.line > 0 || steps->source.file.text() != source.file.text();
  if (written) return;
  for (const std::string& kind : patch_steps(tree)) {
    const bool known =
        std::ranges::any_of(steps->items, [&](const Node& s) { return text_at(s, "kind") == kind; });
    if (known) continue;
    Node step;
    step.source = source;
    step.add("kind", text_node(kind, source));
    steps->items.push_back(std::move(step));
  }
}

} // namespace

std::vector<const Node*> geometries_of(const Node& tree) {
  std::vector<const Node*> found;
  for (const Section& section : case_schema().sections)
    if (const Node* node = tree.find(section.name); node && section.presence == Section::Presence::geometry)
      found.push_back(node);
  const Node* mesh = tree.find("mesh");
  if (const Node* file = mesh ? mesh->find("file") : nullptr) found.push_back(file);
  return found;
}

const Template* template_of(const Node& tree) {
  for (const Template& candidate : templates())
    if (tree.find(candidate.name) && (candidate.with.empty() || tree.find(candidate.with))) return &candidate;
  const Node* mesh = tree.find("mesh");
  return mesh && mesh->find("file") ? &templates().back() : nullptr;
}

namespace {

/// A film of revolution is what a plate, a chamber or a balloon asks for, and inertia what a mass does.
void add_motion_defaults(Node& tree) {
  const Source source{tree.source.file, 0, 0};
  if (!tree.find("model") && (tree.find("plate") || tree.find("chamber") || tree.find("balloon")))
    tree.add("model", text_node("axisymmetric", source));
  Node* steps = tree.find("step");
  if (!(tree.find("plate") || tree.find("point_mass") || tree.find("body")) || !steps ||
      !steps->is(Node::Kind::list))
    return;
  for (Node& step : steps->items)
    if (const std::string kind = text_at(step, "kind");
        (kind == "transient" || kind == "hold") && !step.find("inertia"))
      step.add("inertia", parse_value("true", source));
}

} // namespace

void add_defaults(Node& tree, const Template& device) {
  const Node defaults = parse_default(device.defaults, tree);
  for (std::size_t i = 0; i < defaults.items.size(); ++i)
    if (!tree.find(defaults.keys[i])) tree.add(defaults.keys[i], defaults.items[i]);
  if (device.name == "patch") add_patch_steps(tree);
  add_motion_defaults(tree);
}

namespace {

std::string standard_text(const Node& tree, const Template& device) {
  return fmt::format("{}{}{}", device.quantities, tree.find("chamber") ? chamber_quantities : "",
                     quantities_of_all);
}

} // namespace

int add_standard_quantities(Node& tree, const Template& device) {
  if (const Node* written = tree.find("quantity"); written && !written->is(Node::Kind::list)) return 0;
  const Source source{tree.source.file, 0, 0};
  std::vector<Node> standard;
  for (Node quantity : items_of(parse_default(standard_text(tree, device), tree), "quantity")) {
    if (quantity.find("at") && name_of_step(tree, text_at(quantity, "at")).empty()) continue;
    for (const char* key : {"at", "since"})
      if (Node* step = quantity.find(key)) step->text = name_of_step(tree, step->text);
    if (text_at(quantity, "since").empty()) quantity.remove("since");
    standard.push_back(std::move(quantity));
  }
  for (Node& quantity : of_each_electrode(tree, "capacitance", source))
    standard.push_back(std::move(quantity));
  if (device.name == "patch")
    for (Node& quantity : of_each_electrode(tree, "charge", source)) standard.push_back(std::move(quantity));

  Node* quantities = tree.find("quantity");
  if (!quantities) {
    Node list;
    list.kind = Node::Kind::list;
    list.source = source;
    quantities = &tree.add("quantity", list);
  }
  quantities->items.insert(quantities->items.begin(), standard.begin(), standard.end());
  return static_cast<int>(standard.size());
}

} // namespace dielast::cases
