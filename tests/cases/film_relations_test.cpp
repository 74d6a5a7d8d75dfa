#include "tests/cases/film_cases.hpp"

#include "cases/fit_model.hpp"

#include <cmath>

// Random relations between runs that must agree, twenty draws each.

namespace dielast::cases {
namespace {

constexpr int draws = 20;
const std::string plain = "[output]\nfields = false\nerror_estimate = false\n";

class FilmRelations : public FilmCases {
 protected:
  struct Inflated {
    std::string film, geometry;
    double bulk_modulus, stretch; ///< kPa; the prestretch
    bool balloon;
  };
  Inflated draw() {
    const double stretch = below(3) == 0 ? 1.0 : uniform(1.02, 1.8);
    const bool balloon = below(3) == 0;
    return {fmt::format("[film]\nthickness = \"{} mm\"\nprestretch = {}\n[film.material]\n{}"
                        "permittivity = \"4e-11 F/m\"\n",
                        uniform(0.3, 1.5), balloon ? 1.0 : stretch,
                        laws(uniform(20, 80))[static_cast<std::size_t>(below(5))]),
            balloon
                ? fmt::format("[balloon]\nradius = \"20 mm\"\n")
                : fmt::format("[disc]\nradius = \"20 mm\"\nelectrode_radius = \"{} mm\"\n", uniform(5, 15)),
            std::pow(10, uniform(1.7, 6.3)), stretch, balloon};
  }
  static std::string chamber(const Inflated& device, const std::string& goal, const char* step, int rings) {
    return device.film + device.geometry +
           fmt::format("[chamber]\nbulk_modulus = \"{} kPa\"\n{}[mesh]\nrings = {}\n", device.bulk_modulus,
                       goal, rings) +
           fmt::format("[[step]]\nkind = \"{}\"\n", step) + plain +
           fmt::format(
               "[[quantity]]\nname = \"height\"\nkind = \"displacement\"\nof = \"{}\"\nalong = \"z\"\n",
               device.balloon ? "north" : "centre") +
           "[[quantity]]\nname = \"pumped\"\nkind = \"pumped volume\"\n";
  }
};

TEST_F(FilmRelations, volume_control_leads_to_the_state_of_pressure_control) {
  for (int n = 0; n < draws; ++n) {
    const Inflated device = draw();
    const double pressure = uniform(50, 250); // Pa, below the greatest of the thinnest and softest
    const Ran pressed = run(chamber(device, fmt::format("pressure = \"{} Pa\"\n", pressure), "pressure", 12));
    const double own = pressed.last("volume"), pumped = pressed.last("pumped");
    EXPECT_NEAR(pumped, own * (1 + pressure / (1e3 * device.bulk_modulus)), 1e-12 * pumped);
    const Ran filled = run(chamber(device, fmt::format("volume = \"{:.17g} m^3\"\n", pumped), "inflate", 12));
    EXPECT_NEAR(filled.last("pressure"), pressure, 1e-5 * pressure) << n << device.film << device.geometry;
    EXPECT_NEAR(filled.last("volume"), own, 1e-7 * own);
    EXPECT_NEAR(filled.last("height"), pressed.last("height"), 1e-7);
  }
}

TEST_F(FilmRelations, a_chamber_in_space_is_that_of_the_meridian) {
  for (int n = 0; n < draws; ++n) {
    Inflated device = draw();
    while (device.balloon) device = draw();
    const std::string volume = fmt::format("volume = \"{} ml\"\n", uniform(0.5, 6));
    const Ran meridian = run(chamber(device, volume, "inflate", 12));
    const Ran space = run("model = \"3d\"\n" + chamber(device, volume, "inflate", 6));
    for (const char* name : {"height", "pressure", "volume"})
      EXPECT_NEAR(space.last(name), meridian.last(name), 1e-2 * std::abs(meridian.last(name)))
          << n << " " << name << device.film << device.geometry;
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
    const materials::Material material = read_case(directory / "material.toml").film.material;
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
} // namespace dielast::cases
