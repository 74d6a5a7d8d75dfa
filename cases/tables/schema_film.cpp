// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/part_kind.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/parameter_keys.hpp"
#include "materials/catalog.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

constexpr double vacuum_permittivity = 8.8541878128e-12; // F/m, CODATA 2018

constexpr double smallest_modulus = 1;            // Pa, far below any gel
constexpr double smallest_relaxation_time = 1e-9; // s: the branch's strain would be round-off

std::optional<Conflict> law_conflict(const materials::ElasticLaw& law) {
  if (const auto* ogden = std::get_if<materials::Ogden>(&law))
    if (const auto problem = ogden->problem()) return Conflict{"exponents", *problem};
  const double modulus = materials::initial_shear_modulus(law);
  if (modulus >= smallest_modulus) return std::nullopt;
  return Conflict{"law", fmt::format("its shear modulus at small strain is {:.6g} Pa, allowed at least {} Pa",
                                     modulus, smallest_modulus)};
}

/// [[film.material.branch]], of what has a material
template<class Owner>
Section branch_section() {
  using materials::Branch;
  Section section = list_section(
      "branch", "a Maxwell branch beside the equilibrium law: a spring in series with a dashpot", {});
  section.access = {[](void* parent, const std::string&) -> void* {
                      return &static_cast<Owner*>(parent)->material.branches.emplace_back();
                    },
                    [](const void* parent) {
                      std::vector<Access::Entry> entries;
                      for (const Branch& branch : static_cast<const Owner*>(parent)->material.branches)
                        entries.push_back({"", &branch});
                      return entries;
                    },
                    [](void* parent) { static_cast<Owner*>(parent)->material.branches.clear(); }};
  section.selector = "law";
  section.acts = when::branches_flow();
  add_law_keys<Branch>(
      section.keys, [](auto& branch) -> auto& { return branch.law; }, "law of the spring");
  const Binding relaxation_time{[](void* object, const Value& value) {
                                  auto& branch = *static_cast<Branch*>(object);
                                  branch.viscosity =
                                      value.at(0).number * materials::initial_shear_modulus(branch.law);
                                },
                                [](const void*) { return std::optional<Value>(); }};
  const Binding directions{[](void* object, const Value& value) {
                             auto& flows = static_cast<Branch*>(object)->directions;
                             flows = {};
                             for (const Scalar& axis : value)
                               flows.at(static_cast<std::size_t>(axis.number)) = true;
                           },
                           [](const void* object) -> std::optional<Value> {
                             Value value;
                             const auto& flows = static_cast<const Branch*>(object)->directions;
                             for (std::size_t i = 0; i < flows.size(); ++i)
                               if (flows[i]) value.push_back({static_cast<double>(i), ""});
                             return value;
                           }};
  section.keys.push_back(measure("relaxation_time", "s", relaxation_time,
                                 "viscosity over the spring's shear modulus at small strain")
                             .at_least(smallest_relaxation_time));
  section.keys.push_back(measure("viscosity", "Pa s", to(&Branch::viscosity), "viscosity eta of the dashpot")
                             .above(0)
                             .replacing("relaxation_time"));
  section.keys.push_back(
      word("dashpot",
           {{"log", "resists the rate of the logarithmic viscous strain (Reese & Govindjee 1998)",
             materials::Dashpot::log},
            {"nominal", "resists the rate of the viscous stretches along x and y",
             materials::Dashpot::nominal}},
           to(&Branch::dashpot), "what the dashpot resists")
          .otherwise("log"));
  section.keys.push_back(
      word("directions", {{"x", "along x", 0}, {"y", "along y", 1}}, directions,
           "directions in which a nominal dashpot flows; along the other the spring is free of "
           "stress at stretch 1")
          .values(1, 2)
          .otherwise("[\"x\", \"y\"]"));
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& branch = *static_cast<const Branch*>(object);
    if (branch.dashpot == materials::Dashpot::log && !(branch.directions[0] && branch.directions[1]))
      return Conflict{"directions", "only for dashpot = \"nominal\"; a log dashpot flows in all directions"};
    if (auto wrong = law_conflict(branch.law)) return wrong;
    const double time = branch.viscosity / materials::initial_shear_modulus(branch.law);
    if (time >= smallest_relaxation_time * (1 - 1e-12)) return std::nullopt;
    return Conflict{"viscosity", fmt::format("the relaxation time is {:.6g} s, allowed at least {} s", time,
                                             smallest_relaxation_time)};
  };
  return section;
}

