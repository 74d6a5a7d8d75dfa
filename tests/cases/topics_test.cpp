// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <algorithm>
#include <regex>

namespace dielast::test::topics_test {
namespace {

class Topics : public CommandTest {};

TEST_F(Topics, HelpAndVersion) {
  const Ended help = dielast({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"run", "check", "mesh", "study", "info", "schema", "Exit codes:"})
    EXPECT_NE(help.out.find(command), std::string::npos) << command;
  const Ended version = dielast({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("dielast 0.")) << version.out;
  for (const char* command : {"run", "check", "mesh", "study", "info", "schema"})
    EXPECT_EQ(dielast({command, "--help"}).exit_code, 0) << command;
  EXPECT_EQ(dielast({"help"}).out, help.out);
  EXPECT_EQ(dielast({"help", "run"}).out, dielast({"run", "--help"}).out);
}

TEST_F(Topics, InfoExplainsWhatACaseMaySay) {
  const std::vector<std::pair<const char*, const char*>> words{
      {"overview", "materials"},    {"materials", "VHB 4910 (honeycomb)"},
      {"laws", "arruda-boyce"},     {"laws", "dashpot"},
      {"devices", "patch"},         {"steps", "transient"},
      {"waves", "unipolar sine"},   {"devices", "corner_top"},
      {"actuators", "loudspeaker"}, {"lens", "[chamber]"},
      {"quantities", "elongation"}, {"steps", "release"},
      {"keys", "prestretch"},       {"units", "voltage"},
      {"terms", "arclength"}};
  for (const auto& [topic, word] : words) {
    const Ended ended = dielast({"info", topic});
    EXPECT_EQ(ended.exit_code, 0) << topic;
    EXPECT_NE(ended.out.find(word), std::string::npos) << topic;
  }
  EXPECT_EQ(dielast({"info"}).out, dielast({"info", "overview"}).out);
}

TEST_F(Topics, InfoExplainsAnyName) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> names{
      {"disc", {"electrode_radius", "standard quantities", "places"}},
      {"gent", {"film.material.law", "stretch_limit"}},
      {"film.thickness", {"[film]", "thickness", "required"}},
      {"film", {"[film]", "prestretch", "[film.material]"}},
      {"thickness", {"[film]", "field thickness"}},
      {"voltage", {"[drive", "step.kind = \"voltage\""}},
      {"study.best", {"[[study.best]]", "largest", "[[study.best.where]]"}},
      {"limit point", {"the load turns"}},
      {"arclength", {"past a limit point"}},
      {"meridian", {"of revolution"}},
      {"VHB 4910 (honeycomb)", {"from: ", "law"}}};
  for (const auto& [name, words] : names) {
    const Ended ended = dielast({"info", name});
    EXPECT_EQ(ended.exit_code, 0) << name;
    for (const char* word : words)
      EXPECT_NE(ended.out.find(word), std::string::npos) << name << ": " << ended.out;
  }
  EXPECT_EQ(dielast({"info", ""}).out, dielast({"info"}).out);
  const Ended wrong = dielast({"info", "film.thicknes"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.err.find("did you mean \"film.thickness\"?"), std::string::npos) << wrong.err;
}

// What a case of the literature's devices is said to have is there.
TEST_F(Topics, ActuatorsAreOfSectionsAndFilesThatThereAre) {
  const std::string told = dielast({"info", "actuators"}).out;
  const std::regex section(R"(\[\[?([a-z_.]+)\])"), file("gallery/([a-z_/]+[.]toml)");
  const auto begin = [&](const std::regex& what) {
    return std::sregex_iterator(told.begin(), told.end(), what);
  };
  EXPECT_GT(std::distance(begin(section), {}), 20);
  for (auto found = begin(section); found != std::sregex_iterator(); ++found)
    EXPECT_EQ(dielast({"info", (*found)[1].str()}).exit_code, 0) << (*found)[1];
  EXPECT_GT(std::distance(begin(file), {}), 15);
  for (auto found = begin(file); found != std::sregex_iterator(); ++found)
    EXPECT_TRUE(std::filesystem::exists(source_folder / "cases/gallery" / (*found)[1].str())) << (*found)[1];
}

TEST_F(Topics, LongNamesStandApartFromWhatTheyMean) {
  for (const char* line :
       {"[antagonistic_rolls] two rolls", "[hollow_sphere] sphere", "[[point_mass]] a mass"})
    EXPECT_NE(dielast({"info", "overview"}).out.find(line), std::string::npos) << line;
  EXPECT_NE(dielast({"info", "fin"}).out.find("added_mass_coefficient added"), std::string::npos);
}

TEST_F(Topics, MaterialsAreToldWithoutRoundOff) {
  const std::string out = dielast({"info", "materials"}).out;
  EXPECT_FALSE(std::regex_search(out, std::regex("[0-9]{14}"))) << out;
  EXPECT_FALSE(std::regex_search(out, std::regex("breakdown_exponent[0-9]"))) << out;
}

std::vector<std::string> commands_of_help(const std::string& help) {
  std::vector<std::string> names;
  std::smatch found;
  const std::string list =
      help.substr(help.find("Subcommands:"), help.find("Examples:") - help.find("Subcommands:"));
  for (const std::string& line : lines_of(list))
    if (std::regex_match(line, found, std::regex("  ([a-z]+) +[^ ].*"))) names.push_back(found[1]);
  return names;
}

std::vector<std::string> options_of_help(const std::string& help) {
  std::vector<std::string> words;
  for (const std::string& line : lines_of(help)) {
    std::string head = line.substr(0, 28);
    if (!head.starts_with("  -")) continue;
    for (std::smatch found; std::regex_search(head, found, std::regex("--?[a-z]+(-[a-z]+)*"));
         head = found.suffix())
      words.push_back(found[0]);
  }
  return words;
}

// The manual page and what shells are told know every command and option of the help, and the shells no
// other.
TEST_F(Topics, ManualPageAndCompletionAreWhatTheHelpSays) {
  const std::vector<std::string> commands = commands_of_help(dielast({"--help"}).out);
  ASSERT_GE(commands.size(), 10u);
  std::string page = std::regex_replace(dielast({"man"}).out, std::regex(R"(\\-)"), "-");
  const std::string zsh = dielast({"completion", "zsh"}).out, fish = dielast({"completion", "fish"}).out;
  for (const std::string& line : lines_of(zsh)) // an apostrophe of a meaning would end what is quoted
    EXPECT_EQ(count(std::regex_replace(line, std::regex(R"('\\'')"), ""), "'") % 2, 0u) << line;
  write("bash", dielast({"completion", "bash"}).out + R"(
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _dielast; printf '%s\n' "${COMPREPLY[@]}" | sort
)");
  const auto bash = [&](const std::string& words) {
    const std::string line = "cd " + directory.string() + " && bash bash dielast " + words + " > completed";
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
    return lines_of(content("completed"));
  };
  std::vector<std::string> first = commands;
  first.insert(first.end(), {"--help", "--version"});
  std::ranges::sort(first);
  EXPECT_EQ(bash("''"), first);
  EXPECT_EQ(bash("stu"), std::vector<std::string>{"study"});
  EXPECT_EQ(bash("info devi"), std::vector<std::string>{"devices"});
  EXPECT_EQ(bash("run smal"), std::vector<std::string>{"small.toml"});
  EXPECT_EQ(bash("completion z"), std::vector<std::string>{"zsh"});
  write("my case.toml", "");
  EXPECT_EQ(bash("run my"), std::vector<std::string>{"my case.toml"});
  for (const std::string& command : commands) {
    EXPECT_NE(page.find(".SS dielast " + command), std::string::npos) << command;
    EXPECT_NE(zsh.find("  " + command + ") _arguments"), std::string::npos) << command;
    EXPECT_NE(fish.find(" -a " + command + " "), std::string::npos) << command;
    std::vector<std::string> options = options_of_help(dielast({command, "--help"}).out);
    ASSERT_FALSE(options.empty()) << command;
    std::ranges::sort(options);
    EXPECT_EQ(bash(command + " -"), options) << command;
    for (const std::string& option : options) {
      EXPECT_NE(page.find(option), std::string::npos) << command << " " << option;
      EXPECT_NE(zsh.find(option + "["), std::string::npos) << command << " " << option;
      const std::string long_option = "-l " + option.substr(std::min<std::size_t>(2, option.size()));
      if (option.starts_with("--")) {
        EXPECT_NE(fish.find(long_option), std::string::npos) << command << " " << option;
      }
    }
  }
}

TEST_F(Topics, WhatIsNoCommandIsExplained) {
  const auto error = [&](const std::vector<std::string>& words) {
    const Ended ended = dielast(words);
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(ended.out, "");
    return ended.err;
  };
  EXPECT_EQ(error({"small.toml"}),
            "error: \"small.toml\" is no command: did you mean \"dielast run small.toml\"?\n");
  EXPECT_EQ(error({"runn", "small.toml"}), "error: \"runn\" is no command; did you mean \"run\"?\n");
  EXPECT_TRUE(error({}).starts_with(
      "error: there is no command: write dielast COMMAND ..., with one of run, check,"));
  EXPECT_NE(error({"run", "small.toml", "--set", "drive.voltage=5", "kV"})
                .find("one with blanks stands in quotes: --set \"drive.voltage=5 kV\""),
            std::string::npos);
  EXPECT_EQ(error({"run", "small.toml", "-j", "x"}).find("--set"), std::string::npos);
  EXPECT_NE(error({"run"}).find("dielast run --help"), std::string::npos);
  EXPECT_EQ(error({"run", "--resum"}),
            "error: \"--resum\" is no option; did you mean \"--resume\"?\nMore with: dielast run --help\n");
  EXPECT_EQ(error({"--foo"}), "error: \"--foo\" is no option\nMore with: dielast --help\n");
  EXPECT_EQ(error({"run", "small.toml", "-j", "-1"}).find("is no option"), std::string::npos);
}

TEST_F(Topics, ThePagesAreWhatTheTablesSay) {
  for (const std::string page : {"manual.md", "materials.md"})
    EXPECT_EQ(dielast({"info", page}).out, text_of(source_folder / "docs" / page))
        << "make it again: dielast info " << page << " > docs/" << page;
}

TEST_F(Topics, SchemaIsJson) {
  const Ended ended = dielast({"schema"});
  EXPECT_EQ(ended.exit_code, 0);
  const nlohmann::json schema = nlohmann::json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(schema.is_object());
  EXPECT_TRUE(schema.contains("$schema"));
  for (const char* section :
       {"film", "honeycomb", "disc", "patch", "mesh", "drive", "spring", "step", "check"})
    EXPECT_TRUE(schema["properties"].contains(section)) << section;
}

TEST_F(Topics, MeshIsWrittenAndItsPlacesListed) {
  const Ended ended = dielast({"mesh", "small.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  for (const char* place : {"film", "walls", "boundary", "cell[1,0]", "wall[1]", "left_apex", "corner_top"})
    EXPECT_NE(ended.out.find(std::string("  ") + place + " "), std::string::npos) << place << ended.out;
  EXPECT_NE(content("out/small-mesh.pvd").find("</VTKFile>"), std::string::npos);
  EXPECT_NE(content("out/small-mesh_film_0000.vtu").find("</VTKFile>"), std::string::npos);
  EXPECT_NE(content("out/small-mesh_walls_0000.vtu").find("</VTKFile>"), std::string::npos);
}

TEST_F(Topics, CheckPrintsSizesAndWritesNothing) {
  const Ended ended = dielast({"check", "small.toml"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_TRUE(ended.out.starts_with("small.toml: valid\n")) << ended.out;
  EXPECT_NE(ended.out.find("a free body"), std::string::npos) << ended.out;
  EXPECT_FALSE(exists("small-results"));
  EXPECT_EQ(dielast({"check", "disc.toml"}).out.find("a free body"), std::string::npos);
}

TEST_F(Topics, TangentsPassTheirCheck) {
  for (const char* file : {"small.toml", "disc.toml"})
    for (const char* model : {"model=planar", "model=3d"})
      for (const char* order : {"mesh.order=1", "mesh.order=2"}) {
        const Ended ended = dielast({"check", file, "--tangent", "--set", model, "--set", order});
        EXPECT_EQ(ended.exit_code, 0) << file << " " << model << " " << order << "\n"
                                      << ended.out << ended.err;
        EXPECT_NE(ended.out.find(": passed\n"), std::string::npos) << ended.out;
      }
}

TEST_F(Topics, TangentsOfThinSolidsAndOfContactThatBeginsPassTheirCheck) {
  write("thin.toml", "title = \"Thin\"\nmodel = \"planar\"\n[film]\nthickness = \"20 um\"\n[film.material]\n"
                     "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n"
                     "[slab]\nlength = \"10 mm\"\nheight = \"0.1 mm\"\n[drive]\nvoltage = \"100 V\"\n");
  const std::filesystem::path gallery = source_folder / "cases/gallery";
  for (const std::string& file : {std::string("thin.toml"), (gallery / "gripper/ball.toml").string(),
                                  (gallery / "rolled_muscle/roll_core.toml").string(),
                                  (gallery / "stack_on_table/friction.toml").string()}) {
    const Ended ended = dielast({"check", file, "--tangent"});
    EXPECT_EQ(ended.exit_code, 0) << file << "\n" << ended.out << ended.err;
  }
}

// A text of a thousand lines would run away on a terminal; elsewhere it goes straight on.
TEST_F(Topics, LongTextsGoThroughThePagerOnATerminal) {
  if (std::system("script -qec true /dev/null > /dev/null 2>&1 < /dev/null") != 0)
    GTEST_SKIP() << "no script, or no terminals for it";
  const auto shown = [&](const std::string& topic, const std::string& pager) {
    const std::string line = "cd " + directory.string() + " && PAGER='" + pager +
                             "' script -qec '" DIELAST_PROGRAM " info " + topic +
                             "' /dev/null > shown < /dev/null 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0);
    return content("shown");
  };
  EXPECT_TRUE(shown("keys", "sed s/^/paged:/").starts_with("paged:"));
  EXPECT_EQ(shown("gent", "sed s/^/paged:/").find("paged:"), std::string::npos); // a few lines
  EXPECT_NE(shown("keys", "no-such-pager").find("prestretch"), std::string::npos);
}

} // namespace
} // namespace dielast::test::topics_test
