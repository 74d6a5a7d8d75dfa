// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/actuators.hpp"

namespace dielast::cases {

std::span<const Actuator> actuators() {
  static const std::vector<Actuator> all{
      {{"expanding disc", "planar actuator"},
       "[disc]: film clamped in a ring, with an electrode in its middle",
       "circular/case.toml"},
      {{"loudspeaker", "membrane pump", "valve", "diaphragm"},
       "[annulus] with a [plate], or a [disc] over a [chamber] under pressure; steps \"harmonic\", and "
       "\"transient\" with inertia",
       "diaphragm/harmonic.toml"},
      {{"cone", "double cone"},
       "[annulus] with a [plate] that its weight or a [[load]] pulls out; two films on one plate: [part]s "
       "with a "
       "[[body]], in space",
       "diaphragm/case.toml"},
      {{"lens", "tunable lens"},
       "[disc] over a [chamber] that a step \"inflate\" fills and closes, an [[electrode]] at its place "
       "\"passive\", "
       "the ring beside the lens",
       ""},
      {{"spherical actuator"}, "[balloon], or [hollow_sphere] of thick film", "thick_sphere/case.toml"},
      {{"unidirectional actuator", "lattice"},
       "[honeycomb], cut free, or film with printed [beam]s",
       "honeycomb/case.toml"},
      {{"bender", "unimorph", "bimorph"},
       "film of section = \"shell\" with one [[film.layer]] or more, in space",
       "benders/unimorph.toml"},
      {{"gripper", "finger"}, "solids of layers that [contact] keeps apart", "gripper/case.toml"},
      {{"minimum energy structure", "DEMES"},
       "prestretched film with [beam]s or on a shell, which a step \"release\" cuts free",
       "minimum_energy_structure/case.toml"},
      {{"spring roll", "rolled actuator", "muscle"},
       "[roll], with a [[spring]] between its caps",
       "rolled_muscle/roll.toml"},
      {{"swimming robot", "fish"},
       "[antagonistic_rolls], whose tip bears a [[fin]]",
       "antagonistic_rolls/robot.toml"},
      {{"stack", "multilayer actuator"},
       "[strip] of several layers with a [weight]; a stout one as [slab], on a [table]",
       "hung_stack/case.toml"},
      {{"sensor", "self-sensing"},
       "any device: quantities of kind \"capacitance\", with the stray_capacitance of its [[electrode]]",
       "strip/sensing.toml"},
      {{"slider", "agonist-antagonist"},
       "a film with two [[electrode]]s, drawn in a [mesh] file or as [[region]]s, a [[body]] between them",
       "own_mesh/slider.toml"},
      {{"mirror", "tilting platform"},
       "[annulus] with [sectors] for electrodes and a [plate] on a [pivot]",
       "manipulator/case.toml"},
      {{"generator", "energy harvester"},
       "steps \"move\" or \"inflate\" to stretch, \"voltage\" to charge, \"move\" or \"inflate\" with "
       "control = "
       "\"charge\" and `to` back, \"voltage\" to = \"0 V\"; electrical_work is what the source has given",
       "material/generator.toml"},
      {{"resonator"}, "steps \"modes\" and \"harmonic\" about any state at rest", "diaphragm/modes.toml"},
      {{"tendon", "fibre"},
       "a [line] of [rod], film that is rolled up to a bar, or of [cable], which pulls only",
       "tendons/case.toml"},
      {{"wrinkled film", "texture"},
       "section = \"shell\" in space, or without its wrinkles' size wrinkling = \"tension field\"",
       "wrinkles/case.toml"},
  };
  return all;
}

} // namespace dielast::cases
