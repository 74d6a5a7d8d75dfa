// SPDX-License-Identifier: GPL-3.0-or-later
// What follows a drive or a wave, and how finely.
#include "cases/readers/rules.hpp"

#include "cases/case/holding.hpp"
#include "cases/case/sudden_motion.hpp"
#include "cases/language/conditions.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

namespace dielast::cases {
namespace {

bool drives_charge(const WrittenWave& written) {
  return written.key.starts_with("drive") && written.key.ends_with(".charge");
}

/// Whether the step is a transient that follows the wave: of voltage and charge only the one that it
/// controls.
bool follows(const Step& step, const WrittenWave& written) {
  if (step.kind != StepKind::transient) return false;
  return !written.key.starts_with("drive") || drives_charge(written) == (step.control == Control::charge);
}

/// Longest time that a step follows the wave, s.
double followed_time(const Case& one, const WrittenWave& written) {
  double longest = 0;
  for (const Step& step : one.steps)
    if (follows(step, written)) longest = std::max(longest, *step.duration);
  return longest;
}

constexpr double fewest_steps = 4, telling_steps = 20; ///< of a period

/// A wave whose peaks are no kinks, at which time steps end.
bool is_smooth(const Waveform& wave) {
  using enum Waveform::Kind;
  return wave.kind == sine || wave.kind == unipolar_sine || wave.kind == sweep;
}

/// How far below its amplitude a sine is, %, half a time step beside its peak.
double missed(double steps) { return 100 * (1 - std::cos(std::numbers::pi / steps)); }

/// Where a support's motion along an axis is written, or the section of what has brought it.
std::pair<std::string, Source> place_of_motion(const SectionReader& reader, const Node& tree, const Case& one,
                                               std::size_t support, std::size_t axis) {
  const std::string key = one.supports[support].standard
                              ? one.pivot ? "pivot" : "patch"
                              : fmt::format("support[{}].displacement.{}", support + 1, "xyz"[axis]);
  const auto written = reader.keys().find(key);
  const Node* section = tree.find(key);
  return {key, written != reader.keys().end() ? written->second : section ? section->source : tree.source};
}

/// A support is moved by steps in which it holds.
void check_motions_held(SectionReader& reader, const Node& tree, const Case& one) {
  for (std::size_t i = 0; i < one.supports.size(); ++i) {
    const Support& support = one.supports[i];
    if (support.from.empty() && support.until.empty()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& motion = support.motion[axis];
      const bool over_time = motion && !motion->constant() && has_step(one, {StepKind::transient});
      const bool reached = holds_in_any(one, i, {StepKind::transient}) ||
                           (!over_time && holds_in_any(one, i, {StepKind::move}));
      if (!motion || reached) continue;
      const auto [key, source] = place_of_motion(reader, tree, one, i, axis);
      reader.report(source, key,
                    fmt::format("no step of kind {} moves it: the support does not hold then (from, until)",
                                over_time ? "\"transient\"" : "\"move\" or \"transient\""));
    }
  }
}

/// A support does not jump with what has a mass.
void check_jumps(SectionReader& reader, const Node& tree, const Case& one) {
  const std::span<const Step> steps(one.steps);
  for (std::size_t i = 0; i < one.supports.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t s = 0; s < steps.size(); ++s) {
        if (steps[s].kind != StepKind::transient || !steps[s].inertia || !steps[s].duration) continue;
        const auto jump = sudden_jump(one.supports[i], axis, steps.first(s + 1));
        if (!jump) continue;
        const auto [key, source] = place_of_motion(reader, tree, one, i, axis);
        reader.report(
            source, key,
            fmt::format("jumps by {} at {} of step \"{}\", which no mass can follow (inertia = "
                        "true); let it take a time: {}",
                        post::engineering(std::abs(jump->by), "m"),
                        jump->time == 0 ? "the beginning" : post::engineering(jump->time, "s"), steps[s].name,
                        jump->time == 0 ? "lead it there before by a step of kind \"move\", or let it "
                                          "set out from where it stands"
                                        : "a \"ramp\", or a \"trapezoid\" with rise and fall"));
        break;
      }
}

/// What a ramp leads.
const char* ramped(StepKind kind) {
  switch (kind) {
  case StepKind::voltage:
    return "voltage";
  case StepKind::charge:
    return "charge";
  case StepKind::force:
    return "forces";
  case StepKind::move:
    return "displacements";
  case StepKind::weight:
    return "weight";
  case StepKind::pressure:
    return "pressure";
  default:
    return "volume";
  }
}

/// Ramps to loads that are there already. A support may need the step, to let go in it.
void check_repeated_ramps(SectionReader& reader, const Node& tree, const Case& one) {
  if (std::ranges::any_of(one.supports, [](const Support& s) { return !s.from.empty() || !s.until.empty(); }))
    return;
  std::map<StepKind, const Step*> last; // that has led the loads of a kind to where they are
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    using enum StepKind;
    const bool ramps = step.kind >= voltage && step.kind <= inflate;
    if (const auto before = last.find(step.kind);
        ramps && !step.duration && before != last.end() && step.to == before->second->to &&
        step.electrode == before->second->electrode && step.response == before->second->response) {
      const StepPlace at = place_of_step(tree, s);
      reader.warn(
          at.source, at.key,
          fmt::format("leads nowhere: step \"{}\" has led the {} there already{}", before->second->name,
                      ramped(step.kind),
                      step.kind == force || step.kind == move ? "; `to` says how far a step leads" : ""));
    }
    if (step.kind == transient) last.clear();
    if (step.control == Control::charge || step.kind == charge) last.erase(voltage);
    if (step.kind == voltage || step.duration) last.erase(charge); // which leaks
    if (step.kind == pressure) last.erase(inflate);
    if (step.kind == inflate) last.erase(pressure);
    if (ramps) last[step.kind] = &step;
  }
}

/// A wave's time counts from the start of each step: a second transient that follows it jumps back.
void check_beginnings(SectionReader& reader, const Case& one) {
  constexpr double little = 1e-3, at_once = 1e-9; // of its range, of a step
  for (const WrittenWave& written : reader.waves()) {
    const auto [least, most] = written.wave.extremes();
    const Step* before = nullptr; // that followed it, and from which on it has stayed
    for (const Step& step : one.steps) {
      if (step.is_analysis() || step.kind == StepKind::hold || step.kind == StepKind::relax) continue;
      if (!follows(step, written)) {
        before = nullptr;
        continue;
      }
      const double jump =
          before ? written.wave.at(at_once * *step.duration) - written.wave.before(*before->duration) : 0;
      if (std::abs(jump) > little * (most - least)) {
        reader.warn(
            written.source, written.key,
            fmt::format("begins anew in step \"{}\", by a jump of {:.2g} % of its range from where step "
                        "\"{}\" has left it: its time counts from the start of each step; let one step "
                        "follow all of it, or whole periods",
                        step.name, 100 * std::abs(jump) / (most - least), before->name));
        break;
      }
      before = &step;
    }
  }
}

/// Every row of the history is kept until the run ends.
void check_rows(SectionReader& reader, const Node& tree, const Case& one) {
  constexpr double most_rows = 100000;
  double rows = 0;
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    const double before = rows;
    rows += step.record ? *step.duration / *step.record : step.increments;
    if (rows <= most_rows || before > most_rows) continue;
    const StepPlace at = place_of_step(tree, s);
    reader.report(
        at.source, at.key + (step.record ? ".record" : ".increments"),
        fmt::format(
            "the history would have {:.6g} rows at the end of this step, allowed {:.0f}; record fewer", rows,
            most_rows));
  }
}

} // namespace

