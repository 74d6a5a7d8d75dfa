// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>
#include <tuple>

namespace dielast::test {

/// A body on a pivot in space that three rods hold, which meet it beside the pivot; `fixed`: its own key.
/// Then comes `rest`.
inline std::string held_by_rods(const std::string& fixed, const std::string& rest) {
  std::string text =
      "model = \"3d\"\n[output]\nfields = false\nerror_estimate = false\n[[body]]\nname = \"b\"\n"
      "places = [\"m.end\", \"n.end\", \"p.end\"]\npivot = [0, 0, 0]\ncentre = [2e-3, -3e-3, -10e-3]\n"
      "mass = \"20 g\"\ninertia = [\"1 kg.mm^2\", \"2 kg.mm^2\", \"2.5 kg.mm^2\"]\n" +
      fixed;
  for (const auto& [name, from, to] : {std::tuple("m", "[-0.04, 0.005, 0]", "[-0.005, 0.005, 0]"),
                                       std::tuple("n", "[0, -0.045, -0.008]", "[0.002, -0.006, -0.008]"),
                                       std::tuple("p", "[0.03, 0.03, 0.01]", "[0.006, 0.006, -0.015]")})
    text +=
        fmt::format("[part.{0}.film]\nthickness = \"0.1 mm\"\nprestretch = 1.3\n[part.{0}.film.material]\n"
                    "shear_modulus = \"50 kPa\"\nrelative_permittivity = 3\ndensity = 0\n[part.{0}.line]\n"
                    "from = {1}\nto = {2}\n[part.{0}.rod]\nwidth = \"10 mm\"\nlayers = 2\n"
                    "[[support]]\nplace = \"{0}.start\"\nfix = [\"x\", \"y\", \"z\"]\n",
                    name, from, to);
  return text + "[[step]]\nkind = \"release\"\n" + rest;
}

} // namespace dielast::test
