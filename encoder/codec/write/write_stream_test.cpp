#include "encoder/codec/write/write_stream.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "common/codec/bits/bit_writer.h"

namespace rlpc {
namespace {

// Returns what the end of a payload, from `first` on, inflates to.
std::string inflated(const Bytes& payload, std::size_t first, std::size_t size) {
  std::string text(size, '\0');
  uLongf length = size;
  const int status = uncompress(reinterpret_cast<Bytef*>(text.data()), &length,
                                payload.data() + first, payload.size() - first);
  EXPECT_EQ(status, Z_OK);
  EXPECT_EQ(length, size);
  return text;
}

// Bytes that hardly shrink, in more than one piece of the compressor.
TEST(WriteStream, LargeAssetsAreWhole) {
  std::minstd_rand random(1);
  std::string glb((std::size_t{5} << 19) + 1, '\0');
  for (char& c : glb) c = static_cast<char>(random() >> 8);
  const Bytes payload = write_asset(glb);
  const std::size_t size = glb.size();
  EXPECT_EQ(payload[0], 0);  // asset_format
  EXPECT_EQ(payload[1], 0);
  EXPECT_EQ(payload[2], size >> 16);
  EXPECT_EQ(payload[3], (size >> 8) & 0xFF);
  EXPECT_EQ(payload[4], size & 0xFF);
  EXPECT_TRUE(inflated(payload, 5, size) == glb);
}

TEST(WriteStream, MetadataAreInflatedToTheirSize) {
  const std::string json = R"({"title": "walk"})";
  const Bytes payload = write_metadata(json);
  EXPECT_EQ(payload[3], json.size());
  EXPECT_EQ(inflated(payload, 4, json.size()), json);
}

// The second clip begins in the last frame of the first.
TEST(WriteStream, ClipsAreRelativeToTheEndOfTheOneBefore) {
  BitWriter w;
  w.ue(1);
  w.se(2);
  w.ue(2);
  w.u(8, 0);
  w.u(8, 'a');
  w.se(-1);
  w.ue(6);
  w.u(8, 1);
  w.u(8, 'b');
  w.u(8, 'c');
  w.byte_alignment();
  EXPECT_EQ(write_clip_table(std::vector<Clip>{{"a", 2, 3}, {"bc", 4, 7}}), w.take());
}

}  // namespace
}  // namespace rlpc
