// Tests that memory while frames stream in and out suffices for one GOF, however long the
// sequence.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "conformance/testing/count_memory.h"
#include "decoder/rlpc_decoder.h"
#include "encoder/frame_encoder.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kClothVertices = 60;
constexpr std::uint32_t kClothGofFrames = 10;

// A waving cloth of 10 by 6 vertices, which moves alike in every GOF.
std::vector<float> cloth_frame(std::uint32_t f) {
  std::vector<float> xyz;
  for (std::uint32_t v = 0; v < kClothVertices; ++v) {
    const double x = v % 10 / 10.0;
    const std::uint32_t row = v / 10;
    const double y = row / 6.0;
    const double wave = 0.1 * std::sin(6.2832 * (f % kClothGofFrames / 10.0 + x));
    for (const double c : {x, y, wave * (1 + y)}) xyz.push_back(static_cast<float>(c));
  }
  return xyz;
}

std::size_t peak_of_encoding(std::uint32_t num_frames, std::vector<std::uint8_t>& stream) {
  FrameFormat format;
  format.num_vertices = kClothVertices;
  format.num_frames = num_frames;
  format.box_min = {0, 0, -0.2F};
  format.box_max = {1, 1, 0.2F};
  for (std::uint32_t v = 0; v + 11 < kClothVertices; ++v) {
    if (v % 10 == 9) continue;
    format.triangles.push_back({v, v + 1, v + 10});
    format.triangles.push_back({v + 1, v + 11, v + 10});
  }
  EncoderSettings settings;
  settings.gof_frames = kClothGofFrames;
  settings.target.value = 1.0;
  settings.check_rules = false;  // checked as a whole, the stream would be kept
  stream.clear();
  stream.reserve(1 << 20);
  const std::size_t before = memory_count.now;
  memory_count.peak = before;
  auto encoder = FrameEncoder::create(format, settings, [&](auto bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    return true;
  });
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    EXPECT_FALSE(encoder->add_frame(cloth_frame(f)));
  }
  EXPECT_TRUE(encoder->finish());
  return memory_count.peak - before;
}

std::size_t peak_of_streaming(const std::vector<std::uint8_t>& stream,
                              std::uint32_t num_frames) {
  auto source = memory_source(stream);
  std::vector<std::int32_t> positions(3 * kClothVertices);
  const std::size_t before = memory_count.now;
  memory_count.peak = before;
  auto decoder = Decoder::open(std::move(source));
  EXPECT_TRUE(decoder);
  std::uint32_t count = 0;
  for (; *decoder->next_frame(positions); ++count) {
  }
  EXPECT_EQ(count, num_frames);
  return memory_count.peak - before;
}

TEST(Streaming, MemoryDoesNotGrowWithTheSequence) {
  // Each GOF needs an entry in the index; a growing table reserves twice the room.
  constexpr std::size_t kGofBytes = 64;
  std::vector<std::uint8_t> short_stream;
  std::vector<std::uint8_t> long_stream;
  const std::size_t with_400 = peak_of_encoding(400, short_stream);
  const std::size_t with_2000 = peak_of_encoding(2000, long_stream);
  // The decoder that verifies the stream has a table of its own.
  EXPECT_LE(with_2000, with_400 + 2 * kGofBytes * 160);
  EXPECT_GT(long_stream.size(), 4 * short_stream.size());
  // The frames alone are larger than the allowed growth.
  static_assert(1600 * kClothVertices * 12 > 100 * kGofBytes * 160);

  const std::size_t decoded_400 = peak_of_streaming(short_stream, 400);
  const std::size_t decoded_2000 = peak_of_streaming(long_stream, 2000);
  EXPECT_LE(decoded_2000, decoded_400 + kGofBytes * 160);
  RecordProperty("encoder_bytes", static_cast<int>(with_2000));
  RecordProperty("decoder_bytes", static_cast<int>(decoded_2000));
}

}  // namespace
}  // namespace rlpc
