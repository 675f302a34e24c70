// Tests 6.12.4 rest_residuals( v ), parsing side.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/rest/counterparts.h"
#include "common/codec/rest/rest_contexts.h"
#include "common/testing/skinned_gof_recipe.h"
#include "decoder/testing/skinned_gof_units.h"

namespace rlpc {
namespace {

// Makes a grid closed in both directions, so that vertices have one to four hinges.
std::vector<Triangle> torus(std::uint32_t width, std::uint32_t height) {
  std::vector<Triangle> triangles;
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return y % height * width + x % width;
  };
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return triangles;
}

const std::vector<Triangle> kTorus = torus(5, 6);
constexpr std::uint32_t kVertices = 30;

struct NewCounterpart {
  std::uint32_t hinge;
  std::uint32_t idx;
};

// A slice of zeros in which the first vertex with `num_hinges` hinges has a new counterpart.
class RestSlice {
 public:
  RestSlice() : topology_(make_topology(kVertices, kTorus)), order_(topology_, kTorus) {}

  // Returns the number of hinges that are listed before that vertex.
  std::uint32_t num_listed(std::size_t num_hinges) const {
    std::size_t count = 0;
    for (const std::uint32_t v : order_.order()) {
      if (order_.hinges(v).size() == num_hinges && count > 0) break;
      count += order_.hinges(v).size();
    }
    return static_cast<std::uint32_t>(count);
  }

  std::vector<std::uint8_t> payload(std::size_t num_hinges, const NewCounterpart& wanted) {
    SliceRecipe slice(0, 0);
    const std::uint32_t listed = num_listed(num_hinges);
    CounterpartModels flags;
    VertexModels models;
    Counterparts counterparts(order_);
    RestContexts contexts(order_);
    bool is_done = false;
    for (const std::uint32_t v : order_.order()) {
      counterparts.start(v);
      const std::size_t hinges = order_.hinges(v).size();
      const bool inherited = counterparts.is_inherited();
      if (inherited) slice.section.bin(flags.counterpart_flag[counterparts.context()], false);
      bool used = false;
      if (hinges > 0 && counterparts.num_listed() > 0) {
        used = !is_done && hinges == num_hinges;
        slice.section.bin(flags.new_counterpart_flag[inherited ? 1 : 0], used);
      }
      if (used) {
        is_done = true;
        slice.section.bypass(ceil_log2(hinges), wanted.hinge);
        slice.section.bypass(ceil_log2(listed), wanted.idx);
        slice.section.bypass(1, 1);
        Counterpart legal;
        legal.hinge = static_cast<std::uint8_t>(wanted.hinge < hinges ? wanted.hinge : 0);
        legal.idx = wanted.idx < listed ? wanted.idx : 0;
        legal.mirrored = true;
        counterparts.set_new(legal);
      }
      counterparts.finish(used);
      contexts.start(v, counterparts.class_of(v), counterparts);
      for (std::size_t c = 0; c < kRestFactors; ++c) {
        slice.residual(models[static_cast<std::size_t>(counterparts.class_of(v))],
                       contexts.expected(c), 0);
        contexts.update(c, 0);
      }
    }
    EXPECT_TRUE(is_done);
    return slice.payload();
  }

 private:
  Topology topology_;
  RestOrder order_;
};

Result<bool> parse_slice(const std::vector<std::uint8_t>& slice, SkinnedGof* gof = nullptr) {
  SkinnedGofUnits units(high_header(kVertices, 1), kTorus);
  SkinnedGofRecipe recipe;
  recipe.num_adaptive_factors = 0;
  recipe.rest_order_flag = true;
  recipe.rest_counterparts_flag = true;
  EXPECT_TRUE(units.gof(recipe.payload()));
  auto parsed = units.slice(slice);
  if (gof != nullptr) *gof = units.parser().finish();
  return parsed;
}

void expect_refused(const Result<bool>& parsed, const std::string& element) {
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, Errc::kInvalid);
  EXPECT_STREQ(parsed.error().rule, "R-RST-01");
  EXPECT_EQ(parsed.error().element, element);
}

TEST(ParseRestResiduals, NewCounterpartsAreKept) {
  RestSlice slice;
  const std::uint32_t listed = slice.num_listed(3);
  SkinnedGof gof;
  ASSERT_TRUE(parse_slice(slice.payload(3, {2, listed - 1}), &gof));
  int count = 0;
  for (const Counterpart& choice : gof.counterparts) {
    EXPECT_FALSE(choice.flag);
    if (!choice.new_flag) continue;
    ++count;
    EXPECT_EQ(choice.hinge, 2);
    EXPECT_EQ(choice.idx, listed - 1);
    EXPECT_TRUE(choice.mirrored);
  }
  EXPECT_EQ(count, 1);
}

// Three hinges take two bits; the list has fewer entries than its bits can index.
TEST(ParseRestResiduals, HingesOfACounterpartExist) {
  RestSlice slice;
  const std::uint32_t listed = slice.num_listed(3);
  ASSERT_LT(listed, std::uint32_t{1} << ceil_log2(listed));
  expect_refused(parse_slice(slice.payload(3, {3, 0})), "counterpart_hinge");
  expect_refused(parse_slice(slice.payload(3, {0, listed})), "counterpart_idx");
}

TEST(ParseRestResiduals, EveryProperPrefixFails) {
  RestSlice slice;
  const std::vector<std::uint8_t> whole = slice.payload(2, {1, 0});
  ASSERT_TRUE(parse_slice(whole));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const std::vector<std::uint8_t> prefix(whole.begin(),
                                           whole.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(parse_slice(prefix)) << n;
  }
}

}  // namespace
}  // namespace rlpc
