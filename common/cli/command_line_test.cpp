#include "common/cli/command_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace rlpc {
namespace {

struct Program {
  Program() {
    app.add_option("IN", in, "What to read")->required();
    app.add_option("-o,--output", out,
                   "A description that is much too long for one line, and must be continued in "
                   "the column where it began")
        ->option_text("FILE")
        ->check(CLI::ExistingFile)
        ->group("Main");
    app.add_option("--points", points, "Points")->option_text("FILE")->group("Main");
    app.add_option("--a-rather-long-name", number, "A number")
        ->check(CLI::Range(1, 9))
        ->option_text("N")
        ->group("Rare");
    app.add_option("--level", level, "A level, or the usual one")
        ->expected(0, 1)
        ->check(CLI::IsMember({"low", "7"}))
        ->group("Rare");
    add_help(app, {"IN [OPTIONS]", {"Main"}, "Examples\n  program x", "Details"}, "1.2.3");
  }

  // Returns the exit code; 1000 if the program continues.
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "program");
    std::vector<char*> argv;
    argv.reserve(words.size());
    for (std::string& word : words) argv.push_back(word.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto code = parse_command_line(app, static_cast<int>(argv.size()), argv.data());
    shown = testing::internal::GetCapturedStdout();
    said = testing::internal::GetCapturedStderr();
    return code.value_or(1000);
  }

  CLI::App app{"Does a thing.", "program"};
  std::string in;
  std::string out;
  std::string points;
  int number = 0;
  std::string level = "usual";
  std::string shown;
  std::string said;
};

TEST(CommandLine, OptionsWithoutTheirValueDoNotTakeAnArgument) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--level", "a.obj", "--points", "p"},
        {"--points", "p", "--level", "a.obj"},
        {"a.obj", "--points", "p", "--level"},
        {"--level", "--points", "p", "--", "a.obj"}}) {
    Program p;
    EXPECT_EQ(p.run(words), 1000) << p.said;
    EXPECT_EQ(p.in, "a.obj");
    EXPECT_EQ(p.points, "p");
    EXPECT_NE(p.level, "usual");
  }
  for (const char* value : {"low", "7"}) {
    Program p;
    EXPECT_EQ(p.run({"--level", value, "a.obj"}), 1000) << p.said;
    EXPECT_EQ(p.in, "a.obj");
    EXPECT_EQ(p.level, value);
  }
  EXPECT_EQ(Program().run({"--level", "9", "a.obj"}), 64);  // a wrong number, not a second file
}

TEST(CommandLine, HelpHasTheMainGroupsInColumns) {
  Program p;
  EXPECT_EQ(p.run({"--help"}), 0);
  EXPECT_EQ(p.shown, R"(Does a thing.
Usage: program IN [OPTIONS]

  IN                      What to read

Main:
  -o, --output FILE       A description that is much too long for one line, and
                          must be continued in the column where it began
  --points FILE           Points

Examples
  program x

All options, details and exit codes: program --help-all
)");
}

TEST(CommandLine, HelpAllHasEveryGroupAndTheDetails) {
  Program p;
  EXPECT_EQ(p.run({"--help-all"}), 0);
  for (const char* text :
       {"\nMain:\n", "\nRare:\n  --a-rather-long-name N  A number\n", "\nHelp:\n  -h, --help  ",
        "  --help-all  ", "  --version  ", "\nExamples\n  program x\n\nDetails\n"}) {
    EXPECT_NE(p.shown.find(text), std::string::npos) << text << p.shown;
  }
  EXPECT_EQ(p.shown.find("N:"), std::string::npos);
}

TEST(CommandLine, ShowsTheVersion) {
  Program p;
  EXPECT_EQ(p.run({"--version"}), 0);
  EXPECT_EQ(p.shown, "program 1.2.3\n");
}

TEST(CommandLine, ReadsOptions) {
  Program p;
  EXPECT_EQ(p.run({"x", "--a-rather-long-name", "7"}), 1000);
  EXPECT_EQ(p.in, "x");
  EXPECT_EQ(p.number, 7);
  EXPECT_EQ(p.said, "");
}

TEST(CommandLine, SuggestsSimilarOptions) {
  const std::string more = "\nRun with --help for more information.\n";
  const auto complaint = [&](const std::vector<std::string>& words) {
    Program p;
    EXPECT_EQ(p.run(words), 64);
    EXPECT_TRUE(p.said.ends_with(more)) << p.said;
    return p.said.substr(0, p.said.size() - std::min(more.size(), p.said.size()));
  };
  EXPECT_EQ(complaint({"x", "--pionts=y"}),
            "program: unknown option --pionts=y; did you mean --points?");
  EXPECT_EQ(complaint({"x", "--nonsense"}), "program: unknown option --nonsense");
  EXPECT_EQ(complaint({"x", "y.pc2"}),
            "program: unexpected argument y.pc2; did you mean --points y.pc2?");
  EXPECT_EQ(complaint({"x", "y", "z"}),
            "program: unexpected arguments y z; put patterns in quotes, as in 'walk_*.obj'");
  EXPECT_EQ(complaint({}), "program: IN is required");
}

TEST(CommandLine, KnowsWhichMeshAPointCacheIsFor) {
  const auto complaint = [&](const std::vector<std::string>& words) {
    Program p;
    std::string second;
    std::string points;
    p.app.add_option("SECOND", second, "What else to read");
    p.app.add_option("--points-b", points, "Points");
    EXPECT_EQ(p.run(words), 64);
    return p.said.substr(0, p.said.find('\n'));
  };
  const std::string begin = "program: unexpected argument";
  EXPECT_EQ(complaint({"a.obj", "a.pc2", "b.rlpc"}),
            begin + " a.pc2; did you mean --points-a a.pc2?");
  EXPECT_EQ(complaint({"a.rlpc", "b.obj", "b.mdd"}),
            begin + " b.mdd; did you mean --points-b b.mdd?");
  EXPECT_EQ(complaint({"a.obj", "a.pc2", "b.obj", "b.pc2"}),
            begin + "s a.pc2 b.pc2; did you mean --points-a a.pc2 --points-b b.pc2?");
  EXPECT_EQ(complaint({"a.obj", "a.rlpc", "a.pc2"}),
            begin + " a.pc2; did you mean --points-a a.pc2?");
  EXPECT_EQ(complaint({"a.obj", "out/a.obj", "out/a.pc2"}),
            begin + " out/a.pc2; did you mean --points-b out/a.pc2?");
  EXPECT_EQ(complaint({"a.obj", "b.rlpc", "c.pc2"}),
            begin + " c.pc2; did you mean --points-a c.pc2?");
  EXPECT_EQ(complaint({"a.obj", "b.obj", "c.pc2"}),
            begin + " c.pc2; did you mean --points-b c.pc2?");
  EXPECT_EQ(complaint({"a.pc2", "b.obj", "c.obj"}),
            begin + " c.obj; put patterns in quotes, as in 'walk_*.obj'");
}

}  // namespace
}  // namespace rlpc
