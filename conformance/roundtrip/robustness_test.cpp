// Tests damaged streams: they give an error, after right frames; never a crash or a hang.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "conformance/testing/rig_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

using Frame = std::vector<std::int32_t>;

// The output of a decoder up to the end or an error.
struct Decoded {
  std::vector<Frame> frames;
  std::optional<Error> error;
};

DecoderOptions small_options(bool verify_hashes = true) {
  DecoderOptions options;
  options.limits = {1U << 12, 1U << 13, 1U << 12, std::uint64_t{16} << 20};
  options.verify_hashes = verify_hashes;
  return options;
}

// Decodes an exact-size copy, so that the address sanitizer sees one byte over.
Result<Decoder> open_copy(const StreamBytes& bytes, const DecoderOptions& options) {
  return Decoder::open(memory_source(StreamBytes(bytes)), options);
}

Decoded decode_until_error(const StreamBytes& bytes,
                           const DecoderOptions& options = small_options()) {
  Decoded out;
  auto decoder = open_copy(bytes, options);
  if (!decoder) {
    out.error = decoder.error();
    return out;
  }
  Frame frame(3 * std::size_t{decoder->header().num_vertices});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    if (!more) out.error = more.error();
    if (!more || !*more) break;
    out.frames.push_back(frame);
  }
  if (out.error) {
    // Callers may continue: they get another error, or the end.
    EXPECT_FALSE(decoder->next_frame(frame));
    if (decoder->seek(decoder->header().num_frames - 1)) (void)decoder->next_frame(frame);
    if (decoder->seek(0)) (void)decoder->next_frame(frame);
  }
  return out;
}

// Decodes one frame by seeking; none if there was an error.
std::optional<Frame> decode_frame(const StreamBytes& bytes, std::uint32_t index) {
  auto decoder = open_copy(bytes, small_options());
  if (!decoder || index >= decoder->header().num_frames) return std::nullopt;
  Frame frame(3 * std::size_t{decoder->header().num_vertices});
  const auto found = decoder->seek(index);
  const auto more = decoder->next_frame(frame);
  if (!found || !more || !*more) return std::nullopt;
  return frame;
}

class Robustness : public testing::TestWithParam<StreamBytes (*)()> {
 protected:
  void SetUp() override {
    stream_ = GetParam()();
    ASSERT_FALSE(stream_.empty());
    expected_ = decode_until_error(stream_);
    ASSERT_FALSE(expected_.error) << expected_.error->rule << " " << expected_.error->element;
    for (const UnitPlace& unit : units_of(stream_)) {
      if (unit.type == UnitType::kSlice) slices_.insert(unit.offset);
    }
  }

  // The frames before the error are right.
  void expect_error(const StreamBytes& bytes, Decoded& got) const {
    got = decode_until_error(bytes);
    ASSERT_TRUE(got.error);
    ASSERT_LE(got.frames.size(), expected_.frames.size());
    ASSERT_TRUE(std::equal(got.frames.begin(), got.frames.end(), expected_.frames.begin()));
  }
  void expect_error_or_right_by_seeking(const StreamBytes& bytes) const {
    const auto last = static_cast<std::uint32_t>(expected_.frames.size()) - 1;
    for (const std::uint32_t f : {last, last / 2}) {
      const auto got = decode_frame(bytes, f);
      if (got) {
        ASSERT_EQ(*got, expected_.frames[f]) << "frame " << f;
      }
    }
  }
  // The CRCs match, so anything may be decoded; with hashes, only the hashed positions.
  void expect_an_end(StreamBytes bytes) const {
    repair_crcs(bytes);
    const auto start = std::chrono::steady_clock::now();
    (void)decode_until_error(bytes);
    (void)decode_until_error(bytes, small_options(false));
    (void)decode_frame(bytes, static_cast<std::uint32_t>(expected_.frames.size()) - 1);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    ASSERT_LT(taken.count(), 10.0);
  }

  StreamBytes stream_;
  Decoded expected_;
  std::set<std::size_t> slices_;  // offsets
};

// A GOF is complete, however, without the slices and the hash after it.
TEST_P(Robustness, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < stream_.size(); ++n) {
    if (slices_.contains(n)) continue;
    const StreamBytes prefix(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(n));
    SCOPED_TRACE(testing::Message() << n << " bytes");
    Decoded got;
    ASSERT_NO_FATAL_FAILURE(expect_error(prefix, got));
    // A stream that ends after the version is unsupported from version 1.2 on.
    if (n != kStreamHeaderBytes || stream_[9] < 2) {
      ASSERT_EQ(got.error->code, Errc::kTruncated) << got.error->rule;
    }
    ASSERT_NO_FATAL_FAILURE(expect_error_or_right_by_seeking(prefix));
  }
}

