// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/bodies.hpp"
#include "cases/case/controller.hpp"
#include "cases/case/part.hpp"
#include "cases/case/quantity_kind.hpp"
#include "cases/text/diagnostics.hpp"
#include "cases/text/waveform.hpp"
#include "fem/model/dofs.hpp"
#include "post/reductions.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// [[tie]]: the nodes that two places have at the same points become one
struct TiedPlaces {
  std::array<std::string, 2> between;
};

/// [[electrode]]
struct Electrode {
  std::string name;
  std::string place;
  std::string layer{};                    ///< the [[film.layer]] that it charges; empty: the film
  std::optional<double> sheet_resistance; ///< of both faces together, Ohm per square
  std::string terminal;                   ///< where a resistive one is connected
  double stray_capacitance = 0;           ///< beside the film's, of what leads to it, F
  std::string ground; ///< of a solid with a potential: the surface that lies opposite `place`
};

/// [[support]]
struct Support {
  std::string place;
  std::array<bool, 6> fixed{};                     ///< displacements along x, y, z, rotations about them
  std::array<std::optional<Waveform>, 3> motion{}; ///< displacement of fixed directions, m; absent: none
  std::string from{}, until{}; ///< the first and the last step in which it holds; empty: the case's
  bool standard = false;       ///< brought by the geometry, not written by the user

  bool moves() const { return motion[0] || motion[1] || motion[2]; }
  /// One or two of them.
  bool holds_some_rotations() const {
    const int held = fixed[3] + fixed[4] + fixed[5];
    return held == 1 || held == 2;
  }
};

/// [[load]]: a dead force spread evenly over a place as drawn, or a moment over those that can turn
struct Load {
  std::string place;
  std::array<Waveform, 3> force{};                 ///< N
  std::optional<std::array<Waveform, 3>> moment{}; ///< about axes that stay, N m; instead of a force

  /// The component along x, y, z (0..2) or about them (3..5); null where there is none.
  const Waveform* component(int c) const {
    const auto i = static_cast<std::size_t>(c % 3);
    if (c < 3) return moment ? nullptr : &force[i];
    return moment ? &(*moment)[i] : nullptr;
  }
  bool standard = false; ///< brought by the geometry, not written by the user
};

/// [drive]: what the source of an electrode does; different steps may use the one and the other
struct Drive {
  std::optional<Waveform> voltage; ///< V
  std::optional<Waveform> charge;  ///< C

  bool operator==(const Drive&) const = default;
};

/// [circuit]: what is between an electrode and its source while time passes
struct Circuit {
  double resistance = 0;                    ///< Ohm
  std::optional<double> leakage_resistance; ///< through the film of the whole electrode, Ohm
  std::optional<double> current_limit;      ///< of the source, A

  bool operator==(const Circuit&) const = default;
};

/// [chamber]: what is under the film and the plate, up to z = 0
struct Chamber {
  std::optional<Waveform> pressure; ///< Pa
  std::optional<Waveform> volume;   ///< that is pumped in, m^3
  double bulk_modulus = 0;          ///< of what fills it, Pa
  std::string place;                ///< the surface of a solid on which it presses; empty: the film
};

/// [contact]: what touches is kept apart by a barrier that sets in before it does
struct Contact {
  double thickness = 0;               ///< of the barrier: the gap at which it sets in, m
  std::vector<std::string> between{}; ///< surfaces of solids, each kept apart from each other
  double friction = 0;                ///< Coulomb's coefficient between these
};

/// [table]: a rigid plane on which a surface of a solid lies, and from which it may lift
struct Table {
  std::string place;   ///< the surface
  double friction = 0; ///< Coulomb's coefficient
};

/// [[spring]]: a linear spring between the centroids of two places, tension stiffness (distance -
/// free_length)
struct Spring {
  std::array<std::string, 2> between;
  int along = 0;          ///< 0, 1, 2 = x, y, z
  double stiffness = 0;   ///< N/m
  double free_length = 0; ///< distance of the centroids along the axis at which it is free, m
};

/// [[linkage]]: a weight P at the arm b of a triangle whose other sides are the strut a and l = distance +
/// offset: it pulls two places apart by P (b^2 + l^2 - a^2) / (2 b l) (law of cosines; rolled muscle)
struct Linkage {
  std::array<std::string, 2> between;
  int along = 0;     ///< 0, 1, 2 = x, y, z
  double force = 0;  ///< P, N
  double arm = 0;    ///< b, m
  double strut = 0;  ///< a, m
  double offset = 0; ///< m
};

/// A ramp leads from where the device is to the values that waves have at t = 0; `transient` follows the
/// waves from t = 0 on; in `hold` time passes and everything stays.
/// In `relax` everything stays, too, for as long as anything flows, and no time passes.
/// `modes` and `harmonic` ask for small vibrations about where the device is, and leave it there.
enum class StepKind {
  release,
  voltage,
  charge,
  force,
  move,
  weight,
  pressure,
  inflate,
  transient,
  hold,
  relax,
  modes,
  harmonic
};

