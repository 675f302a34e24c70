// Tests that the encoder reads back the files that the decoder writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "common/files/float_position.h"
#include "common/testing/scratch_folder.h"
#include "decoder/meshes/frame_sink.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc {
namespace {

constexpr std::int32_t kMinInt32 = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kMaxInt32 = std::numeric_limits<std::int32_t>::max();

// Returns small numbers and large ones of all sizes, the same on every run.
std::vector<std::int32_t> test_positions(std::size_t count) {
  std::vector<std::int32_t> positions{0, 1, -1, kMinInt32, kMaxInt32, 16777217, -16777219};
  std::uint64_t state = 1;
  while (positions.size() < count) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const int shift = static_cast<int>((state >> 27) % 31);
    positions.push_back(static_cast<std::int32_t>(state >> 32) >> shift);
  }
  return positions;
}

class MeshFiles : public ScratchFolderTest {
 protected:
  void SetUp() override {
    ScratchFolderTest::SetUp();
    options_.num_vertices = 100;
    options_.num_frames = 12;
    options_.frame_rate = {24000, 1001};
    options_.triangles = {{0, 1, 2}, {99, 98, 97}, {5, 6, 7}};
  }

  // Writes the frames, 300 numbers each; reads them back in some order.
  void expect_same_floats(const std::string& name, std::span<const std::int32_t> all) {
    const std::string file = path(name);
    auto sink = open_frame_sink(file, options_);
    ASSERT_TRUE(sink) << sink.error().message;
    for (std::size_t f = 0; f < 12; ++f) {
      const auto error = (*sink)->write_frame(all.subspan(300 * f, 300));
      ASSERT_FALSE(error) << error->message;
    }
    const auto error = (*sink)->finish();
    ASSERT_FALSE(error) << error->message;

    const bool cache = file.ends_with(".pc2") || file.ends_with(".mdd");
    InputOptions input{cache ? path("x.obj") : file, cache ? file : "", {}};
    input.weld = !file.ends_with(".glb");
    const auto source = open_frame_source(input);
    ASSERT_TRUE(source) << source.error().message;
    ASSERT_EQ((*source)->num_frames(), 12U);
    EXPECT_EQ((*source)->frame_rate(), options_.frame_rate);
    EXPECT_EQ((*source)->triangles(), options_.triangles);
    std::vector<float> xyz(300);
    for (const std::uint32_t f : {11U, 0U, 5U, 1U, 6U}) {
      ASSERT_FALSE((*source)->read_frame(f, xyz));
      for (std::size_t i = 0; i < 300; ++i) {
        ASSERT_EQ(xyz[i], float_position(options_.grid, i % 3, all[300 * f + i]))
            << file << ", frame " << f << ", number " << i;
      }
    }
  }

  SinkOptions options_;
};

constexpr const char* kNames[] = {"x.rlpd", "x.pc2",     "x.mdd",    "x.glb",
                                  "x",      "y/f%d.obj", "z/f%d.ply"};

TEST_F(MeshFiles, EveryFormatGivesBackTheSameFloats) {
  for (const bool ascii : {false, true}) {
    options_.ascii = ascii;
    for (const std::int32_t log2_step : {-150, -20, 0, 90}) {
      options_.grid = {log2_step, {-3, 1000, 77777}};
      for (const char* name : kNames) expect_same_floats(name, test_positions(300 * 12));
    }
  }
}

// glTF stores differences from the first frame for a few vertices, for all, or for none.
TEST_F(MeshFiles, SmallMovesGiveBackTheSameFloats) {
  options_.grid = {-10, {0, 5, 9}};
  std::vector<std::int32_t> all;
  for (int f = 0; f < 12; ++f) {
    for (int i = 0; i < 300; ++i) {
      const bool moves = f % 3 == 1 ? i % 3 == 0 : f % 3 == 2 && i < 5;
      all.push_back(i * i + (moves ? f : 0));
    }
  }
  for (const char* name : kNames) expect_same_floats(name, all);
  for (std::size_t i = 300; i < all.size(); ++i) all[i] = all[i - 300];
  for (const char* name : kNames) expect_same_floats(name, all);
}

TEST_F(MeshFiles, SparseTargetsMakeASmallerFile) {
  options_.grid = {-10, {0, 0, 0}};
  std::vector<std::int32_t> all(300 * 12);
  const auto size_of = [&](std::size_t moving) {
    for (std::size_t f = 1; f < 12; ++f) {
      std::fill_n(all.begin() + static_cast<std::ptrdiff_t>(300 * f), moving, 1);
    }
    expect_same_floats("x.glb", all);
    return std::filesystem::file_size(folder_ / "x.glb");
  };
  const auto few = size_of(10);
  EXPECT_LT(few + 11 * std::size_t{900}, size_of(300));
}

TEST_F(MeshFiles, RefusesPositionsThatNoFloatHolds) {
  options_.grid = {120, {kMaxInt32, 0, 0}};
  auto sink = open_frame_sink(path("x.glb"), options_);
  ASSERT_TRUE(sink);
  const auto error = (*sink)->write_frame(std::vector<std::int32_t>(300, kMaxInt32));
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("frame 0 (from 0), vertex 0: too large"), std::string::npos);
}

}  // namespace
}  // namespace rlpc
