#include "encoder/attributes/quantise_attribute.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace rlpc {
namespace {

// Texture coordinates from 0 to `most`.
SourceAttribute coordinates(float most, std::string name = "uv0") {
  SourceAttribute source;
  source.name = std::move(name);
  source.num_components = 2;
  source.values = {0.0F, 0.0F, 0.3F * most, most};
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
  // As far as values of 16 bits go.
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

}  // namespace
}  // namespace rlpc
