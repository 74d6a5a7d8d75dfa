// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/tables/templates.hpp"

#include "cases/language/convert.hpp"
#include "cases/language/schema.hpp"
#include "cases/language/turned_quantities.hpp"
#include "cases/text/overrides.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace dielast::cases {
namespace {

/// Of every device, of those with beams, and of those with a chamber.
constexpr std::string_view extremes_of_all = R"(
  { name = "max_field", kind = "extreme", of = "electric_field", extreme = "maximum" },
  { name = "breakdown_ratio", kind = "extreme", of = "breakdown_ratio", extreme = "maximum" },
  { name = "min_principal_stress", kind = "extreme", of = "min_principal_stress", extreme = "minimum" },
)";

constexpr std::string_view energies_of_all = R"(
  { name = "electrical_work", kind = "energy", of = "electrical_work" },
  { name = "mechanical_work", kind = "energy", of = "mechanical_work" },
  { name = "stored_energy", kind = "energy", of = "stored" },
  { name = "dissipated_energy", kind = "energy", of = "dissipated" },
  { name = "energy_error", kind = "energy", of = "error" }
)";

constexpr std::string_view yield_quantities = R"(
  { name = "yield_ratio", kind = "extreme", of = "yield_ratio", extreme = "maximum" },
)";

constexpr std::string_view chamber_quantities = R"(
  { name = "pressure", kind = "pressure" },
  { name = "volume", kind = "volume" },
)";

Node parse_default(std::string_view toml, const Node& tree) {
  Node parsed = parse_tree(toml, "");
  // They carry the file's name but no line: the user did not write them.
  parsed.relocate({tree.source.file, 0, 0});
  return parsed;
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

/// Whether the drive of all electrodes, or of one ([drive.NAME]), has the key.
bool drives(const Node& drive, const char* key) {
  return drive.find(key) || std::ranges::any_of(drive.items, [&](const Node& one) { return one.find(key); });
}

/// Kinds of the steps that a patch takes: one for whatever is given, in this order.
std::vector<std::string> patch_steps(const Node& tree) {
  const Node none;
  const Node* const patch = tree.find("patch") ? tree.find("patch") : &none;
  const Node* const drive = tree.find("drive") ? tree.find("drive") : &none;
  if (is_wave(*patch) || is_wave(*drive)) return {"transient"};
  std::vector<std::string> kinds;
  if (patch->find("stretch_x") || patch->find("stretch_y")) kinds.emplace_back("move");
  if (patch->find("stress_x") || patch->find("stress_y")) kinds.emplace_back("force");
  if (drives(*drive, "charge")) kinds.emplace_back("charge");
  if (drives(*drive, "voltage") || kinds.empty()) kinds.emplace_back("voltage");
  return kinds;
}

/// The list at the top of the tree; one that nobody wrote where there is none.
Node& list_at(Node& tree, const std::string& key) {
  if (Node* list = tree.find(key)) return *list;
  Node list;
  list.kind = Node::Kind::list;
  list.source = {tree.source.file, 0, 0};
  return tree.add(key, std::move(list));
}

/// Adds the default steps of a patch.
void add_patch_steps(Node& tree) {
  const Source source{tree.source.file, 0, 0};
  Node& steps = list_at(tree, "step");
  if (steps.source.is_written()) return;
  for (const std::string& kind : patch_steps(tree)) {
    Node step;
    step.source = source;
    step.add("kind", text_node(kind, source));
    steps.items.push_back(std::move(step));
  }
}

/// Each region is an electrode of its name where the user has written none.
void add_region_electrodes(Node& tree) {
  std::vector<std::string> names;
  if (const Node* sectors = tree.find("sectors")) {
    const Node* count = sectors->find("count");
    const double many =
        count && (count->is(Node::Kind::integer) || count->is(Node::Kind::number)) ? count->number : 4;
    for (int k = 0; k < std::clamp(many, 0.0, 26.0); ++k) names.emplace_back(1, static_cast<char>('a' + k));
  }
  for (const Node& region : items_of(tree, "region")) // a second one of the name is reported elsewhere
    if (const std::string name = text_at(region, "name"); !name.empty() && !std::ranges::count(names, name))
      names.push_back(name);
  if (names.empty() || list_at(tree, "electrode").source.is_written()) return;
  std::vector<Node>& electrodes = list_at(tree, "electrode").items;
  electrodes.clear();
  for (const std::string& name : names)
    electrodes.push_back(parse_default(fmt::format("name = {0}\nplace = {0}", toml_string(name)), tree));
}

} // namespace

