// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/tables/patch.hpp"

#include "cases/tables/templates.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

void hold(Case& one, const std::string& place, std::size_t axis, std::optional<Waveform> motion = {}) {
  Support support{.place = place, .standard = true};
  support.fixed[axis] = true;
  support.motion[axis] = std::move(motion);
  one.supports.push_back(std::move(support));
}

/// The side that moves along an axis, of a patch that is turned (sign -1) or is not (1). With the stretch
/// lambda it moves by (lambda - lambda_p) length from where the prestretched film is drawn; the nominal
/// stress s is the dead force s H across.
void drive_side(Case& one, const Film& film, double sign, const std::string& place, std::size_t axis,
                double length, double across, const std::optional<Waveform>& stretch,
                const std::optional<Waveform>& stress) {
  if (stretch) hold(one, place, axis, stretch->affine(sign * length, -sign * film.prestretch[axis] * length));
  if (!stress) return;
  Load load{.place = place, .standard = true};
  load.force[axis] = stress->affine(sign * film.thickness * across, 0);
  one.loads.push_back(std::move(load));
}

void add_sides(Case& one, const Part& part, const Patch& patch) {
  const bool alike = patch.mode == PatchMode::equal_biaxial;
  const double sign = std::cos(part.turned) < 0 ? -1 : 1;
  hold(one, part.called("left"), 0);
  hold(one, part.called("bottom"), 1);
  if (one.dimension == fem::Dimension::spatial) hold(one, part.called("film"), 2);
  if (patch.mode == PatchMode::pure_shear) hold(one, part.called("top"), 1);
  drive_side(one, *part.film, sign, part.called("right"), 0, patch.length, patch.width, patch.stretch_x,
             patch.stress_x);
  drive_side(one, *part.film, sign, part.called("top"), 1, patch.width, patch.length,
             alike ? patch.stretch_x : patch.stretch_y, alike ? patch.stress_x : patch.stress_y);
}

} // namespace

void add_patch_sides(Case& one) {
  for (const Part& part : one.parts)
    if (const auto* patch = std::get_if<Patch>(&part.geometry); patch && part.film)
      add_sides(one, part, *patch);
}

std::string step_before_voltages(const Node& tree) {
  std::string before;
  const Node* steps = tree.find("step");
  for (std::size_t s = 0; steps && steps->is(Node::Kind::list) && s < steps->items.size(); ++s) {
    const Node& step = steps->items[s];
    const std::string kind = text_at(step, "kind");
    if (kind == "voltage" || kind == "charge" || kind == "transient") return before;
    if (kind != "modes" && kind != "harmonic") before = step.find("name") ? text_at(step, "name") : kind;
  }
  return "";
}

void add_solid_defaults(Node& tree) {
  const Source source{tree.source.file, 0, 0};
  const bool sphere = tree.find("hollow_sphere"), slab_on_top = tree.find("slab");
  const auto complete = [&](Node& part) { // which may be a place of what stands at the top
    Node* film = part.is(Node::Kind::table) ? part.find("film") : nullptr;
    const bool of_sphere = sphere || part.find("hollow_sphere");
    if (!film || !film->is(Node::Kind::table) || !(of_sphere || slab_on_top || part.find("slab"))) return;
    if (!film->find("section")) film->add("section", parse_value("\"solid\"", source));
    if (of_sphere && !film->find("field")) film->add("field", parse_value("\"potential\"", source));
    const Node* slab = part.find("slab");
    if (!slab || !slab->is(Node::Kind::table) || !slab->find("width")) return;
    if (!tree.find("model")) tree.add("model", parse_value("\"3d\"", source));
    if (!part.find("mesh")) part.add("mesh", Node{.kind = Node::Kind::table, .source = source});
    if (Node* mesh = part.find("mesh"); mesh->is(Node::Kind::table) && !mesh->find("across"))
      mesh->add("across", parse_value("4", source)); // in space there are many more elements
  };
  complete(tree);
  const Node* model = tree.find("model");
  if (Node* supports = tree.find("support");
      sphere && model && model->is(Node::Kind::text) && model->text == "3d" && supports &&
      supports->is(Node::Kind::list) && std::ranges::none_of(supports->items, [](const Node& support) {
        return support.source.is_written();
      })) // the planes that part an eighth from the others
    for (const char* support :
         {"{ place = \"side_x\", fix = [\"x\"] }", "{ place = \"side_y\", fix = [\"y\"] }"})
      supports->items.push_back(parse_value(support, source));
  if (Node* parts = tree.find("part"))
    for (Node& part : parts->items) complete(part);
}

} // namespace dielast::cases
