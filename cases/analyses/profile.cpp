// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/profile.hpp"

#include "fem/model/contact_block.hpp"
#include "post/engineering.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace dielast::cases {

namespace {

const char* unit(const Profile& profile) {
  return profile.kind == ProfileKind::contact_pressure ? "Pa" : "m";
}

} // namespace

ProfileTable profile_table(const Device& device, const Profile& profile,
                           const std::vector<Eigen::Vector3d>& before,
                           const std::vector<Eigen::Vector3d>& now) {
  const meshing::Mesh& mesh = device.mesh;
  std::vector<double> pressure;
  if (profile.kind == ProfileKind::contact_pressure) {
    fem::State state;
    state.displacement = now;
    pressure = fem::contact_pressure(device.model, state);
  }
  ProfileTable table;
  Eigen::AlignedBox3d box;
  for (const int node : mesh.node_sets.at(profile.of)) {
    const auto n = static_cast<std::size_t>(node);
    table.rows.push_back(
        {mesh.nodes[n], pressure.empty() ? now[n][profile.along] - before[n][profile.along] : pressure[n]});
    box.extend(mesh.nodes[n]);
  }
  box.sizes().maxCoeff(&table.abscissa);
  std::ranges::stable_sort(table.rows, {}, [&](const ProfileTable::Row& row) {
    const Eigen::Vector3d& x = row.place;
    return std::tuple(x[table.abscissa], x[(table.abscissa + 1) % 3], x[(table.abscissa + 2) % 3]);
  });
  return table;
}

std::string ProfileTable::csv(const Profile& profile) const {
  std::string text = fmt::format("x [m],y [m],z [m],{} [{}]\n", profile.name, unit(profile));
  for (const Row& row : rows)
    text += fmt::format("{},{},{},{}\n", row.place.x(), row.place.y(), row.place.z(), row.value);
  return text;
}

post::Plot ProfileTable::plot(const Profile& profile) const {
  double length = 0, largest = 0;
  Eigen::AlignedBox3d box;
  for (const Row& row : rows) {
    length = std::max(length, std::abs(row.place[abscissa]));
    largest = std::max(largest, std::abs(row.value));
    box.extend(row.place);
  }
  Eigen::Vector3d across_it = box.sizes();
  across_it[abscissa] = 0;
  const bool straight = across_it.maxCoeff() < 1e-6 * box.sizes()[abscissa];
  const post::ScaledUnit across = post::scaled_unit(length, "m"),
                         shown = post::scaled_unit(largest, unit(profile));
  post::Plot plot{
      profile.name,
      fmt::format("{} as drawn [{}]", "xyz"[abscissa], across.unit),
      profile.kind == ProfileKind::contact_pressure
          ? fmt::format("contact pressure [{}]", shown.unit)
          : fmt::format("displacement along {} [{}]", "xyz"[profile.along], shown.unit),
      {{.label = "", .style = straight ? post::Series::Style::line : post::Series::Style::points}}};
  for (const Row& row : rows) {
    plot.series[0].x.push_back(row.place[abscissa] * across.factor);
    plot.series[0].y.push_back(row.value * shown.factor);
  }
  return plot;
}

} // namespace dielast::cases
