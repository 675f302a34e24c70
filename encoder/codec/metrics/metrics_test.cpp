#include "encoder/codec/metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace rlpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Metrics, AreZeroForAnExactCopy) {
  MetricsAccumulator metrics(2);
  const std::vector<float> frame{0, 0, 0, 3, 4, 0};
  metrics.add_frame(frame, frame);
  const Metrics m = metrics.result();
  EXPECT_EQ(m.kg_error_percent, 0);
  EXPECT_EQ(m.rms_error, 0);
  EXPECT_EQ(m.max_error, 0);
  EXPECT_EQ(m.diagonal, 5);
  EXPECT_EQ(m.kg_sequence_error_percent, 0);
  EXPECT_EQ(m.diagonal_psnr_db, kInfinity);
  EXPECT_EQ(m.ramanathan_psnr_db, kInfinity);
}

// Two frames of two vertices, computed by hand.
TEST(Metrics, FollowThePapers) {
  MetricsAccumulator metrics(2);
  // Mean (1, 0, 0), spread 2; errors 0 and 0.5.
  metrics.add_frame(std::vector<float>{0, 0, 0, 2, 0, 0},
                    std::vector<float>{0, 0, 0, 2, 0.5F, 0});
  // Vertex 1 has moved by 4. Mean (1, 2, 0), spread 2 + 8; errors 1 and 1.25.
  metrics.add_frame(std::vector<float>{0, 0, 0, 2, 4, 0},
                    std::vector<float>{0, 0, -1, 2.75F, 5, 0});
  const Metrics m = metrics.result();
  const double squared_error = 0.25 + 1 + 1.5625;
  EXPECT_EQ(m.num_vertices, 2U);
  EXPECT_DOUBLE_EQ(m.kg_error_percent, 100 * std::sqrt(squared_error) / std::sqrt(12.0));
  EXPECT_DOUBLE_EQ(m.rms_error, std::sqrt(squared_error / 4));
  // The mean of all four vertices is (1, 1, 0); squared distances 2, 2, 2 and 10.
  EXPECT_DOUBLE_EQ(m.kg_sequence_error_percent, 100 * std::sqrt(squared_error) / 4);
  EXPECT_DOUBLE_EQ(m.rms_spread, std::sqrt(12.0 / 4));
  EXPECT_DOUBLE_EQ(m.rms_sequence_spread, std::sqrt(16.0 / 4));
  EXPECT_DOUBLE_EQ(m.diagonal, std::sqrt(20.0));
  EXPECT_DOUBLE_EQ(m.rms_error_percent, 100 * m.rms_error / m.diagonal);
  EXPECT_EQ(m.max_error, 1.25);
  EXPECT_EQ(m.max_error_frame, 1U);
  EXPECT_EQ(m.max_error_vertex, 1U);
  EXPECT_DOUBLE_EQ(m.max_error_percent, 125 / m.diagonal);
  EXPECT_EQ(m.max_displacement, 4);

  ASSERT_EQ(m.frames.size(), 2U);
  EXPECT_DOUBLE_EQ(m.diagonal_psnr_db, 20 * std::log10(m.diagonal / m.rms_error));
  EXPECT_DOUBLE_EQ(m.frames[0].diagonal_psnr_db,
                   20 * std::log10(m.diagonal / std::sqrt(0.125)));
  EXPECT_EQ(m.frames[0].spread, 2);
  EXPECT_EQ(m.frames[1].spread, 10);
  EXPECT_EQ(m.frames[0].squared_error, 0.25);
  EXPECT_DOUBLE_EQ(m.frames[0].rms_error, std::sqrt(0.125));
  EXPECT_EQ(m.frames[0].max_error_vertex, 1U);
  EXPECT_EQ(m.frames[0].moved_vertices, 2U);  // all in the first frame
  EXPECT_EQ(m.frames[1].moved_vertices, 1U);
  // PMSE = 0.25 / (3 * 2 * 16) and 2.5625 / (3 * 1 * 16).
  EXPECT_DOUBLE_EQ(m.frames[0].ramanathan_psnr_db, -10 * std::log10(0.25 / 96));
  EXPECT_DOUBLE_EQ(m.frames[1].ramanathan_psnr_db, -10 * std::log10(2.5625 / 48));
  EXPECT_DOUBLE_EQ(m.ramanathan_psnr_db,
                   (m.frames[0].ramanathan_psnr_db + m.frames[1].ramanathan_psnr_db) / 2);
}

