// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"
#include "fem/paths/load_path.hpp"
#include "fem/paths/ramp.hpp"

#include <string>

namespace dielast::cases {

/// The loads of a state at s of a path, as a person would name them: of voltages, pressures, charges and
/// volumes that which has changed by the largest part of itself since the beginning, in a timed step since
/// the moment before it; of those that have changed alike the first.
std::string load_text(const fem::Model& model, const fem::LoadPath& path, const fem::State& at, double s,
                      bool timed);

/// Why a step is stopped at load factor s that would hardly come to its end, and what helps.
std::string endless_text(const std::string& step, double s, const fem::RampOptions& options);

} // namespace dielast::cases
