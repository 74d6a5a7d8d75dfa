// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/engineering.hpp"
#include "post/pictures/report.hpp"
#include "post/step_record.hpp"

#include <optional>
#include <span>
#include <string>

namespace dielast::post {

/// A number of the run as the summary shows it.
struct QuantityRow {
  std::string name;
  double value = 0; ///< SI; NaN where it could not be had
  std::string unit;
  Ratio ratio = Ratio::plain;  ///< percent for strains
  std::optional<double> error; ///< estimated discretisation error, in the quantity's unit
  std::string meaning;
  std::string error_remark{}; ///< why there is no error; may be empty
  std::optional<Peak> peak{}; ///< of a run in time, where it is not the value at its end
};

/// A check of the case file and what came out.
struct CheckRow {
  std::string quantity;
  double value = 0, expected = 0, tolerance = 0; ///< SI; tolerance absolute
  std::string unit;
  Ratio ratio = Ratio::plain;
  std::string source;
  bool passed = false;
};

/// A value in engineering units, with its error in the same ones: "33.19 ± 0.05 %".
std::string with_error(const QuantityRow& row);

/// Its error alone, as with_error() says it: "± 0.05 %"; empty where there is none.
std::string error_note(const QuantityRow& row);

/// Its peak: "peak 16.9 MV/m at 0.95 s"; empty where there is none.
std::string peak_note(const QuantityRow& row);

Table quantity_table(std::span<const QuantityRow> rows);
Table check_table(std::span<const CheckRow> rows);

/// The events of all steps, in order; no rows when nothing happened.
Table event_table(std::span<const StepRecord> records);

/// One row per accepted increment: step, load factor, largest voltage, iterations, residual, and whether the
/// tangent is stable or how many unstable modes it has.
Table increment_table(std::span<const StepRecord> records);

} // namespace dielast::post