void check_waves(SectionReader& reader, const Node& tree, const Case& one) {
  check_rows(reader, tree, one);
  for (const WrittenWave& written : reader.waves()) {
    using enum Waveform::Kind;
    const Waveform& wave = written.wave;
    const bool starts = wave.kind == ramp || wave.kind == step || wave.kind == trapezoid;
    if (const double end = followed_time(one, written); end > 0 && starts && wave.start >= end)
      reader.warn(written.source, written.key,
                  fmt::format("has no effect here: it begins at {:.6g} s, and the step that follows it ends "
                              "at {:.6g} s",
                              wave.start, end));
  }
  check_motions_held(reader, tree, one);
  check_jumps(reader, tree, one);
  check_beginnings(reader, one);
  check_repeated_ramps(reader, tree, one);
  for (const WrittenWave& written : reader.waves()) {
    if (written.wave.kind != Waveform::Kind::file) continue;
    const auto& rows = written.wave.samples;
    if (rows.empty()) continue;
    const double end = followed_time(one, written), first = rows.front()[0], last = rows.back()[0];
    if (end > last * (1 + 1e-9))
      reader.warn(
          written.source, written.key,
          fmt::format(
              "its last row is at {:.6g} s, and the step that follows it ends at {:.6g} s: from there "
              "on it keeps that row's value",
              last, end));
    if (end > 0 && first > 0)
      reader.warn(written.source, written.key,
                  fmt::format("its first row is at {:.6g} s: until there it has that row's value", first));
  }
  for (const WrittenWave& written : reader.waves())
    if (std::ranges::none_of(one.steps, [&](const Step& step) { return follows(step, written); }))
      reader.report(
          written.source, written.key,
          fmt::format("no step follows this wave; add a [[step]] with kind = \"transient\"{} and its "
                      "duration",
                      drives_charge(written) ? ", control = \"charge\"" : ""));
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    for (const WrittenWave& written : reader.waves()) {
      if (!follows(step, written)) continue;
      const double period = written.wave.period(), dt = *step.duration / step.increments;
      const StepPlace at = place_of_step(tree, s);
      const auto at_least = [&](double parts) {
        return std::ceil(*step.duration / period * parts * (1 - 1e-9));
      };
      if (dt > period / fewest_steps * (1 + 1e-9))
        reader.report(
            at.source, at.key + ".increments",
            fmt::format("time steps of {:.6g} s are longer than a quarter of the period {:.6g} s of {}; "
                        "allowed at least {:.0f} increments",
                        dt, period, written.key, at_least(fewest_steps)));
      else if (is_smooth(written.wave) && !adapts(one, step) && dt > period / telling_steps * (1 + 1e-9))
        reader.warn(
            at.source, at.key + ".increments",
            fmt::format(
                "time steps of {:.6g} s are up to 1/{:.3g} of the period {:.6g} s of {}: peaks, means "
                "and events between them may be missed, by up to {:.2g} % of its amplitude; "
                "{:.0f} increments make it {:.2g} %",
                dt, period / dt, period, written.key, missed(period / dt), at_least(telling_steps),
                missed(telling_steps)));
    }
  }
}

} // namespace dielast::cases
