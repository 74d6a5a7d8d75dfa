// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"

#include "cases/case/holding.hpp"
#include "cases/devices/attachments.hpp"
#include "cases/devices/bodies.hpp"
#include "cases/devices/chamber.hpp"
#include "cases/devices/pins.hpp"
#include "cases/devices/sections.hpp"
#include "cases/readers/reader.hpp"
#include "cases/warnings/load_warnings.hpp"
#include "cases/warnings/mesh_warnings.hpp"
#include "fem/equilibrium/sheet_conduction.hpp"
#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace dielast::cases {

namespace {

/// Says which [[load]] cannot act.
[[noreturn]] void reject_load(const Case& one, std::size_t number, const std::string& reason) {
  const std::string load = fmt::format("load[{}].", number + 1);
  const char* what = one.loads[number].moment ? "moment" : "force";
  throw one.error_at(load + what, reason);
}

/// Times that tell whether the loads balance at all times.
std::vector<double> telling_times(const Case& one) {
  double longest = 0;
  for (const Step& step : one.steps) longest = std::max(longest, step.duration.value_or(0));
  std::vector<double> times{0, longest};
  for (const Load& load : one.loads)
    for (int c = 0; c < fem::DofMap::components; ++c) {
      const Waveform* wave = load.component(c);
      if (!wave) continue;
      const double period = wave->period();
      if (std::isfinite(period)) times.insert(times.end(), {period / 3, period / 7});
      for (const double t : wave->kinks(0, std::isfinite(period) ? period : longest)) times.push_back(t);
    }
  return times;
}

/// Every load must have something to act on, and nothing would hold a free body.
void require_loads_that_act(const Case& one, const Device& device) {
  for (std::size_t l = 0; l < one.loads.size(); ++l)
    for (int c = 0; c < fem::DofMap::components; ++c) {
      const Waveform* wave = one.loads[l].component(c);
      if (!wave || *wave == Waveform::constant_at(0)) continue;
      const auto& nodes = device.mesh.node_sets.at(one.loads[l].place);
      const auto moving = std::ranges::count_if(
          nodes, [&](int node) { return device.model.dofs.equation(node, c) != fem::DofMap::absent; });
      if (c < 3 && moving < std::ssize(nodes))
        reject_load(one, l, "a planar model does not move along z; use model = \"3d\"");
      if (c >= 3 && moving == 0)
        reject_load(
            one, l,
            fmt::format("nothing turns about {} at \"{}\": membranes have no rotations, walls and bodies "
                        "have, in a planar model about z",
                        "xyz"[c - 3], one.loads[l].place));
      const std::vector<double>& shares = device.shares.at(one.loads[l].place).of_nodes;
      double acting = 0;
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (device.model.dofs.equation(nodes[n], c) != fem::DofMap::absent) acting += shares[n];
      if (!(acting > 0))
        reject_load(one, l,
                    fmt::format("of what is spread over \"{}\" the nodes that turn have no share; name the "
                                "edge or the body that is to turn",
                                one.loads[l].place));
    }
  if (!device.free_body) return;
  for (const double t : telling_times(one)) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force; // moment about the origin, as drawn
    double most_force = 0, most_moment = 0;
    for (const Load& load : one.loads) {
      Eigen::Vector3d of_load;
      for (int c = 0; c < 3; ++c) of_load[c] = load.component(load.moment ? c + 3 : c)->at(t);
      if (load.moment) {
        moment += of_load;
        most_moment = std::max(most_moment, of_load.cwiseAbs().maxCoeff());
        continue;
      }
      const auto& nodes = device.mesh.node_sets.at(load.place);
      const std::vector<double>& shares = device.shares.at(load.place).of_nodes;
      Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
      for (std::size_t n = 0; n < nodes.size(); ++n)
        centroid += shares[n] * device.mesh.nodes[static_cast<std::size_t>(nodes[n])];
      force += of_load;
      moment += centroid.cross(of_load);
      most_force = std::max(most_force, of_load.cwiseAbs().maxCoeff());
    }
    most_moment = std::max(most_moment, most_force * device.model.extent);
    if (one.dimension == fem::Dimension::axisymmetric) force.head<2>().setZero(), moment.setZero();
    if (one.dimension == fem::Dimension::planar) force.z() = 0, moment.head<2>().setZero();
    for (int c = 0; c < fem::DofMap::components; ++c)
      if (c < 3 ? std::abs(force[c]) > 1e-9 * most_force : std::abs(moment[c - 3]) > 1e-6 * most_moment)
        reject_load(one, 0,
                    c < 3 ? "the forces on a free body must balance; hold it with [[support]]"
                          : "the moments on a free body must balance, those of its forces, too; hold it with "
                            "[[support]]");
  }
}

