// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/beam_section.hpp"
#include "materials/material.hpp"

#include <span>
#include <string_view>

namespace dielast::materials {

/// A film material that a case file can name.
struct NamedFilm {
  std::string_view name;
  Material material;
  std::string_view source;   ///< where the numbers come from
  std::string_view validity; ///< what they are good for
};

/// A wall or frame material that a case file can name.
struct NamedSolid {
  std::string_view name;
  ElasticSolid solid;
  std::string_view source;
  std::string_view validity;
};

std::span<const NamedFilm> named_films();
std::span<const NamedSolid> named_solids();

} // namespace dielast::materials
