#include "decoder/surface/attribute_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace rlpc {
namespace {

// A square of two triangles in the plane z = 0, one face each.
const std::vector<Triangle> kSquare{{0, 1, 2}, {0, 2, 3}};
const Vector<std::int32_t> kFlat{0, 0, 0, 100, 0, 0, 100, 100, 0, 0, 100, 0};

// Returns the square turned by an angle about the x axis, moved and larger.
std::vector<float> turned(double angle) {
  std::vector<float> xyz;
  for (std::size_t i = 0; i < kFlat.size(); i += 3) {
    const double y = 3.0 * kFlat[i + 1];
    for (const double x : {3.0 * kFlat[i] + 7.0, std::cos(angle) * y, std::sin(angle) * y}) {
      xyz.push_back(static_cast<float>(x));
    }
  }
  return xyz;
}

AttributeSet unit_vectors(Vector<std::uint32_t> values) {
  AttributeSet set;
  set.header.name = "normal";
  set.header.kind = ValueKind::kUnitVectors;
  set.header.prediction = AttributePrediction::kPositions;
  set.header.num_components = 2;
  set.header.value_bits = 10;
  set.face_of_triangle = {0, 1};
  set.values = std::move(values);
  set.first_positions = kFlat;
  return set;
}

std::array<float, 3> normal_at(FrameNormals& normals, std::span<const float> xyz,
                               std::size_t i) {
  std::vector<float> all(3 * std::size_t{normals.count()});
  normals.compute(xyz, all);
  return {all[3 * i], all[3 * i + 1], all[3 * i + 2]};
}

void expect_near(const std::array<float, 3>& found, const std::array<double, 3>& wanted) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 1e-5) << c;
}

TEST(FrameNormals, UnitVectorsAreThoseOfTheFirstFrameThere) {
  // Straight up, towards x, and two others.
  const AttributeSet set = unit_vectors({511, 511, 1022, 511, 700, 400, 511, 900});
  FrameNormals normals(set, kSquare, 4);
  const std::vector<float> flat = turned(0.0);
  const Vector<float> stored = attribute_numbers(set);
  for (std::size_t i = 0; i < 4; ++i) {
    expect_near(normal_at(normals, flat, i),
                {stored[3 * i], stored[3 * i + 1], stored[3 * i + 2]});
  }
  expect_near(normal_at(normals, flat, 1), {1.0, 0.0, 0.0});
}

TEST(FrameNormals, UnitVectorsTurnWithTheSurface) {
  const AttributeSet set = unit_vectors({511, 511, 1022, 511, 700, 400, 511, 900});
  FrameNormals normals(set, kSquare, 4);
  const double angle = std::numbers::pi / 3;
  const std::vector<float> xyz = turned(angle);
  const Vector<float> stored = attribute_numbers(set);
  for (std::size_t i = 0; i < 4; ++i) {
    const double y = stored[3 * i + 1];
    const double z = stored[3 * i + 2];
    expect_near(normal_at(normals, xyz, i),
                {stored[3 * i], std::cos(angle) * y - std::sin(angle) * z,
                 std::sin(angle) * y + std::cos(angle) * z});
  }
}

TEST(FrameNormals, IntegersAndFloatsOfAFrameGiveTheSame) {
  const AttributeSet set = unit_vectors({511, 511, 1022, 511, 700, 400, 511, 900});
  FrameNormals a(set, kSquare, 4);
  FrameNormals b(set, kSquare, 4);
  const std::vector<float> flat(kFlat.begin(), kFlat.end());
  const auto float_sums = a.sums(std::span<const float>(flat));
  const auto integer_sums = b.sums(std::span<const std::int32_t>(kFlat));
  for (std::size_t i = 0; i < float_sums.size(); ++i) {
    EXPECT_NEAR(float_sums[i], integer_sums[i], 1e-9);
  }
}

// The surface has no axes in a frame.
TEST(FrameNormals, WithoutASurfaceThereIsStillANormal) {
  const AttributeSet set = unit_vectors({511, 511, 1022, 511, 700, 400, 511, 900});
  FrameNormals collapses(set, kSquare, 4);
  const std::vector<float> nothing(12, 5.0F);
  expect_near(normal_at(collapses, nothing, 1), {1.0, 0.0, 0.0});
}

