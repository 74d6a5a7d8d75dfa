// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/schema.hpp"
#include "cases/text/units.hpp"

namespace dielast::cases {

Section wave_section(std::string_view unit) {
  const auto level = [unit](std::string name, double Waveform::*part, std::string meaning) {
    return measure(std::move(name), unit, to(part), std::move(meaning));
  };
  const auto time = [](std::string name, double Waveform::*part, std::string meaning) {
    return measure(std::move(name), "s", to(part), std::move(meaning));
  };
  const auto frequency = [](std::string name, double Waveform::*part, std::string meaning) {
    return measure(std::move(name), "Hz", to(part), std::move(meaning)).above(0);
  };
  const std::string zero = format_measure(0, unit);

  Section section;
  section.name = "wave";
  section.meaning =
      "how a quantity goes with the time t from the start of a step of kind \"transient\"; ramps "
      "lead to its value at t = 0, where it jumps there to the one before the jump";
  section.selector = "wave";
  section.keys = {
      word(
          "wave",
          {{"constant", "does not change", Waveform::Kind::constant},
           {"ramp", "straight from one value to another", Waveform::Kind::ramp},
           {"step", "jumps from one value to another", Waveform::Kind::step},
           {"trapezoid", "rises, stays and falls back, once or again and again", Waveform::Kind::trapezoid},
           {"sine", "mean + amplitude sin(2 pi frequency t + phase)", Waveform::Kind::sine},
           {"unipolar sine", "from + amplitude/2 (1 - cos(2 pi frequency t))", Waveform::Kind::unipolar_sine},
           {"square", "jumps to and fro", Waveform::Kind::square},
           {"sweep",
            "a sine whose frequency grows or falls steadily, and after `duration` stays at `end_frequency`",
            Waveform::Kind::sweep},
           {"file", "straight between the rows of a CSV file", Waveform::Kind::file}},
          to(&Waveform::kind), "its form"),
      level("from", &Waveform::from, "value before it, and where it returns to")
          .otherwise(zero)
          .only({"ramp", "step", "trapezoid", "unipolar sine", "square"}),
      level("to", &Waveform::to, "value that it reaches")
          .only({"constant", "ramp", "step", "trapezoid", "square"}),
      level("mean", &Waveform::mean, "value about which it swings").otherwise(zero).only({"sine", "sweep"}),
      level("amplitude", &Waveform::amplitude,
            "of a sine or sweep from the mean, of a unipolar sine from trough to peak")
          .only({"sine", "unipolar sine", "sweep"}),
      frequency("frequency", &Waveform::frequency, "cycles per time; of a sweep at its start")
          .only({"sine", "unipolar sine", "square", "sweep"}),
      frequency("end_frequency", &Waveform::end_frequency,
                "frequency that the sweep reaches after its duration, and keeps")
          .only({"sweep"}),
      measure("phase", "rad", to(&Waveform::phase), "phase at t = 0").otherwise("0 deg").only({"sine"}),
      time("at", &Waveform::start, "time at which it begins")
          .at_least(0)
          .otherwise("0 s")
          .only({"ramp", "step", "trapezoid"}),
      time("duration", &Waveform::duration, "time that it takes").above(0).only({"ramp", "sweep"}),
      time("rise", &Waveform::rise, "time of the rise").at_least(0).otherwise("0 s").only({"trapezoid"}),
      time("hold", &Waveform::hold, "time at the value reached").above(0).only({"trapezoid"}),
      time("fall", &Waveform::fall, "time of the fall").at_least(0).otherwise("0 s").only({"trapezoid"}),
      time("period", &Waveform::repeat, "time after which it begins again; 0 s: it happens once")
          .at_least(0)
          .otherwise("0 s")
          .only({"trapezoid"}),
      number("duty", to(&Waveform::duty), "part of the period at the value reached")
          .above(0)
          .below(1)
          .otherwise("0.5")
          .only({"square"}),
      text("file", to(&Waveform::file), "CSV file with the columns time_s and one more, beside the case file")
          .only({"file"}),
      text("column", to(&Waveform::column), "column of the file; its end is a unit, as in \"voltage_kV\"")
          .optional()
          .only({"file"}),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& wave = *static_cast<const Waveform*>(object);
    constexpr double round_off = 1e-9;
    if (wave.repeat > 0 && wave.repeat < (1 - round_off) * (wave.rise + wave.hold + wave.fall))
      return Conflict{"period", "must not be below rise + hold + fall"};
    return std::nullopt;
  };
  return section;
}

} // namespace dielast::cases
