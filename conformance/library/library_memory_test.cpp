// What librlpc takes of memory, and what it does without.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "conformance/roundtrip/count_memory.h"
#include "decoder/c_api/rlpc_decode.h"
#include "encoder/c_api/rlpc_encode.h"

// What is taken when memory ends may stay taken, as the headers say: common/ and decoder/ are
// built without exceptions. NOLINTNEXTLINE
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

namespace {

using rlpc::memory_count;

constexpr std::uint32_t kVertices = 40;
constexpr std::uint32_t kGofFrames = 16;
constexpr std::uint32_t kFrames = 4 * kGofFrames;

std::vector<float> frame_of(std::uint32_t f) {
  std::vector<float> xyz;
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    const std::uint32_t column = v / 2;
    const double x = column * 0.05;
    for (const double c : {x, v % 2 * 0.3, 0.2 * std::sin(0.2 * f + 4 * x)}) {
      xyz.push_back(static_cast<float>(c));
    }
  }
  return xyz;
}

int append(void* user, const void* bytes, std::size_t num_bytes) {
  auto& stream = *static_cast<std::vector<std::uint8_t>*>(user);
  const auto* begin = static_cast<const std::uint8_t*>(bytes);
  if (num_bytes > stream.capacity() - stream.size()) return 1;
  stream.insert(stream.end(), begin, begin + num_bytes);
  return 0;
}

rlpc_status encode(std::vector<std::uint8_t>& stream) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t v = 0; v + 2 < kVertices; ++v) {
    for (const std::uint32_t i : {v, v + 1 + v % 2, v + 2 - v % 2}) indices.push_back(i);
  }
  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = kVertices;
  format.num_triangles = kVertices - 2;
  format.indices = indices.data();
  format.num_frames = kFrames;
  format.box_max[0] = format.box_max[1] = 1;
  format.box_min[2] = -0.2F;
  format.box_max[2] = 0.2F;
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.preset = RLPC_FAST;
  options.target_value = 2.0;
  options.gof_frames = kGofFrames;
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < kFrames; ++f) frames.push_back(frame_of(f));
  stream.clear();
  stream.reserve(1 << 16);

  rlpc_encoder* encoder = nullptr;
  rlpc_status status = rlpc_encoder_create(&format, &options, append, &stream, &encoder);
  for (std::uint32_t f = 0; status == RLPC_OK && f < kFrames; ++f) {
    status = rlpc_encoder_add_frame(encoder, frames[f].data(), frames[f].size());
  }
  if (status == RLPC_OK) status = rlpc_encoder_finish(encoder, nullptr, 0);
  if (status == RLPC_OUT_OF_MEMORY && encoder != nullptr) {
    EXPECT_STREQ(rlpc_encoder_error_text(encoder), "out of memory");
    EXPECT_EQ(rlpc_encoder_finish(encoder, nullptr, 0), RLPC_OUT_OF_MEMORY);
  }
  rlpc_encoder_close(encoder);
  return status;
}

// But for what the sum of the bones of a few frames needs, for a moment.
TEST(Library, FramesWithinAGofKeepNoMemory) {
  std::vector<std::uint8_t> stream;
  ASSERT_EQ(encode(stream), RLPC_OK);
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

TEST(Library, WhatIsTakenIsGivenBack) {
  std::vector<std::uint8_t> stream;
  ASSERT_EQ(encode(stream), RLPC_OK);
  std::vector<std::int32_t> positions(3 * kVertices);
  const std::size_t before = memory_count.now;
  rlpc_decoder* decoder = nullptr;
  ASSERT_EQ(rlpc_decoder_open_memory(stream.data(), stream.size(), nullptr, &decoder), RLPC_OK);
  while (rlpc_decoder_next_positions(decoder, positions.data(), positions.size()) == RLPC_OK) {
  }
  rlpc_decoder_close(decoder);
  EXPECT_EQ(memory_count.now, before);
}

// Runs until memory ends, after ever more of it was taken, up to where it is enough.
template <class Run>
void run_out_of_memory(const Run& run, std::size_t stride) {
  for (std::size_t calls = 0;; calls += 1 + calls / stride) {
    memory_count.calls_left = calls;
    const rlpc_status status = run();
    memory_count.calls_left = std::numeric_limits<std::size_t>::max();
    if (status == RLPC_OK) return;
    ASSERT_EQ(status, RLPC_OUT_OF_MEMORY) << calls;
  }
}

TEST(Library, TheEncoderEndsWithMemory) {
  std::vector<std::uint8_t> stream;
  ASSERT_EQ(encode(stream), RLPC_OK);
  std::vector<std::uint8_t> again;
  run_out_of_memory(
      [&] {
        try {
          return encode(again);
        } catch (const std::bad_alloc&) {  // in what this test does itself
          return RLPC_OUT_OF_MEMORY;
        }
      },
      8);
  EXPECT_EQ(again, stream);
}

TEST(Library, TheDecoderEndsWithMemory) {
  std::vector<std::uint8_t> stream;
  ASSERT_EQ(encode(stream), RLPC_OK);
  std::vector<float> xyz(3 * kVertices);
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  const auto decode = [&] {
    rlpc_decoder* decoder = nullptr;
    rlpc_status status =
        rlpc_decoder_open_memory(stream.data(), stream.size(), &options, &decoder);
    while (status == RLPC_OK) {
      status = rlpc_decoder_next_floats(decoder, xyz.data(), xyz.size());
    }
    if (status == RLPC_OUT_OF_MEMORY && decoder != nullptr) {
      EXPECT_EQ(std::strcmp(rlpc_decoder_error_text(decoder), "out of memory"), 0);
      EXPECT_EQ(rlpc_decoder_seek(decoder, 0), RLPC_OUT_OF_MEMORY);
    }
    rlpc_decoder_close(decoder);
    return status == RLPC_END ? RLPC_OK : status;
  };
  run_out_of_memory(decode, 64);
  // Threads count together: not the same call fails each time.
  options.threads = 4;
  for (int i = 0; i < 5; ++i) run_out_of_memory(decode, 64);
}

}  // namespace
