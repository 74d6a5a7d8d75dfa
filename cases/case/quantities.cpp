// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"

namespace dielast::cases {

std::string unit_of(const Quantity& quantity, const std::vector<Quantity>& all) {
  return quantity.kind->unit_by ? quantity.kind->unit_by(quantity, all) : quantity.kind->unit;
}

std::string meaning_of(const Quantity& quantity) { return quantity.kind->in_words(quantity); }

const Quantity* response_quantity(const Case& one, const std::string& name) {
  for (const QuantityKind& kind : quantity_kinds())
    for (const Quantity& quantity : one.quantities)
      if (kind.gradient && quantity.kind == &kind && (quantity.along || !kind.directed) &&
          (name.empty() || quantity.name == name))
        return &quantity;
  return nullptr;
}

std::string response_kinds(const std::string& directed) {
  std::vector<std::string> words;
  for (const QuantityKind& kind : quantity_kinds())
    if (kind.gradient) words.push_back("\"" + kind.word + "\"" + (kind.directed ? directed : ""));
  std::string all = words.front();
  for (std::size_t i = 1; i < words.size(); ++i) all += (i + 1 < words.size() ? ", " : " or ") + words[i];
  return all;
}

std::string voltage_name(const Case& one, std::size_t electrode) {
  return one.electrodes.size() == 1 ? "voltage" : "voltage_" + one.electrodes[electrode].name;
}

std::vector<post::Column> history_columns(const Case& one) {
  std::vector<post::Column> columns{{"load_factor", "1"}, {"time", "s"}};
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) columns.push_back({voltage_name(one, e), "V"});
  for (const Quantity& quantity : one.quantities)
    columns.push_back({quantity.name, unit_of(quantity, one.quantities)});
  for (const char* solver : {"iterations", "residual", "unstable_modes", "jumped"})
    columns.push_back({solver, "1"});
  return columns;
}

} // namespace dielast::cases
