#include "encoder/codec/sequence/normals_target.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "encoder/testing/bumpy_sheet.h"

namespace rlpc {
namespace {

constexpr int kSide = 12;

// A sheet that moves, or one point.
class Sheet final : public FrameSource {
 public:
  explicit Sheet(float size = 1.0F)
      : FrameSource({kSide * kSide, 9, {30, 1}, sheet_triangles(kSide)}), size_(size) {}
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    const Frame found = sheet(kSide, static_cast<float>(frame), 1);
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = size_ * found[i];
    return std::nullopt;
  }

 private:
  float size_;
};

double kg_for(FrameSource& source, double max_normals, double kg = 100.0) {
  const auto found = expected_kg(source, source.triangles(), {Target::kKg, kg, max_normals});
  EXPECT_TRUE(found);
  return found ? *found : 0.0;
}

TEST(NormalsTarget, ExpectsAnErrorInProportionToTheAngle) {
  Sheet source;
  const double one = kg_for(source, 1.0);
  EXPECT_GT(one, 0.001);
  EXPECT_LT(one, 10.0);
  EXPECT_NEAR(kg_for(source, 2.0) / one, 2.0, 0.05);
  EXPECT_NEAR(kg_for(source, 0.1) / one, 0.1, 0.005);
}

TEST(NormalsTarget, DoesNotDependOnTheSize) {
  Sheet source;
  Sheet large(512.0F);
  EXPECT_NEAR(kg_for(large, 1.0) / kg_for(source, 1.0), 1.0, 0.01);
}

TEST(NormalsTarget, ExpectsNoMoreThanTheOtherBound) {
  Sheet source;
  EXPECT_DOUBLE_EQ(kg_for(source, 1.0, 1e-3), 1e-3);
  EXPECT_DOUBLE_EQ(kg_for(source, 179.0, 0.5), 0.5);
}

TEST(NormalsTarget, TakesTheOtherBoundWhereThereIsNoShape) {
  Sheet point(0.0F);
  EXPECT_EQ(kg_for(point, 1.0, 0.5), 0.5);
}

}  // namespace
}  // namespace rlpc
