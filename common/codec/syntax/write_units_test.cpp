#include "common/codec/syntax/write_units.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace rlpc {
namespace {

constexpr std::uint64_t kMax = 0xFFFFFFFE;  // what ue( ) can write

TEST(GofIndexEntries, FitUpToTheLargestNumber) {
  EXPECT_TRUE((GofIndexEntries{kMax, {{1, kMax}}, {}}.fits()));
  EXPECT_FALSE((GofIndexEntries{kMax + 1, {{1, 1}}, {}}.fits()));
  EXPECT_FALSE((GofIndexEntries{1, {{1, 1}, {1, kMax + 1}}, {}}.fits()));
  EXPECT_FALSE((GofIndexEntries{1, {{1, 1}}, {{0, kMax + 1}}}.fits()));
}

// Rigs may be anywhere in the stream, as only the distances between them are written.
TEST(GofIndexEntries, FitIfRigsAreNearEachOther) {
  EXPECT_TRUE((GofIndexEntries{1, {{1, 1}}, {{0, kMax}, {1, 2 * kMax}}}.fits()));
  EXPECT_FALSE((GofIndexEntries{1, {{1, 1}}, {{0, kMax}, {1, 2 * kMax + 1}}}.fits()));
}

}  // namespace
}  // namespace rlpc