/// What the branches do during a ramp that takes no time.
enum class Response {
  relaxed,       ///< they have all the time they need
  instantaneous, ///< they have none
};

/// What the electrodes keep when neither voltage nor charge is ramped: connected or isolated.
enum class Control { voltage, charge };

enum class OnInstability {
  stop,   ///< the step ends at a limit point
  follow, ///< along the path past it, by arclength
  jump,   ///< lands on the next stable state
};

enum class OnBifurcation { follow, switch_branch };

/// Frequencies at equal ratios
struct Sweep {
  double from = 0, to = 0; ///< Hz
  int points = 0;
  std::vector<double> at{}; ///< Hz, instead
};

/// A run's table, and behind "<case>-" its series of critical points: no analysis may take these names.
inline constexpr std::string_view history_name = "history", critical_name = "critical";

/// [[step]]
struct Step {
  StepKind kind{};
  std::string name;           ///< default: its kind
  std::optional<double> to{}; ///< where a ramp of voltage (V), charge (C), pressure (Pa) or volume (m^3)
                              ///< leads, instead of to what [drive] or [chamber] say; see also part()
  std::string electrode{};    ///< the only one that a ramp of voltage or charge is about; empty: all
  int increments = 1;
  std::optional<double> duration{}; ///< s; absent: a ramp that takes no time
  Response response{};              ///< without a duration
  std::optional<double> record{};   ///< s: history has rows only at its multiples; absent: at every increment
  std::vector<double> stops{};      ///< load factors at which rows are wanted instead, ascending; of no key
  Control control{};                ///< of steps that ramp neither voltage nor charge
  bool inertia = false;             ///< of transient and hold: what has a mass resists acceleration
  OnInstability on_instability{};
  OnBifurcation on_bifurcation{};
  int count = 0; ///< of modes
  Sweep sweep{}; ///< of harmonic
  std::string
      response_of{}; ///< of harmonic: a quantity of kind displacement; empty: the first with a direction
  std::vector<std::string> driven{}; ///< of harmonic: electrodes whose sources swing; empty: see driven_ports

  bool is_analysis() const { return kind == StepKind::modes || kind == StepKind::harmonic; }
  /// Of what such a step, `force` or `move`, could ramp to.
  double part(StepKind ramp) const { return kind == ramp ? to.value_or(1) : 1; }
  /// Whether it finds dashpots that have not let go.
  bool moves_dashpots() const { return duration || (!is_analysis() && response == Response::instantaneous); }
};

/// Where gravity pulls, as a direction of a quantity.
constexpr int along_gravity = 3;

/// [[quantity]]: a number of the state, in every row of history.csv and in summary.json
struct Quantity {
  std::string name;
  const QuantityKind* kind = nullptr; ///< says which of these it has, and of what it is
  std::array<std::string, 2> between; ///< two places (their centroids)
  std::string of;                     ///< a place, an electrode, a body, a fin, a field, another quantity ...
  std::optional<int> along;           ///< 0, 1, 2 = x, y, z, 3 = gravity (-z); absent: magnitude
  std::string place;                  ///< over which it is the mean, or where it pulls
  std::optional<std::array<double, 3>> point; ///< instead of a place, as drawn, m
  double length = 0;                          ///< of an electrode, m
  int mode = 1;                               ///< of vibrations, its number, from the lowest
  post::Extreme extreme{};
  std::string at;        ///< the step at whose end summary.json reads it; empty: the last
  std::string since;     ///< the step at whose end it is zero or begins; empty: the mesh as drawn, or the run
  bool standard = false; ///< brought by the geometry's template, not written by the user
};

/// What a profile shows.
enum class ProfileKind : std::uint8_t { displacement, contact_pressure };

/// [[profile]]: how the nodes of a place have moved, or what presses on them
struct Profile {
  std::string name;
  ProfileKind kind{};
  std::string of;      ///< the place
  int along = 0;       ///< 0, 1, 2 = x, y, z
  std::string since{}; ///< the step at whose end it is zero; empty: the mesh as drawn
};
/// Of its file, without the ending.
inline std::string profile_name(const Profile& profile) { return "profile_" + profile.name; }

/// [[check]]
struct Check {
  std::string quantity;
  double value = 0;
  double tolerance =
      0; ///< absolute, in the quantity's unit (a "1 %" in the file is made absolute by the reader)
  std::string source;
};

/// [solver]
struct SolverOptions {
  double tolerance = 0;          ///< |R_free| over the reaction scale
  int max_iterations = 0;        ///< Newton iterations before a cutback
  double smallest_increment = 0; ///< load factor below which a step gives up
  double time_tolerance = 0;     ///< relative local error of the branches in a time step
};

