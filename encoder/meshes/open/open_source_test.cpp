#include "encoder/meshes/open/open_source.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "common/testing/scratch_folder.h"
#include "encoder/meshes/input_format.h"

namespace rlpc {
namespace {

namespace fs = std::filesystem;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

void put_u32(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i));
}
void put_f32(std::string& bytes, float value) {
  put_u32(bytes, std::bit_cast<std::uint32_t>(value));
}

// Returns a PC2 file with these counts in its header, and these values.
std::string pc2(std::uint32_t points, std::uint32_t samples, const std::vector<float>& values) {
  std::string bytes("POINTCACHE2\0", 12);
  put_u32(bytes, 1);
  put_u32(bytes, points);
  put_f32(bytes, 0);
  put_f32(bytes, 1);
  put_u32(bytes, samples);
  for (const float v : values) put_f32(bytes, v);
  return bytes;
}

void put_be(std::string& bytes, std::uint32_t value) {
  for (int i = 3; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i));
}

// Returns an MDD file (LightWave) with unused times.
std::string mdd(std::uint32_t points, std::uint32_t frames, std::size_t times,
                const std::vector<float>& values) {
  std::string bytes;
  put_be(bytes, frames);
  put_be(bytes, points);
  for (std::size_t i = 0; i < times; ++i) put_be(bytes, 0x7FC00000);
  for (const float v : values) put_be(bytes, std::bit_cast<std::uint32_t>(v));
  return bytes;
}

// Returns an .rlpd file (Annex A); three indices make a triangle.
std::string rlpd(std::uint32_t vertices, std::uint32_t frames, std::int32_t log2_step,
                 const std::vector<std::uint32_t>& indices,
                 const std::vector<std::int32_t>& positions) {
  std::string bytes = "RLPD";
  for (const std::uint32_t v :
       {std::uint32_t{1}, vertices, static_cast<std::uint32_t>(indices.size() / 3), frames,
        std::uint32_t{25}, std::uint32_t{1}, static_cast<std::uint32_t>(log2_step),
        std::uint32_t{10}, std::uint32_t{0}, static_cast<std::uint32_t>(-10)}) {
    put_u32(bytes, v);
  }
  for (const std::uint32_t v : indices) put_u32(bytes, v);
  for (const std::int32_t p : positions) put_u32(bytes, static_cast<std::uint32_t>(p));
  return bytes;
}

class FrameSourceTest : public ScratchFolderTest {
 protected:
  // Returns the error of opening, otherwise that of the first bad frame, otherwise "".
  static std::string error_of(const InputOptions& options) {
    const auto source = open_frame_source(options);
    if (!source) return source.error().message;
    std::vector<float> xyz(3 * std::size_t{(*source)->num_vertices()});
    for (std::uint32_t f = 0; f < (*source)->num_frames(); ++f) {
      if (const auto error = (*source)->read_frame(f, xyz)) return error->message;
    }
    return "";
  }
  static void expect_error(const InputOptions& options, const std::string& part) {
    EXPECT_NE(error_of(options).find(part), std::string::npos) << part << "\n"
                                                               << error_of(options);
  }
};

TEST_F(FrameSourceTest, ReadsAPointCacheInAnyOrder) {
  const std::vector<float> values{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 1e30F};
  const auto source =
      open_frame_source({put("a.obj", kTriangle), put("a.pc2", pc2(3, 2, values)), {}});
  ASSERT_TRUE(source) << source.error().message;
  FrameSource& s = **source;
  EXPECT_EQ(s.num_vertices(), 3U);
  EXPECT_EQ(s.num_frames(), 2U);
  EXPECT_EQ(s.frame_rate(), (FrameRate{30, 1}));
  EXPECT_EQ(s.triangles(), (std::vector<Triangle>{{0, 1, 2}}));
  std::vector<float> xyz(9);
  for (const std::uint32_t f : {1U, 0U, 1U}) {
    ASSERT_FALSE(s.read_frame(f, xyz));
    EXPECT_EQ(xyz, std::vector<float>(values.begin() + 9 * f, values.begin() + 9 * f + 9));
  }
}