/// [film.material], of what has one
template<class Owner>
Section material_section() {
  Section section;
  section.name = "material";
  section.meaning =
      "a named material (material = \"...\"), one of a file (material = \"material.toml\", as `dielast fit` "
      "writes it), or a table; with `name`, what the table leaves out is that of the named material";
  section.presence = Section::Presence::required;
  section.access = same_object();
  section.selector = "law";
  section.names = [] {
    std::vector<std::string> names;
    for (const auto& film : materials::named_films()) names.emplace_back(film.name);
    return names;
  };
  section.start = [](void* object, const std::string& name) {
    for (const auto& named : materials::named_films())
      if (named.name == name) {
        static_cast<Owner*>(object)->material = named.material;
        return true;
      }
    return false;
  };
  section.keys.push_back(
      text("name", to(&Owner::material_name), "a named material to start from, or a label").optional());
  add_law_keys<Owner>(
      section.keys, [](auto& film) -> auto& { return film.material.law; },
      "equilibrium law (energy per undeformed volume)");
  add_parameter_keys<Owner, materials::Dielectric>(section.keys,
                                                   [](auto& film) { return &film.material.dielectric; });
  if constexpr (std::is_same_v<Owner, Layer>) // passive ones do not say it
    for (Key& key : section.keys)
      if (key.name == "permittivity") {
        key = std::move(key).optional();
        key.binding.get = [](const void* object) -> std::optional<Value> {
          const double said = static_cast<const Layer*>(object)->material.dielectric.permittivity;
          return said > 0 ? value_of(said) : std::nullopt;
        };
      }
  for (Key& key : section.keys)
    if (key.name == "electrostriction" || key.name.starts_with("breakdown"))
      key.acts = std::is_same_v<Owner, Layer> ? when::charges_layer() : when::charges_film();
  const Binding relative{[](void* object, const Value& value) {
                           static_cast<Owner*>(object)->material.dielectric.permittivity =
                               value.at(0).number * vacuum_permittivity;
                         },
                         [](const void*) { return std::optional<Value>(); }};
  section.keys.push_back(number("relative_permittivity", relative, "permittivity over that of vacuum")
                             .at_least(1)
                             .at_most(1e5)
                             .replacing("permittivity"));
  section.keys.push_back(measure("density", "kg/m^3",
                                 to_part<Owner>([](auto& film) -> auto& { return film.material.density; }),
                                 "mass per volume")
                             .at_least(0)
                             .otherwise("960 kg/m^3")
                             .only_with(when::masses_matter()));
  section.keys.push_back(
      measure(
          "viscosity", "Pa s", to_part<Owner>([](auto& film) -> auto& { return film.material.viscosity; }),
          "of a dashpot beside the law (Kelvin & Voigt), as of a Newtonian liquid: its stress is twice that "
          "times the deviator of the rate of strain, 3 times the rate where film is pulled one way; of "
          "solids with a bulk_modulus per volume as drawn (Kirchhoff stress)")
          .at_least(0)
          .otherwise("0 Pa.s")
          .only_with(when::film_flows()));
  section.sections.push_back(branch_section<Owner>());
  section.check = [](const void* object) {
    return law_conflict(static_cast<const Owner*>(object)->material.law);
  };
  return section;
}

/// I1 of a branch's spring in the relaxed film: what does not flow stays stretched.
double relaxed_invariant(const materials::Branch& branch, const std::array<double, 2>& stretch) {
  if (branch.directions[0] && branch.directions[1]) return 3;
  const double held = stretch[branch.directions[0] ? 1 : 0];
  return held * held + 2 / held; // the other stretches take the smallest energy
}

/// The prestretched film must be within the limits of its laws.
template<class Owner>
std::optional<Conflict> prestretch_conflict(const void* object) {
  const auto& film = *static_cast<const Owner*>(object);
  const double x = film.prestretch[0], y = film.prestretch[1];
  const double c = film.material.dielectric.electrostriction;
  if (const double share = 1 + c * (x + y - 2); !(share > 0))
    return Conflict{"prestretch",
                    fmt::format("with electrostriction = {:.6g} the permittivity is not positive: "
                                "1 + c (l1 + l2 - 2) = {:.4g}",
                                c, share)};
  const auto beyond = [](const std::string& whose, const materials::ElasticLaw& law,
                         double invariant) -> std::optional<Conflict> {
    if (materials::admits(law, invariant)) return std::nullopt;
    const auto name = std::visit([](const auto& one) { return one.name; }, law);
    return Conflict{"prestretch",
                    fmt::format("stretch limit below the prestretch: {} law \"{}\" does not reach "
                                "I1 - 3 = {:.4g}",
                                whose, name, invariant - 3)};
  };
  if (const auto found = beyond("the", film.material.law, x * x + y * y + 1 / (x * x * y * y))) return found;
  for (std::size_t b = 0; b < film.material.branches.size(); ++b) {
    const materials::Branch& branch = film.material.branches[b];
    if (const auto found =
            beyond(fmt::format("branch {}'s", b + 1), branch.law, relaxed_invariant(branch, film.prestretch)))
      return found;
  }
  return std::nullopt;
}