TEST(Metrics, AppendPartsAsIfAddedInOrder) {
  const std::vector<std::vector<float>> originals{
      {0, 0, 0, 2, 0, 0}, {0, 0, 0, 2, 4, 0}, {1, 0, 0.1F, 2, 4, 0}, {1, 0, 7, -2, 4, 0.3F}};
  for (const auto keep : {MetricsAccumulator::kFrames, MetricsAccumulator::kTotals}) {
    MetricsAccumulator whole(2, keep);
    MetricsAccumulator appended(2, keep);
    for (std::size_t f = 0; f < originals.size(); ++f) {
      std::vector<float> decoded = originals[f];
      decoded[f] += 0.1F * static_cast<float>(f);
      whole.add_frame(originals[f], decoded);
      MetricsAccumulator part(2);
      part.follow(appended.last_original());
      part.add_frame(originals[f], decoded);
      appended.append(part);
    }
    const Metrics a = whole.result();
    const Metrics b = appended.result();
    EXPECT_EQ(a.kg_error_percent, b.kg_error_percent);
    EXPECT_EQ(a.kg_sequence_error_percent, b.kg_sequence_error_percent);
    EXPECT_EQ(a.rms_error, b.rms_error);
    EXPECT_EQ(a.max_error, b.max_error);
    EXPECT_EQ(a.max_error_frame, b.max_error_frame);
    EXPECT_EQ(a.diagonal, b.diagonal);
    EXPECT_EQ(a.max_displacement, b.max_displacement);
    EXPECT_EQ(a.ramanathan_psnr_db, b.ramanathan_psnr_db);
    ASSERT_EQ(a.frames.size(), b.frames.size());
    for (std::size_t f = 0; f < a.frames.size(); ++f) {
      EXPECT_EQ(a.frames[f].squared_error, b.frames[f].squared_error);
      EXPECT_EQ(a.frames[f].moved_vertices, b.frames[f].moved_vertices);
      EXPECT_EQ(a.frames[f].ramanathan_psnr_db, b.frames[f].ramanathan_psnr_db);
    }
  }
}

TEST(Metrics, TakeTheFirstOfEqualErrors) {
  MetricsAccumulator metrics(3);
  const std::vector<float> zero(9);
  metrics.add_frame(zero, zero);
  metrics.add_frame(zero, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  metrics.add_frame(zero, std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(metrics.result().max_error_frame, 1U);
  EXPECT_EQ(metrics.result().max_error_vertex, 1U);
}

// 0.1 is not exact in binary: computing the mean as sum / count would give a non-zero spread.
TEST(Metrics, AreZeroOrInfiniteIfVerticesCoincide) {
  const std::vector<float> point(3 * 7, 0.1F);
  MetricsAccumulator exact(7);
  exact.add_frame(point, point);
  EXPECT_EQ(exact.result().kg_error_percent, 0);
  EXPECT_EQ(exact.result().kg_sequence_error_percent, 0);
  EXPECT_EQ(exact.result().max_error_percent, 0);

  MetricsAccumulator inexact(7);
  std::vector<float> moved = point;
  moved[4] += 1;
  inexact.add_frame(point, moved);
  EXPECT_EQ(inexact.result().kg_error_percent, kInfinity);
  EXPECT_EQ(inexact.result().kg_sequence_error_percent, kInfinity);
  EXPECT_EQ(inexact.result().rms_error_percent, kInfinity);
  EXPECT_EQ(inexact.result().diagonal_psnr_db, -kInfinity);
  EXPECT_EQ(inexact.result().ramanathan_psnr_db, -kInfinity);
}

// Both norms differ only by the motion of the mean vertex.
TEST(Metrics, NormsAreEqualIfTheMeanStays) {
  MetricsAccumulator metrics(2);
  metrics.add_frame(std::vector<float>{0.1F, 0, 0, 0.3F, 0, 0}, std::vector<float>(6));
  metrics.add_frame(std::vector<float>{0.3F, 0, 0, 0.1F, 0, 0}, std::vector<float>(6));
  const Metrics m = metrics.result();
  EXPECT_EQ(m.kg_sequence_error_percent, m.kg_error_percent);
  EXPECT_EQ(m.rms_sequence_spread, m.rms_spread);
}

TEST(Metrics, UseTheDiagonalAsPeakIfNothingMoves) {
  MetricsAccumulator metrics(2);
  const std::vector<float> frame{0, 0, 0, 10, 0, 0};
  for (int f = 0; f < 2; ++f) metrics.add_frame(frame, std::vector<float>{0, 0, 0, 10, 0, 3});
  const Metrics m = metrics.result();
  EXPECT_EQ(m.max_displacement, 0);
  EXPECT_EQ(m.frames[1].moved_vertices, 0U);
  EXPECT_DOUBLE_EQ(m.frames[1].ramanathan_psnr_db, -10 * std::log10(9.0 / (3 * 2 * 100)));
}

TEST(Metrics, AcceptHugeCoordinates) {
  MetricsAccumulator metrics(2);
  const float large = std::numeric_limits<float>::max();
  metrics.add_frame(std::vector<float>{-large, -large, -large, large, large, large},
                    std::vector<float>{large, -large, -large, large, large, large});
  const Metrics m = metrics.result();
  EXPECT_TRUE(std::isfinite(m.kg_error_percent));
  EXPECT_DOUBLE_EQ(m.max_error, 2.0 * static_cast<double>(large));
}

TEST(Metrics, CountBitsPerVertexPerFrame) {
  EXPECT_EQ(bits_per_vertex_per_frame(1000, 100, 20), 4);
}

}  // namespace
}  // namespace rlpc
