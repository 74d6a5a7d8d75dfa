#include "cases/schema.hpp"

namespace dielast::cases {
namespace {

const std::vector<Choice> axes{{"x", "along x"}, {"y", "along y"}, {"z", "normal to the undeformed film"}};

Section list_section(std::string name, std::string meaning, Access access) {
  Section section;
  section.name = std::move(name);
  section.meaning = std::move(meaning);
  section.shape = Section::Shape::list;
  section.presence = Section::Presence::list;
  section.access = std::move(access);
  return section;
}

Section electrode_section() {
  Section section = list_section("electrode", "a charged part of the film", each(&Case::electrodes));
  section.keys = {
      text("name", to(&Electrode::name), "its name, for [drive.<name>]").distinct(),
      text("place", to(&Electrode::place), "the part of the film that it covers").refers_to(Reference::place),
  };
  return section;
}

Section support_section() {
  Section section = list_section("support", "a place that is held", each(&Case::supports));
  const Binding fixed{[](void* object, const Value& value) {
                        auto& held = static_cast<Support*>(object)->fixed;
                        held = {};
                        for (const Scalar& axis : value)
                          held.at(static_cast<std::size_t>(axis.number)) = true;
                      },
                      [](const void* object) -> std::optional<Value> {
                        Value value;
                        const auto& held = static_cast<const Support*>(object)->fixed;
                        for (std::size_t i = 0; i < held.size(); ++i)
                          if (held[i]) value.push_back({static_cast<double>(i), ""});
                        return value;
                      }};
  section.keys = {
      text("place", to(&Support::place), "the place that is held").refers_to(Reference::place),
      word("fix", axes, fixed, "directions in which it cannot move").values(1, 3),
  };
  return section;
}

Section load_section() {
  Section section =
      list_section("load", "a dead force, applied by the steps of kind \"force\"", each(&Case::loads));
  section.keys = {
      text("place", to(&Load::place), "the place over whose nodes it is spread evenly")
          .refers_to(Reference::place),
      measure("force", "N", to(&Load::force), "components along x, y and z").values(3, 3),
  };
  return section;
}

Section drive_section() {
  using Drives = std::map<std::string, double>;
  Section section;
  section.name = "drive";
  section.meaning = "how an electrode is driven; with several electrodes [drive.<electrode>]";
  section.shape = Section::Shape::by_electrode;
  section.access = {[](void* parent, const std::string& electrode) -> void* {
                      return &static_cast<Case*>(parent)->drives[electrode];
                    },
                    [](const void* parent) {
                      std::vector<Access::Entry> entries;
                      const Drives& drives = static_cast<const Case*>(parent)->drives;
                      for (const auto& [electrode, voltage] : drives)
                        entries.push_back({electrode, &voltage});
                      return entries;
                    }};
  const Binding voltage{
      [](void* object, const Value& value) { *static_cast<double*>(object) = value.at(0).number; },
      [](const void* object) { return value_of(*static_cast<const double*>(object)); }};
  section.keys = {
      measure("voltage", "V", voltage, "voltage that the steps of kind \"voltage\" reach")
          .at_least(0)
          .otherwise("0 V"),
  };
  return section;
}

Section step_section() {
  Section section = list_section("step", "what happens, in this order", each(&Case::steps));
  section.selector = "kind";
  const auto increments = [] {
    return integer("increments", to(&Step::increments), "number of equal increments to start with")
        .at_least(1)
        .at_most(100000);
  };
  section.keys = {
      word("kind",
           {{"release", "the prestretched film is cut free and finds its equilibrium"},
            {"voltage", "ramps every drive to its voltage"},
            {"force", "ramps every load to its force"}},
           to(&Step::kind), "what happens in this step"),
      text("name", to(&Step::name), "its name in results").otherwise_as("kind").distinct(),
      increments().otherwise("1").only({"release"}),
      increments().otherwise("10").only({"voltage", "force"}),
  };
  return section;
}

} // namespace

std::vector<Section> action_sections() {
  return {electrode_section(), support_section(), load_section(), drive_section(), step_section()};
}

} // namespace dielast::cases
