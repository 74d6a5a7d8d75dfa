// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/sheet.hpp"

#include <algorithm>
#include <stdexcept>

namespace dielast::fem {

SheetMap::SheetMap(const std::vector<Sheet>& sheets) {
  for (const Sheet& sheet : sheets) {
    if (!(sheet.resistance > 0)) throw std::invalid_argument("a sheet resistance must be positive");
    if (!sheets_.emplace(sheet.electrode, &sheet).second)
      throw std::invalid_argument("an electrode has one sheet resistance");
  }
}

int SheetMap::claim(int electrode, int node) {
  const auto sheet = sheets_.find(electrode);
  if (sheet == sheets_.end()) return none;
  const auto [place, is_new] = numbers_.try_emplace({electrode, node}, static_cast<int>(points_.size()));
  if (is_new) {
    const auto& terminal = sheet->second->terminal;
    points_.push_back({.electrode = electrode,
                       .node = node,
                       .at_terminal = std::ranges::find(terminal, node) != terminal.end(),
                       .resistance = sheet->second->resistance});
  }
  return place->second;
}

} // namespace dielast::fem
