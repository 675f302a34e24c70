// Compares third-party glTF files with point caches baked by other software, where available.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "common/files/binary_numbers.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc {
namespace {

constexpr std::size_t kPc2HeaderBytes = 32;

// A point cache without a mesh, which our reader would require.
struct Bake {
  explicit Bake(const std::string& path) : text(*read_whole_file(path)) {}
  std::uint32_t num_vertices() const { return load_u32(text, 16); }
  std::uint32_t num_frames() const { return load_u32(text, 28); }
  float value(std::size_t i) const { return load_f32(text, kPc2HeaderBytes + 4 * i); }
  std::string text;
};

// Returns the diagonal of the box around all frames.
double diagonal_of(const Bake& bake) {
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = bake.value(axis);
    double high = low;
    for (std::size_t v = 0; v < std::size_t{bake.num_vertices()} * bake.num_frames(); ++v) {
      low = std::min<double>(low, bake.value(3 * v + axis));
      high = std::max<double>(high, bake.value(3 * v + axis));
    }
    squared += (high - low) * (high - low);
  }
  return std::sqrt(squared);
}

struct Clip {
  const char* file;
  const char* animation;
};

std::ostream& operator<<(std::ostream& out, const Clip& clip) {
  return out << clip.file << " " << clip.animation;
}

class GltfBakes : public testing::TestWithParam<Clip> {};

TEST_P(GltfBakes, AgreeInEveryFrame) {
  const std::filesystem::path folder = RLPC_SOURCE_DIR "/../shared/data/gltf";
  const std::filesystem::path file = folder / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no test data: " << file;
  const Bake bake(std::filesystem::path(file).replace_extension(".expected.pc2").string());
  const auto source =
      open_frame_source({file.string(), "", FrameRate{30, 1}, {GetParam().animation}, false});
  ASSERT_TRUE(source) << source.error().message;
  ASSERT_EQ((*source)->num_vertices(), bake.num_vertices());
  // Bakes have whole steps only; the last frame of ours has the last pose.
  ASSERT_GE((*source)->num_frames(), bake.num_frames());
  ASSERT_LE((*source)->num_frames(), bake.num_frames() + 1);
  std::vector<float> xyz(3 * std::size_t{bake.num_vertices()});
  double worst = 0;
  for (std::uint32_t f = 0; f < bake.num_frames(); ++f) {
    ASSERT_FALSE((*source)->read_frame(f, xyz));
    for (std::size_t v = 0; v < bake.num_vertices(); ++v) {
      double squared = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double off = xyz[3 * v + c] - bake.value(f * xyz.size() + 3 * v + c);
        squared += off * off;
      }
      worst = std::max(worst, std::sqrt(squared));
    }
  }
  const double part = worst / diagonal_of(bake);
  std::printf("%-18s %5u vertices %4u frames: within %.1e of the diagonal\n", GetParam().file,
              bake.num_vertices(), bake.num_frames(), part);
  EXPECT_LE(part, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Files, GltfBakes,
                         testing::Values(Clip{"cesium-man.glb", "0"}, Clip{"fox.glb", "Run"},
                                         Clip{"robot.glb", "Robot_Running"},
                                         Clip{"knight.glb", "Running_A"},
                                         Clip{"q-trex.glb", "Armature|TRex_Run"},
                                         Clip{"q-spider.glb", "SpiderArmature|Spider_Walk"},
                                         Clip{"morph-stress.gltf", "TheWave"}),
                         [](const auto& test) {
                           std::string name = test.param.file;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return c == '-' || c == '.'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace rlpc
