// Shared by the tests of glTF input: writes documents as files and reads them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/source.h"
#include "encoder/testing/gltf_builder.h"

namespace rlpc {

class GltfFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("gltf_" + std::to_string(getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string put(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

  // Opens the document, by default without welding.
  std::unique_ptr<FrameSource> open(const GltfBuilder& builder,
                                    const std::vector<std::string>& animations = {},
                                    bool weld = false, FrameRate rate = {}) const {
    auto source = open_gltf({put("a.glb", builder.glb()), "", rate, animations, weld});
    EXPECT_TRUE(source) << source.error().message;
    return source ? std::move(*source) : nullptr;
  }

  static std::vector<float> frame_of(FrameSource& source, std::uint32_t frame) {
    std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
    const auto error = source.read_frame(frame, xyz);
    EXPECT_FALSE(error) << error->message;
    return xyz;
  }

  static void expect_near(const std::vector<float>& got, const std::vector<float>& want) {
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], want[i], 1e-6) << i;
  }

  // Returns the error of opening, otherwise that of the first bad frame, otherwise "".
  static std::string error_of_file(const std::string& path,
                                   const std::vector<std::string>& animations = {},
                                   const GltfLimits& limits = {}) {
    const auto source = open_gltf({path, "", {}, animations, true}, limits);
    if (!source) return source.error().message;
    std::vector<float> xyz(3 * std::size_t{(*source)->num_vertices()});
    for (std::uint32_t f = 0; f < (*source)->num_frames(); ++f) {
      if (const auto error = (*source)->read_frame(f, xyz)) return error->message;
    }
    return "";
  }
  std::string error_of(const GltfBuilder& builder,
                       const std::vector<std::string>& animations = {},
                       const GltfLimits& limits = {}) const {
    return error_of_file(put("a.glb", builder.glb()), animations, limits);
  }
  static void expect_text(const std::string& error, const std::string& part) {
    EXPECT_NE(error.find(part), std::string::npos) << part << "\n" << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }

  std::filesystem::path folder_;
};

// Corners of the triangle that most tests animate.
inline const std::vector<float> kCorners{0, 0, 0, 1, 0, 0, 0, 1, 0};

// Builds one triangle without indices, as the mesh of the only root, node 0.
inline GltfBuilder one_triangle() {
  GltfBuilder builder;
  const std::size_t positions = builder.add("VEC3", kCorners);
  builder.add_root({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", positions}}}})}});
  return builder;
}

// Builds the same triangle, moved along x by 1 in each of two seconds: animation 0, "Move".
inline GltfBuilder moving_triangle() {
  GltfBuilder builder = one_triangle();
  builder.push("animations", {{"name", "Move"}});
  const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1, 2});
  const std::size_t output = builder.add("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0});
  builder.add_channel(0, "translation", input, output, "LINEAR");
  return builder;
}

}  // namespace rlpc
