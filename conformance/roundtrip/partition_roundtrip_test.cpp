// Tests clusters by every method of partition, of any mesh: streams conform and reach their
// target.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "conformance/testing/small_animation.h"

namespace rlpc {
namespace {

class Partitions : public testing::TestWithParam<PartitionMethod> {
 protected:
  EncoderSettings settings(std::uint32_t clusters,
                           FrameMode frame_mode = FrameMode::kLcf) const {
    EncoderSettings s;
    s.profile = Profile::kBaseline;
    s.target = {Target::kKg, 0.5};
    s.baseline.partition = GetParam();
    s.baseline.clusters = clusters;
    s.baseline.frame_mode = frame_mode;
    return s;
  }
};

void expect_met(MemoryFrames source, const EncoderSettings& settings,
                std::uint32_t max_clusters) {
  EncodeReport report;
  encode_to_memory(source, settings, &report);
  EXPECT_TRUE(report.target_met);
  EXPECT_GE(report.clusters, 1U);
  EXPECT_LE(report.clusters, max_clusters);
}

// Frames of the first vertices of a tube, without triangles.
MemoryFrames points(std::uint32_t count) {
  MemoryFrames tube = bending_tube((count + 4) / 5, 6);
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < 6; ++f) {
    std::vector<float> xyz(3 * std::size_t{tube.num_vertices()});
    EXPECT_FALSE(tube.read_frame(f, xyz));
    xyz.resize(3 * std::size_t{count});
    frames.push_back(std::move(xyz));
  }
  return {{}, std::move(frames)};
}

// Two tubes that move apart, and a vertex without triangles.
MemoryFrames two_tubes() {
  MemoryFrames tube = bending_tube(12, 6);
  const std::uint32_t n = tube.num_vertices();
  FrameSource::Shape shape;
  shape.triangles = tube_triangles(12, 5);
  for (Triangle t : tube_triangles(12, 5)) {
    for (std::uint32_t& v : t) v += n;
    shape.triangles.push_back(t);
  }
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < 6; ++f) {
    std::vector<float> xyz(3 * std::size_t{n});
    EXPECT_FALSE(tube.read_frame(f, xyz));
    for (std::uint32_t i = 0; i < 3 * n; ++i) {
      const float away = i % 3 == 1 ? 2.0F + static_cast<float>(f) : 0.0F;
      xyz.push_back(xyz[i] + away);
    }
    xyz.insert(xyz.end(), {0.5F, 1.0F, static_cast<float>(f)});
    frames.push_back(std::move(xyz));
  }
  return {std::move(shape), std::move(frames)};
}

TEST_P(Partitions, OfAMesh) {
  for (const FrameMode mode : {FrameMode::kLcf, FrameMode::kWorld, FrameMode::kAuto}) {
    EncodeReport report;
    MemoryFrames source = bending_tube(30, 6);
    encode_to_memory(source, settings(5, mode), &report);
    EXPECT_TRUE(report.target_met);
    EXPECT_EQ(report.clusters, 5U);
  }
  expect_met(bending_tube(30, 6), settings(0, FrameMode::kAuto), 96);
}

TEST_P(Partitions, WithSeedTriangles) {
  EncoderSettings s = settings(5);
  s.target = {Target::kNone, 0.0};
  s.components = 3;
  s.baseline.qu = s.baseline.qc = 12;
  expect_met(bending_tube(30, 6), s, 5);
}

TEST_P(Partitions, OfPoints) { expect_met(points(100), settings(4), 4); }

TEST_P(Partitions, OfSeveralComponents) { expect_met(two_tubes(), settings(6), 6); }

TEST_P(Partitions, OfFewVertices) {
  for (const std::uint32_t n : {1U, 2U, 3U, 4U, 7U}) {
    for (EncoderSettings s : {settings(1024), settings(0, FrameMode::kAuto)}) {
      s.target = {Target::kMaxError, 1e-3};  // the KG error of one vertex is that of its centre
      expect_met(points(n), s, n);
    }
  }
  expect_met(bending_tube(2, 3), settings(1024), 10);
}

TEST_P(Partitions, OfOneFrame) { expect_met(bending_tube(20, 1), settings(4), 4); }

TEST_P(Partitions, DoNotDependOnThreads) {
  EncoderSettings s = settings(0, FrameMode::kAuto);
  s.gof_frames = 5;
  MemoryFrames source = bending_tube(40, 10);
  const StreamBytes one = encode_to_memory(source, s);
  s.threads = 3;
  EXPECT_EQ(encode_to_memory(source, s), one);
}

TEST_P(Partitions, DecideTheStream) {
  MemoryFrames source = bending_tube(40, 6);
  EncoderSettings s = settings(6);
  const StreamBytes chosen = encode_to_memory(source, s);
  s.baseline.partition = PartitionMethod::kSeeds;
  EXPECT_NE(encode_to_memory(source, s), chosen);
}

INSTANTIATE_TEST_SUITE_P(All, Partitions,
                         testing::Values(PartitionMethod::kKway, PartitionMethod::kLloyd,
                                         PartitionMethod::kSpectral, PartitionMethod::kMotion));

}  // namespace
}  // namespace rlpc
