#include "encoder/codec/kinds/skinned/input_rig.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_fit.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kFrames = 12;

// Bones that turn about z, each relative to its parent, at its pivot.
class Skeleton final : public FrameSource {
 public:
  // turn[b]: speed of bone b, in radians per frame.
  // stretch[b]: how much bone b stretches along an axis between x and y, and half as much along
  // z, before it turns.
  Skeleton(SourceRig rig, std::vector<double> turn, std::vector<double> stretch = {})
      : FrameSource(shape_of(std::move(rig))),
        turn_(std::move(turn)),
        stretch_(std::move(stretch)) {
    stretch_.resize(turn_.size());
  }

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    std::vector<BoneMap> maps(rig()->bones.size());
    read_bones(frame, maps);
    for (std::uint32_t v = 0; v < num_vertices(); ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        double total = 0.0;
        for (auto i = rig()->first_influence[v]; i < rig()->first_influence[v + 1]; ++i) {
          const SourceRig::Influence& influence = rig()->influences[i];
          const auto& row = maps[influence.bone][c];
          double x = row[3];
          for (std::size_t k = 0; k < 3; ++k) x += row[k] * rig()->rest[3 * v + k];
          sum += static_cast<double>(influence.weight) * x;
          total += static_cast<double>(influence.weight);
        }
        xyz[3 * v + c] = static_cast<float>(sum / total);
      }
    }
    return std::nullopt;
  }

  // Moves all frames.
  void move(const std::vector<double>& by) { moved_ = by; }

  void read_bones(std::uint32_t frame, std::span<BoneMap> maps) override {
    for (std::size_t b = 0; b < maps.size(); ++b) {
      const SourceRig::Bone& bone = rig()->bones[b];
      const double angle = turn_[b] * frame;
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      const auto& p = bone.pivot;
      const double grown = stretch_[b] * std::sin(0.7 * frame);
      const double xx = 1.0 + 0.8 * grown;
      const double xy = 0.4 * grown;
      const double yy = 1.0 + 0.2 * grown;
      BoneMap turned{{{c * xx - s * xy, c * xy - s * yy, 0, 0},
                      {s * xx + c * xy, s * xy + c * yy, 0, 0},
                      {0, 0, 1.0 + 0.5 * grown, 0}}};
      for (std::size_t i = 0; i < 3; ++i) {
        turned[i][3] = p[i];
        for (std::size_t k = 0; k < 3; ++k) turned[i][3] -= turned[i][k] * p[k];
      }
      maps[b] = turned;
      if (bone.parent < 0) {
        for (std::size_t i = 0; i < 3; ++i) maps[b][i][3] += moved_[i];
        continue;
      }
      const BoneMap& above = maps[static_cast<std::size_t>(bone.parent)];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
          double sum = j == 3 ? above[i][3] : 0.0;
          for (std::size_t k = 0; k < 3; ++k) sum += above[i][k] * turned[k][j];
          maps[b][i][j] = sum;
        }
      }
    }
  }

 private:
  static Shape shape_of(SourceRig rig) {
    Shape shape;
    shape.num_vertices = static_cast<std::uint32_t>(rig.rest.size() / 3);
    shape.num_frames = kFrames;
    shape.rig = std::make_shared<SourceRig>(std::move(rig));
    return shape;
  }

  std::vector<double> turn_;
  std::vector<double> stretch_;
  std::vector<double> moved_{0.0, 0.0, 0.0};
};

// A chain of bones along x, one unit apart, each with two vertices. weights[b]: what they
// follow of bone b, in any unit; the rest is that of bone 0.
SourceRig chain(const std::vector<float>& weights) {
  SourceRig rig;
  rig.first_influence.push_back(0);
  for (std::size_t b = 0; b < weights.size(); ++b) {
    const auto x = static_cast<double>(b);
    rig.bones.push_back({static_cast<std::int32_t>(b) - 1, {x, 0, 0}});
    for (const double y : {0.5, -0.5}) {
      rig.rest.insert(rig.rest.end(), {x + 0.5, y, 0.25});
      if (weights[b] > 0) rig.influences.push_back({static_cast<std::uint32_t>(b), weights[b]});
      if (weights[b] < 2) rig.influences.push_back({0, 2 - weights[b]});
      rig.first_influence.push_back(rig.influences.size());
    }
  }
  return rig;
}

Grid fine_grid() {
  Grid grid;
  grid.log2_step = -12;
  grid.origin = {100, -200, 300};
  return grid;
}

SequenceHeader fine_header() {
  SequenceHeader header;
  header.grid = fine_grid();
  header.position_bits = 18;
  return header;
}