/// The sides of a patch stay straight and parallel; in equal-biaxial tension both move alike.
void keep_homogeneous(const Part& part, const Patch& patch, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto& right = mesh.node_sets.at(part.called("right"));
  const auto& top = mesh.node_sets.at(part.called("top"));
  for (const int node : right) dofs.share(right.front(), node, 0);
  for (const int node : top) dofs.share(top.front(), node, 1);
  if (patch.mode == PatchMode::equal_biaxial) dofs.share(right.front(), 0, top.front(), 1);
}

/// A body's name is a place beside those of the mesh, and a body carries places of the mesh.
void check_body_names(const Case& one, const std::vector<std::string>& places) {
  for (std::size_t b = 0; b < one.bodies.size(); ++b) {
    const auto fail = [&](const char* key, const std::string& message) {
      throw CaseError({{{one.source.string()}, fmt::format("body[{}].{}", b + 1, key), message}});
    };
    const Body& body = one.bodies[b];
    if (std::ranges::count(places, body.name) > 0)
      fail("name", fmt::format("the mesh has a place \"{}\"; call the body otherwise", body.name));
    for (const std::string& place : body.places)
      if (std::ranges::count(one.bodies, place, &Body::name) > 0)
        fail("places", fmt::format("\"{}\" is a body; one body carries places of the mesh", place));
  }
}

void hold(const Support& support, const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto fail = [&one](const char* key, const std::string& message) {
    throw CaseError({{{one.source.string()}, key, message}});
  };
  bool turns = false, clamps = false;
  for (int c = 0; c < fem::DofMap::components; ++c) {
    const bool fixed = support.fixed[static_cast<std::size_t>(c)];
    clamps = clamps || (fixed && c > 2);
    for (const int node : mesh.node_sets.at(support.place)) {
      turns = turns || (c > 2 && dofs.equation(node, c) != fem::DofMap::absent);
      if (fixed && c < 3 && dofs.is_tied_node(node)) {
        const Eigen::Vector3d at = 1e3 * mesh.nodes[static_cast<std::size_t>(node)];
        fail("support.place",
             fmt::format(
                 "\"{}\" has the node drawn at ({:.4g}, {:.4g}, {:.4g}) mm, which a [[body]], or a wall over "
                 "its width, carries: hold that instead, or a place that ends before it",
                 support.place, at.x(), at.y(), at.z()));
      }
      if (fixed) dofs.hold(node, c);
    }
  }
  if (clamps && !turns)
    fail("support.fix",
         fmt::format("nothing turns at \"{}\": membranes have no rotations, walls and shells have",
                     support.place));
}

/// What acts on single rotations needs all three of a shell's nodes, in every step alike.
void keep_spins(const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  std::vector<std::string> places = one.places_of_spins;
  for (const Support& support : one.supports)
    if (support.holds_some_rotations()) places.push_back(support.place);
  for (const Load& load : one.loads)
    if (load.component(3) || load.component(4) || load.component(5)) places.push_back(load.place);
  for (const std::string& place : places)
    for (const int node : mesh.node_sets.at(place)) dofs.keep_spins(node);
}

/// The plate keeps its edge round and level: it moves along z only.
void carry_plate(const Plate& plate, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto& edge = mesh.node_sets.at(plate.place);
  for (const int node : edge) {
    dofs.hold(node, 0);
    dofs.hold(node, 1);
    dofs.share(edge.front(), node, 2);
    for (int c = 3; c < fem::DofMap::components; ++c) dofs.hold(node, c);
  }
}

/// V, that makes charges of order one: what the sources of the electrode reach, where that is known.
double typical_voltage(const Case& one, const std::string& electrode) {
  constexpr double most = 1000;
  double largest = 0;
  const auto reach = [&largest](double voltage) { largest = std::max(largest, std::abs(voltage)); };
  if (const auto drive = one.drives.find(electrode); drive != one.drives.end()) {
    if (drive->second.charge) return most;
    if (const auto& voltage = drive->second.voltage)
      for (const double extreme : voltage->extremes()) reach(extreme);
  }
  for (const Step& step : one.steps)
    if (step.kind == StepKind::voltage && step.to && (step.electrode.empty() || step.electrode == electrode))
      reach(*step.to);
  for (const Controller& controller : one.controllers)
    if (controller.drives.what == Driven::voltage && controller.drives.of == electrode) {
      reach(controller.lowest);
      reach(controller.highest);
    }
  return largest > 0 ? std::min(largest, most) : most;
}