Key thickness_key(Binding binding, std::string meaning) {
  return measure("thickness", "m", std::move(binding), std::move(meaning)).above(0).at_most(0.1);
}

Key prestretch_key(Binding binding, std::string meaning) {
  return number("prestretch", std::move(binding), std::move(meaning))
      .of_stretch()
      .values(2, 2)
      .or_one_for_all()
      .above(0)
      .at_most(100)
      .otherwise("1");
}

/// [[film.layer]]
Section layer_section() {
  Section section = list_section(
      "layer",
      "film that lies on that of a shell, bonded to it as both are drawn; one after another, each farther "
      "from it",
      each(&Film::further_layers));
  section.keys = {
      text("name", to(&Layer::name), "its name, for the electrodes on its faces").optional().distinct(),
      word("side",
           {{"above", "where z is larger than in the film as drawn; of a standing surface outside", false},
            {"below", "on the other side", true}},
           to(&Layer::below), "the side of the film on which it lies")
          .otherwise("above"),
      thickness_key(to(&Layer::thickness), "thickness of the unstretched layer"),
      prestretch_key(
          to(&Layer::prestretch),
          "stretch along x and y in which it is bonded to the film, or one for both; with 1 it is free "
          "of stress where the film is drawn"),
  };
  section.sections.push_back(material_section<Layer>());
  section.check = prestretch_conflict<Layer>;
  return section;
}

/// What film may be by its section alone.
std::vector<Choice> sections() {
  std::vector<Choice> words;
  for (const PartKind& kind : part_kinds())
    if (kind.section) words.emplace_back(kind.word, kind.meaning, *kind.section);
  return words;
}

} // namespace

Section film_section() {
  Section section;
  section.name = "film";
  section.meaning = "the dielectric film";
  section.presence = Section::Presence::required;
  section.access = present(&Part::film);
  section.keys = {
      thickness_key(
          to(&Film::thickness),
          "thickness of the unstretched film; of a solid that of one of its layers, or the distance of its "
          "electrodes"),
      prestretch_key(to(&Film::prestretch), "stretch along x and y before anything else, or one for both"),
      word("wrinkling",
           {{"compression", "it carries the compression", false},
            {"tension field", "it wrinkles and carries tension only", true}},
           to(&Film::tension_field), "what the film does where it would be compressed")
          .otherwise("compression"),
      word("section", sections(), to(&Film::section), "what the film's thickness does").otherwise("membrane"),
      word(
          "field",
          {{"layers",
            "of layers of its thickness, each between two electrodes, stacked along the height: voltage over "
            "thickness, along the layers' normal; even within each, which in one or few layers that bend it "
            "is not",
            false},
           {"potential", "follows from the electric potential between an electrode's place and its ground",
            true}},
          to(&Film::potential), "where the field of a solid comes from")
          .otherwise("layers")
          .only_with(when::solid()),
      word("stacked_along", axes(), to(&Film::stacked_along),
           "direction in which the layers of a solid are stacked, as it is drawn (they turn with a part that "
           "is `turned`); without it along the height: y in plane strain and in a [slab], z otherwise")
          .optional()
          .only_with(when::layers()),
      measure("width", "m", to(&Film::width), "of a solid in plane strain: across the plane")
          .above(0)
          .at_most(10)
          .otherwise("1 m")
          .only_with(when::plane_strain()),
      measure("bulk_modulus", "Pa", to(&Film::bulk_modulus), "of a solid; without it it is incompressible")
          .above(0)
          .optional()
          .only_with(when::law_without_volume()),
      measure(
          "offset", "m", to(&Film::offset),
          "of a shell: from the surface on which it is drawn, held and measured, up to the film's middle as "
          "drawn; stresses, mass and weight are where the layers are")
          .at_least(-0.1)
          .at_most(0.1)
          .otherwise("0 m")
          .only_with(when::shell()),
  };
  section.sections = {material_section<Film>(), layer_section()};
  section.check = prestretch_conflict<Film>;
  return section;
}

} // namespace dielast::cases
