// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"

namespace dielast::cases {

/// Conditions under which keys act. Each asks the whole case, and says in words what it needs.
namespace when {

Condition electrodes();          ///< there is an electrode
Condition charges_film();        ///< one charges the key's own film itself
Condition charges_layer();       ///< one charges the key's own layer
Condition voltages();            ///< a step brings a voltage, and none takes time
Condition branches();            ///< the film has branches
Condition sheets_matter();       ///< likewise, or a circuit leaks
Condition without_duration();    ///< the key's own step has none
Condition weight();              ///< gravity acts in a step
Condition direction_of_weight(); ///< likewise, or a quantity is along it
Condition film_has_weight();     ///< likewise, and film or bars have a mass
Condition masses_matter();       ///< something has inertia, vibrates, or weighs
Condition turns_matter();        ///< likewise, and bodies turn
Condition hung_weight_matters(); ///< beside the standard quantities, whose natural frequency has it
Condition inertia();             ///< something moves with inertia
Condition dampers_matter();      ///< something moves with inertia, or is linearised
Condition point_masses_matter(); ///< masses that weigh without gravity.film
Condition has_mass();            ///< something has one
Condition film_flows();          ///< a dashpot beside the law is felt
Condition branches_flow();       ///< some of the branch's springs are felt
Condition circuits_matter();     ///< time passes, something is linearised, or the circuit leaks
Condition limits_matter();       ///< time passes, or the circuit leaks
Condition time_steps_matter();   ///< in a step with a duration something flows or has inertia
Condition voltage_applies();
Condition charge_applies();
Condition chamber_is_open(); ///< a step reaches or follows its pressure
Condition chamber_is_closed();
Condition volume_applies();   ///< a step pumps it
Condition elements();         ///< its mesh is more than one
Condition order_matters();    ///< its elements may have nodes between their ends
Condition surfaces_touch();   ///< of solids: [contact] between
Condition curved_triangles(); ///< the film is of 6-node triangles
Condition moves_along_it();   ///< of a quantity's direction
Condition an_electrode_keeps_off_walls();
Condition shell();
Condition solid();              ///< the film's own section is one
Condition layers();             ///< it is a solid whose field is that of layers
Condition law_without_volume(); ///< it is a solid whose law leaves the energy of volume open
Condition of_revolution();
Condition in_space();
Condition fills_a_surface(); ///< the part's mesh file is one
Condition plane_strain();    ///< the section is a solid, of a planar model

} // namespace when

/// Whether time passes in a step.
bool takes_time(const Case& one);
/// Whether a step is of one of these kinds.
bool has_step(const Case& one, std::initializer_list<StepKind> kinds);

/// Beams, cables, or the walls of a lattice.
bool has_bars(const Part& part);
/// Whether some of these have a density.
bool has_heavy_bars(const Part& part);

/// Whether film, bars, the plate, a point mass, a body or what is around a fin has a mass.
bool has_mass(const Case& one);
/// Whether a step or a quantity knows what masses do as they accelerate.
bool masses_accelerate(const Case& one);
/// Whether film and bars are let hang by a step.
bool film_weighs(const Case& one);
/// Whether there is contact with friction.
bool slides_with_friction(const Case& one);
/// Whether a step may jump to another state, or follow an unstable path. The rules refuse what may not.
bool may_jump(const Case& one);
bool may_follow(const Case& one, const Step& step);
/// Whether a step's time steps are as short as the error of something that flows or has inertia wants them.
bool adapts(const Case& one, const Step& step);
bool is_linearised(const Case& one); ///< by a harmonic response or a linear model

} // namespace dielast::cases