// A GOF is complete, however, before a slice or hash whose type has been changed.
TEST_P(Robustness, EveryFlippedBitIsNoticed) {
  for (std::size_t bit = 0; bit < 8 * stream_.size(); ++bit) {
    if (slices_.contains(bit / 8)) continue;
    StreamBytes damaged = stream_;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (128U >> (bit % 8)));
    SCOPED_TRACE(testing::Message() << "bit " << bit);
    Decoded got;
    ASSERT_NO_FATAL_FAILURE(expect_error(damaged, got));
    ASSERT_NO_FATAL_FAILURE(expect_error_or_right_by_seeking(damaged));
  }
}

TEST_P(Robustness, EveryFlippedBitUnderAFittingCrcEnds) {
  for (std::size_t bit = 0; bit < 8 * stream_.size(); ++bit) {
    StreamBytes damaged = stream_;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (128U >> (bit % 8)));
    SCOPED_TRACE(testing::Message() << "bit " << bit);
    ASSERT_NO_FATAL_FAILURE(expect_an_end(damaged));
  }
}

TEST_P(Robustness, RandomBytesUnderAFittingCrcEnd) {
  constexpr unsigned kSeeds = 3;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < stream_.size(); ++i) {
      StreamBytes damaged = stream_;
      damaged[i] = static_cast<std::uint8_t>(random());
      // Now and then a burst.
      for (std::size_t j = i + 1; j < damaged.size() && random() % 3 == 0; ++j) {
        damaged[j] = static_cast<std::uint8_t>(random());
      }
      SCOPED_TRACE(testing::Message() << "byte " << i << ", seed " << seed);
      ASSERT_NO_FATAL_FAILURE(expect_an_end(damaged));
    }
  }
}

TEST_P(Robustness, EveryShorterOrLongerPayloadFails) {
  for (const UnitPlace& unit : units_of(stream_)) {
    const std::span<const std::uint8_t> payload(stream_.data() + unit.payload(), unit.size);
    // Reading from front to back does not need the index.
    const bool must_fail = unit.type != UnitType::kGofIndex;
    for (std::size_t n = 0; n < unit.size; ++n) {
      const StreamBytes damaged = with_payload(stream_, unit, payload.first(n));
      SCOPED_TRACE(testing::Message() << "unit at " << unit.offset << ", payload " << n);
      ASSERT_NO_FATAL_FAILURE(expect_an_end(damaged));
      ASSERT_EQ(decode_until_error(damaged).error.has_value(), must_fail);
    }
    StreamBytes longer(payload.begin(), payload.end());
    longer.push_back(0);
    EXPECT_EQ(decode_until_error(with_payload(stream_, unit, longer)).error.has_value(),
              must_fail)
        << "unit at " << unit.offset;
  }
}

TEST_P(Robustness, UnitsLeftOutOrRepeatedEnd) {
  for (const UnitPlace& unit : units_of(stream_)) {
    const auto first = stream_.begin() + static_cast<std::ptrdiff_t>(unit.offset);
    const auto last = stream_.begin() + static_cast<std::ptrdiff_t>(unit.end());
    StreamBytes without = stream_;
    without.erase(without.begin() + (first - stream_.begin()),
                  without.begin() + (last - stream_.begin()));
    StreamBytes twice = stream_;
    twice.insert(twice.begin() + (last - stream_.begin()), first, last);
    SCOPED_TRACE(testing::Message() << "unit at " << unit.offset);
    ASSERT_NO_FATAL_FAILURE(expect_an_end(without));
    ASSERT_NO_FATAL_FAILURE(expect_an_end(twice));
    // A stream needs neither a vertex order nor ancillary units, and may repeat the latter;
    // a shared rig may replace one without slices.
    const bool ancillary = (stream_[unit.offset] & kAncillaryFlag) != 0;
    const bool optional = ancillary || unit.type == UnitType::kVertexOrder;
    EXPECT_TRUE(optional || decode_until_error(without).error);
    EXPECT_TRUE(ancillary || unit.type == UnitType::kRig || decode_until_error(twice).error);
  }
}

std::string damaged_stream_name(const testing::TestParamInfo<StreamBytes (*)()>& stream) {
  return std::array{"Rich", "Indexed", "Rigs"}.at(stream.index);
}
INSTANTIATE_TEST_SUITE_P(Streams, Robustness,
                         testing::Values(rich_stream, indexed_stream, indexed_rig_stream),
                         damaged_stream_name);

}  // namespace
}  // namespace rlpc
