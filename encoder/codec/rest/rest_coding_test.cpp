#include "encoder/codec/rest/rest_coding.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/mesh_prediction/rest_recon.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kWidth = 20;
constexpr std::uint32_t kHeight = 20;
constexpr int kPositionBits = 20;
constexpr std::uint32_t kStep = 24;

// A bumpy sheet of random heights, and next to it another: the same mirrored and turned, or one
// of other heights.
struct TwoSheets {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> wanted;

  explicit TwoSheets(bool copied) {
    std::mt19937 random(5);
    const auto noise = [&random](std::uint32_t range) {
      return static_cast<std::int32_t>(random() % range);
    };
    for (std::uint32_t sheet = 0; sheet < 2; ++sheet) {
      const std::uint32_t first = sheet * kWidth * kHeight;
      for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
          add_vertex(sheet,
                     {static_cast<std::int32_t>(x) * 1000 + noise(500),
                      static_cast<std::int32_t>(y) * 1000 + noise(500), noise(3000)},
                     copied);
          if (x + 1 == kWidth || y + 1 == kHeight) continue;
          const std::uint32_t v = first + y * kWidth + x;
          add_triangle(sheet, {v, v + 1, v + kWidth + 1});
          add_triangle(sheet, {v, v + kWidth + 1, v + kWidth});
        }
      }
    }
  }

 private:
  void add_vertex(std::uint32_t sheet, const std::array<std::int32_t, 3>& x, bool copied) {
    std::array<std::int32_t, 3> position = x;
    if (sheet == 1 && copied) {
      const std::size_t num_first = wanted.size() - std::size_t{3} * kWidth * kHeight;
      position = {50000 - wanted[num_first + 1], wanted[num_first], -wanted[num_first + 2]};
    }
    wanted.insert(wanted.end(), position.begin(), position.end());
  }
  // The second sheet is mirrored: its triangles have the opposite orientation.
  void add_triangle(std::uint32_t sheet, const Triangle& t) {
    triangles.push_back(sheet == 0 ? t : Triangle{t[0], t[2], t[1]});
  }
};

struct Coded {
  explicit Coded(const TwoSheets& sheets, bool counterparts)
      : topology(make_topology(2 * kWidth * kHeight, sheets.triangles)),
        meshes(topology, sheets.triangles),
        rest(code_rest_in_order(meshes[Prediction::kLayers], sheets.wanted, kStep,
                                kPositionBits, {.counterparts = counterparts})) {}

  Topology topology;
  OrderedMeshes meshes;
  RestEncoding rest;
};

int count_counterparts(const RestEncoding& rest) {
  int count = 0;
  for (const Counterpart& x : rest.counterparts) {
    if (x.flag || x.new_flag) ++count;
  }
  return count;
}

TEST(RestCoding, CopiesOfAPartAreItsCounterparts) {
  const TwoSheets copied(true);
  const Coded without(copied, false);
  const Coded with(copied, true);
  EXPECT_FALSE(without.rest.settings.counterparts_flag);
  EXPECT_TRUE(with.rest.settings.counterparts_flag);
  EXPECT_GT(count_counterparts(with.rest), static_cast<int>(kWidth * kHeight * 9 / 10));
  EXPECT_LT(with.rest.bits, 0.75 * without.rest.bits);
}

TEST(RestCoding, OtherShapesAreNot) {
  const Coded coded(TwoSheets(false), true);
  EXPECT_LT(count_counterparts(coded.rest), static_cast<int>(kWidth * kHeight / 10));
}

TEST(RestCoding, ValuesAreWithinHalfAStepAsDecoded) {
  for (const bool copied : {false, true}) {
    const TwoSheets sheets(copied);
    const Coded coded(sheets, true);
    const RestOrder& order = coded.meshes[Prediction::kLayers].rest_order();
    const RestRecon recon(order, coded.rest.settings, kStep, kPositionBits);
    const auto decoded = recon_rest(recon, order, coded.rest.residual, coded.rest.counterparts);
    EXPECT_EQ(decoded, coded.rest.values);
    for (std::size_t v = 0; v < sheets.wanted.size() / 3; ++v) {
      double square = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        square += std::pow(decoded[3 * v + c] - sheets.wanted[3 * v + c], 2);
      }
      // The error is half a step on each axis, and rounding to a sixteenth.
      EXPECT_LT(std::sqrt(square), std::sqrt(3.0) * (kStep / 2.0 + 1.0));
    }
  }
}

// Cheaper than by layers on a rough mesh.
TEST(RestCoding, AnOrderOfItsOwnTakesFewerBitsThanLayers) {
  const TwoSheets sheets(false);
  const Coded coded(sheets, false);
  const OrderedMesh& mesh = coded.meshes[Prediction::kLayers];
  std::vector<std::int32_t> residual(sheets.wanted.size());
  std::vector<std::int32_t> values(sheets.wanted.size());
  for (const std::uint32_t v : mesh.order()) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t sum = 0;
      for (const std::uint32_t u : mesh.ring(v)) sum += values[3 * u + c];
      const std::int64_t mean =
          mesh.ring(v).empty() ? 0
                               : div_round(sum, static_cast<std::int64_t>(mesh.ring(v).size()));
      residual[3 * v + c] =
          static_cast<std::int32_t>(div_round(sheets.wanted[3 * v + c] - mean, kStep));
      values[3 * v + c] = static_cast<std::int32_t>(
          mean + residual[3 * v + c] * static_cast<std::int64_t>(kStep));
    }
  }
  EXPECT_LT(coded.rest.cost, rest_cost_in_layers(mesh, sheets.wanted, kStep, residual, values));
}

}  // namespace
}  // namespace rlpc
