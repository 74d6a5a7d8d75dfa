// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/manual/materials_page.hpp"

#include "cases/language/convert.hpp"
#include "cases/text/units.hpp"
#include "materials/beam_section.hpp"
#include "materials/catalog.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases {
namespace {

std::string range_of(const materials::Parameter& parameter) {
  const auto shown = [&](double value) { return format_measure(value, parameter.unit); };
  const bool bounded = std::isfinite(parameter.above), limited = std::isfinite(parameter.below);
  if (bounded && limited) return fmt::format("{} .. {}", shown(parameter.above), shown(parameter.below));
  if (bounded) return "above " + shown(parameter.above);
  return limited ? "below " + shown(parameter.below) : "any";
}

template<class S>
std::string parameter_table() {
  std::string text = "| key | meaning | unit | range | default |\n|---|---|---|---|---|\n";
  for (const materials::ParameterOf<S>& row : S::parameters)
    text += fmt::format("| `{}`{} | {} | {} | {} | {} |\n", row.name, row.list ? " (list)" : "", row.meaning,
                        row.unit == "1" ? "-" : row.unit, range_of(row),
                        row.fallback ? format_measure(*row.fallback, row.unit) : "required");
  return text + "\n";
}

template<class Law>
std::string law_text() {
  return fmt::format("### `{}`\n\n`{}`\n\nSource: {}.\n\n", Law::name, Law::formula, Law::source) +
         parameter_table<Law>();
}

template<std::size_t... I>
std::string laws_text(std::index_sequence<I...>) {
  return (law_text<std::variant_alternative_t<I, materials::ElasticLaw>>() + ...);
}

/// Keys of [film.material] that are no law's and no dielectric's.
std::string mass_and_viscosity_table() {
  const Section& material = *case_schema().find_section("film")->find_section("material");
  std::string text = "| key | meaning | unit | range | default |\n|---|---|---|---|---|\n";
  for (const char* name : {"density", "viscosity"}) {
    const Key& key = *material.find_key(name, "");
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, key.meaning, key.unit,
                        range_text(key, key.unit), *key.fallback);
  }
  return text + "\n";
}

/// The parameters of a law as it stands.
std::string values_of(const materials::ElasticLaw& law) {
  return std::visit(
      []<class Law>(const Law& one) {
        std::string text = fmt::format("`{}`", Law::name);
        const auto shown = [](double value, std::string_view unit) { return format_measure(value, unit); };
        for (const auto& row : Law::parameters) {
          text += fmt::format(", {} ", row.name);
          if (row.number) text += shown(one.*row.number, row.unit);
          if (row.list)
            for (const double value : one.*row.list) text += shown(value, row.unit) + " ";
        }
        return text;
      },
      law);
}

std::string film_text(const materials::NamedFilm& film) {
  const materials::Dielectric& dielectric = film.material.dielectric;
  std::string text = fmt::format("### {}\n\n- law: {}\n", film.name, values_of(film.material.law));
  for (const materials::Branch& branch : film.material.branches) {
    const auto [x, y] = branch.directions;
    text += fmt::format("- branch: {}, relaxation time {}, dashpot `{}`{}\n", values_of(branch.law),
                        format_measure(branch.viscosity / materials::initial_shear_modulus(branch.law), "s"),
                        branch.dashpot == materials::Dashpot::log ? "log" : "nominal",
                        x && y ? "" : fmt::format(", directions `[\"{}\"]`", x ? "x" : "y"));
  }
  text += fmt::format(
      "- permittivity {}, breakdown field {}, density {}\n", format_measure(dielectric.permittivity, "F/m"),
      format_measure(dielectric.breakdown_field, "V/m"), format_measure(film.material.density, "kg/m^3"));
  return text + fmt::format("- source: {}\n- good for: {}\n\n", film.source, film.validity);
}

} // namespace

std::string materials_page() {
  std::string text =
      "# Materials\n\nMade by `dielast info materials.md` from the tables that the program itself reads; "
      "`dielast info laws` and `dielast info materials` show the same on the terminal.\n\n"
      "Stresses and moduli are per undeformed film; I1, I2 are the invariants of the right Cauchy-Green "
      "tensor, l1, l2, l3 the principal stretches. Laws are incompressible unless they say otherwise. "
      "Thickness, field and capacitance take every film as if it kept its volume, l3 = 1/(l1 l2), one of a "
      "compressible law (St. Venant-Kirchhoff), too.\n\n"
      "## Equilibrium laws (`[film.material] law`, and those of branches)\n\n";
  text += laws_text(std::make_index_sequence<std::variant_size_v<materials::ElasticLaw>>());
  text += "## Dielectric\n\n"
          "`potential per undeformed volume = -eps(C)/2 (Phi/H)^2 (l1 l2)^2, "
          "eps(C) = eps (1 + c (l1 + l2 - 2))`\n\nSource: Zhao & Suo 2007 and 2008, J. Appl. Phys. 104, "
          "123530. Breakdown where the true field reaches E_B (l1 l2)^(n/2) (Koh et al. 2011).\n\n" +
          parameter_table<materials::Dielectric>();
  text +=
      "## Branches (`[[film.material.branch]]`)\n\n"
      "A spring (any of the laws) in series with a dashpot, beside the law. It stores the law's energy at "
      "the elastic deformation C Cv^-1. `relaxation_time` is viscosity over the law's shear modulus at "
      "small strain; give one of the two. As drawn branches are relaxed; along an axis in which its dashpot "
      "does not flow a branch's spring is free of stress at the stretch 1, not at the prestretch. Fits and "
      "runs go by the same flow rules.\n\n"
      "| dashpot | flow rule | source |\n|---|---|---|\n"
      "| `log` | `eta Cv' = 2 dW/dG - alpha Cv, G = Cv^-1, det Cv = 1` | Reese & Govindjee 1998; Foo, Cai, "
      "Koh, Bauer & Suo 2012 |\n"
      "| `nominal` | `eta xi_i' = -dW/dxi_i` along the film's axes named in `directions` | Jeong, Mun, Yun & "
      "Kyung 2023 (spring-rolled muscle) |\n\n";
  text +=
      "## Mass and viscosity (`[film.material]`)\n\n" + mass_and_viscosity_table() +
      "`viscosity` is that of a dashpot beside the law (Kelvin & Voigt): a branch of the dashpot `log` whose "
      "neo-Hookean spring is 1e4 times as stiff as the law, or as eta times the fastest rate of the "
      "case where that is more: angular frequencies of waves and sweeps, and one over the durations of "
      "steps. Up to that rate the complex modulus mu + i omega eta is off by less than 1e-4 of itself; "
      "loads that jump move the film by 1e-4 of where they lead at once.\n\n";
  text += "## Named film materials (`film.material = \"...\"`)\n\n";
  for (const materials::NamedFilm& film : materials::named_films()) text += film_text(film);
  text += "## Walls and frames (`honeycomb.wall_material`)\n\n" + parameter_table<materials::ElasticSolid>();
  for (const materials::NamedSolid& solid : materials::named_solids())
    text += fmt::format(
        "### {}\n\n- Young's modulus {}, Poisson's ratio {}, yield strain {}\n- source: {}\n- good "
        "for: {}\n\n",
        solid.name, format_measure(solid.solid.youngs_modulus, "Pa"), solid.solid.poisson_ratio,
        solid.solid.yield_strain, solid.source, solid.validity);
  text.pop_back();
  return text;
}

} // namespace dielast::cases
