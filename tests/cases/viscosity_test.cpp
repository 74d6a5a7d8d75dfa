// SPDX-License-Identifier: GPL-3.0-or-later
// A dashpot beside the law.
#include "tests/cases/film_cases.hpp"

#include <cmath>
#include <complex>

namespace dielast::cases::viscosity_test {
namespace {

class Viscosity : public FilmCases {};

// A dashpot rules where the law is soft beside it, however fast: a liquid's nominal stress in uniaxial
// tension is 3 eta l'/l^2.
TEST_F(Viscosity, IsThatOfALiquidWhateverTheLaw) {
  for (const auto& [viscosity, duration] : {std::pair{1e7, 1.0}, {1e3, 1e-4}, {1e2, 1.0}}) {
    const Ran ran = run(fmt::format("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"1 "
                                    "kPa\"\nrelative_permittivity = 4\n"
                                    "viscosity = \"{0} Pa.s\"\n[patch]\nstretch_x = {{ wave = \"ramp\", to "
                                    "= 1.1, from = 1, duration = \"{1} s\" "
                                    "}}\n[[step]]\nkind = \"transient\"\nduration = \"{1} s\"\n",
                                    viscosity, duration));
    const double stress = 3 * viscosity * 0.1 / duration / 1.21 + 1e3 * (1.1 - 1 / 1.21);
    EXPECT_NEAR(ran.last("stress_x"), stress, 1e-4 * stress) << viscosity;
  }
}

// Its spring hardly stores anything at the highest frequency that is asked for either: there a film without
// mass follows its voltage by u = p/(k + i omega c), k and c those of 0 Hz and of high frequencies.
TEST_F(Viscosity, StoresNothingAtTheHighestFrequency) {
  const Ran ran =
      run("[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"1 kPa\"\n"
          "relative_permittivity = 4\ndensity = 0\nviscosity = \"1 kPa.s\"\n[patch]\n"
          "length = \"10 mm\"\n[drive]\nvoltage = \"500 V\"\n[[step]]\nkind = \"voltage\"\n"
          "[[step]]\nkind = \"harmonic\"\nfrom = \"1e-6 Hz\"\nto = \"1 kHz\"\npoints = 3\n"
          "[[quantity]]\nname = \"u\"\nkind = \"displacement\"\nof = \"right\"\nalong = \"x\"\n");
  const std::vector<std::complex<double>> u = ran.analyses.at(0).values(1);
  const std::complex<double> slow = u.front(), fast = u.back();
  // Re(1/u) stays at k/p; a spring of 1e4 times the law's modulus would add six tenths of the whole.
  EXPECT_NEAR((1.0 / fast).real(), (1.0 / slow).real(), 2e-4 * std::abs(1.0 / fast));
}

} // namespace
} // namespace dielast::cases::viscosity_test
