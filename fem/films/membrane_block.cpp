// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/membrane_block.hpp"

#include "fem/films/film_of_law.hpp"
#include "fem/films/rod_kinematics.hpp"

#include <numeric>

namespace dielast::fem {

namespace {

/// make.operator()<Kinematics, Law>() for the law that is there. (Of a lambda in a lambda Clang 14 leaves
/// functions out.)
template<class Kinematics, class Make>
struct OfLaw {
  const Make& make;
  template<class Law>
  std::unique_ptr<ElementBlock> operator()(const Law& /*law*/) const {
    return make.template operator()<Kinematics, Law>();
  }
};

} // namespace

std::unique_ptr<ElementBlock> make_membrane_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                                  const MembraneSection& section, std::vector<int> electrodes,
                                                  Dimension dimension, int integration_points,
                                                  std::vector<int> numbers) {
  if (cells.size() == 0 || static_cast<int>(electrodes.size()) != cells.size())
    throw std::invalid_argument("a membrane needs elements, and one electrode number for each");
  if (numbers.empty()) {
    numbers.resize(electrodes.size());
    std::iota(numbers.begin(), numbers.end(), 0);
  }
  if ((dimension == Dimension::axisymmetric) != meshing::is_meridian(cells.type))
    throw std::invalid_argument("a film of revolution is made of meridians, any other of triangles or rods");
  const auto make = [&]<class Kinematics, class Law>() -> std::unique_ptr<ElementBlock> {
    return std::make_unique<FilmOfLaw<Kinematics, Law>>(mesh, cells, section, std::move(electrodes),
                                                        integration_points, std::move(numbers));
  };
  const auto triangles = [&]<class Kinematics>() { // these are many: each law has a loop of its own
    return std::visit(OfLaw<Kinematics, decltype(make)>{make}, section.material.law);
  };
  const auto lines = [&]<class Kinematics>() { // these are few
    return make.template operator()<Kinematics, materials::ElasticLaw>();
  };
  const bool planar = dimension == Dimension::planar;
  switch (cells.type) {
  case meshing::CellType::triangle6:
    return planar ? triangles.template operator()<TriangleKinematics<6, 2>>()
                  : triangles.template operator()<TriangleKinematics<6, 3>>();
  case meshing::CellType::triangle3:
    return planar ? triangles.template operator()<TriangleKinematics<3, 2>>()
                  : triangles.template operator()<TriangleKinematics<3, 3>>();
  case meshing::CellType::meridian3:
    return lines.template operator()<MeridianKinematics<3>>();
  case meshing::CellType::meridian2:
    return lines.template operator()<MeridianKinematics<2>>();
  case meshing::CellType::rod2:
    return planar ? lines.template operator()<RodKinematics<2>>()
                  : lines.template operator()<RodKinematics<3>>();
  default:
    throw std::invalid_argument("a membrane is not made of walls");
  }
}

} // namespace dielast::fem
