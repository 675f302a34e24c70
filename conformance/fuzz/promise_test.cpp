// Random animations and settings: the encoder keeps its promises, or says that it does not.
//
// The program `promises` tries as many as one likes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
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

// Returns a case that keeps its promise.
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

// A few vertices, each frame of them turned about another axis by any angle, or at rest: how
// many bits they need depends on the way they are coded more than on the step.
PromiseCase turned_case(std::uint32_t seed) {
  std::minstd_rand random(seed + 1);
  const auto number = [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; };
  PromiseCase c;
  c.settings.profile = std::array{Profile::kBaseline, Profile::kMain, Profile::kHigh}[seed % 3];
  c.shape.num_vertices = 3 + static_cast<std::uint32_t>(random() % 10);
  c.shape.num_frames = 8 + static_cast<std::uint32_t>(random() % 24);
  c.shape.frame_rate = {30, 1};
  for (std::uint32_t v = 2; v < c.shape.num_vertices; ++v) {
    c.shape.triangles.push_back({v - 2, v - 1, v});
  }
  std::vector<double> rest(3 * c.shape.num_vertices);
  for (double& x : rest) x = number();
  for (std::uint32_t f = 0; f < c.shape.num_frames; ++f) {
    std::vector<double>& frame = c.frames.emplace_back(rest);
    if (f == 0 || random() % 3 == 0) continue;
    const std::size_t axis = random() % 3;
    const double angle = 3.0 * number();
    for (std::size_t i = 0; i < frame.size(); i += 3) {
      const double x = rest[i + axis];
      const double y = rest[i + (axis + 1) % 3];
      frame[i + axis] = x * std::cos(angle) - y * std::sin(angle);
      frame[i + (axis + 1) % 3] = x * std::sin(angle) + y * std::cos(angle);
    }
  }
  return c;
}

// A rate that is missed is lower than any that the same animation has at another target.
TEST(Promises, OnlyRatesOutOfReachAreMissed) {
  int missed = 0;
  for (std::uint32_t seed = 0; seed < 36; ++seed) {
    PromiseCase c = turned_case(seed);
    double lowest = std::numeric_limits<double>::infinity();
    std::vector<double> missed_rates;
    for (const double rate : {3.0, 4.9, 8.0, 13.0, 21.0, 34.0, 55.0}) {
      c.settings.target = {Target::kBpvf, rate};
      const PromiseStream stream = encode_for_test(c);
      lowest = std::min(lowest, stream.report.bpvf);
      if (!stream.report.target_met) missed_rates.push_back(rate);
    }
    for (const double rate : missed_rates) EXPECT_LT(rate, lowest) << "seed " << seed;
    missed += static_cast<int>(missed_rates.size());
  }
  EXPECT_GT(missed, 0);
}

// Tests the checks themselves: they find planted faults.
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

  PromiseCase turned = turned_case(2);
  turned.settings.target = {Target::kKg, 1.0};
  const PromiseStream turned_stream = encode_for_test(turned);
  ASSERT_EQ(check_stream(turned, turned_stream).outcome, Outcome::kKept);
  turned.settings.target.max_normals = 1e-3;
  EXPECT_NE(check_stream(turned, turned_stream).what.find("normals"), std::string::npos);

  PromiseStream damaged = stream;
  damaged.bytes[damaged.bytes.size() / 2] ^= 1;
  EXPECT_EQ(check_stream(right, damaged).outcome, Outcome::kWrong);

  PromiseStream flattered = stream;
  flattered.report.metrics.max_error *= 0.5;
  EXPECT_EQ(check_stream(right, flattered).outcome, Outcome::kWrong);
}

}  // namespace
}  // namespace rlpc
