#include "encoder/meshes/sequence/mesh_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "common/testing/scratch_folder.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc {
namespace {

using Random = std::mt19937;
using Face = std::vector<std::uint32_t>;

class MeshSequenceFilesTest : public ScratchFolderTest {
 protected:
  // Returns the error of opening or of the first bad frame, or the notes, a line each.
  static std::string result_of(const InputOptions& options, bool reads_backwards = false) {
    const auto source = open_frame_source(options);
    if (!source) return source.error().message;
    std::vector<float> xyz(3 * std::size_t{(*source)->num_vertices()});
    const std::uint32_t count = (*source)->num_frames();
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t f = reads_backwards ? count - 1 - i : i;
      if (const auto error = (*source)->read_frame(f, xyz)) return error->message;
    }
    std::string text;
    for (const std::string& note : (*source)->notes()) text += note + "\n";
    return text;
  }
  std::string result() const { return result_of({folder_.string(), "", {}}); }
};

// Returns faces of 3 to 6 different vertices.
std::vector<Face> random_faces(Random& random, std::uint32_t num_vertices) {
  std::vector<std::uint32_t> all(num_vertices);
  for (std::uint32_t v = 0; v < num_vertices; ++v) all[v] = v;
  std::vector<Face> faces(1 + random() % 12);
  for (Face& face : faces) {
    std::shuffle(all.begin(), all.end(), random);
    face.assign(all.begin(), all.begin() + 3 + static_cast<std::ptrdiff_t>(random() % 4));
  }
  return faces;
}

// Corners have texture coordinates, materials alternate: both by face.
std::string obj_of(const std::vector<Face>& faces, std::uint32_t num_vertices, Random& random,
                   bool with_attributes) {
  std::string text;
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    text +=
        "v " + std::to_string(random() % 100) + " " + std::to_string(random() % 100) + " 0\n";
  }
  for (std::uint32_t v = 0; v < num_vertices; ++v) text += "vt 0." + std::to_string(v) + " 0\n";
  for (const Face& face : faces) {
    if (with_attributes) {
      const std::uint32_t sum = *std::max_element(face.begin(), face.end());
      text += "usemtl m" + std::to_string(sum % 3) + "\n";
    }
    text += "f";
    for (const std::uint32_t v : face) {
      text += " " + std::to_string(v + 1);
      if (with_attributes) text += "/" + std::to_string(v + 1);
    }
    text += "\n";
  }
  return text;
}

TEST_F(MeshSequenceFilesTest, TakeFacesInAnyOrder) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const std::uint32_t n = 6 + random() % 4;
    std::vector<Face> faces = random_faces(random, n);
    put("f1.obj", obj_of(faces, n, random, false));
    std::shuffle(faces.begin(), faces.end(), random);
    for (Face& face : faces) {
      std::rotate(face.begin(),
                  face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()),
                  face.end());
    }
    put("f2.obj", obj_of(faces, n, random, false));
    ASSERT_EQ(result(), "") << i;
    // Another set of faces: one turned over, or another corner.
    Face& changed = faces[random() % faces.size()];
    if (random() % 2 == 0) {
      std::reverse(changed.begin(), changed.end());
    } else {
      changed[0] = changed[0] == 0 ? 1 : 0;
    }
    put("f2.obj", obj_of(faces, n, random, false));
    const auto copies = std::count(faces.begin(), faces.end(), changed);
    ASSERT_NE(result().find("must have the vertices and faces of the first"), std::string::npos)
        << i << " " << copies;
  }
}

TEST_F(MeshSequenceFilesTest, CompareAttributesOfFacesInAnyOrder) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t n = 6 + random() % 4;
    std::vector<Face> faces = random_faces(random, n);
    put("f1.obj", obj_of(faces, n, random, true));
    std::shuffle(faces.begin(), faces.end(), random);
    for (Face& face : faces) {
      std::rotate(face.begin(),
                  face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()),
                  face.end());
    }
    put("f2.obj", obj_of(faces, n, random, true));
    std::string said = result();
    // A mesh with one material has no asset that keeps its name.
    if (said.find("its only name") != std::string::npos) said.erase(0, said.find('\n') + 1);
    ASSERT_EQ(said, "") << i;
  }
}

// A polygon that is concave in one way, then in another: its triangles are those of the first.
TEST_F(MeshSequenceFilesTest, SplitPolygonsAsInTheFirstFrame) {
  put("f1.obj", "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 1 2 3 4\nf 4 3 2 1\n");
  put("f2.obj", "v 3 3 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 4 1 2 3\nf 3 2 1 4\n");
  const auto source = open_frame_source({folder_.string(), "", {}});
  ASSERT_TRUE(source);
  std::vector<float> xyz(12);
  ASSERT_FALSE((*source)->read_frame(1, xyz));
  // Neither fan, from 1 nor from 4, has both triangles on one side.
  for (const Triangle& t : (*source)->triangles()) {
    EXPECT_TRUE(std::count(t.begin(), t.end(), 0U) == 1 &&
                std::count(t.begin(), t.end(), 2U) == 1)
        << t[0] << t[1] << t[2];
  }
  EXPECT_EQ(result(), "");
}

