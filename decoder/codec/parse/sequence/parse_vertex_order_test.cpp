#include "decoder/codec/parse/sequence/parse_vertex_order.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/testing/element_lines.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Order = std::vector<std::uint32_t>;

// vertex_order_delta 4, 1, -2, -3, 1, 1
const Bytes kLegalOrder{0x09, 0x12, 0x70};

Result<Order> order_in(const Bytes& payload, std::uint32_t num_vertices,
                       Trace* trace = nullptr) {
  BitReader r(payload, 0, trace);
  return parse_vertex_order(r, num_vertices);
}

TEST(ParseVertexOrder, GivesThePermutation) {
  ElementLines lines;
  const auto order = order_in(kLegalOrder, 6, &lines);
  ASSERT_TRUE(order);
  EXPECT_EQ(*order, (Order{4, 5, 3, 0, 1, 2}));
  EXPECT_EQ(lines.text,
            "vertex_order_delta 4\nvertex_order_delta 1\nvertex_order_delta -2\n"
            "vertex_order_delta -3\nvertex_order_delta 1\nvertex_order_delta 1\n");
}

TEST(ParseVertexOrder, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < kLegalOrder.size(); ++n) {
    const Bytes exact(kLegalOrder.begin(),
                      kLegalOrder.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(order_in(exact, 6)) << n;
  }
}

TEST(ParseVertexOrder, BytesLeftOverAreInvalid) {
  Bytes longer = kLegalOrder;
  longer.push_back(0);
  expect_invalid(order_in(longer, 6), "R-RNG-01", "vertex_order");
}

TEST(ParseVertexOrder, SectionMustNotStartWithOnes) {
  expect_invalid(order_in({0xFF, 0xFF, 0xFF, 0xFF, 0x00}, 6), "R-RNG-02", "vertex_order");
}

TEST(ParseVertexOrder, IndicesAreBelowTheNumberOfVertices) {
  for (const std::uint32_t num_vertices : {1U, 4U, 5U}) {
    expect_invalid(order_in(kLegalOrder, num_vertices), "R-VOR-01", "vertex_order_delta");
  }
}

TEST(ParseVertexOrder, IndicesAreNotNegative) {
  expect_invalid(order_in({0x68}, 2), "R-VOR-01", "vertex_order_delta");  // -1
}

TEST(ParseVertexOrder, NoIndexComesTwice) {
  expect_invalid(order_in({0x50}, 2), "R-VOR-02", "vertex_order_delta");  // 1, 0
  EXPECT_TRUE(order_in({0x48, 0x90}, 3));                                 // 1, 1, -2
}

TEST(ParseVertexOrder, ManyClaimedVerticesEndWithTheBytes) {
  for (const int fill : {0x00, 0x55, 0xAA, 0xFE}) {
    EXPECT_FALSE(order_in(Bytes(8, static_cast<std::uint8_t>(fill)), 1U << 23)) << fill;
  }
}

}  // namespace
}  // namespace rlpc
