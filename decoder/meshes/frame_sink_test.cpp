#include "decoder/meshes/frame_sink.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/files/float_position.h"
#include "common/testing/scratch_folder.h"

namespace rlpc {
namespace {

namespace fs = std::filesystem;

SinkOptions two_frames() {
  SinkOptions options;
  options.num_vertices = 3;
  options.num_frames = 2;
  options.frame_rate = {30000, 1001};
  options.grid = {-2, {100, 0, -100}};
  options.triangles = {{0, 1, 2}};
  return options;
}
const std::vector<std::int32_t> kFirst{-100, 0, 100, -99, 0, 100, -100, 1, 100};
const std::vector<std::int32_t> kSecond{-100, 0,           102, -99, 2147483647,
                                        100,  -2147483647, 1,   100};

class FrameSinkTest : public ScratchFolderTest {
 protected:
  // Returns all paths below the folder, sorted.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      names.push_back(fs::relative(entry.path(), folder_).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  // Writes both frames; returns the first error.
  static std::string write(const std::string& to, const SinkOptions& options = two_frames()) {
    auto sink = open_frame_sink(to, options);
    if (!sink) return sink.error().message;
    for (const auto& frame : {kFirst, kSecond}) {
      if (const auto error = (*sink)->write_frame(frame)) return error->message;
    }
    if (const auto error = (*sink)->finish()) return error->message;
    return "";
  }
};

using Names = std::vector<std::string>;

TEST_F(FrameSinkTest, WritesRlpdAsInTheAnnex) {
  EXPECT_EQ(write(path("a.rlpd")), "");
  EXPECT_EQ(files(), (Names{"a.rlpd"}));
  const std::string bytes = content("a.rlpd");
  ASSERT_EQ(bytes.size(), 44U + 12 + 2 * 36);
  const std::vector<std::uint32_t> expected{0x44504C52, 1,   3, 1,          2, 30000, 1001,
                                            0xFFFFFFFE, 100, 0, 0xFFFFFF9C, 0, 1,     2};
  for (std::size_t i = 0; i < bytes.size() / 4; ++i) {
    std::uint32_t value = 0;
    for (std::size_t b = 4; b-- > 0;) {
      value = (value << 8) | static_cast<unsigned char>(bytes[4 * i + b]);
    }
    if (i < 14) {
      EXPECT_EQ(value, expected[i]) << i;
    } else {
      EXPECT_EQ(static_cast<std::int32_t>(value), i < 23 ? kFirst[i - 14] : kSecond[i - 23])
          << i;
    }
  }
}

TEST_F(FrameSinkTest, WritesAPointCacheAndItsMesh) {
  EXPECT_EQ(write(path("a.pc2")), "");
  EXPECT_EQ(files(), (Names{"a.obj", "a.pc2"}));
  EXPECT_EQ(content("a.obj"),
            "# frame_rate 30000/1001\nv 0 0 0\nv 0.25 0 0\nv 0 0.25 0\nf 1 2 3\n");
  const std::string bytes = content("a.pc2");
  ASSERT_EQ(bytes.size(), 32U + 2 * 36);
  EXPECT_EQ(bytes.substr(0, 20), std::string("POINTCACHE2\0\1\0\0\0\3\0\0\0", 20));
  EXPECT_EQ(bytes.substr(20, 12), std::string("\0\0\0\0\0\0\x80\x3F\2\0\0\0", 12));
  EXPECT_EQ(bytes.substr(44, 4), std::string("\0\0\x80\x3E", 4));  // 0.25
}

TEST_F(FrameSinkTest, WritesANewFolderOfObjFiles) {
  EXPECT_EQ(write(path("out")), "");
  EXPECT_EQ(files(), (Names{"out", "out/frame_0000.obj", "out/frame_0001.obj"}));
  EXPECT_EQ(content("out/frame_0001.obj"),
            "# frame_rate 30000/1001\nv 0 0 0.5\nv 0.25 536870912 0\nv -536870880 0.25 0\n"
            "f 1 2 3\n");
  EXPECT_EQ(write(path("slash/")), "");
  EXPECT_TRUE(fs::exists(path("slash/frame_0000.obj")));
}

TEST_F(FrameSinkTest, WritesIntoAnExistingFolderAndLeavesOtherFilesAlone) {
  fs::create_directory(path("out"));
  put("out/notes.txt", "mine");
  put("out/w7.obj", "old");
  put("out/w9.obj", "old");
  SinkOptions options = two_frames();
  options.first_number = 7;
  EXPECT_EQ(write(path("out/w%d.obj"), options), "");
  EXPECT_EQ(files(), (Names{"out", "out/notes.txt", "out/w7.obj", "out/w8.obj", "out/w9.obj"}));
  EXPECT_EQ(content("out/notes.txt"), "mine");
  EXPECT_EQ(content("out/w9.obj"), "old");
  EXPECT_NE(content("out/w7.obj"), "old");
}

TEST_F(FrameSinkTest, WritesASingleFrameAsOneObj) {
  SinkOptions options = two_frames();
  options.num_frames = 1;
  auto sink = open_frame_sink(path("a.obj"), options);
  ASSERT_TRUE(sink);
  EXPECT_FALSE((*sink)->write_frame(kFirst));
  EXPECT_FALSE((*sink)->finish());
  EXPECT_EQ(files(), (Names{"a.obj"}));
  EXPECT_NE(write(path("b.obj")).find("one OBJ file holds one frame"), std::string::npos);
}

TEST_F(FrameSinkTest, TakesTheFormatFromTheFormOfThePath) {
  using enum SinkFormat;
  const std::vector<std::pair<std::string, SinkFormat>> named{
      {"a.rlpd", kRlpd}, {"a.PC2", kPc2}, {"a.mdd", kMdd},           {"a.glb", kGlb},
      {"a.ply", kPly},   {"a.obj", kObj}, {"o.ut/f_%04d.ply", kPly}, {"a.ply/out", kObj},
      {"out", kObj},     {"-", kObj}};
  for (const auto& [path, format] : named) {
    EXPECT_EQ(sink_format(path, kByName), format) << path;
    EXPECT_EQ(sink_format(path, kMdd), kMdd) << path;
  }
}

TEST_F(FrameSinkTest, LeavesNothingBehindWithoutFinish) {
  put("old.rlpd", "old");
  fs::create_directory(path("have"));
  for (const char* name : {"a.rlpd", "old.rlpd", "a.pc2", "out", "have", "have/f%d.obj"}) {
    auto sink = open_frame_sink(path(name), two_frames());
    ASSERT_TRUE(sink) << sink.error().message;
    EXPECT_FALSE((*sink)->write_frame(kFirst));
    EXPECT_EQ(content("old.rlpd"), "old");
  }
  EXPECT_EQ(files(), (Names{"have", "old.rlpd"}));
  EXPECT_EQ(content("old.rlpd"), "old");
}

TEST_F(FrameSinkTest, ReplacesAFinishedFileOnly) {
  put("a.rlpd", "old");
  put("a.rlpd.partial", "somebody else's");
  EXPECT_EQ(write(path("a.rlpd")), "");
  EXPECT_EQ(content("a.rlpd").size(), 128U);
  EXPECT_EQ(content("a.rlpd.partial"), "somebody else's");
}

TEST_F(FrameSinkTest, FollowsLinks) {
  put("real.rlpd", "old");
  fs::create_symlink("real.rlpd", path("link.rlpd"));
  EXPECT_EQ(write(path("link.rlpd")), "");
  EXPECT_TRUE(fs::is_symlink(path("link.rlpd")));
  EXPECT_EQ(content("real.rlpd").size(), 128U);
}

TEST_F(FrameSinkTest, KeepsExactlyTheFramesOfAPartialRlpd) {
  SinkOptions options = two_frames();
  options.keep_partial = true;
  for (const std::size_t frames : {0U, 1U}) {
    auto sink = open_rlpd_sink(path("a.rlpd"), options);
    ASSERT_TRUE(sink);
    if (frames == 1) {
      EXPECT_FALSE((*sink)->write_frame(kFirst));
    }
    EXPECT_FALSE((*sink)->finish());
    EXPECT_EQ(content("a.rlpd").size(), 56 + 36 * frames);
    EXPECT_EQ(content("a.rlpd")[16], 2);  // still declares two
  }
}

// The limit is exact to the byte.
TEST_F(FrameSinkTest, WritesUpToALimit) {
  for (const char* name : {"a.rlpd", "a.pc2", "a.mdd", "a.glb", "f%d.obj", "f%d.ply", "out"}) {
    SinkOptions options = two_frames();
    constexpr std::uint64_t kEnough = 1 << 20;
    options.limit = std::make_shared<OutputLimit>(kEnough);
    ASSERT_EQ(write(path(name), options), "") << name;
    const std::uint64_t needed = kEnough - options.limit->left;
    std::uint64_t there = 0;
    for (const std::string& file : files()) {
      if (fs::is_regular_file(folder_ / file)) there += fs::file_size(folder_ / file);
    }
    EXPECT_EQ(needed, there) << name;
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    for (std::uint64_t bytes = 0; bytes <= needed; ++bytes) {
      options.limit = std::make_shared<OutputLimit>(bytes);
      const std::string error = write(path(name), options);
      if (bytes == needed) {
        EXPECT_EQ(error, "") << name;
        continue;
      }
      const bool has_unit = bytes % 1000 == 0 || bytes % 1024 == 0;  // "1 kB"
      EXPECT_NE(error.find("has more than the " + std::to_string(bytes) + " bytes of"),
                has_unit ? 0 : std::string::npos)
          << error;
      EXPECT_TRUE(files().empty()) << name;
    }
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
}

TEST_F(FrameSinkTest, NamesPathAndReason) {
  for (const char* name : {"none/a.rlpd", "none/a.pc2", "none/out/f%d.obj", "none/out"}) {
    const std::string error = write(path(name));
    EXPECT_NE(error.find("none"), std::string::npos) << error;
    const char* const reason = std::string(name).find("a.") != std::string::npos
                                   ? ": there is no folder "
                                   : ": No such file or directory";
    EXPECT_NE(error.find(reason), std::string::npos) << error;
  }
  fs::create_directory(path("d.rlpd"));
  EXPECT_NE(write(path("d.rlpd")).find("is a folder"), std::string::npos);
  put("file", "x");
  EXPECT_NE(write(path("file")).find("is a file"), std::string::npos);
  EXPECT_NE(write(path("f%s.obj")).find("expected one %d"), std::string::npos);
  EXPECT_NE(write(path("a.fbx")).find("cannot write .fbx"), std::string::npos);
}

TEST_F(FrameSinkTest, ReportsAnUnwritableFolder) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  for (const char* name : {"a.rlpd", "a.pc2", "out", "f%d.obj"}) {
    EXPECT_NE(write(path(name)).find("Permission denied"), std::string::npos);
  }
  fs::permissions(folder_, fs::perms::owner_all);
}

TEST_F(FrameSinkTest, ReportsAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  fs::create_symlink("/dev/full", path("full.rlpd"));
  const std::string error = write(path("full.rlpd"));
  EXPECT_NE(error.find("full.rlpd: cannot write: No space left on device"), std::string::npos)
      << error;
  EXPECT_TRUE(fs::exists("/dev/full"));
}

// A limit on file sizes simulates a disk that fills up during writing.
TEST_F(FrameSinkTest, LeavesNothingBehindIfTheDiskIsFull) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  SinkOptions options = two_frames();
  options.num_vertices = 3000;
  const std::vector<std::int32_t> frame(9000, 123456789);
  for (const char* name : {"a.rlpd", "a.pc2", "out"}) {
    rlimit limit = before;
    limit.rlim_cur = 5000;
    setrlimit(RLIMIT_FSIZE, &limit);
    std::string message;
    {
      auto sink = open_frame_sink(path(name), options);
      ASSERT_TRUE(sink) << sink.error().message;
      auto error = (*sink)->write_frame(frame);
      if (!error) error = (*sink)->finish();
      ASSERT_TRUE(error) << name;
      message = error->message;
    }
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(message.find("cannot write: File too large"), std::string::npos) << message;
    EXPECT_EQ(files(), Names{}) << name;
  }
  std::signal(SIGXFSZ, old_handler);
}

TEST_F(FrameSinkTest, WritesToDevicesDirectly) {
  auto sink = open_rlpd_sink("/dev/null", two_frames());
  ASSERT_TRUE(sink);
  EXPECT_FALSE((*sink)->write_frame(kFirst));
  EXPECT_FALSE((*sink)->write_frame(kSecond));
  EXPECT_FALSE((*sink)->finish());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(FloatPosition, RoundsOnce) {
  const Grid grid{-24, {1, 0, -1}};
  EXPECT_EQ(float_position(grid, 0, -1), 0.0F);
  EXPECT_EQ(float_position(grid, 1, 16777216), 1.0F);
  EXPECT_EQ(float_position(grid, 1, 16777217), 1.0F);           // tie, to even
  EXPECT_EQ(float_position(grid, 1, 16777219), 0x1.000004p0F);  // tie, to even
  EXPECT_EQ(float_position(grid, 0, 2147483647), 128.0F);
  EXPECT_EQ(float_position(grid, 2, -2147483647 - 1), -128.0F);
  EXPECT_EQ(float_position({-150, {}}, 0, 1), 0.0F);       // half the smallest float: to even
  EXPECT_EQ(float_position({-150, {}}, 0, 3), 0x1p-148F);  // 1.5 times it: to even
  EXPECT_EQ(float_position({127, {}}, 0, -1), -0x1p127F);
}

}  // namespace
}  // namespace rlpc
