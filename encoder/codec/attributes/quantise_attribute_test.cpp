#include "encoder/codec/attributes/quantise_attribute.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "common/codec/attributes/recon/attribute_prediction.h"

namespace rlpc {
namespace {

// Texture coordinates from 0 to `max`.
SourceAttribute coordinates(float max, std::string name = "uv0") {
  SourceAttribute source;
  source.name = std::move(name);
  source.num_components = 2;
  source.values = {0.0F, 0.0F, 0.3F * max, max};
  return source;
}

int log2_step(const SourceAttribute& source, const std::vector<double>& texels,
              double scale = 1.0) {
  AttributeSettings settings;
  settings.uv_bits = 12;
  for (const double t : texels) settings.uv_uses.push_back({t, scale});
  return quantise_attribute(source, settings).header.log2_step;
}

TEST(QuantiseAttribute, TextureCoordinatesHaveTheirBitsOverAnImage) {
  EXPECT_EQ(log2_step(coordinates(1.0F), {64.0}), -12);
  EXPECT_EQ(log2_step(coordinates(0.1F), {64.0}), -12);
  EXPECT_EQ(log2_step(coordinates(1.9F), {64.0}), -12);
}

TEST(QuantiseAttribute, CoordinatesThatRepeatAnImageHaveThemOverTheirRange) {
  EXPECT_EQ(log2_step(coordinates(2.0F), {64.0}), -11);
  EXPECT_EQ(log2_step(coordinates(10.2F), {64.0}), -9);
  EXPECT_EQ(log2_step(coordinates(10.2F, "uv1"), {0.0, 64.0}), -9);
}

TEST(QuantiseAttribute, CoordinatesKeepAQuarterOfATexel) {
  EXPECT_EQ(log2_step(coordinates(15.0F), {256.0}), -10);
  EXPECT_EQ(log2_step(coordinates(15.0F), {1024.0}), -12);
  EXPECT_EQ(log2_step(coordinates(15.0F), {8192.0}), -12);
}

TEST(QuantiseAttribute, CoordinatesThatATransformScalesHaveTheirBitsOverAnImage) {
  const double unknown = std::numeric_limits<double>::infinity();
  EXPECT_EQ(log2_step(coordinates(0.1F), {0.0}, 1.0), -12);
  EXPECT_EQ(log2_step(coordinates(0.1F), {unknown}, 4.0), -14);
  EXPECT_EQ(log2_step(coordinates(0.1F), {unknown}, 40.0), -18);
  EXPECT_EQ(log2_step(coordinates(0.1F), {40.0 * 1024.0}, 40.0), -18);
  EXPECT_EQ(log2_step(coordinates(0.1F), {40.0 * 64.0}, 40.0), -16);
  // The step is as fine as values of 16 bits allow.
  EXPECT_EQ(log2_step(coordinates(0.1F), {unknown}, 1e300), -19);
  EXPECT_EQ(log2_step(coordinates(1.0F), {unknown}, 40.0), -15);
}

TEST(QuantiseAttribute, CoordinatesOfUnknownImagesHaveTheirBitsOverAnImage) {
  EXPECT_EQ(log2_step(coordinates(10.2F), {}), -12);
  EXPECT_EQ(log2_step(coordinates(10.2F), {0.0}), -12);
  EXPECT_EQ(log2_step(coordinates(10.2F), {std::numeric_limits<double>::infinity()}), -12);
  EXPECT_EQ(log2_step(coordinates(10.2F, "uv1"), {64.0}), -12);
  EXPECT_EQ(log2_step(coordinates(10.2F, "uv"), {64.0}), -12);
}

// Returns the value that a decoder reconstructs for a coordinate.
double decoded(const QuantisedAttribute& q, std::size_t i) {
  if (q.header.kind == ValueKind::kFloats) {
    return std::bit_cast<float>(unordered_bits(q.values[i]));
  }
  return (static_cast<double>(q.values[i]) + q.header.origin[i % 2]) *
         std::exp2(q.header.log2_step);
}

// All coordinates but one lie within an image.
TEST(QuantiseAttribute, CoordinatesFarFromTheOthersLeaveTheOthersTheirPrecision) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> within(0.0F, 1.0F);
  for (const float far : {200.0F, 1000.0F, 1e5F, -1e5F, 3e7F, -1e20F, 3e38F}) {
    SourceAttribute source;
    source.name = "uv0";
    source.num_components = 2;
    for (int i = 0; i < 128; ++i) source.values.push_back(within(random));
    source.values[random() % 128] = far;
    const QuantisedAttribute q = quantise_attribute(source, {});
    for (std::size_t i = 0; i < source.values.size(); ++i) {
      EXPECT_NEAR(decoded(q, i), source.values[i], 1.01 / 1024) << far << " " << i;
    }
  }
}

}  // namespace
}  // namespace rlpc
