// The checks of encoder_fuzz on random cases, and on results with planted faults.
#include "conformance/fuzz/encoder_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/syntax/sequence_header.h"

namespace rlpc {
namespace {

// Bytes 1 to 3 are profile, preset and target; see encoder_case.cpp.
std::vector<std::uint8_t> random_bytes(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(400);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
  // Most cases have the right box, number of frames and number of vertices.
  if (seed % 4 != 0) bytes[0] &= 0b00101111;
  return bytes;
}

TEST(EncoderCheck, RandomCases) {
  std::uint32_t encoded[3][3] = {};  // profile, preset
  std::uint32_t sequences = 0;
  std::uint32_t refused = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    const EncoderCase c = make_encoder_case(random_bytes(seed));
    std::optional<EncodedCase> result;
    ASSERT_EQ(check_encoder(c, &result), "") << "seed " << seed;
    if (!result) {
      ++refused;
    } else {
      ++encoded[c.options.profile % 3][c.options.preset % 3];
      if (c.settings) ++sequences;
    }
  }
  for (const auto& profile : encoded) {
    for (const std::uint32_t count : profile) EXPECT_GT(count, 20U);
  }
  EXPECT_GT(sequences, 50U);
  EXPECT_GT(refused, 100U);
}

// A strip that bends, frame by frame.
EncoderCase strip() {
  EncoderCase c = make_encoder_case({});
  c.num_vertices = 12;
  for (std::uint32_t t = 0; t < 10; ++t) {
    for (const std::uint32_t v : {t, t + 1 + t % 2, t + 2 - t % 2}) c.indices.push_back(v);
  }
  for (std::uint32_t f = 0; f < 6; ++f) {
    std::vector<float> xyz;
    for (std::uint32_t v = 0; v < 12; ++v) {
      const std::uint32_t column = v / 2;
      const auto x = static_cast<float>(column);
      const auto y = static_cast<float>(v % 2);
      xyz.insert(xyz.end(), {x, y, 0.01F * static_cast<float>(f) * x * x});
    }
    c.frames.push_back(std::move(xyz));
  }
  c.num_frames = 6;
  c.frame_rate = {25, 1};
  c.box_max = {6.0F, 1.0F, 2.0F};
  rlpc_encode_options_init(&c.options, sizeof c.options);
  c.options.keep_order = 0;
  return c;
}

TEST(EncoderCheck, AcceptsAStrip) {
  const EncoderCase c = strip();
  EXPECT_TRUE(c.is_legal());
  std::optional<EncodedCase> result;
  EXPECT_EQ(check_encoder(c, &result), "");
  ASSERT_TRUE(result);
  EXPECT_EQ(check_encoded(c, *result), "");
}

struct Wrong {
  const char* complaint;
  std::function<void(EncoderCase&, EncodedCase&)> make;
};

TEST(EncoderCheck, NoticesWhatIsWrong) {
  const EncoderCase right = strip();
  std::optional<EncodedCase> result;
  ASSERT_EQ(check_encoder(right, &result), "");
  ASSERT_TRUE(result);
  const std::vector<Wrong> list{
      {"num_bytes", [](auto&, auto& e) { ++e.report.num_bytes; }},
      {"bpvf", [](auto&, auto& e) { e.report.bpvf *= 1.001; }},
      {"kg_error_percent", [](auto&, auto& e) { e.report.kg_error_percent *= 0.999; }},
      {"rms_error", [](auto&, auto& e) { e.report.rms_error *= 1.001; }},
      {"max_error", [](auto&, auto& e) { e.report.max_error *= 0.999; }},
      {"num_gofs", [](auto&, auto& e) { ++e.report.num_gofs; }},
      {"level", [](auto&, auto& e) { ++e.report.level; }},
      {"permutation", [](auto&, auto& e) { e.input_vertex[0] = e.input_vertex[1]; }},
      {"other triangles",
       [](auto&, auto& e) { std::swap(e.input_vertex[0], e.input_vertex[1]); }},
      {"other triangles", [](auto& c, auto&) { std::swap(c.indices[0], c.indices[1]); }},
      {"frame rate", [](auto& c, auto&) { c.frame_rate.numerator = 24; }},
      {"metadata", [](auto& c, auto&) { c.metadata = "{}"; }},
      {"num_vertices",
       [](auto& c, auto& e) {
         c.num_vertices = 13;
         e.input_vertex.push_back(12);
       }},
      {"breaks R-UNT-03", [](auto&, auto& e) { e.bytes[40] ^= 1; }},
      {"breaks", [](auto&, auto& e) { e.bytes.resize(e.bytes.size() - 1); }},
      {"count of frames", [](auto& c, auto&) { c.num_frames = 5; }},
      {"kg_error_percent", [](auto& c, auto&) { c.frames[3][7] += 0.1F; }},
      {"target is reported as met",
       [](auto& c, auto& e) { c.options.target_value = 0.9 * e.report.kg_error_percent; }},
      {"target is reported as met",
       [](auto& c, auto& e) {
         c.options.target = RLPC_TARGET_MAX_ERROR;
         c.options.target_value = 0.9 * e.report.max_error;
       }},
      {"target is reported as met",
       [](auto& c, auto& e) {
         c.options.target = RLPC_TARGET_BPVF;
         c.options.target_value = 0.9 * e.report.bpvf;
       }},
  };
  for (const Wrong& wrong : list) {
    EncoderCase c = right;
    EncodedCase encoded = *result;
    wrong.make(c, encoded);
    EXPECT_NE(check_encoded(c, encoded).find(wrong.complaint), std::string::npos)
        << wrong.complaint << ": " << check_encoded(c, encoded);
  }
}

// A case wrongly taken as legal or as illegal would show in the status of the call.
TEST(EncoderCheck, KnowsWhatIsLegal) {
  const std::vector<std::function<void(EncoderCase&)>> list{
      [](auto& c) { c.num_vertices = 0; },
      [](auto& c) { c.num_frames = 0; },
      [](auto& c) { c.frame_rate.denominator = 0; },
      [](auto& c) { c.indices[5] = 12; },
      [](auto& c) { c.box_min[1] = 2.0F; },
      [](auto& c) { c.box_max[2] = 0x1p101F; },
      [](auto& c) { c.options.target_value = 0.0; },
      [](auto& c) { c.options.components = 1025; },
      [](auto& c) { c.options.least_level = kMaxLevelIdc + 1; },
      [](auto& c) { c.options.profile = 3; },
      [](auto& c) { c.options.preset = 3; },
      [](auto& c) { c.options.target = 0; },
      [](auto& c) { c.options.hash_mode = 3; },
  };
  for (std::size_t i = 0; i < list.size(); ++i) {
    EncoderCase c = strip();
    list[i](c);
    EXPECT_FALSE(c.is_legal()) << i;
    std::optional<EncodedCase> result;
    EXPECT_EQ(check_encoder(c, &result), "") << i;
    EXPECT_FALSE(result) << i;
  }
  EncoderCase c = strip();
  c.frames[2][4] = 1.01F;
  EXPECT_TRUE(c.is_legal());
  EXPECT_FALSE(c.is_legal_frame(2));
  EXPECT_EQ(check_encoder(c), "");
}

}  // namespace
}  // namespace rlpc