std::vector<const Node*> geometries_of(const Node& table) {
  std::vector<const Node*> found;
  for (const Section& section : case_schema().sections)
    if (const Node* node = table.find(section.name); node && section.presence == Section::Presence::geometry)
      found.push_back(node);
  const Node* mesh = table.find("mesh");
  if (const Node* file = mesh ? mesh->find("file") : nullptr) found.push_back(file);
  return found;
}

const Template* template_of(const Node& table) {
  for (const Template& candidate : templates())
    if (table.find(candidate.name) && (candidate.with.empty() || table.find(candidate.with)))
      return &candidate;
  const Node* mesh = table.find("mesh");
  return mesh && mesh->find("file") ? &templates().back() : nullptr;
}

std::string geometry_of(const Node& table) {
  return geometries_of(table).size() == 1 ? std::string(template_of(table)->name) : "";
}

namespace {

bool is_heavy(const Node& body) try {
  const Node* mass = body.find("mass");
  return mass && (mass->is(Node::Kind::text) ? split_measure(mass->text).number : mass->number) != 0;
} catch (const UnitError&) {
  return false; // reported where it is read
}

/// A film of revolution is what a balloon asks for, and a plate or a chamber where the geometry can be one.
void add_model(Node& tree) {
  const Source source{tree.source.file, 0, 0};
  const auto any = [&](std::initializer_list<const char*> names) {
    return std::ranges::any_of(names, [&](const char* name) { return tree.find(name) != nullptr; });
  };
  if (!tree.find("model") && tree.find("pivot")) tree.add("model", text_node("3d", source));
  const bool is_flat = any({"strip", "rectangle", "honeycomb", "patch"});
  if (!tree.find("model") &&
      (any({"balloon", "roll", "hollow_sphere"}) || (!is_flat && any({"plate", "chamber"}))))
    tree.add("model", text_node("axisymmetric", source));
}

/// A strip hangs along -y, and so does its own weight.
void add_gravity_of_strip(Node& tree) {
  if (!tree.find("strip")) return;
  const Node hangs = parse_default("direction = [0, -1, 0]\nfilm = true", tree);
  Node* gravity = tree.find("gravity");
  if (!gravity) gravity = &tree.add("gravity", Node{.kind = Node::Kind::table, .source = hangs.source});
  for (std::size_t i = 0; gravity->is(Node::Kind::table) && i < hangs.items.size(); ++i)
    if (!gravity->find(hangs.keys[i])) gravity->add(hangs.keys[i], hangs.items[i]);
}

/// The coupling of a strip is that of its electrode, if there is one.
void complete_coupling(std::vector<Node>& standard, const Node& tree) {
  const Node* strip = tree.find("strip");
  const Node* length = strip ? strip->find("electrode_length") : nullptr;
  if (strip && !length) length = strip->find("length");
  std::string electrode;
  for (const Node& candidate : items_of(tree, "electrode"))
    if (text_at(candidate, "place") == "electrode") electrode = text_at(candidate, "name");
  std::erase_if(standard, [&](const Node& quantity) {
    return text_at(quantity, "kind") == "coupling" && (!length || electrode.empty());
  });
  for (Node& quantity : standard)
    if (text_at(quantity, "kind") == "coupling") {
      quantity.add("of", text_node(electrode, quantity.source));
      Node copy = *length;
      copy.relocate(quantity.source);
      quantity.add("length", std::move(copy));
    }
}

/// A part with a geometry of its own.
struct TemplatePart {
  std::string name;
  const Template* device;
};

std::vector<TemplatePart> parts_with_geometry(const Node& tree) {
  std::vector<TemplatePart> found;
  const Node* parts = tree.find("part");
  for (std::size_t i = 0; parts && parts->is(Node::Kind::table) && i < parts->items.size(); ++i)
    if (const Template* device = parts->items[i].is(Node::Kind::table) && is_name(parts->keys[i])
                                     ? template_of(parts->items[i])
                                     : nullptr;
        device && !device->alone)
      found.push_back({parts->keys[i], device});
  return found;
}

bool may_yield(const Node& tree) {
  const auto brings = [](const Node& table) {
    const Node* cable = table.find("cable"); // without a yield strain no limit is known
    return table.find("honeycomb") || table.find("beam") || table.find("antagonistic_rolls") ||
           (cable && cable->find("yield_strain"));
  };
  const Node* parts = tree.find("part");
  return brings(tree) || (parts && std::ranges::any_of(parts->items, brings));
}

/// Puts the part's name in front of a place.
void prefix(Node* place, const std::string& part) {
  if (!place) return;
  if (place->is(Node::Kind::text)) place->text = part + "." + place->text;
  for (Node& item : place->items) prefix(&item, part);
}

/// Whether a table's film resists bending.
bool is_of_shell(const Node& top) {
  return top.find("film") && text_at(*top.find("film"), "section") == "shell";
}

/// An edge that a template clamps does not turn either where the film is a shell.
void clamp_shell(Node& defaults, const Node& top) {
  if (Node* supports = defaults.find("support"); supports && is_of_shell(top))
    for (Node& support : supports->items)
      for (const char* turn : {"turn_x", "turn_y", "turn_z"})
        support.find("fix")->items.push_back(text_node(turn, support.source));
}

/// Adds a part's electrode or supports to those of the case.
void add_part_defaults(Node& tree, const std::string& key, const TemplatePart& part) {
  Node defaults = parse_default(part.device->defaults, tree);
  clamp_shell(defaults, *tree.find("part")->find(part.name));
  const Node* brought = defaults.find(key);
  if (!brought) return;
  for (Node item : brought->items) {
    for (const char* of : {"place", "ground"}) prefix(item.find(of), part.name);
    if (Node* name = item.find("name")) name->text = part.name;
    list_at(tree, key).items.push_back(std::move(item));
  }
}

/// Standard quantities that no template brings.
std::vector<Node> quantities_beside(const Node& tree) {
  const std::string text =
      fmt::format("quantity = [{}{}{}{}]", tree.find("chamber") ? chamber_quantities : "", extremes_of_all,
                  may_yield(tree) ? yield_quantities : "", energies_of_all);
  return items_of(parse_default(text, tree), "quantity");
}

/// Standard quantities of a template; those of a part are about its places. Extremes are of the whole case.
std::vector<Node> template_quantities(const Node& tree, const Template& device, const std::string& part) {
  std::vector<Node> quantities;
  for (Node quantity : items_of(parse_default(device.quantities, tree), "quantity")) {
    if (!part.empty()) {
      const std::string kind = text_at(quantity, "kind");
      if (kind == "extreme" || kind == "natural frequency") continue;
      quantity.find("name")->text = part + "_" + text_at(quantity, "name");
      prefix(quantity.find("between"), part);
      prefix(quantity.find("of"), part);
    }
    if (const Node* pivot = tree.find("pivot"); pivot && device.with == "pivot")
      if (const std::string body = text_at(*pivot, "body"); !body.empty()) quantity.find("of")->text = body;
    quantities.push_back(std::move(quantity));
  }
  if (!part.empty()) turn_standard_quantities(quantities, *tree.find("part")->find(part));
  return quantities;
}

} // namespace

