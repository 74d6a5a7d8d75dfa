#include "materials/catalog.hpp"

#include <array>

namespace dielast::materials {

std::span<const NamedFilm> named_films() {
  static const std::array films{
      NamedFilm{"VHB 4910 (honeycomb)", Material{NeoHookean{45e3}, IdealDielectric{4.0e-11, 100e6}, 960},
                "A unidirectional soft dielectric elastomer actuator (Polymers 12, 619, 2020), Table 1",
                "quasi-static actuation of prestretched film; no stiffening, no creep"},
      NamedFilm{"VHB 4910 (diaphragm)",
                Material{NeoHookean{40e3}, IdealDielectric{4.7 * 8.8541878128e-12, 100e6}, 960},
                "modulus from the measured stiffness of a diaphragm actuator (36..44 kPa fit), eps_r = 4.7 "
                "as stated there",
                "stretches up to about 2.5; no stiffening, no creep"},
  };
  return films;
}

std::span<const NamedSolid> named_solids() {
  static const std::array solids{
      NamedSolid{"TPU 78 MPa", ElasticSolid{78e6, 0.36, 0.55},
                 "A unidirectional soft dielectric elastomer actuator (Polymers 12, 619, 2020), Table 2",
                 "printed thermoplastic polyurethane below 55 % strain (elongation at yield)"},
  };
  return solids;
}

} // namespace dielast::materials
