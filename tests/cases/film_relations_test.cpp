// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/film_cases.hpp"

#include "cases/fitting/fit_model.hpp"
#include "meshing/rings.hpp"
#include "tests/cases/own_mesh.hpp"

#include <cmath>

// Random relations between runs that must agree, twenty draws each.

namespace dielast::cases::film_relations_test {
namespace {

constexpr int draws = 20;
const std::string plain = "[output]\nfields = false\nerror_estimate = false\n";

class FilmRelations : public FilmCases {
 protected:
  /// Films over a chamber.
  enum Kind { disc, disc_in_space, balloon, diaphragm, own_mesh, kinds };
  struct Inflated {
    std::string model, film, geometry, top; ///< lines of the case; the place whose height is told
    double bulk_modulus;                    ///< kPa
    int rings;
  };
  Inflated draw(Kind kind) {
    const bool flat = kind != balloon && kind != diaphragm && below(3) == 0;
    const double stretch = kind == balloon || flat ? 1.0 : uniform(1.02, 1.8);
    Inflated device{"",
                    fmt::format("[film]\nthickness = \"{} mm\"\nprestretch = {}\n[film.material]\n{}"
                                "permittivity = \"4e-11 F/m\"\n",
                                uniform(0.3, 1.5), stretch,
                                laws(uniform(20, 80))[static_cast<std::size_t>(below(5))]),
                    "",
                    "centre",
                    std::pow(10, uniform(1.7, 6.3)),
                    12};
    const double inner = uniform(5, 15); // mm
    switch (kind) {
    case balloon:
      device.geometry = "[balloon]\nradius = \"20 mm\"\n";
      device.top = "north";
      break;
    case diaphragm:
      device.geometry = fmt::format("[annulus]\ninner_radius = \"{} mm\"\nouter_radius = \"20 mm\"\n[plate]\n"
                                    "mass = \"10 g\"\n",
                                    inner);
      device.top = "inner";
      break;
    case own_mesh:
      write("disc.msh",
            test::gmsh_text(meshing::disc_mesh(0.02, 1e-3 * inner, 6, 1, false), "electrode", "rim"));
      device.model = "model = \"3d\"\n";
      device.geometry =
          "[[electrode]]\nname = \"film\"\nplace = \"electrode\"\n[[support]]\nplace = \"rim\"\nfix "
          "= [\"x\", \"y\", \"z\"]\n";
      device.top = "electrode";
      break;
    default:
      device.geometry = fmt::format("[disc]\nradius = \"20 mm\"\nelectrode_radius = \"{} mm\"\n", inner);
    }
    if (kind == disc_in_space) device.model = "model = \"3d\"\n", device.rings = 6;
    return device;
  }
  static std::string chamber(const Inflated& device, const std::string& goal, const char* step) {
    const std::string mesh = device.top == "electrode" ? "file = \"disc.msh\"\nunit = \"1 mm\"\n"
                                                       : fmt::format("rings = {}\n", device.rings);
    return device.model + device.film + device.geometry +
           fmt::format("[chamber]\nbulk_modulus = \"{} kPa\"\n{}[mesh]\n{}", device.bulk_modulus, goal,
                       mesh) +
           fmt::format("[[step]]\nkind = \"{}\"\n", step) + plain +
           fmt::format(
               "[[quantity]]\nname = \"height\"\nkind = \"displacement\"\nof = \"{}\"\nalong = \"z\"\n",
               device.top) +
           "[[quantity]]\nname = \"held\"\nkind = \"volume\"\n[[quantity]]\nname = \"pumped\"\nkind = "
           "\"pumped volume\"\n[[quantity]]\nname = \"reached\"\nkind = \"pressure\"\n";
  }
};

TEST_F(FilmRelations, volume_control_leads_to_the_state_of_pressure_control) {
  for (int n = 0; n < draws; ++n) {
    const Inflated device = draw(static_cast<Kind>(n % kinds));
    const double pressure = uniform(50, 250); // Pa, below the greatest of the thinnest and softest
    const Ran pressed = run(chamber(device, fmt::format("pressure = \"{} Pa\"\n", pressure), "pressure"));
    const double own = pressed.last("held"), pumped = pressed.last("pumped");
    EXPECT_GT(pressed.last("height"), 1e-5);
    EXPECT_NEAR(pumped, own * (1 + pressure / (1e3 * device.bulk_modulus)), 1e-12 * pumped);
    const Ran filled = run(chamber(device, fmt::format("volume = \"{:.17g} m^3\"\n", pumped), "inflate"));
    EXPECT_NEAR(filled.last("reached"), pressure, 1e-5 * pressure) << n << device.film << device.geometry;
    EXPECT_NEAR(filled.last("held"), own, 1e-7 * own);
    EXPECT_NEAR(filled.last("height"), pressed.last("height"), 1e-7);
  }
}

TEST_F(FilmRelations, a_chamber_in_space_is_that_of_the_meridian) {
  for (int n = 0; n < draws; ++n) {
    const Inflated device = draw(disc);
    Inflated turned = device;
    turned.model = "model = \"3d\"\n";
    turned.rings = 6;
    const std::string volume = fmt::format("volume = \"{} ml\"\n", uniform(0.5, 6));
    const Ran meridian = run(chamber(device, volume, "inflate"));
    const Ran space = run(chamber(turned, volume, "inflate"));
    for (const char* name : {"height", "reached", "held"})
      EXPECT_NEAR(space.last(name), meridian.last(name), 1e-2 * std::abs(meridian.last(name)))
          << n << " " << name << device.film << device.geometry;
  }
}

/// The plate of a driven diaphragm, pulled by a force or moved as far: the support then takes that force.
TEST_F(FilmRelations, a_moved_plate_takes_the_force_that_moves_it_as_far) {
  for (int n = 0; n < draws; ++n) {
    const std::string device =
        (n % 5 > 0 ? "" : "model = \"3d\"\n") +
        fmt::format(
            "[film]\nthickness = \"{} mm\"\nprestretch = {}\n[film.material]\n{}permittivity = \"4e-11 "
            "F/m\"\n",
            uniform(0.3, 1.5), uniform(1.3, 2.5), laws(uniform(20, 80))[static_cast<std::size_t>(below(5))]) +
        fmt::format("[annulus]\ninner_radius = \"{} mm\"\nouter_radius = \"30 mm\"\n[mesh]\nrings = 4\n",
                    uniform(6, 15)) +
        fmt::format("[plate]\nmass = \"1 g\"\n[drive]\nvoltage = \"{} V\"\n", uniform(100, 800)) + plain +
        "[[quantity]]\nname = \"height\"\nkind = \"displacement\"\nof = \"inner\"\nalong = "
        "\"z\"\n[[step]]\nkind = \"voltage\"\nincrements = 2\n";
    const double force = uniform(0.02, 0.5); // N
    const Ran pulled =
        run(device +
            fmt::format("[[step]]\nkind = \"force\"\nincrements = 4\n[[load]]\nplace = \"inner\"\nforce = "
                        "[0, 0, {}]\n",
                        force));
    EXPECT_GT(pulled.last("height"), 1e-4);
    const std::string supported = "[[quantity]]\nname = \"taken\"\nkind = \"force\"\nof = \"inner\"\nalong = "
                                  "\"z\"\n[[support]]\nplace = \"outer\"\nfix = [\"x\", \"y\", \"z\"]\n";
    const Ran moved =
        run(device + supported +
            fmt::format("[[step]]\nkind = \"move\"\nincrements = 4\n[[support]]\nplace = \"inner\"\n"
                        "[support.displacement]\nz = {:.17g}\n",
                        pulled.last("height")));
    EXPECT_NEAR(moved.last("taken"), force, 1e-6 * force) << device;
    for (const char* name : {"capacitance", "stretch_inner"})
      EXPECT_NEAR(moved.last(name), pulled.last(name), 1e-7 * pulled.last(name)) << device;
  }
}

/// Stretched to `top` and back by a patch, and the stress there by the fit's model of the case's material.
TEST_F(FilmRelations, a_fit_has_the_model_of_a_run) {
  const std::array modes{std::pair{"", materials::Mode::uniaxial},
                         std::pair{"mode = \"pure-shear\"\n", materials::Mode::pure_shear},
                         std::pair{"mode = \"equal-biaxial\"\n", materials::Mode::equal_biaxial}};
  for (int n = 0; n < draws; ++n) {
    const auto& [mode, kind] = modes[static_cast<std::size_t>(n % 3)];
    const std::string law = laws(uniform(20, 80))[static_cast<std::size_t>(below(5))];
    std::string branches;
    for (int b = 0; b <= below(2); ++b)
      branches += "[[film.material.branch]]\n" + laws(uniform(20, 80))[static_cast<std::size_t>(below(5))] +
                  fmt::format("relaxation_time = \"{} s\"\ndashpot = \"{}\"\n", uniform(0.3, 5),
                              below(2) == 0 ? "log" : "nominal");
    const double top = uniform(1.3, 2.2);
    write("stretch.csv", fmt::format("time_s,stretch\n0,1\n2,{0:.17g}\n4,1.1\n5,1.1\n", top));
    const std::string text =
        "[film]\nthickness = \"1 mm\"\n[film.material]\n" + law + "permittivity = \"4e-11 F/m\"\n" +
        branches + "[patch]\n" + mode +
        "stretch_x = { wave = \"file\", file = \"stretch.csv\" }\n"
        "[solver]\ntime_tolerance = 1e-8\n[[step]]\nkind = \"transient\"\nduration = \"5 s\"\n"
        "increments = 50\nrecord = \"0.25 s\"\n" +
        plain;
    const Ran ran = run(text);
    write("material.toml", text);
    const materials::Material material = read_case(directory / "material.toml").parts.front().film->material;
    StretchHistory history{.mode = kind};
    std::vector<double> stress;
    for (std::size_t row = 1; row < ran.time.size(); ++row) {
      if (!(ran.time[row] > (history.time.empty() ? 0 : history.time.back() + 1e-9))) continue;
      history.time.push_back(ran.time[row]);
      history.stretch.push_back(ran.values.at("stretch_x")[row]);
      stress.push_back(ran.values.at("stress_x")[row]);
    }
    ASSERT_GT(stress.size(), 15u);
    const std::vector<double> fitted = nominal_stress(material, history, 256);
    double largest = 0;
    for (const double s : stress) largest = std::max(largest, std::abs(s));
    for (std::size_t row = 0; row < stress.size(); ++row)
      EXPECT_NEAR(fitted[row], stress[row], 2e-5 * largest) << history.time[row] << "\n" << text;
  }
}

} // namespace
} // namespace dielast::cases::film_relations_test
