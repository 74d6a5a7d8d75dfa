// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/report_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::post {

namespace {

/// An estimate says nothing about digits that nobody reads.
constexpr double smallest_relative_error = 1e-6;

/// As far as it is shown.
double shown_error(const QuantityRow& row) {
  return std::max(std::abs(*row.error), smallest_relative_error * std::abs(row.value));
}

/// The error in the unit in which the value is shown, to the two digits that it deserves.
std::string error_text(const QuantityRow& row, const ScaledUnit& scaled) {
  if (!row.error) return row.error_remark.empty() ? "-" : row.error_remark;
  const double shown = shown_error(row);
  return (shown > std::abs(*row.error) ? "< " : "") + significant(shown * scaled.factor, 2);
}

/// The value to the digits that its error leaves.
std::string value_text(const QuantityRow& row, const ScaledUnit& scaled) {
  constexpr int fewest = 4, most = 8;
  int digits = fewest;
  if (row.error && shown_error(row) > 0)
    digits = static_cast<int>(
        std::clamp(std::log10(std::abs(row.value) / shown_error(row)) + 2, 1.0 * fewest, 1.0 * most));
  return significant(row.value * scaled.factor, digits);
}

constexpr std::size_t most_rows = 500;

std::string load_text(double load_factor) { return significant(load_factor, 3); }

} // namespace

std::string with_error(const QuantityRow& row) {
  if (!row.error || std::isnan(row.value))
    return engineering(row.value, row.unit, row.ratio) +
           (row.error_remark.empty() ? "" : fmt::format(" ({})", row.error_remark));
  const ScaledUnit scaled = scaled_unit(row.value, row.unit, row.ratio);
  return fmt::format("{} ± {}{}{}", value_text(row, scaled), error_text(row, scaled),
                     scaled.unit.empty() ? "" : " ", scaled.unit);
}

std::string error_note(const QuantityRow& row) {
  if (!row.error || std::isnan(row.value)) return "";
  const ScaledUnit scaled = scaled_unit(row.value, row.unit, row.ratio);
  return fmt::format("± {}{}{}", error_text(row, scaled), scaled.unit.empty() ? "" : " ", scaled.unit);
}

std::string peak_note(const QuantityRow& row) {
  if (!row.peak) return "";
  return fmt::format("peak {} at {}", engineering(row.peak->value, row.unit, row.ratio),
                     engineering(row.peak->time, "s"));
}

Table quantity_table(std::span<const QuantityRow> rows) {
  const bool peaks = std::ranges::any_of(rows, [](const QuantityRow& row) { return row.peak.has_value(); });
  Table table{{"Quantity", "Value", "Error", "Unit", "Meaning"}, {}};
  if (peaks) table.header.insert(table.header.end() - 1, "On the way");
  for (const QuantityRow& row : rows) {
    const ScaledUnit scaled = scaled_unit(row.value, row.unit, row.ratio);
    table.rows.push_back(
        {row.name, value_text(row, scaled), error_text(row, scaled), scaled.unit, row.meaning});
    if (peaks) table.rows.back().insert(table.rows.back().end() - 1, peak_note(row));
  }
  return table;
}

Table check_table(std::span<const CheckRow> rows) {
  Table table{{"", "Quantity", "Value", "Expected", "Tolerance", "Source"}, {}};
  for (const CheckRow& row : rows) {
    const auto shown = [&](double value, int digits) {
      return engineering(value, row.unit, row.ratio, digits);
    };
    table.rows.push_back({row.passed ? Cell{"✓ pass", Tone::good} : Cell{"✗ FAIL", Tone::bad}, row.quantity,
                          shown(row.value, 4), shown(row.expected, 4), shown(row.tolerance, 2), row.source});
  }
  return table;
}

Table event_table(std::span<const StepRecord> records) {
  Table table{{"Step", "Load", "Event", "Place", "What happened"}, {}};
  for (const StepRecord& record : records)
    for (const Event& event : record.events)
      table.rows.push_back({record.step,
                            load_text(event.before ? event.before->load_factor : record.load_factor),
                            {event.kind, Tone::warning},
                            event.place,
                            event.message});
  return table;
}

Table increment_table(std::span<const StepRecord> records) {
  Table table{{"#", "Step", "Load", "Voltage", "Iterations", "Residual", "Tangent"}, {}};
  const std::size_t every = 1 + records.size() / most_rows; // history.csv has them all
  for (std::size_t r = 0; r < records.size(); ++r) {
    const StepRecord& record = records[r];
    if (r % every != 0 && r + 1 != records.size()) continue;
    double voltage = 0;
    for (const double v : record.voltages)
      if (std::abs(v) > std::abs(voltage)) voltage = v;
    table.rows.push_back({fmt::to_string(record.index), record.step, load_text(record.load_factor),
                          engineering(voltage, "V"), fmt::to_string(record.iterations),
                          fmt::format("{:.1e}", record.residual),
                          record.unstable_modes == 0
                              ? Cell{"stable"}
                              : Cell{fmt::format("unstable ({})", record.unstable_modes), Tone::warning}});
  }
  return table;
}

} // namespace dielast::post
