// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"

#include <set>
#include <string>
#include <vector>

namespace dielast::cases {

/// Where a field of the film is read, and with which weights the integration points of the element there
/// count. At a point of an element they add up to 1, at the nodes of a place to their shares in it: values
/// are continued by a linear function (least squares). In a part of the film they are the undeformed volumes,
/// m^3.
struct FilmReading {
  int cell = 0;
  std::vector<int> points; ///< numbers of the element's integration points among the samples
  Eigen::Vector3d drawn;   ///< the point, m; of a part of the film a node of the element
  Eigen::VectorXd weight;
  int node = -1; ///< the node where it is; -1: none
};

/// At the nodes of a place, in every element that has them. `samples`: of any state.
std::vector<FilmReading> readings_at(const std::string& place, const meshing::Mesh& mesh,
                                     const fem::Samples& samples);

/// A point of an element, as drawn.
struct ElementPoint {
  int cell = 0;
  Eigen::VectorXd local; ///< coordinates in the element
  Eigen::VectorXd shape; ///< weights of the values at its nodes
};

/// In all elements that have the point, as drawn, to a thousandth of their size; in a film of revolution it
/// may be at any angle about the z axis. None beside the film.
std::vector<ElementPoint> elements_at(const Eigen::Vector3d& point, const meshing::Mesh& mesh);

/// Why there are none.
std::string no_element_text(const Case& one, const Eigen::Vector3d& point);

/// Turns the half plane y = 0, in which film of revolution is drawn, about z to the point; of other film, and
/// on the axis, the identity.
Eigen::Matrix3d turn_to(const Eigen::Vector3d& point, const meshing::Mesh& mesh);

/// In the elements that have the point, as drawn, to a thousandth of their size; in a film of revolution it
/// may be at any angle about the z axis. None beside the film.
std::vector<FilmReading> readings_at(const Eigen::Vector3d& point, const meshing::Mesh& mesh,
                                     const fem::Samples& samples);

/// Makes nodes of a place count by their shares in it, in how many elements whatsoever they are read.
void weigh_by_shares(std::vector<FilmReading>& readings, const std::string& place, const Device& device);

/// In all elements of a part of the film; none where the place is no part of it.
std::vector<FilmReading> readings_in(const std::string& place, const meshing::Mesh& mesh,
                                     const fem::Samples& samples);

/// The part whose mesh has a place, by its name; null: a body, or no part.
const Part* part_with(const std::string& place, const Case& one);

/// Which elements of the film belong to a place: its own, or those with a node there; of a place of a part's
/// mesh only those of that mesh, whatever it is tied to.
std::vector<char> film_at(const std::string& place, const Case& one, const Device& device);

/// Numbers, in Case::parts, of those whose film that is.
std::set<int> film_parts_at(const std::string& place, const Case& one, const Device& device);

/// The points of a block of film.
fem::Samples points_of(const fem::ElementBlock& film, const fem::State& state);

/// Elements of a block of film, by their numbers in it.
struct FilmElements {
  bool all = false;
  std::vector<int> elements;
};

/// Of each of a device's blocks of film the elements of film_parts_at() a place.
std::vector<FilmElements> films_of(const std::string& place, const Case& one, const Device& device);

/// Where film is so near the limit of stretch of its law (Gent, Arruda-Boyce) that it takes the whole device
/// no further, in words, with what to do; empty where none is.
std::string law_limit(const Case& one, const Device& device, const fem::State& state);

/// Where film under an electrode has no positive permittivity, in words; empty where none is.
std::string permittivity_limit(const Case& one, const Device& device, const fem::State& state);

/// Where wrinkled film is much wider or narrower than `before`, the accepted state before, in words; empty
/// where none is. What wrinkles take up moves no node: a film may go from one natural state to another
/// (Gent's law pulled in by the field) in equilibria that are neighbours by all displacements.
std::string snap_of_wrinkles(const Device& device, const fem::State& before, const fem::State& state);

/// Mean of `value(sample, reading)`; NaN without readings.
template<class Value>
double mean(const std::vector<FilmReading>& readings, const fem::Samples& samples, Value&& value) {
  double sum = 0, weight = 0;
  for (const FilmReading& reading : readings) {
    for (Eigen::Index p = 0; p < reading.weight.size(); ++p)
      sum +=
          reading.weight[p] *
          value(samples.film[static_cast<std::size_t>(reading.points[static_cast<std::size_t>(p)])], reading);
    weight += reading.weight.sum();
  }
  return sum / weight;
}

} // namespace dielast::cases
