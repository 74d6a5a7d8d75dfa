// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/waveform.hpp"
#include "materials/beam_section.hpp"
#include "materials/material.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace dielast::meshing {
struct Mesh;
}

namespace dielast::cases {

/// What a film's thickness does.
enum class FilmSection {
  membrane, ///< it does not resist bending
  shell,    ///< it resists bending
  solid,    ///< it is meshed
};

/// [[film.layer]]: film that lies on that of a shell, each farther from it than those before
struct Layer {
  std::string name; ///< for electrodes; empty: it has none
  std::string material_name;
  materials::Material material;
  double thickness = 0;               ///< undeformed H, m
  std::array<double, 2> prestretch{}; ///< lambda_p along x and y, in which it is bonded
  bool below = false;                 ///< on the side that the drawing's normal points away from
};

/// [film]
struct Film {
  std::string material_name;
  materials::Material material;
  double thickness = 0;               ///< undeformed H, m
  std::array<double, 2> prestretch{}; ///< lambda_p along x and y
  bool tension_field = false;         ///< it wrinkles where it would be compressed, and carries tension only
  double wrinkled = 1e-5;             ///< MembraneSection::wrinkled; other discretisations change it
  FilmSection section{};
  std::vector<Layer> further_layers{}; ///< of a shell
  double offset =
      0; ///< of a shell: from the drawn surface to the film's middle as drawn, along its normal, m
  bool potential = false; ///< of a solid: the field follows from the electric potential; otherwise it is
                          ///< that of layers of `thickness`, stacked along the height
  double width = 0;       ///< of a solid in plane strain, across the plane, m
  std::optional<double> bulk_modulus{}; ///< of a solid, Pa; absent: incompressible
  std::optional<int> stacked_along{};   ///< of a solid's layers: x, y or z (0..2); absent: along the height

  bool is_solid() const { return section == FilmSection::solid; }
};

/// Bars of rectangular section: the walls of a lattice, or [part.NAME.beam] along lines of a mesh
struct Beam {
  double width = 0, height = 0; ///< in the film's plane and normal to it, m
  std::string material_name;
  materials::ElasticSolid material;
  double offset = 0; ///< of their axes from the lines, along the film's normal, m
};

/// [rod]: a film rolled up to a bar that pulls along itself; both directions across it change alike
struct Rod {
  double width = 0;                         ///< of one layer, unstretched, m
  int layers = 1;                           ///< of film, one on another or wound
  std::optional<double> electrode_width{};  ///< of the electrode on a layer, unstretched, m; absent: all
  std::optional<double> electrode_length{}; ///< likewise, along the rod
};

/// [part.NAME.cable]: threads that pull along themselves and resist nothing else
struct Cable {
  double diameter = 0;                  ///< m
  double youngs_modulus = 0;            ///< Pa
  double prestretch = 1;                ///< length as drawn over that at rest
  double crimp = 0;                     ///< strain over which its fibres straighten
  double density = 0;                   ///< kg/m^3
  std::optional<double> yield_strain{}; ///< of the fibres; absent: not known
};

enum class WallBond {
  line,  ///< the film moves with the wall's centreline
  width, ///< the film under a wall is clamped to it over its width
};

/// On which of the film's faces walls are printed.
enum class WallPrint {
  merged,     ///< on both, as if there were no film between
  both_faces, ///< half of the height on each: they bend as one across the film, and each is twisted by itself
  one_face,   ///< all of it above: rigid links lead from the film to the wall's axis
};

/// [mesh]
struct MeshOptions {
  std::optional<double> unit{}; ///< m per unit of length of a user's own mesh; absent: 1
  int refine = 0;               ///< how often each triangle of a user's own mesh is split into four
  int order = 2;         ///< 1: 3-node triangles and 2-node beams; 2: 6-node triangles and 3-node beams
  int wall_elements = 8; ///< beams per wall (honeycomb), or along a line
  double grading = 0;    ///< largest film element over the wall's (honeycomb), the inner edge's (annulus)
  int rings = 0;         ///< elements along a radius (disc, annulus), from pole to pole (balloon)
  int across = 0; ///< elements from side to side of a strip, across the height of a slab, or a sphere's wall
  int quadrature = 3;           ///< integration points of a 6-node triangle: 3 or 6
  std::optional<double> size{}; ///< of tetrahedra in a user's own surface, m; absent: a tenth of its extent
};

/// What is known of a geometry besides its dimensions.
struct GeometryTraits {
  int MeshOptions::*elements = nullptr; ///< how many there are; null: its mesh is not made coarser by that
  int fewest = 1;                       ///< the smallest number that serves
  bool corners = false;                 ///< films or bars meet in corners, where strains may be singular
};

/// [honeycomb]: the geometry template of the unidirectional actuator
struct Honeycomb {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::wall_elements, .corners = true};
  double angle = 0;         ///< interior angle at a cell's four equal vertices, rad
  std::vector<int> columns; ///< cells in each column, left to right
  double wall_length = 0;   ///< m
  Beam wall;
  WallBond wall_bond{};
  WallPrint print{};
  double electrode_gap = 0; ///< from the wall, or its face where it is bonded over its width, m
};

