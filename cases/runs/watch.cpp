// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/watch.hpp"

#include "cases/loads/load_text.hpp"
#include "meshing/solids/crossings.hpp"
#include "post/engineering.hpp"
#include "post/reductions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::cases {

namespace {

/// From the first on the fluid's work on a fin that swings is more than 5 % off, rad; said again where it has
/// turned farther.
constexpr std::array far_turns{0.2, 0.4, 0.8};

/// Of film that wrinkles, over smallest_stress(): taut film would bear as much only at a third of its length.
constexpr double pushed = 1e4;

constexpr const char* tension = "tension"; ///< no event: film has it

constexpr double largest_leak = 0.01; ///< that steady voltages leave out, relative

/// Of a lattice, also of one that is a part with a name.
bool is_cell(const std::string& place) {
  return place.starts_with("cell[") || place.find(".cell[") != std::string::npos;
}

/// What leaks through sheets as they lie, without time, less what the steady voltage takes: relative.
double leak_beyond_drawn(const fem::Model& model, const fem::State& state) {
  double largest = 0;
  for (std::size_t e = 0; e < model.ports.size(); ++e) {
    const auto& circuit = model.ports[e].circuit;
    if (!circuit) continue;
    const double taken = circuit->steady_leakage() * state.voltage[e];
    if (circuit->sheet_share == 1 || state.supply[e] != fem::Supply::voltage || taken == 0) continue;
    const double beyond = model.ports.leak(state, e) / taken - 1;
    if (std::abs(beyond) > std::abs(largest)) largest = beyond;
  }
  return largest;
}

} // namespace

double smallest_stress(const Case& one) {
  double stress = 1e-3;
  for (const materials::Material* material : one.film_materials())
    stress = std::max(stress, 1e-8 * materials::initial_shear_modulus(material->law));
  return stress;
}

Watch::Watch(const Case& one, const Device& device)
    : device_(device), smallest_stress_(smallest_stress(one)),
      kept_apart_(one.contact ? one.contact->between : std::vector<std::string>()) {
  prepare();
}

void Watch::prepare() {
  contacts_.reset();
  if (const meshing::CellBlock* walls = device_.mesh.walls())
    contacts_.emplace(device_.mesh, *walls, device_.bars.widths);
}

std::string Watch::place_of_triangle(int triangle) const {
  for (const auto& [name, set] : device_.mesh.cell_sets)
    if (is_cell(name) && std::binary_search(set.cells.begin(), set.cells.end(), triangle)) return name;
  return place_of_element(device_.mesh.film()->cell(triangle));
}

std::string Watch::place_of_element(std::span<const int> nodes) const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int node : nodes)
    middle += device_.mesh.nodes[static_cast<std::size_t>(node)] / static_cast<double>(nodes.size());
  const Eigen::Vector3d size = device_.mesh.bounds().sizes();
  std::vector<std::string> at;
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] > 0)
      at.push_back(fmt::format("{} = {}", "xyz"[axis], post::engineering(middle[axis], "m")));
  return fmt::format("the element drawn about {}", fmt::join(at, ", "));
}

std::string Watch::place_of_line(int line) const { return cell_of(line, line); }

/// The lattice cell whose outline has both beams, or what each is in: a cell, or itself.
std::string Watch::cell_of(int line, int other) const {
  const meshing::CellBlock& walls = *device_.mesh.walls();
  std::string one_of_first, one_of_other;
  for (const auto& [name, nodes] : device_.mesh.node_sets) {
    if (!is_cell(name)) continue;
    const auto has = [&nodes = nodes, &walls](int beam) {
      const auto ends = walls.cell(beam);
      return std::binary_search(nodes.begin(), nodes.end(), ends[0]) &&
             std::binary_search(nodes.begin(), nodes.end(), ends[1]);
    };
    const bool first = has(line), second = has(other);
    if (first && second) return name;
    if (first) one_of_first = name;
    if (second) one_of_other = name;
  }
  if (one_of_first.empty()) one_of_first = place_of_element(walls.cell(line));
  if (one_of_other.empty()) one_of_other = place_of_element(walls.cell(other));
  return one_of_first == one_of_other ? one_of_first : one_of_first + " and " + one_of_other;
}