void add_defaults(Node& tree) {
  const Source source{tree.source.file, 0, 0};
  const Node before = take_brought(tree); // overrides may have made another device of it
  const std::array keys{"electrode", "support"};
  std::array<bool, 2> written{};
  for (std::size_t k = 0; k < keys.size(); ++k) written[k] = tree.find(keys[k]);
  if (const Template* device = template_of(tree)) {
    Node defaults = parse_default(device->defaults, tree);
    clamp_shell(defaults, tree);
    for (std::size_t i = 0; i < defaults.items.size(); ++i)
      if (!tree.find(defaults.keys[i])) tree.add(defaults.keys[i], defaults.items[i]);
    if (device->name == "patch") add_patch_steps(tree);
    add_region_electrodes(tree);
  }
  const std::vector<TemplatePart> parts = parts_with_geometry(tree);
  for (const TemplatePart& part : parts)
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (!written[k]) add_part_defaults(tree, keys[k], part);
  if (!parts.empty() && !tree.find("step")) tree.add("step", parse_value("[{ kind = \"voltage\" }]", source));
  add_gravity_of_strip(tree);
  add_solid_defaults(tree);
  add_model(tree);
  for (std::size_t i = 0; i < before.items.size(); ++i)
    if (is_changed(before.items[i])) {
      Node& list = list_at(tree, before.keys[i]);
      list = with_changes(list, before.items[i]);
    }
}