/// [disc]: clamped at its rim; dimensions as clamped, after the prestretch
struct Disc {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::rings, .fewest = 2};
  double radius = 0;                        ///< m
  std::optional<double> electrode_radius{}; ///< m; absent: all of the film is under the electrode
};

/// [annulus]: dimensions as clamped, after the prestretch
struct Annulus {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::rings, .fewest = 2};
  double inner_radius = 0, outer_radius = 0; ///< m
};

enum class RegionKind { sector, ring, rectangle, polygon };

/// [[region]]: a part of a disc or an annulus, drawn in its plane as clamped; dimensions in m, angles in rad
struct DrawnRegion {
  std::string name;
  RegionKind kind{};
  std::optional<double> inner_radius{}, outer_radius{}; ///< of sectors and rings; absent: the film's
  double from = 0, to = 0;                              ///< directions between which a sector is
  std::array<double, 2> centre{};                       ///< of a rectangle
  double length = 0, width = 0;                         ///< of a rectangle, along x and y before it is turned
  double turned = 0;                                    ///< of a rectangle, about its centre
  std::vector<double> x, y;                             ///< corners of a polygon
  double gap = 0;                                       ///< by which all of its edges are moved inwards
};

/// [sectors]: regions of one size around the middle, called a, b, c, ... counter-clockwise
struct Sectors {
  int count = 0;
  double gap = 0;      ///< width of the strip between two of them, m
  double edge_gap = 0; ///< between them and the film's edges, m
  double first = 0;    ///< direction of the middle of the first, rad from x
};

enum class PatchMode {
  biaxial,       ///< x and y move independently
  equal_biaxial, ///< both stretches are one
  pure_shear,    ///< y is held
};

/// [patch]: a homogeneous block of film. Stretches are with respect to the unstretched film, stresses nominal
/// (force over undeformed section); a direction with neither is free of stress.
struct Patch {
  static constexpr GeometryTraits traits{};
  double length = 0, width = 0; ///< along x and y, before the prestretch, m
  PatchMode mode{};
  std::optional<Waveform> stretch_x, stretch_y;
  std::optional<Waveform> stress_x, stress_y; ///< Pa
};

/// [mesh] file = "...": the user's own mesh, drawn after the prestretch, physical names as places
struct MeshFile {
  static constexpr GeometryTraits traits{.corners = true};
  std::filesystem::path path;
};

/// [balloon]: a sphere of film, as drawn
struct Balloon {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::rings, .fewest = 4};
  double radius = 0; ///< m
};

/// [hinge], [ribbon]: a thin beam
struct Leaf {
  double length = 0; ///< m
  Beam beam;         ///< `width`: its thickness in the plane in which it bends
};

enum class RibbonBending {
  with_hinge, ///< ribbons turn freely at their ends; what bends them is taken with the hinge
  own,        ///< they are beams
};

/// [antagonistic_rolls]: a backbone that ends at x = 0, from which a hinge leads along -x to the tip; a roll
/// on either side of it, parallel to x, pulls the tip by a ribbon
struct AntagonisticRolls {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::wall_elements};
  Rod roll;          ///< both
  double length = 0; ///< of a roll, unstretched, m
  double arm = 0;    ///< from the hinge's face to a ribbon's end on the tip, and from there to the roll, m
  RibbonBending ribbons{};
};

/// [strip]: a rectangle of film, clamped at both ends, that hangs along -y. Of one layer, or a stack of
/// layers with passive covers. Dimensions as clamped, after the prestretch.
struct Strip {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::across, .corners = true};
  double length = 0, width = 0; ///< between the clamps (y), from side to side (x), m
  int layers = 1;               ///< of film, each with the electrode's voltage across it
  double cover_thickness = 0;   ///< of passive film on each face, undeformed, m
  std::optional<double>
      electrode_length{}; ///< m; absent: all; longer than the strip: the rest lies in the clamps
  std::optional<double> electrode_width{}; ///< m; absent: all

  /// Length of the electrode between the clamps, and in them, m.
  double free_electrode() const { return std::min(electrode_length.value_or(length), length); }
  double clamped_electrode() const { return electrode_length.value_or(length) - free_electrode(); }
};

/// [rectangle]: film held in a frame, about the origin; dimensions as clamped, after the prestretch
struct Rectangle {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::across, .fewest = 2, .corners = true};
  double length = 0, width = 0;                                ///< along x, along y, m
  std::optional<double> electrode_length{}, electrode_width{}; ///< m; absent: all
};

/// What the core of a roll does to the film's radius.
enum class RollCore {
  two_sided, ///< it keeps it, pressed or pulled
  one_sided, ///< it carries pressure, not tension
  none,      ///< nothing: the film is held at its ends only
};

/// [roll]: film wound around a core, along which it slides, between two end caps: a film of revolution about
/// z. The prestretch is along the roll and around it.
struct Roll {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::rings, .fewest = 2};
  double length = 0;                        ///< before the prestretch, m
  double radius = 0;                        ///< of the film's middle as wound, m
  int turns = 1;                            ///< layers of film, each with the electrode's voltage across it
  std::optional<double> electrode_length{}; ///< in the middle, before the prestretch, m; absent: all
  RollCore core{};
};

