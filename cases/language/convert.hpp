// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"
#include "cases/text/tree.hpp"

#include <functional>
#include <string>

namespace dielast::cases {

/// A value does not fit its key: what a diagnostic says, and the value (perhaps one item of a list) to blame.
struct Mismatch {
  std::string message;
  Source source;
};

/// Reads a table that says how a quantity goes with time.
using WaveReader = std::function<Waveform(const Node& table)>;

/// The value of `key` in SI. `unit` is the SI unit of the measure: the key's, or that of the quantity of a
/// check. Throws Mismatch.
Value convert(const Key& key, const Node& node, std::string_view unit, const WaveReader& read_wave = {});

/// What to tell of a number without a unit that is far from what devices have in SI, as if another were
/// meant: "3 without a unit is 3 V". "": nothing.
std::string doubt_of_unit(const Key& key, const Node& node);

/// Throws Mismatch where a wave has values that the key does not allow.
void require_range(const Key& key, const Waveform& wave, const Node& table);

/// Whether a text is a name: at most longest_name letters, digits, _ and -.
bool is_name(std::string_view text);

/// The inverse: TOML text of a value, in SI units.
std::string toml_text(const Key& key, const Value& value);

/// What may be written: `a length such as "1 mm"`, `one of "x", "y"`, `a list of 2: ...`.
std::string expectation(const Key& key, std::string_view unit);

/// `above 0 mm and at most 100 mm`, in `shown`, a unit of the same kind; "" without a range.
std::string range_text(const Key& key, const std::string& shown);

} // namespace dielast::cases