// Returns a strip of triangles; each corner has the normal of the angle of its vertex.
std::string strip_with_normals(const std::vector<double>& angles) {
  std::string text;
  for (std::size_t v = 0; v < angles.size(); ++v) {
    text += "v " + std::to_string(v / 2) + " " + std::to_string(v % 2) + " 0\nvn " +
            std::to_string(std::sin(angles[v])) + " 0 " + std::to_string(std::cos(angles[v])) +
            "\n";
  }
  for (std::size_t v = 1; v + 2 <= angles.size(); ++v) {
    text += "f";
    for (const std::size_t c : {v, v + 1, v + 2}) {
      text += " " + std::to_string(c) + "//" + std::to_string(c);
    }
    text += "\n";
  }
  return text;
}

// Corners may share a normal in the first frame; each has its own in the others.
TEST_F(MeshSequenceFilesTest, FollowNormalsOfLaterFrames) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const std::size_t n = 4 + random() % 20;
    const std::uint32_t num_frames = 2 + static_cast<std::uint32_t>(random() % 6);
    std::vector<std::vector<double>> angles;
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      angles.emplace_back(n, 0.0);
      for (double& angle : angles.back())
        angle = f == 0 ? 0.0 : 0.1 * static_cast<double>(random() % 15);
      std::string text = strip_with_normals(angles.back());
      // All corners of the first frame use the first normal.
      if (f == 0 && i % 2 == 0) {
        for (std::size_t at = 0; (at = text.find("//", at)) != text.npos; at += 2) {
          const std::size_t end = text.find_first_of(" \n", at);
          text.replace(at, end - at, "//1");
        }
      }
      put("g" + std::to_string(i) + "_" + std::to_string(f) + ".obj", text);
    }
    const auto source = open_frame_source({path("g" + std::to_string(i) + "_%d.obj"), "", {}});
    ASSERT_TRUE(source) << source.error().message;
    const SourceAttributes& attributes = (*source)->attributes();
    const SourceAttribute& normals = attributes.sets.at(0);
    ASSERT_EQ(attributes.later_normals.size(), num_frames - 1);
    std::uint32_t frame = 0;
    for (const PosedNormals& later : attributes.later_normals) {
      EXPECT_EQ(later.frame, ++frame);
      ASSERT_EQ(later.normals.size(), normals.values.size());
      for (std::size_t c = 0; c < normals.value_of_corner.size(); ++c) {
        const std::uint32_t v = (*source)->triangles()[c / 3][c % 3];
        const std::size_t value = 3 * std::size_t{normals.value_of_corner[c]};
        EXPECT_NEAR(later.normals[value], std::sin(angles[later.frame][v]), 1e-5);
        EXPECT_NEAR(normals.values[value], 0.0, 1e-5);
      }
    }
  }
}

TEST_F(MeshSequenceFilesTest, NameNormalsThatTheFirstFrameHasNot) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  put("f1.obj", points + "f 1 2 3\n");
  put("f2.obj", points + "vn 0 0 1\nf 1//1 2//1 3//1\n");
  EXPECT_NE(result().find("f2.obj: normal is dropped"), std::string::npos) << result();
}

// Encoders read frames in any order.
TEST_F(MeshSequenceFilesTest, NameTheFirstFileThatDiffers) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  put("f1.obj", points + "f 1 2 3\n");
  put("f2.obj", points + "vn 0 0 1\nf 1//1 2//1 3//1\n");
  put("f3.obj", points + "vt 0 1\nvn 0 0 1\nusemtl red\nf 1/1/1 2/1/1 3/1/1\n");
  put("f4.obj", points + "vt 0 1\nusemtl blue\nf 1/1 2/1 3/1\n");
  const std::string backwards = result_of({folder_.string(), "", {}}, true);
  for (const std::string& text : {result(), backwards}) {
    EXPECT_NE(text.find("f2.obj: normal is dropped"), std::string::npos) << text;
    EXPECT_NE(text.find("f3.obj: uv0 is dropped"), std::string::npos) << text;
    EXPECT_NE(text.find("f3.obj: names of materials are dropped"), std::string::npos) << text;
    EXPECT_EQ(text.find("f4.obj"), std::string::npos) << text;
  }
}

TEST_F(MeshSequenceFilesTest, AreSortedByNumberWhenGivenOneByOne) {
  std::vector<std::string> paths;
  for (const int n : {1, 10, 11, 2, 9}) {
    paths.push_back(put("f" + std::to_string(n) + ".obj",
                        "v " + std::to_string(n) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  }
  InputOptions options{paths[0], "", {}};
  options.more_paths.assign(paths.begin() + 1, paths.end());
  const auto source = open_frame_source(options);
  ASSERT_TRUE(source) << source.error().message;
  std::vector<float> found;
  std::vector<float> xyz(9);
  for (std::uint32_t f = 0; f < (*source)->num_frames(); ++f) {
    ASSERT_FALSE((*source)->read_frame(f, xyz));
    found.push_back(xyz[0]);
  }
  EXPECT_EQ(found, (std::vector<float>{1, 2, 9, 10, 11}));
  options.more_paths.push_back(put("rest.obj", "v 0 0 0\n"));
  EXPECT_NE(result_of(options).find("rest.obj"), std::string::npos);
  options.more_paths.back() = put("a.glb", "glTF");
  EXPECT_NE(result_of(options).find("encode others one by one"), std::string::npos);
  options.more_paths.back() = put("f12.ply", "ply\n");
  EXPECT_NE(result_of(options).find("is no .obj file"), std::string::npos);
  options.points = put("a.pc2", "");
  EXPECT_NE(result_of(options).find("give one mesh"), std::string::npos);
}

}  // namespace
}  // namespace rlpc