/// The electrodes with what is between them and their sources.
void add_electrodes(const Case& one, const meshing::Mesh& mesh, fem::Model& model) {
  for (const Electrode& electrode : one.electrodes) {
    fem::Port port{.name = electrode.name};
    if (const auto found = one.circuits.find(electrode.name); found != one.circuits.end()) {
      port.circuit = {.resistance = found->second.resistance};
      if (found->second.leakage_resistance) port.circuit->leakage = 1 / *found->second.leakage_resistance;
      if (found->second.current_limit) port.circuit->current_limit = *found->second.current_limit;
    }
    if (electrode.sheet_resistance)
      port.sheet = {.resistance = *electrode.sheet_resistance,
                    .terminal = mesh.node_sets.at(electrode.terminal),
                    .voltage_scale = typical_voltage(one, electrode.name)};
    model.ports.push_back(std::move(port));
  }
}

/// The charges as drawn are known only when the model's histories are placed.
void scale_charges(const Case& one, fem::Model& model) {
  const std::vector<double> capacitance = model.charges(model.initial_state(), false).capacitance;
  for (std::size_t p = 0; p < model.ports.size(); ++p)
    if (fem::Port& port = model.ports[p]; port.circuit)
      port.circuit->charge_scale = typical_voltage(one, port.name) * capacitance[p];
}

/// What leaks under sheets in the long run, as drawn.
void share_leaks(fem::Model& model) {
  const auto leaks_under_sheet = [](const fem::Port& port) {
    return port.sheet && port.circuit && port.circuit->leakage > 0;
  };
  if (std::ranges::none_of(model.ports, leaks_under_sheet)) return;
  fem::State rest = model.initial_state();
  rest.scheme = materials::TimeScheme::relaxed();
  std::ranges::fill(rest.voltage, 1.0);
  fem::SheetConduction(model).solve(rest);
  for (std::size_t p = 0; p < model.ports.size(); ++p)
    if (fem::Port& port = model.ports[p]; leaks_under_sheet(port))
      port.circuit->sheet_share = model.ports.leak(rest, p) / port.circuit->leakage;
}

} // namespace

std::vector<std::string> places_of(const meshing::Mesh& mesh) {
  std::vector<std::string> places;
  for (const auto& [name, nodes] : mesh.node_sets) places.push_back(name);
  return places;
}

