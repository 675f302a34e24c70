// Random animations and settings: the encoder keeps its promises, or says that it does not.
//
// The program `promises` tries as many as one likes.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conformance/fuzz/promise_check.h"

namespace rlpc {
namespace {

constexpr std::uint64_t kCases = 400;

TEST(Promises, AreKeptByRandomCases) {
  std::array<std::array<std::uint32_t, 3>, 5> counts{};  // [target][outcome]
  for (std::uint64_t seed = 0; seed < kCases; ++seed) {
    const PromiseCase c = make_promise_case(seed);
    const PromiseResult result = check_promises(c);
    ASSERT_NE(result.outcome, Outcome::kWrong)
        << "seed " << seed << ", " << c.kind << ": " << result.what;
    ++counts[c.settings.target.kind][static_cast<std::size_t>(result.outcome)];
  }
  // All targets are met in many cases.
  for (const auto kind : {Target::kLossless, Target::kMaxError, Target::kKg, Target::kBpvf}) {
    EXPECT_GT(counts[kind][static_cast<std::size_t>(Outcome::kKept)], kCases / 40) << kind;
  }
  EXPECT_GT(counts[Target::kLossless][static_cast<std::size_t>(Outcome::kKept)], kCases / 4);
}

// A case, with its stream, that keeps its promise.
PromiseCase lossless_case() {
  PromiseCase c = make_promise_case(0);
  c.way = PromiseCase::kWhole;
  c.open_ended = false;
  c.settings = {};
  c.settings.profile = Profile::kHigh;
  c.settings.target = {Target::kLossless, 12.0};
  c.settings.keep_order = true;
  c.shape.attributes = {};
  return c;
}

PromiseStream encode_for_test(const PromiseCase& c) {
  ExactFrames source(c.shape, c.frames);
  PromiseStream stream;
  auto report = encode(source, c.settings, [&](std::span<const std::uint8_t> more) {
    stream.bytes.insert(stream.bytes.end(), more.begin(), more.end());
    return true;
  });
  if (report) stream.report = std::move(*report);
  return stream;
}

// The checks themselves: what is planted is found.
TEST(Promises, AreSeenToBeBroken) {
  const PromiseCase right = lossless_case();
  const PromiseStream stream = encode_for_test(right);
  ASSERT_EQ(check_stream(right, stream).outcome, Outcome::kKept)
      << check_stream(right, stream).what;

  PromiseCase other = right;
  other.settings.target.value = 0.0;
  other.frames[0][0] += 1e-3;
  EXPECT_EQ(check_stream(other, stream).outcome, Outcome::kWrong);

  other = right;
  other.settings.target = {Target::kMaxError, 0.5 * stream.report.metrics.max_error};
  EXPECT_NE(check_stream(other, stream).what.find("largest error"), std::string::npos);

  other.settings.target = {Target::kKg, 0.5 * stream.report.metrics.kg_error_percent};
  EXPECT_NE(check_stream(other, stream).what.find("KG error"), std::string::npos);

  other.settings.target = {Target::kBpvf, 0.9 * stream.report.bpvf};
  EXPECT_NE(check_stream(other, stream).what.find("rate"), std::string::npos);

  PromiseStream damaged = stream;
  damaged.bytes[damaged.bytes.size() / 2] ^= 1;
  EXPECT_EQ(check_stream(right, damaged).outcome, Outcome::kWrong);

  PromiseStream flattered = stream;
  flattered.report.metrics.max_error *= 0.5;
  EXPECT_EQ(check_stream(right, flattered).outcome, Outcome::kWrong);
}

}  // namespace
}  // namespace rlpc