/// [[linearise.compare]]: a transfer function to compare with, numerator / denominator in powers of s, the
/// highest first, from V to the unit of the output
struct TransferFunction {
  std::string name;
  std::vector<double> numerator, denominator;
};

/// [linearise]: the linear model that `dielast linearise` makes about the state at the end of the steps
struct Linearise {
  int order = 0;
  std::string output;              ///< a quantity of kind displacement; empty: the first with a direction
  Sweep sweep;                     ///< over which it is compared with the full response
  std::vector<std::string> driven; ///< electrodes whose sources swing together; empty: see driven_ports
  std::vector<TransferFunction> compare;
};

/// Everything the user asked for: validated, complete, in SI. No type of the file format gets past the
/// reader.
struct Case {
  std::string title;
  std::filesystem::path source; ///< the case file
  fem::Dimension dimension{};
  std::vector<Part> parts; ///< the unnamed one first, if there is one
  std::vector<TiedPlaces> ties;
  std::vector<Electrode> electrodes;
  std::vector<Support> supports;
  std::vector<std::string> places_of_spins; ///< where supports that do not hold now hold some rotations
  bool pinned = true;                       ///< against rigid motion, where nothing holds it; see Holding
  std::vector<Load> loads;
  std::map<std::string, Drive> drives;     ///< by the electrode's name
  std::map<std::string, Circuit> circuits; ///< likewise
  std::vector<Controller> controllers;
  std::optional<Plate> plate;
  std::vector<PointMass> point_masses;
  std::vector<Body> bodies;
  std::vector<Fin> fins;
  std::optional<HungWeight> weight{};
  std::optional<Pivot> pivot;
  Gravity gravity;
  std::optional<Chamber> chamber;
  std::optional<Contact> contact;
  std::optional<Table> table;
  std::vector<Spring> springs;
  std::vector<Linkage> linkages;
  std::vector<Step> steps;
  std::vector<Quantity> quantities; ///< the template's and the user's
  std::vector<Profile> profiles;
  std::vector<Check> checks;
  int skipped_checks = 0; ///< checks of another device than this one: the file's, before an override
  SolverOptions solver;
  std::optional<Linearise> linearise{};
  bool error_estimate = true;  ///< [output] error_estimate: solve again with other elements and steps
  bool fields = true;          ///< [output] fields: write the VTK series
  double margins_up_to = 1;    ///< [output] margins_up_to: factor on the voltages, 1: what the run knows
  bool all_states = true;      ///< [output] states: of every row, not only the last of each step
  std::vector<Mention> places; ///< every place that the case names, for check_places
  std::map<std::string, Source> keys; ///< where they stand, by path, for what only the device can tell
  std::vector<Diagnostic> warnings{};

  /// What stands at the top of the file; null: everything is in named parts.
  const Part* unnamed() const {
    return parts.empty() || !parts.front().name.empty() ? nullptr : &parts.front();
  }
  /// The only geometry of that kind, of the unnamed part; null: it has another, or there is none.
  template<class T>
  const T* geometry() const {
    return unnamed() ? std::get_if<T>(&unnamed()->geometry) : nullptr;
  }
  /// Whether a film of the case is such.
  template<class Rule>
  bool any_film(const Rule& rule) const {
    return std::ranges::any_of(parts, [&](const Part& part) { return part.film && rule(*part.film); });
  }
  /// Of all films and the layers on them.
  std::vector<const materials::Material*> film_materials() const {
    std::vector<const materials::Material*> all;
    for (const Part& part : parts) {
      if (!part.film) continue;
      all.push_back(&part.film->material);
      for (const Layer& layer : part.film->further_layers) all.push_back(&layer.material);
    }
    return all;
  }
  /// Whether a part's geometry is of that kind.
  template<class T>
  bool any_geometry() const {
    return std::ranges::any_of(parts,
                               [](const Part& part) { return std::holds_alternative<T>(part.geometry); });
  }

  /// Whether contact is looked for at this place: a surface, or what lies on the [table].
  bool may_touch(const std::string& place) const {
    return (contact && std::ranges::count(contact->between, place) > 0) || (table && table->place == place);
  }

  /// Where the key of this path stands, or the file as a whole.
  Source where(const std::string& key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? Source{source.string()} : found->second;
  }
  /// What is wrong with a key's value, where that stands.
  Diagnostic told_at(const std::string& key, std::string message, Severity severity = Severity::error) const {
    return {where(key), key, std::move(message), severity};
  }
  CaseError error_at(const std::string& key, std::string message) const {
    return CaseError({told_at(key, std::move(message))});
  }
  std::string warning_at(const std::string& key, std::string message) const {
    return told_at(key, std::move(message), Severity::warning).text();
  }
};

} // namespace dielast::cases