std::shared_ptr<const Rig> rig_of(FrameSource& source, const FrameRange& span) {
  std::vector<std::uint32_t> order(source.num_vertices());
  std::iota(order.rbegin(), order.rend(), 0U);  // decoded vertices in another order
  const std::size_t num_bones = source.rig()->bones.size();
  std::vector<BoneMap> maps(num_bones * span.count);
  for (std::uint32_t f = 0; f < span.count; ++f) {
    source.read_bones(span.first + f, std::span(maps).subspan(f * num_bones, num_bones));
  }
  return rig_of_span(*source.rig(), maps, fine_header(), order, true);
}

void expect_positions(FrameSource& source, const Rig& rig, const FrameRange& span) {
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  for (std::uint32_t f = 0; f < span.count; ++f) {
    ASSERT_FALSE(source.read_frame(span.first + f, xyz));
    for (std::uint32_t v = 0; v < source.num_vertices(); ++v) {
      const Point p = skinned_position(rig, f, source.num_vertices() - 1 - v);
      for (std::size_t c = 0; c < 3; ++c) {
        const double want =
            static_cast<double>(xyz[3 * v + c]) * 4096.0 - fine_grid().origin[c];
        ASSERT_NEAR(p[c], want, 0.3) << "frame " << f << ", vertex " << v;
      }
    }
  }
}

