// SPDX-License-Identifier: GPL-3.0-or-later
// Electrodes and chambers.
#include "cases/quantities/probing.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

std::vector<Key> electrode_keys() { return {electrode_key()}; }

std::string without_chamber(const Case& one, const Quantity&) {
  return one.chamber ? "" : "there is no chamber; add [chamber]";
}

Probe current(const Probing& probing) {
  const std::size_t e = probing.electrode();
  return [e, &ports = probing.device.model.ports](const Measured& measured) {
    const auto& circuit = ports[e].circuit;
    const fem::State& state = measured.state;
    if (!circuit || fem::is_isolated(state.supply[e])) return no_value;
    if (state.supply[e] == fem::Supply::circuit) return circuit->current(state.source[e], state.voltage[e]);
    return ports.leak(state, e); // without time
  };
}

Probe source_voltage(const Probing& probing) {
  const std::size_t e = probing.electrode();
  return [e, behind = probing.device.model.ports[e].circuit.has_value()](const Measured& measured) {
    const fem::State& state = measured.state;
    if (fem::is_isolated(state.supply[e])) return no_value;
    return behind ? state.source[e] : state.voltage[e];
  };
}

std::size_t chamber(const Probing& probing) { return probing.device.model.ports.chamber(); }

} // namespace

std::vector<QuantityKind> port_kinds() {
  return {
      {.word = "capacitance",
       .meaning = "of an electrode (F)",
       .unit = "F",
       .keys = electrode_keys,
       .in_words =
           [](const Quantity& q) { return fmt::format("capacitance of electrode {}{}", q.of, at_words(q)); },
       .probe = [](const Probing& probing) -> Probe {
         return [&model = probing.device.model, e = probing.electrode()](const Measured& measured) {
           return model.capacitance(measured.state, e);
         };
       }},
      {.word = "charge",
       .meaning = "of an electrode (C)",
       .unit = "C",
       .keys = electrode_keys,
       .in_words =
           [](const Quantity& q) { return fmt::format("charge on electrode {}{}", q.of, at_words(q)); },
       .probe = [](const Probing& probing) -> Probe {
         return [e = probing.electrode()](const Measured& measured) { return measured.charges.charge[e]; };
       }},
      {.word = "current",
       .meaning =
           "that the source of an electrode's [circuit] gives: without time what leaks; none where the "
           "electrode is isolated or its charge is given (A)",
       .unit = "A",
       .keys = electrode_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("current from the source of electrode {}{}", q.of, at_words(q));
           },
       .probe = current,
       .idle =
           [](const Case& one, const Quantity& q) {
             return std::string(one.circuits.contains(q.of)
                                    ? ""
                                    : "has no value here: the current is that through a [circuit], and there "
                                      "is none");
           }},
      {.word = "source voltage",
       .meaning =
           "that of an electrode's source, before its [circuit], as a wave or a [[controller]] asks for "
           "it; none where the electrode is isolated or its charge is given (V)",
       .unit = "V",
       .keys = electrode_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("voltage of the source of electrode {}{}", q.of, at_words(q));
           },
       .probe = source_voltage},
      {.word = "pressure",
       .meaning = "in the chamber (Pa)",
       .unit = "Pa",
       .in_words = [](const Quantity& q) { return fmt::format("pressure in the chamber{}", at_words(q)); },
       .probe = [](const Probing& probing) -> Probe {
         return [port = chamber(probing)](const Measured& measured) { return measured.state.voltage[port]; };
       },
       .refusal = without_chamber},
      {.word = "volume",
       .meaning = "of the chamber itself (m^3)",
       .unit = "m^3",
       .in_words = [](const Quantity& q) { return fmt::format("volume of the chamber{}", at_words(q)); },
       .probe = [](const Probing& probing) -> Probe {
         return [port = chamber(probing)](const Measured& measured) { return measured.charges.charge[port]; };
       },
       .refusal = without_chamber},
      {.word = "pumped volume",
       .meaning = "that was pumped into the chamber, as it is without pressure (m^3)",
       .unit = "m^3",
       .in_words =
           [](const Quantity& q) {
             return fmt::format("volume pumped into the chamber, as it is without pressure{}", at_words(q));
           },
       .probe = [](const Probing& probing) -> Probe {
         return [port = chamber(probing), &ports = probing.device.model.ports](const Measured& measured) {
           return ports[port].chamber->pumped(measured.charges.charge[port], measured.state.voltage[port]);
         };
       },
       .refusal = without_chamber},
  };
}

} // namespace dielast::cases
