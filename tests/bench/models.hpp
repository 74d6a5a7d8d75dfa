// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/paths/ramp.hpp"
#include "materials/material.hpp"
#include "meshing/mesh.hpp"

namespace dielast::bench {

/// A benchmark model and the loads of its ramp: neo-Hookean film, mu = 45 kPa, eps = 4e-11 F/m, H = 1 mm,
/// straight-sided 6-node triangles with 6 integration points on hexagonal rings.
struct Task {
  meshing::Mesh mesh; ///< drawn after the prestretch, m
  fem::Model model;
  std::vector<std::pair<fem::Loads, int>> steps; ///< target and increments
  bool framed = false; ///< a frame holds it as drawn, and lets it go in the first step
  int node = 0;        ///< where the result is read
  int component = 0;   ///< displacement component of the result
};

/// B1: disc of undeformed radius 30 mm, electrode inside 10 mm, rim held at 3 x 3; 0 -> 5 kV in 10 steps.
/// `rings` = 21, 66, 129 give 10838, 105338, 400934 unknowns. Result: displacement of the electrode's edge on
/// the x axis, from 30 mm.
Task partial_electrode_disc(int rings);

/// B2 without plate bending: annulus 6.35..34.29 mm, prestretch 2, a rigid plate inside that moves along z
/// only; 0.981 N in 5 steps, then 5 kV in 10. 27 k rings, the plate's edge is ring 5 k. Result: the plate's
/// displacement.
Task plate_diaphragm(int k);

/// B2 with a film that resists bending, a hundredth as thick, and loads such that all stresses are alike:
/// its result is that of plate_diaphragm() but for what bending adds.
Task plate_diaphragm_shell(int k);

/// The incompressible stack of gallery/stack_on_table in space, 750 V at once. `across` = 3, 4 give 65 000
/// and 130 000 unknowns. Result: the rise of the upper electrode's first corner.
Task stack_on_table(int across);

/// B5: the spring-rolled muscle of gallery/rolled_muscle/cycles.toml, two triangles with a Gent law and four
/// nominal dashpots on a spring and a linkage. Its only step lets it go at once; then a 4 kV sine of 0.5 Hz
/// acts for 1200 s. Result: the displacement of the end that moves.
Task rolled_muscle();
fem::LoadPath rolled_muscle_cycles();

/// Film stretched 1.5 x 1.5 in a ring of walls, 8 mm in radius, let go, then 4 kV in 4 steps. Result: the
/// displacement of the ring along x.
Task film_in_a_ring();

/// 40 elements along the meridian of B2's film and plate; the same loads and result.
Task meridian_of_diaphragm();

// What more than one of them is made of.
inline const materials::Material film{materials::NeoHookean{45e3}, materials::Dielectric{4e-11, 100e6}, 960};
void hold(Task& task, const std::string& place, std::initializer_list<int> components);
meshing::Mesh diaphragm_mesh(int k);
/// Loads of a film as thick as `thickness` times that of B2, such that all stresses are alike.
Task diaphragm(meshing::Mesh mesh, std::unique_ptr<fem::ElementBlock> block, double thickness);

/// The state that the first step starts from.
fem::State begun(const Task& task, fem::Equilibrium& equilibrium);

constexpr double muscle_length = 40e-3, muscle_prestretch = 1.94999, muscle_duration = 1200; ///< m, 1, s
constexpr int muscle_steps = 19200;

} // namespace dielast::bench