std::vector<post::Event> Watch::check(const fem::State& state, const post::Extremes& extremes,
                                      int unstable_modes, bool ends, bool gives_way) {
  std::vector<post::Event> events;
  const auto begins = [&](bool holds, const std::string& kind) {
    if (!holds) active.erase(kind);
    return holds && active.insert(kind).second;
  };
  if (const auto wrinkles = extremes.find("tension_state", post::Extreme::maximum);
      device_.tension_field && wrinkles && begins(wrinkles->value > 0, "loss of tension"))
    events.push_back({"loss of tension", place_of_triangle(wrinkles->cell),
                      fmt::format("the film is {} here: it carries tension in {}",
                                  wrinkles->value > 1 ? "slack" : "wrinkled",
                                  wrinkles->value > 1 ? "no direction" : "one direction only")});
  if (const auto stress = extremes.find("min_principal_stress", post::Extreme::minimum);
      !device_.tension_field && !device_.bears_compression && stress) {
    const bool had_tension = active.contains(tension);
    begins(stress->value > no_tension * smallest_stress_, tension);
    const bool ends_there = gives_way && had_tension && !active.contains(tension);
    if (begins(ends_there || stress->value < -smallest_stress_, "loss of tension"))
      events.push_back({"loss of tension", place_of_triangle(stress->cell),
                        stress->value < -smallest_stress_
                            ? fmt::format("the film is compressed here ({}): it would wrinkle, which this "
                                          "membrane does not resolve",
                                          post::engineering(stress->value, "Pa"))
                            : "the film has no tension left here: it leaves its surface"});
  }
  if (const auto stress = extremes.find("min_principal_stress", post::Extreme::minimum);
      device_.tension_field && stress && begins(stress->value < -pushed * smallest_stress_, "pushed film"))
    events.push_back(
        {"pushed film", place_of_triangle(stress->cell),
         fmt::format("film that wrinkles bears no push: {} are borne here by what is left of its stiffness "
                     "for a regular tangent, and the shape is that of this rest",
                     post::engineering(-stress->value, "Pa"))});
  if (const auto ratio = extremes.find("breakdown_ratio", post::Extreme::maximum);
      ratio && begins(ratio->value >= 1, "breakdown"))
    events.push_back({"breakdown", place_of_triangle(ratio->cell),
                      fmt::format("the electric field is {:.3g} times the breakdown field", ratio->value)});
  double turn = 0;
  for (const FinPoints& fin : device_.fins) turn = std::max(turn, turn_of(fin, state));
  bool turns_farther = false;
  for (const double far : far_turns)
    turns_farther = begins(turn > far, fmt::format("fin turns {:g}", far)) || turns_farther;
  if (turns_farther) // v_n^2 along its own normal, not the share of v^2 and of its push along the drawn one
    events.push_back({"fin turns", "",
                      fmt::format("a fin has turned by {}: the fluid resists along the axis across it as "
                                  "drawn, with {:.2g} % less work where the fin swings",
                                  post::engineering(turn, "rad"), 100 * (1 - std::pow(std::cos(turn), 3)))});
  if (const auto ratio = extremes.find("yield_ratio", post::Extreme::maximum);
      ratio && begins(ratio->value >= 1, "wall yield"))
    events.push_back({"wall yield", place_of_line(ratio->cell),
                      fmt::format("a fibre is strained {:.3g} times its yield strain", ratio->value)});
  if (contacts_) {
    const auto found = contacts_->find(state);
    if (begins(!found.empty(), "wall contact")) {
      const auto& worst = found.front();
      const double width = device_.bars.widths[static_cast<std::size_t>(worst.lines[0])];
      events.push_back(
          {"wall contact", cell_of(worst.lines[0], worst.lines[1]),
           fmt::format("walls touch at {} place{}; the nearest centrelines are {} apart, the walls are {} "
                       "wide. Contact is not resisted: the shape beyond it is not what a device does",
                       found.size(), found.size() == 1 ? "" : "s",
                       worst.distance > 1e-9 ? post::engineering(worst.distance, "m") : "0",
                       post::engineering(width, "m"))});
    }
  }
  if (ends) {
    std::vector<Eigen::Vector3d> x = device_.mesh.nodes;
    for (std::size_t n = 0; n < x.size(); ++n) x[n] += state.displacement[n];
    const auto found = meshing::FilmSurface(device_.mesh, device_.film_parts, kept_apart_).crossing(x);
    if (begins(found.has_value(), "passes through itself"))
      events.push_back(
          {"passes through itself", place_of_triangle(found->cells[0]),
           fmt::format("what stands here passes through {}, which nothing keeps it from: the shape beyond "
                       "it is not what a device does; a [contact] keeps solids apart",
                       place_of_element(device_.mesh.film()->cell(found->cells[1])))});
  }
  const double leak = leak_beyond_drawn(device_.model, state);
  if (begins(std::abs(leak) > largest_leak, "leak as drawn"))
    events.push_back({"leak as drawn", "",
                      fmt::format("without time the voltage behind a circuit takes what leaks under a "
                                  "sheet_resistance as it was drawn, which is {:.2g} % off here; a step "
                                  "\"hold\" takes it as it is",
                                  100 * std::abs(leak))});
  if (begins(unstable_modes > 0, "instability"))
    events.push_back(
        {"instability", "",
         fmt::format("the equilibrium is unstable ({} unstable mode{}): a device under these loads would "
                     "leave it",
                     unstable_modes, unstable_modes == 1 ? "" : "s")});
  return events;
}