/// [line]: a straight rod, or a straight row of beams, as drawn
struct Line {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::wall_elements};
  std::array<double, 3> from{}, to{}; ///< m
};

/// [slab]: a rectangle of solid, in plane strain or of revolution about z; with a width a block in space
struct Slab {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::across};
  double length = 0, height = 0;                    ///< along x, and along y or z, m
  double inner_radius = 0;                          ///< of revolution: where it begins, m
  std::optional<std::array<double, 2>> electrode{}; ///< from where to where along x, m; absent: all of it
  double cover_thickness = 0;                       ///< without field below and above the electrode, m
  std::optional<double> width{}; ///< of a block, along z about z = 0, m; absent: a drawing in its plane
  std::optional<double> electrode_width{}; ///< of that, about z = 0, m; absent: all of it
};

/// [hollow_sphere]: of solid, as drawn; of revolution, or in space its eighth at x, y, z >= 0
struct HollowSphere {
  static constexpr GeometryTraits traits{.elements = &MeshOptions::across};
  double inner_radius = 0, outer_radius = 0; ///< m
};

/// Of a part without a mesh of its own.
struct NoGeometry {
  static constexpr GeometryTraits traits{};
};

using Geometry = std::variant<NoGeometry, Honeycomb, Disc, Annulus, Balloon, Patch, Strip, Rectangle, Roll,
                              Line, AntagonisticRolls, Slab, HollowSphere, MeshFile>;

/// A film, rods of it, or bars, with a mesh of their own or in a place of the unnamed part's. The part
/// without a name is what stands at the top of the file, in [film], [disc], [mesh] ...; others are
/// [part.NAME]. Places of a named part's own mesh are called "NAME.<place>", and all of it "NAME".
struct Part {
  std::string name;
  std::string place; ///< of the unnamed part's mesh; empty: it has a mesh of its own
  std::optional<Film> film;
  std::optional<Rod> rod; ///< what the film is rolled to
  std::optional<Beam> beam;
  std::optional<Cable> cable{};
  std::optional<Leaf> hinge{}, ribbon{}; ///< of antagonistic rolls
  Geometry geometry;
  std::vector<DrawnRegion> regions{};
  std::optional<Sectors> sectors{};
  MeshOptions mesh;
  std::array<double, 3> at{}; ///< where the origin of its mesh is, m
  double turned = 0;          ///< of its mesh about z, rad

  /// Layers of its film that lie one on another.
  int layers() const {
    if (const auto* strip = std::get_if<Strip>(&geometry)) return strip->layers;
    if (const auto* roll = std::get_if<Roll>(&geometry)) return roll->turns;
    return 1;
  }
  /// What its film is rolled to; null: it lies flat, or is a film of revolution.
  const Rod* rolled() const {
    if (const auto* rolls = std::get_if<AntagonisticRolls>(&geometry)) return &rolls->roll;
    return rod ? &*rod : nullptr;
  }
  bool has_mesh() const { return !std::holds_alternative<NoGeometry>(geometry); }
  const GeometryTraits& traits() const {
    return std::visit([](const auto& own) -> const GeometryTraits& { return own.traits; }, geometry);
  }
  /// What its keys begin with.
  std::string key_prefix() const { return name.empty() ? "" : "part." + name + "."; }
  /// A place of its own mesh as the case calls it.
  std::string called(const std::string& own_place) const {
    return name.empty() ? own_place : name + "." + own_place;
  }
};

/// What the mesh of a geometry depends on besides its dimensions.
struct Drawing {
  const Part& part;
  bool of_revolution = false, in_space = false;
  int patch_order = 1;
  const std::vector<std::string>& bars; ///< places along which there are some
};

// The mesh of each geometry as it is drawn by itself, in `devices/`.
meshing::Mesh mesh_of(const NoGeometry& none, const Drawing& drawing);
meshing::Mesh mesh_of(const Honeycomb& lattice, const Drawing& drawing);
meshing::Mesh mesh_of(const Disc& disc, const Drawing& drawing);
meshing::Mesh mesh_of(const Annulus& annulus, const Drawing& drawing);
meshing::Mesh mesh_of(const Balloon& balloon, const Drawing& drawing);
meshing::Mesh mesh_of(const Patch& patch, const Drawing& drawing);
meshing::Mesh mesh_of(const Strip& strip, const Drawing& drawing);
meshing::Mesh mesh_of(const Rectangle& rectangle, const Drawing& drawing);
meshing::Mesh mesh_of(const Roll& roll, const Drawing& drawing);
meshing::Mesh mesh_of(const Line& line, const Drawing& drawing);
meshing::Mesh mesh_of(const AntagonisticRolls& rolls, const Drawing& drawing);
meshing::Mesh mesh_of(const Slab& slab, const Drawing& drawing);
meshing::Mesh mesh_of(const HollowSphere& sphere, const Drawing& drawing);
meshing::Mesh mesh_of(const MeshFile& file, const Drawing& drawing);

} // namespace dielast::cases