Device build_device(const Case& one) {
  meshing::Mesh mesh = build_mesh(one);
  std::vector<std::string> places = places_of(mesh);
  check_body_names(one, places);
  for (const Body& body : one.bodies) places.push_back(body.name);
  check_places(one, places);
  const fem::Dimension dimension = one.dimension;
  std::vector<std::string> warnings = mesh_warnings(one, mesh);
  const Eigen::Vector3d size = mesh.bounds().sizes(); // bodies have nodes of their own
  PlaceShares shares = meshing::shares(mesh, dimension == fem::Dimension::axisymmetric);
  const std::vector<BodyNodes> bodies = add_body_nodes(one, shares, mesh);
  for (const Body& body : one.bodies) shares[body.name] = {.of_nodes = {1}};
  std::vector<FinPoints> fins = add_fin_nodes(one, mesh);
  std::ranges::move(share_warnings(one, shares), std::back_inserter(warnings));
  const std::vector<fem::Tie> links = set_off_bars(one, mesh);
  if (!mesh.film()) throw meshing::MeshError("the case has no film: neither triangles nor rods");
  std::vector<int> parts = film_parts(one, mesh);
  std::ranges::move(mesh_file_warnings(one, mesh, parts), std::back_inserter(warnings));
  const int without_arms = mesh.node_count();
  const std::vector<MassOfShells> of_shells = add_mass_nodes(one, parts, mesh);
  const std::vector<fem::RelativeMass> rotary = add_rotary_nodes(one, mesh);
  fem::Model model{.dofs = fem::DofMap(mesh.node_count())};
  add_electrodes(one, mesh, model);
  model.extent = size.norm();
  model.drawn = mesh.nodes;
  model.corners = fem::element_corners(mesh);

  const meshing::CellBlock* film = mesh.film();
  std::ranges::move(thickness_warnings(one, mesh, parts), std::back_inserter(warnings));
  const bool of_solid = one.any_film([](const Film& f) { return f.is_solid(); });
  if (meshing::is_triangle(film->type) && !of_solid) check_film_in_space(one, mesh, parts, model.extent);
  const auto elements = static_cast<double>(film->size());
  model.length_scale = model.extent / (meshing::is_meridian(film->type)      ? elements
                                       : meshing::is_tetrahedron(film->type) ? std::cbrt(elements)
                                                                             : std::sqrt(elements));
  int films = 0;
  try {
    add_films(one, mesh, parts, model);
    films = static_cast<int>(model.blocks.size());
    add_masses_of_shells(of_shells, mesh, model);
    add_bars(one, mesh, model);
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
  if (!rotary.empty()) model.blocks.push_back(fem::make_relative_mass_block(rotary));
  add_contact(one, mesh, parts, model);

  add_springs(one, mesh, shares, model);
  add_capacitors(one, model);
  add_masses(one, mesh, shares, model);
  for (auto& masses : {body_masses(bodies), fluid_around(fins)})
    if (!masses.empty()) model.blocks.push_back(fem::make_point_mass_block(masses));
  for (const auto& block : model.blocks) {
    block->place_scalars(model.dofs);
    block->claim_dofs(model.dofs, dimension);
  }
  tie_bodies(one, bodies, mesh, model.dofs);
  tie_fins(fins, mesh, model.dofs);
  clamp_under_walls(one, mesh, model.dofs);
  hold_radii(one, mesh, model.dofs);
  link_bars(links, dimension, model.dofs);
  tie_rotary_nodes(rotary, mesh, model.dofs);
  tie_mass_nodes(of_shells, mesh, model.dofs);
  for (const Support& support : one.supports) hold(support, one, mesh, model.dofs);
  keep_spins(one, mesh, model.dofs);
  const bool free_body = is_free(one, std::vector<char>(one.supports.size(), 1));
  std::vector<Pin> pins;
  if (free_body && one.pinned)
    pins = pin(std::span(mesh.nodes).first(static_cast<std::size_t>(without_arms)), dimension,
               quarter_turns(one), model.dofs);
  if (dimension == fem::Dimension::axisymmetric)
    for (int n = 0; n < mesh.node_count(); ++n)
      if (mesh.nodes[static_cast<std::size_t>(n)].x() <= 1e-12 * model.extent && !model.dofs.is_tied_node(n))
        model.dofs.hold(n, 0); // a master stays on the axis itself
  if (one.plate) carry_plate(*one.plate, mesh, model.dofs);
  for (const Part& part : one.parts)
    if (const auto* patch = std::get_if<Patch>(&part.geometry))
      keep_homogeneous(part, *patch, mesh, model.dofs);
  try {
    model.dofs.number();
  } catch (const std::invalid_argument& error) {
    throw CaseError(
        {{{one.source.string()},
          one.bodies.empty() ? "support.place" : "body.places",
          fmt::format(
              "{}: what a [[body]], or a wall over its width, carries no [[support]], [plate] or side of "
              "a patch can hold",
              error.what())}});
  }
  add_chamber(one, mesh, free_body, model); // behind what holds its edges
  try {
    model.place_histories();
    share_leaks(model);
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
  scale_charges(one, model);

  for (const Part& part : one.parts)
    if (part.film && part.film->section == FilmSection::membrane && !part.film->tension_field &&
        std::ranges::min(part.film->prestretch) < 1)
      warnings.push_back(
          fmt::format("{}: the prestretch {:.4g} is below 1: it compresses the film, which buckles",
                      part.called("film"), std::ranges::min(part.film->prestretch)));

  const auto lets_go = [](const Support& support) { return !support.from.empty() || !support.until.empty(); };
  if (model.dofs.free_count() == 0 && !one.any_geometry<Patch>() &&
      std::ranges::none_of(one.supports, lets_go))
    warnings.push_back("nothing can move: every node is held");

  Device device{.mesh = std::move(mesh),
                .shares = std::move(shares),
                .model = std::move(model),
                .free_body = free_body,
                .pins = std::move(pins)};
  device.weight = weight_of(one, bodies, fins, device.mesh, device.shares, device.model);
  require_loads_that_act(one, device);
  std::ranges::move(carrying_warnings(one), std::back_inserter(warnings));
  std::ranges::move(weight_warnings(one), std::back_inserter(warnings));
  std::ranges::move(pressure_warnings(one, device.mesh, parts, device.model.dofs),
                    std::back_inserter(warnings));
  std::ranges::move(idle_attachments(one, device.mesh, device.model.dofs), std::back_inserter(warnings));
  if (!free_body) {
    std::ranges::move(load_warnings(one, device.mesh, device.model.dofs), std::back_inserter(warnings));
    std::ranges::move(warnings_of_held_quantities(one, device.mesh, device.model.dofs),
                      std::back_inserter(warnings));
  }
  device.film_parts = std::move(parts);
  device.films = films;
  device.tension_field = one.any_film([](const Film& f) { return f.tension_field; });
  device.bears_compression = !one.any_film([](const Film& f) { return f.section == FilmSection::membrane; });
  device.solid = of_solid;
  device.bars = bars(one, device.mesh);
  device.fins = std::move(fins);
  device.warnings = std::move(warnings);
  return device;
}

} // namespace dielast::cases