void add_inertia(Node& tree) {
  Node* steps = tree.find("step");
  const Node* weight = tree.find("weight");
  const bool moving = tree.find("plate") || tree.find("point_mass") || tree.find("fin") ||
                      (weight && is_heavy(*weight)) || std::ranges::any_of(items_of(tree, "body"), is_heavy);
  if (!moving || !steps || !steps->is(Node::Kind::list)) return;
  for (Node& step : steps->items)
    if (const std::string kind = text_at(step, "kind");
        (kind == "transient" || kind == "hold") && !step.find("inertia"))
      step.add("inertia", parse_value("true", {tree.source.file, 0, 0}));
}

std::vector<Node> standard_quantities(const Node& tree, const Template* device) {
  const Source source{tree.source.file, 0, 0};
  const std::vector<TemplatePart> parts = parts_with_geometry(tree);
  std::vector<Node> standard;
  if (device) standard = template_quantities(tree, *device, "");
  for (const TemplatePart& part : parts)
    for (Node& quantity : template_quantities(tree, *part.device, part.name))
      standard.push_back(std::move(quantity));
  if (device || !parts.empty())
    for (Node& quantity : quantities_beside(tree)) standard.push_back(std::move(quantity));
  std::erase_if(standard, [&](const Node& quantity) {
    return (quantity.find("at") && name_of_step(tree, text_at(quantity, "at")).empty()) ||
           (is_of_shell(tree) && text_at(quantity, "kind") == "radial stretch") || // which membranes have
           // The edge of an electrode in the middle, which regions take the place of.
           (text_at(quantity, "of") == "electrode_edge" && (tree.find("region") || tree.find("sectors")));
  });
  complete_coupling(standard, tree);
  for (Node& quantity : standard) {
    for (const char* key : {"at", "since"})
      if (Node* step = quantity.find(key)) step->text = name_of_step(tree, step->text);
    if (Node* since = quantity.find("since"); since && since->text.empty())
      since->text = step_before_voltages(tree);
    if (text_at(quantity, "since").empty()) quantity.remove("since");
  }
  const bool patch =
      (device && device->name == "patch") ||
      std::ranges::any_of(parts, [](const TemplatePart& part) { return part.device->name == "patch"; });
  for (Node& quantity : of_each_electrode(tree, "capacitance", source))
    standard.push_back(std::move(quantity));
  if (patch)
    for (Node& quantity : of_each_electrode(tree, "charge", source)) standard.push_back(std::move(quantity));
  return standard;
}

int add_standard_quantities(Node& tree) {
  if (const Node* written = tree.find("quantity"); written && !written->is(Node::Kind::list)) return 0;
  const std::vector<Node> standard = standard_quantities(tree, template_of(tree));
  if (standard.empty()) return 0;
  std::vector<Node>& quantities = list_at(tree, "quantity").items;
  quantities.insert(quantities.begin(), standard.begin(), standard.end());
  return static_cast<int>(standard.size());
}

} // namespace dielast::cases
