#include "decoder/report/gof_pictures.h"

#include <gtest/gtest.h>

#include <numeric>

#include "decoder/testing/occurrences.h"

namespace rlpc {
namespace {

// A strip of squares, three wide, with two clusters; or its vertices alone.
class GofPictures : public testing::Test {
 protected:
  static constexpr std::uint32_t kVertices = 800;

  explicit GofPictures(bool with_triangles = true)
      : meshes_(kVertices, with_triangles ? triangles() : std::vector<Triangle>()) {
    for (std::uint32_t v = 0; v < kVertices; ++v) {
      for (const std::uint32_t x : {v / 4, v % 4, v % 3})
        frame_.xyz.push_back(static_cast<float>(x));
      frame_.groups.group_of_vertex.push_back(v < 300 ? 0 : 1);
    }
    frame_.groups.kind = GroupKind::kClusters;
    frame_.groups.num_groups = 2;
    frame_.groups.first_frame = 20;
    frame_.groups.num_frames = 10;
    frame_.groups.seeds = {{0, 1, 5}};
    frame_.frame = 25;
    frame_.meshes = &meshes_;
  }
  static std::vector<Triangle> triangles() {
    std::vector<Triangle> list;
    for (std::uint32_t v = 0; v + 5 < kVertices; ++v) {
      if (v % 4 == 3) continue;
      list.push_back({v, v + 1, v + 5});
      list.push_back({v, v + 5, v + 4});
    }
    return list;
  }
  std::string note(const GofPicture& picture) const {
    return picture.notes.size() < 3 ? "" : picture.notes[2];
  }

  CoarseMeshes meshes_;
  PicturedFrame frame_;
};

TEST_F(GofPictures, ShowClustersAndLayersFromTwoSides) {
  const auto all = gof_pictures(frame_, 10000);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "clusters");
  EXPECT_EQ(all[0].title, "2 clusters, 1 with a seed triangle, which is outlined");
  EXPECT_EQ(all[0].notes[0], "Frame 25, in the inter GOF 20 to 29.");
  EXPECT_EQ(all[0].notes.size(), 2U);
  EXPECT_EQ(occurrences(all[0].body, "<g class=\"view\""), 2U);
  EXPECT_EQ(occurrences(all[0].body, "class=\"seed\""), 4U);
  EXPECT_EQ(occurrences(all[0].body, ">0: 300</text>"), 1U);
  EXPECT_EQ(occurrences(all[0].body, ">1: 500</text>"), 1U);
  EXPECT_EQ(all[1].name, "layers");
  EXPECT_EQ(occurrences(all[1].body, "class=\"seed\""), 0U);
  EXPECT_EQ(occurrences(all[1].body, "<rect"), meshes_.num_layers());
}

TEST_F(GofPictures, OfGofsOfFramesShowLayersAlone) {
  frame_.groups = {};
  const auto all = gof_pictures(frame_, 10000);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].name, "layers");
}

TEST_F(GofPictures, ShowPatches) {
  frame_.groups.kind = GroupKind::kPatches;
  frame_.groups.seeds.clear();
  const auto all = gof_pictures(frame_, 10000);
  EXPECT_EQ(all[0].name, "patches");
  EXPECT_EQ(all[0].title, "2 patches");
  EXPECT_EQ(all[0].notes[1], "The list has each patch with its number of vertices.");
}

TEST_F(GofPictures, OfBonesSayWhich) {
  frame_.groups.kind = GroupKind::kBones;
  frame_.groups.seeds.clear();
  const auto all = gof_pictures(frame_, 10000);
  EXPECT_EQ(all[0].name, "bones");
  EXPECT_EQ(all[0].title, "2 bones; each vertex shows that of the greatest weight");
}

TEST_F(GofPictures, OfLargeMeshesShowTheLargestCoarseMeshThatIsAllowed) {
  const std::uint32_t layers = meshes_.num_layers() - 2;
  const MeshSize size = meshes_.size(layers);
  for (const GofPicture& picture : gof_pictures(frame_, size.num_triangles)) {
    EXPECT_EQ(note(picture).find("The coarse mesh of " + std::to_string(layers) +
                                 " layers, with " + grouped_text(size.num_triangles)),
              0U)
        << note(picture);
    EXPECT_LE(occurrences(picture.body, "<path class=\"g"), 2 * 3 * size.num_triangles);
  }
  const std::uint32_t whole = meshes_.size(meshes_.num_layers()).num_triangles;
  for (const GofPicture& picture : gof_pictures(frame_, whole)) EXPECT_EQ(note(picture), "");
}

TEST_F(GofPictures, OfMeshesThatAreLargerStillShowVertices) {
  const std::uint32_t min_triangles = meshes_.size(1).num_triangles;
  ASSERT_GT(min_triangles, 1U);
  const std::uint32_t max_triangles = min_triangles - 1;
  for (const GofPicture& picture : gof_pictures(frame_, max_triangles)) {
    EXPECT_NE(note(picture).find("there is no coarse mesh"), std::string::npos);
    const std::uint32_t every = (kVertices + max_triangles - 1) / max_triangles;
    EXPECT_NE(note(picture).find("One of every " + std::to_string(every)), std::string::npos);
    EXPECT_EQ(occurrences(picture.body, "h0\"/>"), 2 * ((kVertices - 1) / every + 1));
  }
}

TEST_F(GofPictures, HaveLegendsOfALimitedLength) {
  frame_.groups.num_groups = 800;
  std::iota(frame_.groups.group_of_vertex.begin(), frame_.groups.group_of_vertex.end(), 0U);
  const auto all = gof_pictures(frame_, 10000);
  EXPECT_EQ(occurrences(all[0].body, "<rect"), 60U);
  EXPECT_EQ(occurrences(all[0].body, ">and 740 more</text>"), 1U);
  EXPECT_LT(all[0].height, 600);
}

class GofPicturesOfPoints : public GofPictures {
 protected:
  GofPicturesOfPoints() : GofPictures(false) {}
};

TEST_F(GofPicturesOfPoints, ShowDots) {
  const auto all = gof_pictures(frame_, kVertices);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(note(all[0]), "");
  EXPECT_EQ(occurrences(all[0].body, "h0\"/>"), 2 * kVertices);
  EXPECT_EQ(all[1].title, "1 vertex layer, of which 0 is the coarsest");
  EXPECT_EQ(note(gof_pictures(frame_, kVertices - 1)[0]), "One of every 2 vertices.");
}

TEST_F(GofPictures, AreWholeFilesAndPartsOfPages) {
  const std::string file = svg_file(gof_pictures(frame_, 10000)[0]);
  EXPECT_EQ(file.find("<svg xmlns=\"http://www.w3.org/2000/svg\""), 0U);
  EXPECT_EQ(occurrences(file, "<svg"), occurrences(file, "</svg>"));
  EXPECT_EQ(occurrences(file, "<g "), occurrences(file, "</g>"));
  HtmlPage page("pictures");
  add_picture_section(page, frame_);
  EXPECT_EQ(occurrences(page.text(), "<svg class=\"groups\""), 2U);
  EXPECT_EQ(occurrences(page.text(), "://"), 0U);
}

}  // namespace
}  // namespace rlpc