TEST_F(FrameSourceTest, FindsTheFrameRate) {
  const std::string points = put("a.pc2", pc2(3, 1, std::vector<float>(9)));
  const std::string mesh = put("a.obj", "# frame_rate 25/1\n" + kTriangle);
  EXPECT_EQ((*open_frame_source({mesh, points, {}}))->frame_rate(), (FrameRate{25, 1}));
  EXPECT_EQ((*open_frame_source({mesh, "", {}}))->frame_rate(), (FrameRate{25, 1}));
  const InputOptions given{mesh, points, FrameRate{60, 1}};
  EXPECT_EQ((*open_frame_source(given))->frame_rate(), (FrameRate{60, 1}));
}

TEST_F(FrameSourceTest, RefusesPointCachesThatDoNotFitTheMesh) {
  const std::string mesh = put("a.obj", kTriangle);
  const std::vector<float> zeros(18);
  expect_error({mesh, put("b.pc2", pc2(2, 3, zeros)), {}},
               "b.pc2: 2 points per frame, but " + mesh + " has 3 vertices");
  expect_error({mesh, put("b.pc2", pc2(0xFFFFFFFF, 2, zeros)), {}}, "-1 points per frame");
  expect_error({mesh, put("b.pc2", pc2(3, 0, {})), {}}, "0 samples");
  expect_error({mesh, put("b.pc2", pc2(3, 0x80000000, zeros)), {}}, "-2147483648 samples");
  expect_error({mesh, put("b.pc2", pc2(3, 0x7FFFFFFF, zeros)), {}},
               "104 bytes; expected 77309411324");
}

TEST_F(FrameSourceTest, RefusesEveryOtherLengthOfAPointCache) {
  const std::string mesh = put("a.obj", kTriangle);
  const std::string good = pc2(3, 2, std::vector<float>(18));
  EXPECT_EQ(error_of({mesh, put("b.pc2", good), {}}), "");
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_NE(error_of({mesh, put("b.pc2", good.substr(0, n)), {}}), "") << n;
  }
  expect_error({mesh, put("b.pc2", good.substr(0, 100)), {}},
               "100 bytes; expected 104 for 2 frames of 3 points; the file is truncated");
  expect_error({mesh, put("b.pc2", good + "x"), {}}, "the file is too long");
}

TEST_F(FrameSourceTest, RefusesOtherFilesAsPointCaches) {
  const std::string mesh = put("a.obj", kTriangle);
  std::string bytes = pc2(3, 1, std::vector<float>(9));
  expect_error({mesh, path("none.pc2"), {}}, "none.pc2: no such file");
  expect_error({mesh, put("b.pc2", "P" + bytes), {}}, "does not begin with POINTCACHE2");
  bytes[12] = 2;
  expect_error({mesh, put("b.pc2", bytes), {}}, "PC2 version 2");
  expect_error({path("b.pc2"), "", {}}, "a point cache has no triangles");
  expect_error({path("none.obj"), path("b.pc2"), {}}, "none.obj: no such file");
}

TEST_F(FrameSourceTest, ReadsAnMddPointCache) {
  const std::vector<float> values{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 1e30F};
  const std::string mesh = put("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const auto source = open_frame_source({mesh, put("a.MDD", mdd(3, 2, 2, values)), {}});
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->num_frames(), 2U);
  EXPECT_EQ((*source)->triangles(), (std::vector<Triangle>{{0, 1, 2}}));
  std::vector<float> xyz(9);
  for (const std::uint32_t f : {1U, 0U}) {
    ASSERT_FALSE((*source)->read_frame(f, xyz));
    EXPECT_EQ(xyz, std::vector<float>(values.begin() + 9 * f, values.begin() + 9 * f + 9));
  }
}

TEST_F(FrameSourceTest, RefusesBrokenMddPointCaches) {
  const std::string mesh = put("a.obj", kTriangle);
  std::vector<float> values(18);
  const std::string good = mdd(3, 2, 2, values);
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_NE(error_of({mesh, put("b.mdd", good.substr(0, n)), {}}), "") << n;
  }
  expect_error({mesh, put("b.mdd", good + "x"), {}}, "89 bytes; expected 88");
  expect_error({mesh, put("b.mdd", mdd(2, 2, 2, values)), {}}, "2 points per frame, but");
  expect_error({mesh, put("b.mdd", mdd(3, 0, 0, {})), {}}, "0 samples");
  expect_error({mesh, put("b.mdd", mdd(3, 0x80000000, 2, values)), {}}, "-2147483648 samples");
  expect_error({mesh, put("b.mdd", mdd(3, 0x7FFFFFFF, 2, values)), {}},
               "88 bytes; expected 85899345888");
  expect_error({path("b.mdd"), "", {}}, "a point cache has no triangles");
  values[10] = kNan;
  expect_error({mesh, put("b.mdd", mdd(3, 2, 2, values)), {}},
               "b.mdd: frame 1, vertex 0 (both from 0): y is not a number");
}

