// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace dielast::cases {

/// A kind of quantity that a case file can hold.
struct Dimension {
  std::string_view unit;    ///< SI, as udunits spells it
  std::string_view noun;    ///< with its article: "a length"
  std::string_view example; ///< "1 mm"
  double largest;           ///< beyond this (SI) no actuator of this world can be meant
  std::string_view shown;   ///< unit in which a person reads it
  std::string_view usual;   ///< units that people write, separated by blanks
};

std::span<const Dimension> dimensions();

/// The dimension whose SI unit is `unit`; throws std::logic_error when the table has none.
const Dimension& dimension(std::string_view unit);

/// A text is not a quantity of the expected dimension; what() continues "found ..." and names the reason.
class UnitError : public std::runtime_error {
 public:
  explicit UnitError(const std::string& reason, std::string unknown_unit = {})
      : std::runtime_error(reason), unknown_unit_(std::move(unknown_unit)) {}
  /// The unit that does not exist; empty when something else is wrong.
  const std::string& unknown_unit() const { return unknown_unit_; }

 private:
  std::string unknown_unit_;
};

/// A quantity as written.
struct WrittenMeasure {
  double number = 0;
  std::string unit; ///< empty for a pure number
};

/// "70 deg" -> 70 and "deg", whatever the unit. Throws UnitError: no finite number in front.
WrittenMeasure split_measure(std::string_view text);

struct Measure {
  double value = 0; ///< SI
  std::string unit; ///< as written; empty for a pure number
};

/// "0.8 mm" -> 0.0008 (for unit "m"). Independent of the locale. Throws UnitError: no number, not finite,
/// unknown unit, another dimension, or an offset or logarithmic unit.
Measure parse_measure(std::string_view text, std::string_view si_unit);

/// Shortest text that parse_measure reads back to exactly `value`; angles in degrees when that is exact.
std::string format_measure(double value, std::string_view si_unit);

/// `value` (SI) in the unit that a user wrote, to 6 digits, for messages: "1000 mm".
std::string in_unit(double value, const std::string& unit, std::string_view si_unit);

/// What units are products of.
inline constexpr std::array<std::string_view, 5> base_units{"kg", "m", "s", "A", "rad"};
using BasePowers = std::array<double, base_units.size()>;

/// A unit as a number of base units.
struct SiUnit {
  double factor = 1;
  BasePowers powers{};
};

/// Of any unit of these, "" is the pure number. Throws UnitError.
SiUnit si_unit(const std::string& unit);

/// The SI unit that has these powers, as the table of dimensions writes it where it has one; "" of a pure
/// number.
std::string name_of_unit(const BasePowers& powers);

/// A value as it stands in TOML as a number in its own unit: "75 deg", quoted, is 75 in "deg". Nothing for
/// lists and words.
std::optional<WrittenMeasure> written_measure(const std::string& toml);

} // namespace dielast::cases