void Watch::locate(std::vector<post::Event>& events, const Passage& passage) const {
  Crossings crossings(device_, passage);
  for (post::Event& event : events) {
    const auto threshold = std::ranges::find(thresholds, event.kind, &Threshold::kind);
    if (threshold == thresholds.end() || (device_.tension_field && event.kind == "loss of tension")) continue;
    if (const auto place = crossings.find(*threshold)) tell(event, passage, *place);
  }
}

/// Where an event began.
void Watch::tell(post::Event& event, const Passage& passage, const Crossings::Place& place) const {
  const fem::State& at = place.state;
  event.before = {place.load_factor, at.time, {}};
  for (std::size_t p = 0; p < at.voltage.size(); ++p)
    if (device_.model.ports[p].is_electrode()) event.before->voltages.push_back(at.voltage[p]);
  const std::string where = passage.timed ? post::engineering(at.time, "s")
                            : event.before->voltages.size() > 1
                                ? fmt::format("load factor {:.5g}", place.load_factor)
                                : load_text(device_.model, passage.path, at, place.load_factor, false);
  event.message += fmt::format(" (from about {} on)", where);
}

std::optional<post::Event> no_voltage(const Case& one, const Step& step) {
  const auto charged = [](const auto& drive) { return drive.second.voltage || drive.second.charge; };
  const auto controlled = [](const Controller& own) { return own.drives.what == Driven::voltage; };
  const auto leads = [](const Step& other) {
    return other.to && (other.kind == StepKind::voltage || other.kind == StepKind::charge);
  };
  if (step.kind != StepKind::voltage || one.electrodes.empty() ||
      std::ranges::any_of(one.controllers, controlled) || std::ranges::any_of(one.drives, charged) ||
      std::ranges::any_of(one.steps, leads))
    return std::nullopt;
  return post::Event{
      "no voltage", "",
      fmt::format("step \"{}\" leaves every electrode at 0 V: give [drive] a voltage", step.name)};
}

post::Event struck(const std::string& sudden) {
  return {
      "sudden motion", "",
      (sudden.empty() ? "a support changes its speed at once" : sudden) +
          ": masses are struck there, with a force that is the larger the shorter the time steps are; its "
          "work is accounted for. Let its wave set out smoothly where that force matters, as a \"unipolar "
          "sine\" does, or a sine of phase = \"90 deg\" behind a step of kind \"move\""};
}

post::Event poor_energy(const fem::EnergyBalance::Resolution& energy, std::span<const Step> steps,
                        const std::string& sudden) {
  const Step& step = steps[std::min(static_cast<std::size_t>(energy.step), steps.size() - 1)];
  std::string text =
      fmt::format("up to row {} of history.csv, in step \"{}\", works and heat are known to {} only, ",
                  energy.row, step.name, post::engineering(energy.told, "J"));
  text += energy.exchanged > 0
              ? fmt::format("of {} that were exchanged: ", post::engineering(energy.exchanged, "J"))
              : "which is all that was exchanged: ";
  if (sudden.empty())
    text += fmt::format("give the step \"{}\" more increments{}", step.name,
                        step.duration ? " or [solver] a smaller time_tolerance" : "");
  else
    text += sudden +
            ", which no time step resolves: let its wave set out smoothly, as a \"unipolar sine\" does, "
            "or a sine of phase = \"90 deg\" behind a step of kind \"move\"";
  return {"unresolved energy", "", text};
}

post::Event left_out(double ratio, const Step& step) {
  return {"inertia left out", "",
          fmt::format(
              "step \"{}\" moves so fast that its kinetic energy would be {:.2g} times the work that takes "
              "the device as far: with inertia = true it would move otherwise",
              step.name, ratio)};
}

post::Event jumped(const std::optional<fem::EnergyBalance::JumpRelease>& release, bool unseen) {
  std::string text = "jumped to another stable state";
  if (release && release->energy > release->doubt)
    text += fmt::format("; {} were released", post::engineering(release->energy, "J"));
  else if (release)
    text += fmt::format("; less was released than the {} to which the works of its increment are known",
                        post::engineering(release->doubt, "J"));
  if (unseen) text += "; whether inertia would have counted before that in this step is not known";
  return {"jump", "", text};
}

} // namespace dielast::cases