TEST_F(FrameSourceTest, DetectsAPointCacheByItsContents) {
  const std::string mesh = put("a.obj", kTriangle);
  const std::vector<float> values{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::string good = mdd(3, 2, 2, values);
  for (const std::string& bytes : {good, pc2(3, 2, values)}) {
    const auto source = open_frame_source({mesh, put("cache", bytes), {}});
    ASSERT_TRUE(source) << source.error().message;
    std::vector<float> xyz(9);
    ASSERT_FALSE((*source)->read_frame(1, xyz));
    EXPECT_EQ(xyz, std::vector<float>(values.begin() + 9, values.end()));
  }
  for (const std::string& bytes : {std::string(), good.substr(0, 87), good + "x", "x" + good,
                                   mdd(2, 3, 3, values), mdd(3, 0, 0, {})}) {
    expect_error({mesh, put("cache", bytes), {}},
                 "nor an MDD one of the 3 vertices of " + mesh);
  }
}

TEST_F(FrameSourceTest, RefusesGltfOptionsForOtherFiles) {
  const std::string mesh = put("a.obj", kTriangle);
  const std::string points = put("a.pc2", pc2(3, 1, std::vector<float>(9)));
  for (const std::string& cache : {std::string(), points}) {
    expect_error({mesh, cache, {}, {"Walk"}},
                 mesh + ": 'animations' is for .glb and .gltf files");
    expect_error({mesh, cache, {}, {}, false},
                 mesh + ": 'weld = false' is for .glb and .gltf files");
  }
}

TEST_F(FrameSourceTest, KnowsTheFileOfAFrame) {
  const std::string mesh = put("f1.obj", kTriangle);
  const std::string next = put("f2.obj", kTriangle);
  EXPECT_EQ((*open_frame_source({path("f%d.obj"), "", {}}))->file_of(1), next);
  const std::string points = put("a.pc2", pc2(3, 1, std::vector<float>(9)));
  EXPECT_EQ((*open_frame_source({mesh, points, {}}))->file_of(0), points);
  const std::string decoded = put("a.rlpd", rlpd(1, 1, 0, {}, {0, 0, 0}));
  EXPECT_EQ((*open_frame_source({decoded, "", {}}))->file_of(0), decoded);
}

TEST_F(FrameSourceTest, NamesFrameAndVertexOfNonFiniteValues) {
  const std::string mesh = put("a.obj", kTriangle);
  std::vector<float> values(18);
  values[9 + 7] = kNan;
  expect_error({mesh, put("b.pc2", pc2(3, 2, values)), {}},
               "b.pc2: frame 1, vertex 2 (both from 0): y is not a number");
  values[9 + 7] = -kInfinity;
  expect_error({mesh, put("b.pc2", pc2(3, 2, values)), {}}, "y is infinite");
}

class MeshSequenceTest : public FrameSourceTest {
 protected:
  // Returns a frame that is identified by its first coordinate.
  static std::string frame(int number) {
    return "v " + std::to_string(number) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  }
  static std::vector<float> first_coordinates(const std::string& path) {
    const auto source = open_frame_source({path, "", {}});
    EXPECT_TRUE(source) << source.error().message;
    std::vector<float> result;
    std::vector<float> xyz(9);
    for (std::uint32_t f = 0; source && f < (*source)->num_frames(); ++f) {
      const auto error = (*source)->read_frame(f, xyz);
      EXPECT_FALSE(error) << error->message;
      result.push_back(xyz[0]);
    }
    return result;
  }
};

TEST_F(MeshSequenceTest, ReadsFolderGlobAndPattern) {
  for (const int n : {1, 2, 10, 11}) put("f" + std::to_string(n) + ".OBJ", frame(n));
  put("other.txt", "not a frame");
  EXPECT_EQ(first_coordinates(folder_.string()), (std::vector<float>{1, 2, 10, 11}));
  EXPECT_EQ(first_coordinates(folder_.string() + "/"), (std::vector<float>{1, 2, 10, 11}));
  EXPECT_EQ(first_coordinates(path("f1*.OBJ")), (std::vector<float>{1, 10, 11}));
  EXPECT_EQ(first_coordinates(path("f?.OBJ")), (std::vector<float>{1, 2}));
  for (const int n : {98, 99, 100}) {
    put("w_" + std::string(n < 100 ? "0" : "") + std::to_string(n) + ".obj", frame(n));
  }
  put("w_7.obj", frame(7));  // not three digits: does not match
  EXPECT_EQ(first_coordinates(path("w_%03d.obj")), (std::vector<float>{98, 99, 100}));
}

TEST_F(MeshSequenceTest, ReadsOneFile) {
  EXPECT_EQ(first_coordinates(put("one.obj", frame(5))), (std::vector<float>{5}));
  EXPECT_EQ(first_coordinates(put("odd[1]%.obj", frame(6))), (std::vector<float>{6}));
}

TEST_F(MeshSequenceTest, ReadsEveryFormat) {
  const auto put_frame = [&](int n) {
    const std::string x = std::to_string(n);
    put("off" + x + ".off", "OFF 3 1 0\n" + x + " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    put("ply" + x + ".ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n" +
            x + " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  };
  for (const int n : {9, 10, 11}) put_frame(n);
  for (const std::string name : {"off", "ply"}) {
    EXPECT_EQ(first_coordinates(path(name + "%d." + name)), (std::vector<float>{9, 10, 11}));
    EXPECT_EQ(first_coordinates(path(name + "*." + name)), (std::vector<float>{9, 10, 11}));
    fs::rename(path(name + "9." + name), path(name));  // detected by its contents
    EXPECT_EQ(first_coordinates(path(name)), (std::vector<float>{9}));
  }
  expect_error({folder_.string(), "", {}}, "has .off and .ply files; choose with a pattern");
  for (const int n : {9, 10, 11}) fs::remove(path("off" + std::to_string(n) + ".off"));
  EXPECT_EQ(first_coordinates(folder_.string()), (std::vector<float>{10, 11}));
}

TEST_F(MeshSequenceTest, HasTheNumbersOfItsFilesExactly) {
  const std::string file = put("one.obj", "v 0.1 -0.3 0.5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto source = open_frame_source({file, "", {}});
  ASSERT_TRUE(source) << source.error().message;
  std::vector<double> xyz(9);
  ASSERT_FALSE((*source)->read_exact(0, xyz));
  EXPECT_NEAR(xyz[0], 0.1, 1e-14);
  EXPECT_NEAR(xyz[1], -0.3, 1e-14);
  EXPECT_EQ(xyz[2], 0.5);
}

TEST_F(MeshSequenceTest, DetectsAnObjFileByItsContents) {
  EXPECT_EQ(first_coordinates(put("mesh", "# by hand\n" + frame(3))), (std::vector<float>{3}));
  expect_error({put("text", "voila\n"), "", {}}, "unknown kind of file");
}

TEST_F(MeshSequenceTest, NamesTheMissingFrame) {
  for (const int n : {3, 4, 6}) put("f" + std::to_string(n) + ".obj", frame(n));
  expect_error({path("f%d.obj"), "", {}},
               "f5.obj: this frame is missing, though f6.obj exists");
}

TEST_F(MeshSequenceTest, NotesSuspiciousSequences) {
  const auto notes = [&] {
    const auto source = open_frame_source({folder_.string(), "", {}});
    return source ? (*source)->notes() : std::vector<std::string>{source.error().message};
  };
  for (const int n : {9, 10, 11}) put("f" + std::to_string(n) + ".obj", frame(n));
  put("._f9.obj", "of another system");
  fs::create_symlink(path("loop"), path("loop"));
  EXPECT_TRUE(notes().empty());
  fs::remove(path("f10.obj"));
  ASSERT_EQ(notes().size(), 1U);
  EXPECT_NE(notes()[0].find("no frame between"), std::string::npos) << notes()[0];
  put("f10.obj", frame(10));
  put("backup.obj", frame(0));
  ASSERT_EQ(notes().size(), 1U);
  EXPECT_NE(notes()[0].find("1 file is not: backup.obj"), std::string::npos) << notes()[0];
}

TEST_F(MeshSequenceTest, RefusesPatternsWithoutFiles) {
  expect_error({path("f%d.obj"), "", {}}, "no such file, for example f0.obj");
  expect_error({path("f%s.obj"), "", {}}, "expected one %d, %04d");
  expect_error({path("f%d_%d.obj"), "", {}}, "expected one %d, %04d");
  expect_error({path("none/f%d.obj"), "", {}}, "cannot list the folder");
  expect_error({path("f*.obj"), "", {}}, "no file matches");
  const std::string meshes = extensions_text({InputFormat::Holds::kMesh});
  expect_error({folder_.string(), "", {}}, "no " + meshes + " file in this folder");
  expect_error({path("none"), "", {}}, "no such file or folder");
  expect_error({put("a.stl", "solid"), "", {}}, "unknown kind of file");
}

TEST_F(MeshSequenceTest, NamesTheFrameWhoseTopologyChanges) {
  put("f1.obj", frame(1));
  put("f2.obj", frame(2));
  const std::string third = put("f3.obj", frame(3) + "v 0 0 0\n");
  expect_error({path("f%d.obj"), "", {}},
               third + ": frame 2 (from 0) has 4 vertices, but " + path("f1.obj") + " has 3");
  put("f3.obj", frame(3) + "f 1 2 3\n");
  expect_error({path("f%d.obj"), "", {}}, "has 2 triangles, but");
  put("f3.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n");
  expect_error({path("f%d.obj"), "", {}}, "has no face f 1 2 3, but");
}

TEST_F(MeshSequenceTest, NamesTheLineOfABadFrame) {
  put("f1.obj", frame(1));
  put("f2.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
  expect_error({path("f%d.obj"), "", {}}, "f2.obj:3: \"nan\" is not finite");
  put("f2.obj", "");
  expect_error({path("f%d.obj"), "", {}}, "f2.obj: the file is empty");
}

TEST_F(FrameSourceTest, ReadsDecoderOutput) {
  const std::vector<std::int32_t> positions{0,   0, 0,  1, 0, 0, 0, 2147483647, 0,
                                            -10, 0, 10, 1, 1, 1, 0, 0,          0};
  const auto source =
      open_frame_source({put("a.rlpd", rlpd(3, 5, -1, {0, 1, 2}, positions)), "", {}});
  ASSERT_TRUE(source) << source.error().message;
  FrameSource& s = **source;
  EXPECT_EQ(s.num_frames(), 2U);  // 5 are announced
  EXPECT_EQ(s.frame_rate(), (FrameRate{25, 1}));
  EXPECT_EQ(s.triangles(), (std::vector<Triangle>{{0, 1, 2}}));
  std::vector<float> xyz(9);
  ASSERT_FALSE(s.read_frame(1, xyz));
  EXPECT_EQ(xyz, (std::vector<float>{0, 0, 0, 5.5F, 0.5F, -4.5F, 5, 0, -5}));
  ASSERT_FALSE(s.read_frame(0, xyz));
  EXPECT_EQ(xyz[7], 1073741824.0F);
  std::vector<double> exact(9);
  ASSERT_FALSE(s.read_exact(0, exact));
  EXPECT_EQ(exact, (std::vector<double>{5, 0, -5, 5.5, 0, -5, 5, 1073741823.5, -5}));
}

TEST_F(FrameSourceTest, RefusesBrokenDecoderOutput) {
  const std::vector<std::int32_t> positions(18);
  const std::string good = rlpd(3, 2, 0, {0, 1, 2}, positions);
  EXPECT_EQ(error_of({put("a.rlpd", good), "", {}}), "");
  for (std::size_t n = 0; n < good.size(); ++n) {
    const bool whole_frame = n == good.size() - 36;
    EXPECT_EQ(error_of({put("a.rlpd", good.substr(0, n)), "", {}}) == "", whole_frame) << n;
  }
  const auto expect_rlpd_error = [&](const std::string& bytes, const std::string& part) {
    expect_error({put("a.rlpd", bytes), "", {}}, part);
  };
  expect_rlpd_error(rlpd(3, 1, 0, {0, 1, 2}, positions), "holds 2 frames, but announces 1");
  expect_rlpd_error(rlpd(3, 2, 0, {0, 1, 3}, positions), "index 3 is out of range 0 to 2");
  expect_rlpd_error(rlpd(0, 2, 0, {}, {}), "no vertices");
  expect_rlpd_error(rlpd(3, 2, 128, {0, 1, 2}, positions), "grid_log2_step 128");
  expect_rlpd_error(rlpd(3, 2, -151, {0, 1, 2}, positions), "grid_log2_step -151");
  expect_rlpd_error(rlpd(3, 2, 127, {0, 1, 2}, positions), "frame 0, vertex 0");
  std::string lying = good;
  lying.replace(12, 4, "\xFF\xFF\xFF\xFF");
  expect_rlpd_error(lying, "4294967295 triangles alone need");
  lying = good;
  lying.replace(24, 4, std::string(4, '\0'));
  expect_rlpd_error(lying, "frame rate 25/0");
}

// Streams of frames are read from a file here, as from a pipe: in order, without its size.
class FrameStreamTest : public FrameSourceTest {
 protected:
  struct Contents {
    std::vector<float> xyz;
    std::vector<double> exact;
  };
  // Returns the positions of all frames.
  static Contents read_all(const std::string& path, const std::string& mesh_path) {
    std::FILE* const file = std::fopen(path.c_str(), "rb");
    const auto stream = open_frame_stream(file, mesh_path, {});
    EXPECT_TRUE(stream) << stream.error().message;
    Contents all;
    while (stream) {
      std::vector<float> xyz(3 * std::size_t{(*stream)->shape().num_vertices});
      const auto more = (*stream)->next_frame(xyz);
      EXPECT_TRUE(more) << more.error().message;
      if (!more || !*more) break;
      all.xyz.insert(all.xyz.end(), xyz.begin(), xyz.end());
      const auto exact = (*stream)->exact();
      all.exact.insert(all.exact.end(), exact.begin(), exact.end());
    }
    std::fclose(file);
    return all;
  }
};

TEST_F(FrameStreamTest, ReadsAPointCache) {
  const std::vector<float> values{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 1e30F};
  const Contents all = read_all(put("a.pc2", pc2(3, 2, values)), put("a.obj", kTriangle));
  EXPECT_EQ(all.xyz, values);
  EXPECT_TRUE(all.exact.empty());
}

TEST_F(FrameStreamTest, ReadsDecoderOutput) {
  const std::vector<std::int32_t> positions{0,   0, 0,  1, 0, 0, 0, 33554433, 0,
                                            -10, 0, 10, 1, 1, 1, 0, 0,        0};
  const Contents all = read_all(put("a.rlpd", rlpd(3, 5, -1, {0, 1, 2}, positions)), "");
  EXPECT_EQ(all.xyz, (std::vector<float>{5, 0, -5, 5.5F, 0, -5, 5, 16777216, -5,  //
                                         0, 0, 0, 5.5F, 0.5F, -4.5F, 5, 0, -5}));
  EXPECT_EQ(all.exact, (std::vector<double>{5, 0, -5, 5.5, 0, -5, 5, 16777216.5, -5,  //
                                            0, 0, 0, 5.5, 0.5, -4.5, 5, 0, -5}));
}

TEST(FrameRateText, IsExact) {
  EXPECT_EQ(*parse_frame_rate("25"), (FrameRate{25, 1}));
  EXPECT_EQ(*parse_frame_rate("60/2"), (FrameRate{30, 1}));
  EXPECT_EQ(*parse_frame_rate("30000/1001"), (FrameRate{30000, 1001}));
  EXPECT_EQ(*parse_frame_rate("29.97"), (FrameRate{2997, 100}));
  EXPECT_EQ(*parse_frame_rate("23.976"), (FrameRate{2997, 125}));
  EXPECT_EQ(*parse_frame_rate("12.50"), (FrameRate{25, 2}));
  EXPECT_EQ(*parse_frame_rate("0.5"), (FrameRate{1, 2}));
  for (const char* text : {"", "0", "-1", "1/0", "x", "1e3", "1/2/3", "4294967296", ".", "0.0",
                           "1.0000000001", "9999999999.5", " 30", "nan"}) {
    EXPECT_FALSE(parse_frame_rate(text)) << text;
  }
}

}  // namespace
}  // namespace rlpc
