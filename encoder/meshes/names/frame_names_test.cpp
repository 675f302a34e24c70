#include "encoder/meshes/names/frame_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "encoder/meshes/names/frame_pattern.h"
#include "encoder/testing/random_names.h"

namespace rlpc {
namespace {

// Returns the names in the order of the frames, or the error.
Names sorted(Names names) {
  const auto files = sort_frames(std::move(names), "FOLDER");
  return files ? files->paths : Names{files.error().message};
}

void expect_order(const Names& names) {
  Names shuffled = names;
  Random random(7);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    EXPECT_EQ(sorted(shuffled), names);
  }
}

void expect_refused(const Names& names, const std::string& part) {
  const auto files = sort_frames(names, "FOLDER");
  ASSERT_FALSE(files) << testing::PrintToString(files->paths);
  EXPECT_NE(files.error().message.find(part), std::string::npos) << files.error().message;
}

TEST(FrameNames, CompareRunsOfDigitsByValue) {
  EXPECT_TRUE(natural_less("frame2.obj", "frame10.obj"));
  EXPECT_FALSE(natural_less("frame10.obj", "frame2.obj"));
  EXPECT_TRUE(natural_less("a9b2", "a9b10"));
  EXPECT_TRUE(natural_less("frame", "frame1"));
  EXPECT_TRUE(natural_less("f01", "f1"));
  EXPECT_FALSE(natural_less("f1", "f01"));
  EXPECT_FALSE(natural_less("f1", "f1"));
  EXPECT_FALSE(natural_less("\xC3\xA9_1", "z_1"));  // compares bytes, whatever the sign of char
  EXPECT_TRUE(natural_less("f99999999999999999999998", "f99999999999999999999999"));
}

TEST(FrameNames, AreInOrderOfSignedNumbers) {
  expect_order(
      {"sim.-005.obj", "sim.-004.obj", "sim.-001.obj", "sim.0000.obj", "sim.0001.obj"});
  expect_order({"sim.-003.obj", "sim.-002.obj", "sim.-001.obj"});
  expect_order({"-2.obj", "-1.obj", "0.obj", "1.obj"});
  expect_order({"f-1.obj", "f0.obj", "f1.obj"});
  expect_order(
      {"sim.\xE2\x88\x92"
       "2.obj",
       "sim.\xE2\x88\x92"
       "1.obj"});
  expect_order({"walk-1.obj", "walk-2.obj", "walk-10.obj"});  // no sign: a hyphen after a word
  expect_order({"2026-01-05.obj", "2026-01-06.obj", "2026-01-17.obj"});
}

TEST(FrameNames, AreInOrderOfFractions) {
  expect_order({"f_1.obj", "f_1.25.obj", "f_1.5.obj", "f_1.75.obj", "f_2.obj"});
  expect_order({"f_1.obj", "f_1.25.obj", "f_1.5.obj"});
  expect_order({"f_1.25.obj", "f_1.5.obj", "f_1.75.obj"});
  expect_order({"f_9.5.obj", "f_10.0.obj", "f_10.5.obj"});
  expect_order({"f_1,25.obj", "f_1,5.obj", "f_1,75.obj", "f_2,0.obj"});
  expect_order({"s.-1.5.obj", "s.-1.obj", "s.-0.5.obj", "s.0.obj", "s.0.5.obj"});
  expect_order({"f_1.33.obj", "f_1.67.obj", "f_2.obj", "f_2.33.obj"});
  // Frames of versions, counted.
  expect_order({"v003.8.obj", "v003.9.obj", "v003.10.obj", "v003.11.obj"});
  expect_order({"V003.8.obj", "V003.9.obj", "V003.11.obj", "V003.12.obj"});
  expect_order({"sh010_cloth_v003.995.mesh01.obj", "sh010_cloth_v003.998.mesh01.obj",
                "sh010_cloth_v003.1000.mesh01.obj", "sh010_cloth_v003.1001.mesh01.obj"});
  expect_order({"take1.8.obj", "take1.9.obj", "take1.10.obj"});
}

TEST(FrameNames, AreInOrderWhateverThePadding) {
  expect_order({"f_1.obj", "f_02.obj", "f_003.obj", "f_10.obj", "f_0011.obj"});
  expect_order({"f1.OBJ", "f2.obj", "f3.Obj"});
  expect_order({"99999999999999999999998.obj", "99999999999999999999999.obj"});
  expect_order({"a/1/mesh.obj", "a/2/mesh.obj", "a/10/mesh.obj"});
}

TEST(FrameNames, AreInOrderOfDates) {
  expect_order({"cap_2025-12-31_23-59-59.obj", "cap_2026-01-01_00-00-01.obj"});
  expect_order({"20251231_235959.obj", "20260101_000001.obj", "20260101_000002.obj"});
  expect_order({"2025-12-31.obj", "2026-01-01.obj", "2026-02-01.obj"});
}

TEST(FrameNames, AreRefusedWithStrangers) {
  const Names frames{"f_0000.obj", "f_0001.obj", "f_0002.obj", "f_0003.obj"};
  for (const char* stranger :
       {"restpose.obj", "f.obj", "f_rest.obj", "f_0003_copy.obj", "f_0003 (2).obj",
        "Copy of f_0003.obj", "g_0000.obj", "f_0003b.obj", "f_3_2.obj", "F_0004.obj",
        "f_0003 - Copy.obj", "0.obj", "f_0003.1.obj", "f_0003.5.obj", "rest_0000.obj",
        "f_0003.v2.obj"}) {
    Names names = frames;
    names.insert(names.begin(), stranger);
    expect_refused(names, stranger);
    expect_refused(names, "such as f_%04d.obj");
  }
  expect_refused({"a_1.obj", "a_2.obj", "b_1.obj", "b_2.obj", "b_3.obj"}, "a_1.obj, a_2.obj");
  expect_refused({"a.obj", "b.obj"}, "a.obj, b.obj");
  expect_refused({"f_1.obj", "f_01.obj"}, "same frame number");
  expect_refused({"f_1.obj", "f_1.0.obj"}, "same frame number");
  // A rest pose, or several takes, with a point before the frame.
  expect_refused({"take1.obj", "take1.0001.obj", "take1.0002.obj"}, "take1.obj");
  expect_refused({"take1.0001.obj", "take1.0002.obj", "take2.0001.obj"}, "take2.0001.obj");
  expect_refused({"v1.1.obj", "v1.2.obj", "v2.1.obj", "v2.2.obj"}, "v1.1.obj");
  expect_refused({"V1.1.obj", "V1.2.obj", "V2.1.obj", "V2.2.obj"}, "V1.1.obj");
  expect_refused({"take1.1.obj", "take1.2.obj", "take2.1.obj", "take2.2.obj"}, "take1.1.obj");
  expect_refused({"f_1.5.obj", "f_1.25.obj"}, "f_1.%g.obj for f_1.5.obj, f_1.25.obj");
}

TEST(FrameNames, TellsAboutGaps) {
  const auto notes = [](const Names& names) { return sort_frames(names, "")->notes; };
  EXPECT_TRUE(notes({"f1.obj", "f2.obj", "f3.obj"}).empty());
  EXPECT_TRUE(notes({"f_1.obj", "f_1.5.obj", "f_2.obj"}).empty());
  EXPECT_TRUE(notes({"s.-1.obj", "s.0.obj", "s.1.obj"}).empty());
  EXPECT_EQ(notes({"f1.obj", "f3.obj"}),
            Names{"there is no frame between f1.obj and f3.obj; the gap is closed"});
  EXPECT_EQ(notes({"f1.obj", "f2.obj", "f4.obj", "f7.obj"}),
            Names{"the numbers of the frames have 2 gaps, the first between f2.obj and f4.obj; "
                  "the gaps are closed"});
  EXPECT_EQ(notes({"f10.obj", "f20.obj", "f30.obj"}),
            Names{"the numbers of the frames go up in steps of 10; each file is one frame, "
                  "without gaps"});
}

TEST(FrameNames, AreSelectedByPatterns) {
  const Names names{"s.-0002.obj", "s.-001.obj", "s.0000.obj", "s.0001.obj", "s.02.obj",
                    "s.1.5.obj",   "s.rest.obj", "t_1.obj",    "t_1.5.obj",  "t_2.obj"};
  const auto select = [&](const std::string& pattern) {
    const auto files = select_frames(pattern, names);
    return files ? files->paths : Names{files.error().message};
  };
  EXPECT_EQ(select("s.%04d.obj"),
            (Names{"s.-0002.obj", "s.-001.obj", "s.0000.obj", "s.0001.obj"}));
  EXPECT_EQ(select("t_%d.obj"), (Names{"t_1.obj", "t_2.obj"}));
  EXPECT_EQ(select("d/t_%g.obj"), (Names{"d/t_1.obj", "d/t_1.5.obj", "d/t_2.obj"}));
  EXPECT_EQ(select("s.%g.obj"), (Names{"s.-0002.obj", "s.-001.obj", "s.0000.obj", "s.0001.obj",
                                       "s.1.5.obj", "s.02.obj"}));
  EXPECT_NE(select("t_%04d.obj")[0].find("no such file"), std::string::npos);
  EXPECT_NE(select("t_%04d.obj")[0].find("t_%g.obj takes t_1.5.obj"), std::string::npos);
  EXPECT_NE(select("t_%g_%g.obj")[0].find("expected one %d"), std::string::npos);
}

TEST(FrameNames, AreSelectedByPatternsWithSigns) {
  const Names signs{"f_-3.obj", "f_-2.obj", "f_-1.obj", "f_+0.obj", "f_+1.OBJ", "f_+2.obj"};
  for (const char* pattern : {"f_%d.obj", "f_%g.obj", "f_#.obj"}) {
    const auto files = select_frames(pattern, signs);
    ASSERT_TRUE(files) << files.error().message;
    EXPECT_EQ(files->paths, signs) << pattern;
    EXPECT_TRUE(files->notes.empty()) << files->notes[0];
  }
  const Names padded{"f_-001.obj", "f_+000.obj", "f_+001.obj"};
  EXPECT_EQ(select_frames("f_%04d.obj", padded)->paths, padded);  // like "%+04d" in C
  EXPECT_EQ(select_frames("f_###.obj", padded)->paths, padded);
}

TEST(FrameNames, ThatPatternsLeaveOutAreTold) {
  const auto note = [](const std::string& pattern, const Names& names) {
    const auto files = select_frames(pattern, names);
    if (!files) return files.error().message;
    return files->notes.empty() ? std::string() : files->notes.back();
  };
  const std::string told = "left out, whose numbers are written in another way: ";
  EXPECT_EQ(note("d/f_%d.obj", {"f_1.obj", "f_2.obj", "f_2.5.obj", "f_03.obj", "f_r.obj"}),
            "2 files are " + told + "f_03.obj ...; d/f_%g.obj takes every number");
  EXPECT_EQ(note("f-%g.obj", {"f-1.obj", "f-2.obj", "f0.obj"}),
            "1 file is " + told + "f0.obj; f%g.obj takes every number");
  EXPECT_EQ(note("f_%04d.obj", {"f_0001.obj", "f_0002.obj", "g_3.obj", "f_1b.obj"}), "");
}

// A pattern for whole numbers selects what "%g" selects, or reports the rest.
TEST(FrameNames, ThatPatternsLeaveOutAreToldInRandomSchemes) {
  Random random(14);
  int told = 0;
  for (int i = 0; i < 3000; ++i) {
    Names names;
    const int first = static_cast<int>(below(random, 30)) - 15;
    for (int number = first; number < first + 12; ++number) {
      static const std::vector<const char*> kFormats{"%d",    "%+d",  "%04d",
                                                     "%+04d", "%05d", "%d.0"};
      char text[16];
      const std::size_t odd = below(random, 8) == 0 ? below(random, kFormats.size())
                                                    : static_cast<std::size_t>(i % 5);
      std::snprintf(text, sizeof text, kFormats[odd], number);
      names.push_back("f_" + std::string(text) + ".obj");
    }
    const auto files = select_frames(i % 2 == 0 ? "f_%d.obj" : "f_####.obj", names);
    if (!files) continue;  // gaps
    const bool is_whole = files->paths.size() == names.size();
    ASSERT_EQ(is_whole, files->notes.empty()) << testing::PrintToString(names);
    if (!is_whole) ++told;
  }
  EXPECT_GT(told, 50);
}

TEST(FrameNames, AreExplainedWherePatternsAreWrong) {
  const auto message = [](const std::string& pattern) {
    return select_frames(pattern, {"f_0001.obj"}).error().message;
  };
  EXPECT_NE(message("f_%4d.obj").find("write %04d"), std::string::npos);
  EXPECT_NE(message("f_%x.obj").find("expected one %d, %04d or ####"), std::string::npos);
  EXPECT_NE(message("f_%x.obj").find("walk_%04d.obj"), std::string::npos);
}

// A way to name frames, with other numbers before and after the frame number.
class Scheme {
 public:
  explicit Scheme(Random& random) {
    static const Names kBefore{"",
                               "f",
                               "f_",
                               "walk.",
                               "sh010_v003.",
                               "sh010_cloth_v12_",
                               "cap_2026-01-31_",
                               "\xC3\xA9t\xC3\xA9_",
                               "\xE6\xAD\xA9",
                               "take2-",
                               "a b ",
                               "x1y2z3_",
                               "frame",
                               "walk-"};
    static const Names kAfter{".obj",    ".mesh01.obj", "_lod2.obj",
                              "_v2.OBJ", ".geo.obj",    "m.obj"};
    before_ = kBefore[below(random, kBefore.size())];
    after_ = kAfter[below(random, kAfter.size())];
    width_ = below(random, 6);
    // A hyphen after a word, before every number, is no sign.
    const bool may_be_all_negative =
        before_.empty() || std::string("._ ").find(before_.back()) != std::string::npos;
    const int count = 3 + static_cast<int>(below(random, 30));
    int first = static_cast<int>(below(random, 1200));
    if (below(random, 2) == 0) first = -static_cast<int>(below(random, 20));
    // Versions and takes have no parts.
    const bool may_have_parts =
        before_.empty() || before_ == "f" || before_ == "f_" || before_ == "frame";
    const int parts =
        may_have_parts ? std::vector<int>{1, 1, 2, 4, 5, 10}[below(random, 6)] : 1;
    if (!may_be_all_negative && first * parts + count <= 0) first = 0;
    for (int i = 0; i < count; ++i) names_.push_back(name_of(first * parts + i, parts));
  }
  const Names& names() const { return names_; }

