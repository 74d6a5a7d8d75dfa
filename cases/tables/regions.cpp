// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/tables/regions.hpp"

#include <Eigen/Geometry>

#include <numbers>

namespace dielast::cases {

std::optional<meshing::RoundFilm> round_film(const Part& part) {
  if (const auto* disc = std::get_if<Disc>(&part.geometry)) return meshing::RoundFilm{0, disc->radius};
  if (const auto* annulus = std::get_if<Annulus>(&part.geometry))
    return meshing::RoundFilm{annulus->inner_radius, annulus->outer_radius};
  return std::nullopt;
}

meshing::Region region_of(const DrawnRegion& drawn, const meshing::RoundFilm& film) {
  const meshing::RoundFilm between{drawn.inner_radius.value_or(film.inner_radius),
                                   drawn.outer_radius.value_or(film.outer_radius)};
  std::vector<Eigen::Vector2d> corners;
  switch (drawn.kind) {
  case RegionKind::sector:
    return meshing::sector(drawn.name, between, drawn.from, drawn.to, drawn.gap, drawn.gap);
  case RegionKind::ring:
    return meshing::ring(drawn.name, between, drawn.gap);
  case RegionKind::rectangle:
    for (const auto& [x, y] : {std::array{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
      corners.emplace_back(Eigen::Vector2d(drawn.centre.data()) +
                           Eigen::Rotation2Dd(drawn.turned) *
                               Eigen::Vector2d(x * drawn.length, y * drawn.width));
    break;
  case RegionKind::polygon:
    for (std::size_t i = 0; i < drawn.x.size(); ++i) corners.emplace_back(drawn.x[i], drawn.y[i]);
    break;
  }
  return meshing::polygon(drawn.name, std::move(corners), drawn.gap);
}

std::vector<meshing::Region> sectors_of(const Sectors& sectors, const meshing::RoundFilm& film) {
  std::vector<meshing::Region> regions;
  const double angle = 2 * std::numbers::pi / sectors.count;
  for (int k = 0; k < sectors.count; ++k)
    regions.push_back(meshing::sector(std::string(1, static_cast<char>('a' + k)), film,
                                      sectors.first + (k - 0.5) * angle, sectors.first + (k + 0.5) * angle,
                                      sectors.gap / 2, sectors.edge_gap));
  return regions;
}

std::vector<meshing::Region> regions_of(const Part& part) {
  std::vector<meshing::Region> regions;
  const auto film = round_film(part);
  if (!film) return regions;
  if (part.sectors) regions = sectors_of(*part.sectors, *film);
  for (const DrawnRegion& drawn : part.regions) regions.push_back(region_of(drawn, *film));
  return regions;
}

void add_pivot_support(Case& one) {
  if (!one.pivot) return;
  Support support{.place = one.pivot->body, .standard = true};
  support.fixed[0] = support.fixed[1] = support.fixed[2] = true;
  support.motion[2] = Waveform::constant_at(one.pivot->height);
  one.supports.push_back(std::move(support));
}

} // namespace dielast::cases
