// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/catalog.hpp"

#include <array>

namespace dielast::materials {

namespace {

constexpr double vacuum = 8.8541878128e-12; // permittivity, F/m

/// Neo-Hookean branch with the shear modulus mu (Pa) and the relaxation time tau (s).
Branch relaxing(double mu, double tau) { return {.law = NeoHookean{mu}, .viscosity = mu * tau}; }

/// Gent branch of the rolled muscle: shear modulus mu (Pa), it flows along the roll only.
Branch rolled(double mu) {
  return {.law = Gent{mu, 200}, .dashpot = Dashpot::nominal, .viscosity = 1e7, .directions = {true, false}};
}

} // namespace

std::span<const NamedFilm> named_films() {
  static const std::array films{
      NamedFilm{"VHB 4910",
                Material{ArrudaBoyce{15.36e3, 5.99},
                         Dielectric{4.8 * vacuum},
                         960,
                         {relaxing(26.06e3, 0.6074), relaxing(26.53e3, 6.56), relaxing(10.83e3, 61.25)}},
                "Wang, Decker, Henann & Chester 2016, J. Mech. Phys. Solids 95, 213",
                "creep and rate effects over seconds to minutes, uniaxial stretches up to about 6; batches "
                "differ by 20 % and more"},
      NamedFilm{
          "VHB 4905",
          Material{NeoHookean{20.2e3},
                   Dielectric{4.8 * vacuum},
                   960,
                   {relaxing(54.2e3, 2.0), relaxing(19.7e3, 127)}},
          "fitted to four uniaxial cycles at 20 C of Liao, Mokarram, Hossain et al. 2020, Int. J. Non-Linear "
          "Mech. 118, 103263 (root mean square 2.4 kPa of 115 kPa); eps_r as VHB 4910 of Wang et al. 2016",
          "stretch rates 0.03..0.1 1/s, uniaxial stretches up to 4; batches differ by 20 % and more"},
      NamedFilm{
          "VHB F9473PC",
          Material{Gent{49458, 200},
                   Dielectric{4.08 * vacuum},
                   960,
                   {rolled(1e5), rolled(1e5), rolled(1e5), rolled(1e6)}},
          "Jeong, Mun, Yun & Kyung 2023, Front. Bioeng. Biotechnol. 11, 1006346, Table 1; shear modulus from "
          "the roll at rest",
          "film in a roll, x along its axis, y around it and held; creep over minutes; nominal dashpots"},
      NamedFilm{
          "Ecoflex 00-30", Material{Yeoh{8097, 76.7, 0}, Dielectric{2.8 * vacuum}, 1070},
          "fitted to a uniaxial test of the Soft Robotics Materials Database (Marechal et al., Open Database "
          "License; root mean square 0.6 kPa up to the stretch 6); eps_r is assumed, as usual for silicones",
          "uniaxial stretches up to 6; no creep; the permittivity and breakdown field were not measured"},
      NamedFilm{
          "Elastosil 2030", Material{Yeoh{180.7e3, -16.7e3, 6.6e3}, Dielectric{2.8 * vacuum, 80e6}, 1050},
          "law: Hoffstadt, Koellnberger & Maas 2018, ACTUATOR 2018 (VDE), as Solano, Zhang & Cattafesta "
          "quote "
          "it for their membranes; eps_r, breakdown field (lower end of 80..100 MV/m) and density: nominal "
          "values of the maker",
          "the quoted law held for membranes at the equal-biaxial stretches 1.15 and 1.38 (resonances within "
          "10 "
          "%); the stretches of its fit, creep and hysteresis are not known; eps_r falls with stretch "
          "(Hodgins & Seelecke 2016, Smart Mater. Struct. 25, 095001: 2.76 - 0.28 l)"},
      NamedFilm{"VHB 4910 (honeycomb)", Material{NeoHookean{45e3}, Dielectric{4.0e-11}, 960},
                "A unidirectional soft dielectric elastomer actuator (Polymers 12, 619, 2020), Table 1",
                "quasi-static actuation of prestretched film; no stiffening, no creep"},
      NamedFilm{"VHB 4910 (diaphragm)", Material{NeoHookean{40e3}, Dielectric{4.7 * vacuum}, 960},
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
