// What the decoder writes, the encoder reads back.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "decoder/float_position.h"
#include "decoder/frame_sink.h"
#include "encoder/frame_source.h"
#include "encoder/grid_value.h"

namespace rlpc {
namespace {

constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();

// Small numbers and all sizes of large ones, the same on every run.
std::vector<std::int32_t> test_positions(std::size_t count) {
  std::vector<std::int32_t> positions{0, 1, -1, kMin, kMax, 16777217, -16777219};
  std::uint64_t state = 1;
  while (positions.size() < count) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const int shift = static_cast<int>((state >> 27) % 31);
    positions.push_back(static_cast<std::int32_t>(state >> 32) >> shift);
  }
  return positions;
}

TEST(GridValue, IsTheSameOnBothSides) {
  const std::vector<std::int32_t> positions = test_positions(1000);
  for (std::int32_t log2_step = -150; log2_step <= 127; ++log2_step) {
    for (const std::int32_t origin : {0, 1, -12345, kMin, kMax}) {
      const Grid grid{log2_step, {origin, origin, origin}};
      for (std::size_t i = 0; i < positions.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(grid_value(grid, i % 3, positions[i])),
                  std::bit_cast<std::uint32_t>(float_position(grid, i % 3, positions[i])))
            << positions[i] << " + " << origin << ", step 2^" << log2_step;
      }
    }
  }
}

TEST(MeshFiles, EveryFormatGivesBackTheSameFloats) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("mesh_files_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  SinkOptions options;
  options.num_vertices = 100;
  options.num_frames = 12;
  options.frame_rate = {24000, 1001};
  options.triangles = {{0, 1, 2}, {99, 98, 97}, {5, 5, 5}};
  for (const std::int32_t log2_step : {-150, -20, 0, 90}) {
    options.grid = {log2_step, {-3, 1000, 77777}};
    const std::vector<std::int32_t> all = test_positions(300 * 12);
    for (const char* name : {"x.rlpd", "x.pc2", "x", "y/f%d.obj"}) {
      const std::string path = (folder / name).string();
      auto sink = open_frame_sink(path, options);
      ASSERT_TRUE(sink) << sink.error().message;
      for (std::size_t f = 0; f < 12; ++f) {
        ASSERT_FALSE((*sink)->write_frame(std::span(all).subspan(300 * f, 300)));
      }
      ASSERT_FALSE((*sink)->finish());

      const bool cache = path.ends_with(".pc2");
      const auto source =
          open_frame_source(cache ? InputOptions{(folder / "x.obj").string(), path, {}}
                                  : InputOptions{path, "", {}});
      ASSERT_TRUE(source) << source.error().message;
      EXPECT_EQ((*source)->num_frames(), 12U);
      EXPECT_EQ((*source)->frame_rate(), options.frame_rate);
      EXPECT_EQ((*source)->triangles(), options.triangles);
      std::vector<float> xyz(300);
      for (const std::uint32_t f : {11U, 0U, 5U}) {
        ASSERT_FALSE((*source)->read_frame(f, xyz));
        for (std::size_t i = 0; i < 300; ++i) {
          ASSERT_EQ(xyz[i], float_position(options.grid, i % 3, all[300 * f + i])) << path;
        }
      }
    }
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace rlpc
