// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"
#include "cases/tables/bar_keys.hpp"
#include "cases/tables/templates.hpp"

#include <span>
#include <vector>

namespace dielast::cases {

/// A geometry in the case language: what its section says, which keys of [mesh] it has, and what it brings.
struct GeometryKind {
  Section section; ///< its name alone: a user's own mesh
  std::vector<Key> mesh_keys;
  std::vector<Template> templates;
};

std::span<const GeometryKind> geometry_kinds();

template<class M>
Binding mesh_option(M MeshOptions::*option) {
  return to_part<Part>([option](auto& part) -> auto& { return part.mesh.*option; });
}

// --- keys of [mesh] that several have
Key order_key();
Key wall_elements_key();
Key rings_key();
Key across_key(std::string meaning, int largest, std::string fallback);
Key grading_key(std::string meaning, std::string fallback);
Key quadrature_key(std::string fallback);

GeometryKind rectangle_geometry();

Section honeycomb_section();
Section disc_section();
Section annulus_section();
Section balloon_section();
Section patch_section();
Section strip_section();
Section roll_section();
Section slab_section();
Section hollow_sphere_section();

std::vector<Template> honeycomb_templates();
std::vector<Template> disc_templates();
std::vector<Template> annulus_templates();
std::vector<Template> balloon_templates();
std::vector<Template> patch_templates();
std::vector<Template> strip_templates();
std::vector<Template> roll_templates();
std::vector<Template> slab_templates();
std::vector<Template> hollow_sphere_templates();
std::vector<Template> line_templates();
std::vector<Template> antagonistic_rolls_templates();
std::vector<Template> file_templates();

} // namespace dielast::cases