 private:
  std::string name_of(int number, int parts) const {
    const int size = number < 0 ? -number : number;
    char whole[16];
    std::snprintf(whole, sizeof whole, "%0*d", static_cast<int>(width_), size / parts);
    std::string text = before_ + (number < 0 ? "-" : "") + whole;
    if (size % parts != 0) {
      char part[16];
      std::snprintf(part, sizeof part, "%g", static_cast<double>(size % parts) / parts);
      text += part + 1;  // skips the zero before the point
    }
    return text + after_;
  }

  std::string before_;
  std::string after_;
  std::size_t width_ = 0;
  Names names_;
};

TEST(FrameNames, AreInOrderInRandomSchemes) {
  Random random(11);
  for (int i = 0; i < 3000; ++i) {
    const Names names = Scheme(random).names();
    Names shuffled = names;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    ASSERT_EQ(sorted(shuffled), names) << i;
  }
}

// Names that do not fit the scheme are changed or lengthened anywhere but in their digits.
TEST(FrameNames, AreNeverThoseOfRandomStrangers) {
  Random random(12);
  for (int i = 0; i < 3000; ++i) {
    Names names = Scheme(random).names();
    std::string stranger = names[below(random, names.size())];
    static const Names kAdded{"copy", " (2)",    "_rest", "x",       "~",
                              "_1",   " copy 2", "b2",    "\xC3\xA9"};
    const std::size_t place = below(random, 2) == 0 ? 0 : stranger.rfind('.');
    stranger.insert(place, kAdded[below(random, kAdded.size())]);
    names.push_back(stranger);
    std::shuffle(names.begin(), names.end(), random);
    const auto files = sort_frames(names, "FOLDER");
    ASSERT_FALSE(files) << stranger << testing::PrintToString(names);
  }
}

TEST(FrameNames, AreOneSequenceOnly) {
  Random random(13);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    Names names = Scheme(random).names();
    const Names others = Scheme(random).names();
    if (others[0].substr(0, 1) == names[0].substr(0, 1)) continue;
    names.insert(names.end(), others.begin(), others.end());
    std::shuffle(names.begin(), names.end(), random);
    ASSERT_FALSE(sort_frames(names, "FOLDER")) << testing::PrintToString(names);
    ++refused;
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace rlpc
