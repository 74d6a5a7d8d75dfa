// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/results_folder.hpp"

#include "post/file_output.hpp"
#include "tests/post/scratch.hpp"

#include <sys/wait.h>

namespace dielast::post::results_folder_test {
namespace {

class ResultsFolderTest : public ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    path = directory / "results";
  }
  bool exists(const std::string& file) const { return std::filesystem::exists(path / file); }
  std::string text(const std::string& file) const { return content("results/" + file); }
  void foreign(const std::string& file, const std::string& text = "foreign") const {
    std::ofstream(path / file, std::ios::binary) << text;
  }
  /// A folder of complete results: a.csv, b.csv.
  void make_results() const {
    ResultsFolder folder(path, "run");
    folder.begin();
    folder.write("a.csv", "a");
    folder.write("b.csv", "b");
    folder.set_complete(4);
  }
  /// What a folder that cannot be owned says.
  std::string refusal(const std::string& command = "run") const {
    try {
      ResultsFolder folder(path, command);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path path;
};

TEST_F(ResultsFolderTest, ListsWhatItWrites) {
  make_results();
  EXPECT_EQ(text("manifest.txt"), "dielast results 1 run\nfile a.csv\nfile b.csv\ncomplete 4\n");
  EXPECT_EQ(text("b.csv"), "b");
  EXPECT_EQ(ResultsFolder(path, "run").complete(), 4);
}

TEST_F(ResultsFolderTest, ListsANameBeforeItIsMade) {
  ResultsFolder folder(path, "run");
  folder.begin();
  folder.add("a.csv");
  EXPECT_EQ(text("manifest.txt"), "dielast results 1 run\nfile a.csv\n");
  folder.write("a.csv", "a");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.csv"});
  EXPECT_FALSE(folder.complete());
}

TEST_F(ResultsFolderTest, NothingOfOlderResultsStaysAndWhatIsForeignDoes) {
  make_results();
  foreign("b.csv.part");
  foreign("notes.txt");
  ResultsFolder folder(path, "run");
  folder.begin();
  folder.write("a.csv", "new");
  EXPECT_EQ(text("a.csv"), "new");
  EXPECT_FALSE(exists("b.csv"));
  EXPECT_FALSE(exists("b.csv.part"));
  EXPECT_EQ(text("notes.txt"), "foreign");
  EXPECT_EQ(text("manifest.txt"), "dielast results 1 run\nfile a.csv\n");
  EXPECT_FALSE(folder.complete());
}

TEST_F(ResultsFolderTest, WhatIsForeignIsNotOverwritten) {
  make_results();
  foreign("c.csv");
  ResultsFolder folder(path, "run");
  folder.begin();
  folder.write("a.csv", "again");
  EXPECT_THROW(folder.write("c.csv", "c"), std::runtime_error);
  EXPECT_EQ(text("c.csv"), "foreign");
  EXPECT_EQ(text("a.csv"), "again");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.csv"});
}

TEST_F(ResultsFolderTest, GoesOnWithWhatIsKept) {
  make_results();
  foreign("a.csv.part"); // of a run that was killed
  ResultsFolder folder(path, "run");
  folder.begin({"a.csv"});
  EXPECT_EQ(text("a.csv"), "a");
  EXPECT_FALSE(exists("a.csv.part"));
  EXPECT_FALSE(exists("b.csv"));
  folder.write("c.csv", "c");
  EXPECT_EQ(text("manifest.txt"), "dielast results 1 run\nfile a.csv\nfile c.csv\n");
}

TEST_F(ResultsFolderTest, InnerFoldersGoWithWhatTheyList) {
  make_results();
  for (const char* study : {"one", "two"}) {
    ResultsFolder outer(directory / study, "study");
    outer.begin();
    outer.add("point");
    ResultsFolder(directory / study / "point", "run").write("a.csv", "a");
  }
  std::ofstream(directory / "two/point/notes.txt") << "foreign";
  for (const char* study : {"one", "two"}) ResultsFolder(directory / study, "study").begin();
  EXPECT_FALSE(std::filesystem::exists(directory / "one/point"));
  EXPECT_FALSE(std::filesystem::exists(directory / "two/point/a.csv"));
  EXPECT_TRUE(std::filesystem::exists(directory / "two/point/notes.txt"));
}

TEST_F(ResultsFolderTest, OnlyOneProcessOwnsIt) {
  make_results();
  const pid_t owner = fork();
  if (owner == 0) {
    const ResultsFolder folder(path, "run");
    std::ofstream(directory / "ready").put('1');
    pause();
  }
  while (!std::filesystem::exists(directory / "ready")) usleep(1000);
  EXPECT_NE(refusal().find("in use by another run"), std::string::npos);
  kill(owner, SIGKILL);
  waitpid(owner, nullptr, 0);
  EXPECT_EQ(refusal(), "");
}

TEST_F(ResultsFolderTest, OfAnotherCommandIsRefused) {
  make_results();
  EXPECT_EQ(refusal("study"),
            path.string() + ": holds the results of \"dielast run\"; choose another with -o");
  EXPECT_EQ(ResultsFolder(path, "run").complete(), 4);
}

TEST_F(ResultsFolderTest, WhatIsNoManifestIsRefusedAndStays) {
  std::filesystem::create_directory(path);
  for (const std::string& other :
       {std::string("my own list"), std::string("my own list\n"), std::string("dielast results 2 run\n"),
        std::string("dielast results 1 run\nfile ../a.csv\n"),
        std::string("dielast results 1 run\nfile a/b\n"), std::string("dielast results 1 run\nfile ..\n"),
        std::string("dielast results 1 run\nfile \n"),
        std::string("dielast results 1 run\nfile manifest.txt\n"),
        std::string("dielast results 1 run\ncomplete\n"), std::string("dielast results 1 run\nthing\n"),
        std::string("dielast results 1 run\n\n"), std::string("dielast results 1 run\nfile a\0b\n", 32)}) {
    foreign("manifest.txt", other);
    EXPECT_NE(refusal().find("not the manifest of this version"), std::string::npos) << other;
    EXPECT_EQ(text("manifest.txt"), other);
  }
}

// A full disk leaves half a line, which could be the name of a foreign file.
TEST_F(ResultsFolderTest, HalfALineListsNothing) {
  std::filesystem::create_directory(path);
  foreign("notes");
  for (const char* cut : {"dielast resu", "dielast results 1 ru", "dielast results 1 run\nfile notes"}) {
    foreign("manifest.txt", cut);
    ResultsFolder folder(path, "run");
    EXPECT_TRUE(folder.names().empty());
    EXPECT_EQ(text("manifest.txt"), "dielast results 1 run\n");
    folder.begin();
    EXPECT_EQ(text("notes"), "foreign");
  }
}

TEST_F(ResultsFolderTest, NamesThatLeadElsewhereAreRefused) {
  ResultsFolder folder(path, "run");
  for (const char* name : {"", "..", "a/b", "/etc/passwd", "a\nfile b", "manifest.txt"})
    EXPECT_THROW(folder.add(name), std::runtime_error) << name;
}

// In a folder that others can write to, a planted link must not lead a file of results elsewhere.
TEST_F(ResultsFolderTest, PlantedLinksAreNotFollowed) {
  std::ofstream(directory / "mine") << "mine";
  std::filesystem::create_directory(path);
  std::filesystem::create_symlink(directory / "mine", path / "a.csv.part");
  std::filesystem::create_symlink(directory / "mine", path / "b.csv");
  ResultsFolder folder(path, "run");
  folder.write("a.csv", "a");
  EXPECT_THROW(folder.write("b.csv", "b"), std::runtime_error);
  EXPECT_EQ(content("mine"), "mine");
  EXPECT_EQ(text("a.csv"), "a");
  std::filesystem::create_directory(directory / "other");
  std::filesystem::create_symlink(directory / "mine", directory / "other/manifest.txt");
  EXPECT_THROW(ResultsFolder(directory / "other", "run"), WriteError);
  EXPECT_EQ(content("mine"), "mine");
}

TEST_F(ResultsFolderTest, AFullDiskKeepsTheOldFile) {
  ResultsFolder folder(path, "run");
  folder.write("a.csv", "old");
  const FileSizeLimit limit(500);
  EXPECT_THROW(folder.write("a.csv", std::string(1000, 'x')), WriteError);
  EXPECT_EQ(text("a.csv"), "old");
  EXPECT_FALSE(exists("a.csv.part"));
}

} // namespace
} // namespace dielast::post::results_folder_test
