// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/signals.hpp"

#include "cases/loads/control_signal.hpp"

namespace dielast::cases {

const Waveform* said_of(const Case& one, const DrivenLoad& load) {
  const auto there = [](const std::optional<Waveform>& wave) { return wave ? &*wave : nullptr; };
  const auto along = static_cast<std::size_t>(load.along);
  switch (load.what) {
  case Driven::voltage:
    if (const auto drive = one.drives.find(load.of); drive != one.drives.end())
      return there(drive->second.voltage);
    return nullptr;
  case Driven::pressure:
    return there(one.chamber->pressure);
  case Driven::volume:
    return there(one.chamber->volume);
  case Driven::force:
    for (const Load& own : one.loads)
      if (own.place == load.of && !own.moment) return &own.force[along];
    return nullptr;
  case Driven::displacement:
    for (const Support& own : one.supports)
      if (own.place == load.of && own.fixed[along] && own.motion[along]) return &*own.motion[along];
    return nullptr;
  }
  return nullptr;
}

Signals signals_of(const Case& one) {
  Signals signals;
  for (const Controller& controller : one.controllers)
    signals[controller.drives] = control_signal(one, controller);
  return signals;
}

} // namespace dielast::cases