TEST(InputRig, MovesTheVerticesOfASpan) {
  Skeleton source(chain({2, 1.5F, 1, 0.5F}), {0.3, -0.2, 0.4, 0.1});
  const FrameRange span{3, 6};
  const auto rig = rig_of(source, span);
  ASSERT_TRUE(rig);
  ASSERT_EQ(rig->bones.size(), 4U);
  for (const RigBone& bone : rig->bones) EXPECT_EQ(bone.poses.size(), span.count);
  for (const auto& weights : rig->weights) {
    double sum = 0.0;
    for (const RigWeight& w : weights) sum += w.weight;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
  expect_positions(source, *rig, span);
}

// The axis of largest growth is that of (2, 1, 0).
TEST(InputRig, StretchesBonesAndThoseBelow) {
  Skeleton source(chain({2, 1.5F, 1, 0.5F}), {0.3, -0.2, 0.4, 0.1}, {0, 0.3, 0, -0.2});
  const FrameRange span{3, 6};
  const auto rig = rig_of(source, span);
  ASSERT_TRUE(rig);
  ASSERT_EQ(rig->bones.size(), 4U);
  EXPECT_EQ(rig->bones[1].stretch, Stretch::kOwnAxes);
  EXPECT_EQ(rig->bones[2].stretch, Stretch::kNone);
  EXPECT_EQ(rig->bones[3].stretch, Stretch::kOwnAxes);
  for (std::size_t b = 1; b < 4; ++b) EXPECT_EQ(rig->bones[b].axes.size(), span.count);
  expect_positions(source, *rig, span);
  const auto& turn = rig->bones[1].stretch_turn;
  const double angle = 2.0 * std::atan2(turn[3], turn[0]);
  EXPECT_NEAR(std::abs(std::sin(2.0 * angle)), 0.8, 1e-6);
  EXPECT_NEAR(turn[1], 0.0, 1e-9);
  EXPECT_NEAR(turn[2], 0.0, 1e-9);
}

TEST(InputRig, EnlargesTheRestShapeWhereBonesGrow) {
  Skeleton source(chain({2, 2, 2}), {0.3, 0.2, 0.1}, {0, 0.5, 0});
  const FrameRange span{0, kFrames};
  const auto rig = rig_of(source, span);
  ASSERT_TRUE(rig);
  expect_positions(source, *rig, span);
  EXPECT_EQ(rig->bones[0].stretch, Stretch::kRestAxes);  // keeps its size
  for (const RigBone& bone : rig->bones) {
    for (const AxisImages& images : bone.axes) {
      for (const Point& image : images) {
        for (const double x : image) EXPECT_LE(std::abs(x), 1.0 + 1e-12);
      }
    }
  }
}

// Frames are far from the rest shape, which does not fit the coordinates of rest positions
// there.
TEST(InputRig, MovesTheRestShapeToTheFrames) {
  for (const bool stretches : {false, true}) {
    SourceRig far = chain({2, 1.5F, 1});
    for (std::size_t i = 0; i < far.rest.size(); ++i) far.rest[i] += i % 3 == 1 ? 500.0 : -90.0;
    for (SourceRig::Bone& bone : far.bones) {
      for (std::size_t c = 0; c < 3; ++c) bone.pivot[c] += c == 1 ? 500.0 : -90.0;
    }
    Skeleton source(std::move(far), {0.3, -0.2, 0.4},
                    std::vector<double>(3, stretches ? 0.4 : 0.0));
    const std::vector<double> back{90.0, -500.0, 90.0};
    source.move(back);
    const FrameRange span{0, kFrames};
    const auto rig = rig_of(source, span);
    ASSERT_TRUE(rig);
    EXPECT_EQ(rig->stretches(), stretches);
    expect_positions(source, *rig, span);
    const double limit = 1 << 18;
    for (const Point& p : rig->rest) {
      for (const double x : p) EXPECT_LE(std::abs(x), limit);
    }
    for (const RigBone& bone : rig->bones) {
      for (const double x : bone.pivot) EXPECT_LE(std::abs(x), limit);
    }
  }
}

TEST(InputRig, HasRotationsAloneInProfilesWithoutStretch) {
  Skeleton source(chain({2, 1.5F, 1}), {0.3, -0.2, 0.4}, {0, 0.3, 0});
  std::vector<std::uint32_t> order(source.num_vertices());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<BoneMap> maps(3);
  source.read_bones(4, maps);
  const auto rig = rig_of_span(*source.rig(), maps, fine_header(), order, false);
  ASSERT_TRUE(rig);
  for (const RigBone& bone : rig->bones) {
    EXPECT_EQ(bone.stretch, Stretch::kNone);
    EXPECT_TRUE(bone.axes.empty());
  }
}

TEST(InputRig, MergesBonesThatStandStillRelativeToTheirParents) {
  Skeleton source(chain({2, 1, 2, 1}), {0.3, 0.0, 0.0, 0.2});
  const FrameRange span{0, kFrames};
  const auto rig = rig_of(source, span);
  ASSERT_TRUE(rig);
  ASSERT_EQ(rig->bones.size(), 2U);
  EXPECT_EQ(rig->bones[1].parent, 0);
  expect_positions(source, *rig, span);
}

TEST(InputRig, DropsBonesThatJoinNothing) {
  Skeleton source(chain({2, 0, 2, 0}), {0.3, 0.1, 0.2, 0.2});
  const FrameRange span{0, kFrames};
  const auto rig = rig_of(source, span);
  ASSERT_TRUE(rig);
  ASSERT_EQ(rig->bones.size(), 2U);
  expect_positions(source, *rig, span);
}

TEST(InputRig, KeepsBonesThatJoinOthers) {
  SourceRig forked = chain({2, 0, 2, 2});
  forked.bones[3].parent = 1;  // as that of bone 2
  Skeleton source(std::move(forked), {0.3, 0.1, 0.2, 0.4});
  const FrameRange span{0, kFrames};
  const auto rig = rig_of(source, span);
  ASSERT_TRUE(rig);
  ASSERT_EQ(rig->bones.size(), 4U);
  EXPECT_EQ(rig->bones[3].parent, 1);
  expect_positions(source, *rig, span);
}

TEST(InputRig, IsAbsentWhereAllMovesAsOne) {
  Skeleton source(chain({2, 1, 2}), {0.3, 0.0, 0.0});
  EXPECT_FALSE(rig_of(source, {0, kFrames}));
}

// Bones may vanish, mirror or lie anywhere: whatever the maps are, poses are rotations.
TEST(InputRig, HasRotationsWhateverTheMapsAre) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-2.0, 2.0);
  const SourceRig rig = chain({2, 1, 2, 1});
  const std::vector<std::uint32_t> order{0, 1, 2, 3, 4, 5, 6, 7};
  for (int round = 0; round < 2000; ++round) {
    std::vector<BoneMap> maps(5 * rig.bones.size());
    for (BoneMap& map : maps) {
      const double scale = std::array{0.0, 1e-12, 1.0, -1.0, 1e12}[random() % 5];
      for (auto& row : map) {
        for (double& x : row) x = scale * number(random);
      }
      if (random() % 4 == 0) map[1] = map[0];  // flat
    }
    const auto made = rig_of_span(rig, maps, fine_header(), order, true);
    if (!made) continue;
    for (const RigBone& bone : made->bones) {
      for (const RigPose& pose : bone.poses) {
        double norm = 0.0;
        for (const double q : pose.rotation) norm += q * q;
        ASSERT_NEAR(norm, 1.0, 1e-9);
        for (const double x : pose.origin) ASSERT_TRUE(std::isfinite(x));
      }
    }
  }
}

TEST(InputRig, IsAbsentWhereNumbersAreOfNoUse) {
  const std::vector<std::uint32_t> order{0, 1, 2, 3};
  for (const double x : {1e31, std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<BoneMap> maps(4);
    for (std::size_t i = 0; i < maps.size(); ++i) {
      maps[i] = {{{1, 0, 0, static_cast<double>(i * i)}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    }
    EXPECT_TRUE(rig_of_span(chain({2, 1}), maps, fine_header(), order, true));
    SourceRig far = chain({2, 1});
    far.rest[4] = x;
    EXPECT_FALSE(rig_of_span(far, maps, fine_header(), order, true));
    maps[2][1][3] = x;
    EXPECT_FALSE(rig_of_span(chain({2, 1}), maps, fine_header(), order, true));
  }
}

}  // namespace
}  // namespace rlpc
