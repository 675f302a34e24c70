// Tests that the encoder's choice of bones is not worse than the number of parts of a mesh, if
// parts are so few and small that expected costs are imprecise.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "conformance/testing/small_animation.h"

namespace rlpc {
namespace {

constexpr double kMaxBonesRatio = 1.03;

// Boxes that turn and move, one after the other, as objects of a scene do.
class MovingBoxes {
 public:
  explicit MovingBoxes(unsigned seed) : random_(seed), num_boxes_(8 + seed % 4) {
    for (std::uint32_t b = 0; b < num_boxes_; ++b) {
      const auto half = static_cast<float>(0.4 + 0.1 * below(6));
      for (std::uint32_t corner = 0; corner < 8; ++corner) {
        for (std::uint32_t c = 0; c < 3; ++c) {
          corners_.push_back((corner >> c & 1) != 0 ? half : -half);
        }
      }
      for (const Triangle& t : kBox) {
        triangles_.push_back({8 * b + t[0], 8 * b + t[1], 8 * b + t[2]});
      }
      speeds_.push_back(0.05 + 0.01 * below(10));
      shifts_.push_back(0.1 * below(8));
    }
  }

  std::uint32_t num_boxes() const { return num_boxes_; }

  MemoryFrames source() const {
    constexpr std::uint32_t kFramesOfBox = 50;
    std::vector<std::vector<float>> frames;
    for (std::uint32_t f = 0; f < kFramesOfBox * num_boxes_; ++f) {
      const std::uint32_t moving = f / kFramesOfBox;
      std::vector<float> xyz;
      for (std::uint32_t b = 0; b < num_boxes_; ++b) {
        add_box(b, b == moving ? f % kFramesOfBox : 0, xyz);
      }
      frames.push_back(std::move(xyz));
    }
    FrameSource::Shape shape;
    shape.frame_rate = {30, 1};
    shape.triangles = triangles_;
    return {std::move(shape), std::move(frames)};
  }

 private:
  static constexpr std::array<Triangle, 12> kBox{{{0, 2, 1},
                                                  {1, 2, 3},
                                                  {4, 5, 6},
                                                  {5, 7, 6},
                                                  {0, 1, 4},
                                                  {1, 5, 4},
                                                  {2, 6, 3},
                                                  {3, 6, 7},
                                                  {0, 4, 2},
                                                  {2, 4, 6},
                                                  {1, 3, 5},
                                                  {3, 7, 5}}};

  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(random_() % count);
  }

  // Adds a box at a time of its motion; 0: at rest.
  void add_box(std::uint32_t b, std::uint32_t time, std::vector<float>& xyz) const {
    const double turn = speeds_[b] * time;
    const double lift = shifts_[b] * std::sin(0.126 * time);
    const auto c = static_cast<float>(std::cos(turn));
    const auto s = static_cast<float>(std::sin(turn));
    for (std::size_t i = 24 * std::size_t{b}; i < 24 * (std::size_t{b} + 1); i += 3) {
      xyz.push_back(3.0F * static_cast<float>(b) + c * corners_[i] - s * corners_[i + 1]);
      xyz.push_back(s * corners_[i] + c * corners_[i + 1]);
      xyz.push_back(corners_[i + 2] + static_cast<float>(lift));
    }
  }

  std::mt19937 random_;
  std::uint32_t num_boxes_;
  std::vector<float> corners_;
  std::vector<Triangle> triangles_;
  std::vector<double> speeds_;
  std::vector<double> shifts_;
};

std::size_t bytes_of_boxes(const MovingBoxes& boxes, Profile profile, std::uint32_t num_bones) {
  EncoderSettings settings;
  settings.profile = profile;
  settings.target = {Target::kKg, 0.1};
  settings.gof_frames = EncoderSettings::kWholeSequence;
  settings.main.bones = num_bones;
  MemoryFrames source = boxes.source();
  return encode_to_memory(source, settings).size();
}

TEST(MovingParts, AreFoundWithoutAskingForTheirNumber) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const MovingBoxes boxes(seed);
    const std::size_t chosen = bytes_of_boxes(boxes, Profile::kMain, 0);
    const std::size_t asked = bytes_of_boxes(boxes, Profile::kMain, boxes.num_boxes());
    EXPECT_LE(static_cast<double>(chosen), kMaxBonesRatio * static_cast<double>(asked))
        << "with " << boxes.num_boxes() << " bones: " << asked;
  }
}

}  // namespace
}  // namespace rlpc
