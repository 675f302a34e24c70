// The memory that librlpc uses.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "conformance/testing/count_memory.h"
#include "conformance/testing/waving_strip.h"
#include "decoder/c_api/rlpc_c_decoder.h"

namespace {

using rlpc::memory_count;

constexpr std::uint32_t kVertices = 40;
constexpr std::uint32_t kGofFrames = 16;
constexpr std::uint32_t kFrames = 4 * kGofFrames;

std::vector<std::uint8_t> encoded_strip() {
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.preset = RLPC_PRESET_FAST;
  options.target_value = 2.0;
  options.gof_kind = RLPC_GOF_KIND_SKINNED;
  options.gof_frames = kGofFrames;
  const rlpc::WavingStrip strip(kVertices, kFrames);
  std::vector<std::uint8_t> stream;
  stream.reserve(1 << 16);
  rlpc_encoder* encoder = nullptr;
  EXPECT_EQ(strip.create(options, stream, &encoder), RLPC_OK);
  EXPECT_EQ(strip.add_all(encoder), RLPC_OK);
  rlpc_encoder_close(encoder);
  return stream;
}

// Frames only use a temporary buffer for the sums of bones of a few frames.
TEST(Library, FramesWithinAGofKeepNoMemory) {
  const std::vector<std::uint8_t> stream = encoded_strip();
  rlpc_decoder* decoder = nullptr;
  ASSERT_EQ(rlpc_decoder_open_memory(stream.data(), stream.size(), nullptr, &decoder), RLPC_OK);
  std::vector<float> xyz(3 * kVertices);
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    const rlpc::MemoryCount before = memory_count;
    ASSERT_EQ(rlpc_decoder_next_floats(decoder, xyz.data(), xyz.size()), RLPC_OK);
    if (f % kGofFrames == 0) continue;
    EXPECT_EQ(memory_count.now, before.now) << f;
    EXPECT_LE(memory_count.calls, before.calls + (f % 4 == 0 ? 1 : 0)) << f;
  }
  rlpc_decoder_close(decoder);
}

TEST(Library, AllMemoryIsFreed) {
  const std::vector<std::uint8_t> stream = encoded_strip();
  std::vector<std::int32_t> positions(3 * kVertices);
  const std::size_t before = memory_count.now;
  rlpc_decoder* decoder = nullptr;
  ASSERT_EQ(rlpc_decoder_open_memory(stream.data(), stream.size(), nullptr, &decoder), RLPC_OK);
  while (rlpc_decoder_next_positions(decoder, positions.data(), positions.size()) == RLPC_OK) {
  }
  rlpc_decoder_close(decoder);
  EXPECT_EQ(memory_count.now, before);
}

}  // namespace