// A part without a surface in the first frame: all its vertices are at a point, or on a line.
TEST(FrameNormals, UnitVectorsWithoutAFirstSurfaceFollowLaterOnes) {
  AttributeSet set = unit_vectors({511, 511, 1022, 511, 700, 400, 511, 900});
  const double angle = 0.5;
  for (const Vector<std::int32_t>& first :
       {Vector<std::int32_t>(12, 5),
        Vector<std::int32_t>{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}}) {
    set.first_positions = first;
    FrameNormals normals(set, kSquare, 4);
    for (std::size_t i = 0; i < 4; ++i) {
      expect_near(normal_at(normals, turned(angle), i),
                  {0.0, -std::sin(angle), std::cos(angle)});
    }
  }
}

// The first vertex has the normal of its triangles, and follows them where they bend.
TEST(FrameNormals, UnitVectorsWithoutResidualFollowTheSurface) {
  const AttributeSet set = unit_vectors({511, 511, 1022, 511, 511, 511, 511, 900});
  FrameNormals normals(set, kSquare, 4);
  std::vector<float> bent(kFlat.begin(), kFlat.end());
  bent[3 * 3 + 2] = 100.0F;  // the fourth vertex goes up, and the second triangle with it
  // Their angles at it are 45 and 60 degrees; the normal of the second is (1, -1, 1).
  const double second = std::numbers::pi / (3 * std::sqrt(3.0));
  const double angle = std::atan2(std::sqrt(2.0) * second, second + std::numbers::pi / 4);
  const auto at_first = normal_at(normals, bent, 0);
  EXPECT_NEAR(std::acos(static_cast<double>(at_first[2])), angle, 1e-5);
  AttributeSet smoothing = set;
  smoothing.header.kind = ValueKind::kSmoothing;
  smoothing.header.num_components = 0;
  smoothing.values.clear();
  smoothing.first_positions.clear();
  FrameNormals smooth(smoothing, kSquare, 4);
  EXPECT_EQ(normal_at(smooth, bent, 0), at_first);
  EXPECT_EQ(normal_at(smooth, bent, 2), normal_at(normals, bent, 2));
  EXPECT_GT(normal_at(normals, bent, 1)[0], 0.9F);  // this one turns
}

TEST(FrameNormals, LeavesOutThoseThatAreNotWanted) {
  AttributeSet set = unit_vectors({511, 511, 1022, 511, 511, 511, 511, 900});
  std::vector<float> bent(kFlat.begin(), kFlat.end());
  bent[3 * 3 + 2] = 100.0F;
  for (const auto weight :
       {SmoothingWeight::kArea, SmoothingWeight::kEqual, SmoothingWeight::kAngle}) {
    set.header.weight = weight;
    FrameNormals whole(set, kSquare, 4);
    for (std::size_t wanted = 0; wanted < 4; ++wanted) {
      FrameNormals some = whole;
      Vector<std::uint8_t> one(4);
      one[wanted] = 1;
      some.restrict_to(std::move(one));
      std::vector<float> normals(12, 7.0F);
      some.compute(bent, normals);
      const auto expected = normal_at(whole, bent, wanted);
      for (std::size_t i = 0; i < normals.size(); ++i) {
        EXPECT_EQ(normals[i], i / 3 == wanted ? expected[i % 3] : 7.0F) << wanted << " " << i;
      }
    }
  }
}

TEST(FrameNormals, SmoothingFollowsFromPositions) {
  AttributeSet set = unit_vectors({});
  set.header.kind = ValueKind::kSmoothing;
  set.header.num_components = 0;
  set.first_positions.clear();
  const double angle = 0.7;
  for (const SmoothingWeight weight :
       {SmoothingWeight::kAngle, SmoothingWeight::kArea, SmoothingWeight::kEqual}) {
    set.header.weight = weight;
    FrameNormals normals(set, kSquare, 4);
    expect_near(normal_at(normals, turned(angle), 2), {0.0, -std::sin(angle), std::cos(angle)});
  }
}

}  // namespace
}  // namespace rlpc
