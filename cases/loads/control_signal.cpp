// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/control_signal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::cases {
namespace {

/// Part of a step within which a time is that of a measurement: waves that turn as close to it share its
/// break.
constexpr double same_time = 4e-9;

class ControlSignal : public Signal {
 public:
  ControlSignal(const Case& one, const Controller& controller) : controller_(controller) {
    const auto found = std::ranges::find(one.quantities, controller.quantity, &Quantity::name);
    quantity_ = static_cast<std::size_t>(found - one.quantities.begin());
  }

  double at(Instant t) const override {
    const double last = (samples_ - 1) * controller_.every;
    const bool at_last = std::abs(t.t - last) <= close_;
    return (at_last ? t.before : t.t < last) ? before_ : held_;
  }

  std::vector<double> kinks(double duration) const override {
    std::vector<double> times;
    for (int k = 0; k * controller_.every < duration; ++k) times.push_back(k * controller_.every);
    return times;
  }

  void begin(double duration) override {
    if (samples_ > 0) since_ = std::max(0.0, duration_ - (samples_ - 1) * controller_.every);
    samples_ = 0;
    duration_ = duration;
    close_ = same_time * duration;
  }

  bool samples(double t) const override { return t >= samples_ * controller_.every - close_; }

  std::string sample(double t, const Waveform* said, const Measured& measured,
                     const Measurement& measurement) override {
    const double lack = controller_.target - measurement.value(quantity_, measured);
    if (!std::isfinite(lack))
      return fmt::format("quantity \"{}\", which a controller measures, has no value", controller_.quantity);
    integral_ += rate_ * (samples_ > 0 ? controller_.every : since_);
    const double base = said ? said->at(t) : 0;
    const double wanted = base + controller_.gain * lack + controller_.integral_gain * integral_;
    before_ = std::exchange(held_, std::clamp(wanted, controller_.lowest, controller_.highest));
    // At a limit the integral stays, unless it leads away from there.
    const double push = controller_.integral_gain * lack;
    const bool pushes_on =
        (wanted > controller_.highest && push > 0) || (wanted < controller_.lowest && push < 0);
    rate_ = pushes_on ? 0 : lack;
    ++samples_;
    return "";
  }

  std::vector<double> memory() const override {
    return {static_cast<double>(samples_), duration_, close_, held_, before_, integral_, rate_, since_};
  }
  void recall(const std::vector<double>& memory) override {
    samples_ = static_cast<int>(memory.at(0));
    duration_ = memory.at(1), close_ = memory.at(2);
    held_ = memory.at(3), before_ = memory.at(4);
    integral_ = memory.at(5), rate_ = memory.at(6), since_ = memory.at(7);
  }

 private:
  const Controller& controller_;
  std::size_t quantity_ = 0;
  int samples_ = 0;              ///< in this step
  double duration_ = 0;          ///< of this step, s
  double close_ = 0;             ///< times as close as this are one, s
  double held_ = 0, before_ = 0; ///< since the last measurement, and until then
  double integral_ = 0;          ///< of what the quantity lacks, s times its unit
  double rate_ = 0;              ///< of the integral, from the last measurement on
  double since_ = 0;             ///< from that to the beginning of this step, s
};

} // namespace

std::unique_ptr<Signal> control_signal(const Case& one, const Controller& controller) {
  return std::make_unique<ControlSignal>(one, controller);
}

} // namespace dielast::cases
