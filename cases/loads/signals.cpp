// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/signals.hpp"

#include "cases/loads/control_signal.hpp"

namespace dielast::cases {
namespace {

class WaveSignal : public Signal {
 public:
  explicit WaveSignal(const Waveform& wave) : wave_(wave) {}
  double at(Instant t) const override { return t.of(wave_); }
  std::vector<double> kinks(double duration) const override { return wave_.kinks(0, duration); }

 private:
  const Waveform& wave_;
};

std::unique_ptr<Signal> signal_of(const Electrode& electrode, const Case& one) {
  const auto drive = one.drives.find(electrode.name);
  const Waveform* wave =
      drive != one.drives.end() && drive->second.voltage ? &*drive->second.voltage : nullptr;
  for (const Controller& controller : one.controllers)
    if (controller.electrode == electrode.name) return control_signal(one, controller, wave);
  return wave ? std::make_unique<WaveSignal>(*wave) : nullptr;
}

} // namespace

Signals signals_of(const Case& one) {
  Signals signals;
  for (const Electrode& electrode : one.electrodes) signals.push_back(signal_of(electrode, one));
  return signals;
}

} // namespace dielast::cases
