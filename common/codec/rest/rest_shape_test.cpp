#include "common/codec/rest/rest_shape.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

// 8.18.6: ClipSigned( position_bits + 5, x ); at most 2^28 in magnitude, as 8.18.3 says.
TEST(RestShape, PositionsHaveFourFractionalBitsAndOneMore) {
  EXPECT_EQ(rest_bits(2), 7);
  EXPECT_EQ(rest_bits(24), 29);
}

// 6.11: elements of rest_order( ) that are absent are 0.
TEST(RestShape, HasNoOrderOfItsOwnUnlessItSaysSo) {
  const RestSettings rest;
  EXPECT_FALSE(rest.order_flag);
  EXPECT_FALSE(rest.exact_flag);
  EXPECT_FALSE(rest.axes_flag);
  EXPECT_FALSE(rest.counterparts_flag);
  EXPECT_EQ(rest, RestSettings{});
  const Counterpart none;
  EXPECT_FALSE(none.flag);
  EXPECT_FALSE(none.new_flag);
}

}  // namespace
}  // namespace rlpc
