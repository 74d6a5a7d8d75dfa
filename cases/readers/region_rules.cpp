// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/rules.hpp"
#include "cases/tables/regions.hpp"
#include "meshing/honeycomb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace dielast::cases {
namespace {

/// Where the regions of a part are written: its sectors count as the first.
struct Written {
  const Node* node;
  std::string key;
};

std::vector<Written> written_regions(const Node& tree, const Part& part) {
  std::vector<Written> all;
  if (part.sectors)
    all.resize(static_cast<std::size_t>(part.sectors->count), {tree.find("sectors"), "sectors"});
  for (std::size_t r = 0; r < part.regions.size(); ++r)
    all.push_back({&tree.find("region")->items.at(r), fmt::format("region[{}]", r + 1)});
  return all;
}

} // namespace

void check_surroundings_of_walls(SectionReader& reader, const Node& tree, const Case& one) {
  for (const Part& part : one.parts) {
    const auto* lattice = std::get_if<Honeycomb>(&part.geometry);
    if (!lattice) continue;
    const double half_width = lattice->wall_bond == WallBond::width ? lattice->wall.width / 2 : 0;
    try {
      meshing::cell_corners({lattice->angle, lattice->columns, lattice->wall_length},
                            half_width + lattice->electrode_gap);
    } catch (const std::invalid_argument& error) {
      const Node* top = part.name.empty() ? &tree : tree.find("part")->find(part.name);
      const Node& written = *top->find("honeycomb");
      const Node* gap = written.find("electrode_gap");
      reader.report(gap ? gap->source : written.source,
                    part.key_prefix() + (gap ? "honeycomb.electrode_gap" : "honeycomb.wall_bond"),
                    error.what());
    }
  }
}

void check_regions(SectionReader& reader, const Node& tree, const Case& one) {
  const Part* part = one.unnamed();
  if (!part || (part->regions.empty() && !part->sectors)) return;
  const std::vector<Written> written = written_regions(tree, *part);
  const auto report = [&](const Written& at, const std::string& message) {
    reader.report(at.node->source, at.key, message);
  };
  const auto film = round_film(*part);
  if (!film)
    return report(written.front(), "regions are drawn in a [disc] or an [annulus]; a [honeycomb] has an "
                                   "electrode_gap, and a mesh of your own has its physical names");
  if (one.dimension == fem::Dimension::axisymmetric)
    return report(
        written.front(),
        "a film of revolution has no regions; the film beside the electrode of a [disc] is its place "
        "\"passive\", others need model = \"planar\" or \"3d\"");
  if (const auto* disc = one.geometry<Disc>(); disc && disc->electrode_radius)
    return reader.report(tree.find("disc")->find("electrode_radius")->source, "disc.electrode_radius",
                         "given twice: the regions say where the electrodes are");
  std::vector<meshing::Region> regions;
  try {
    if (part->sectors) regions = sectors_of(*part->sectors, *film);
  } catch (const std::invalid_argument& error) {
    return report(written.front(), error.what());
  }
  bool complete = true;
  for (std::size_t r = 0; r < part->regions.size(); ++r) {
    const DrawnRegion& drawn = part->regions[r];
    const Written& at = written[written.size() - part->regions.size() + r];
    try {
      const bool taken = std::ranges::count(regions, drawn.name, &meshing::Region::name) > 0;
      if (one.plate && drawn.name == "plate")
        report(at, "the edge that the [plate] carries is the place \"plate\"; call the region otherwise");
      if (std::ranges::count(one.bodies, drawn.name, &Body::name) > 0)
        report(at, fmt::format("a body is called \"{}\"; call the region otherwise", drawn.name));
      if (taken) report(at, fmt::format("a sector is called \"{}\"; call the region otherwise", drawn.name));
      regions.push_back(region_of(drawn, *film));
    } catch (const std::invalid_argument& error) {
      report(at, error.what());
      complete = false;
    }
  }
  if (!complete) return; // numbers of the regions that are left would name others
  for (const meshing::RegionFault& fault : meshing::faults(*film, regions))
    report(written[static_cast<std::size_t>(fault.region)], fault.reason);
}

void check_pivot(SectionReader& reader, const Node& tree, const Case& one) {
  if (!one.pivot) return;
  const Source& source = tree.find("pivot")->source;
  if (one.dimension != fem::Dimension::spatial)
    reader.report(source, "pivot", "a body that is pushed up and tilts needs model = \"3d\"");
  if (one.plate)
    reader.report(source, "pivot", "[plate] moves along z only; leave it out, or use a [[body]]");
  const auto body = std::ranges::find(one.bodies, one.pivot->body, &Body::name);
  if (body != one.bodies.end() && body->pivot)
    reader.report(
        source, "pivot",
        fmt::format("the body \"{}\" has a pivot that stays where it is; leave one of them out", body->name));
}

} // namespace dielast::cases
