#include "cases/parameter_keys.hpp"
#include "materials/catalog.hpp"

namespace dielast::cases {
namespace {

constexpr double vacuum_permittivity = 8.8541878128e-12; // F/m, CODATA 2018

/// The law and its parameters, for every alternative of the registry.
template<std::size_t... I>
void add_law_keys(std::vector<Key>& keys, std::index_sequence<I...>) {
  using materials::ElasticLaw;
  std::vector<Choice> laws{{std::string(std::variant_alternative_t<I, ElasticLaw>::name),
                            std::string(std::variant_alternative_t<I, ElasticLaw>::formula)}...};
  const Binding choose{
      [](void* object, const Value& value) {
        ElasticLaw& law = static_cast<Film*>(object)->material.law;
        const auto wanted = static_cast<std::size_t>(value.at(0).number);
        // a law that a named material has brought keeps its parameters
        if (law.index() != wanted) ((I == wanted ? void(law.emplace<I>()) : void()), ...);
      },
      [](const void* object) { return value_of(static_cast<const Film*>(object)->material.law.index()); }};
  const std::string usual = laws.front().word;
  keys.push_back(
      word("law", laws, choose, "equilibrium law (energy per undeformed volume)").otherwise(usual));
  (add_parameter_keys<Film, std::variant_alternative_t<I, ElasticLaw>>(
       keys, [](auto& film) { return std::get_if<I>(&film.material.law); }, {laws[I].word}),
   ...);
}

Section material_section() {
  Section section;
  section.name = "material";
  section.meaning =
      "a named material (material = \"...\"), or a table; with `name`, what the table leaves out is "
      "that of the named material";
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
        static_cast<Film*>(object)->material = named.material;
        return true;
      }
    return false;
  };
  section.keys.push_back(
      text("name", to(&Film::material_name), "a named material to start from, or a label").optional());
  add_law_keys(section.keys, std::make_index_sequence<std::variant_size_v<materials::ElasticLaw>>());
  add_parameter_keys<Film, materials::IdealDielectric>(section.keys,
                                                       [](auto& film) { return &film.material.dielectric; });
  const Binding relative{[](void* object, const Value& value) {
                           static_cast<Film*>(object)->material.dielectric.permittivity =
                               value.at(0).number * vacuum_permittivity;
                         },
                         [](const void*) { return std::optional<Value>(); }};
  section.keys.push_back(number("relative_permittivity", relative, "permittivity over that of vacuum")
                             .at_least(1)
                             .at_most(1e5)
                             .replacing("permittivity"));
  section.keys.push_back(measure("density", "kg/m^3",
                                 to_part<Film>([](auto& film) -> auto& { return film.material.density; }),
                                 "mass per volume")
                             .above(0)
                             .otherwise("960 kg/m^3"));
  return section;
}

} // namespace

Section film_section() {
  Section section;
  section.name = "film";
  section.meaning = "the dielectric film";
  section.presence = Section::Presence::required;
  section.access = member(&Case::film);
  section.keys = {
      measure("thickness", "m", to(&Film::thickness), "thickness of the unstretched film")
          .above(0)
          .at_most(0.1),
      number("prestretch", to(&Film::prestretch),
             "stretch along x and y before anything else, or one for both")
          .values(2, 2)
          .or_one_for_all()
          .above(0)
          .at_most(100)
          .otherwise("1"),
  };
  section.sections.push_back(material_section());
  return section;
}

} // namespace dielast::cases
