// librlpc when memory runs out: each call of `new` fails in turn, alone or with all later ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "conformance/testing/count_memory.h"
#include "conformance/testing/waving_strip.h"
#include "decoder/c_api/rlpc_c_decoder.h"

namespace {

using rlpc::memory_count;

constexpr std::uint32_t kVertices = 24;
constexpr std::uint32_t kGofFrames = 6;
constexpr std::uint32_t kFrames = 3 * kGofFrames;

struct Case {
  rlpc_profile profile;
  rlpc_preset preset;
  bool once;  // only one call fails
  std::uint32_t threads;
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  return std::string(c.profile == RLPC_PROFILE_MAIN ? "Main" : "Baseline") +
         (c.preset == RLPC_PRESET_FAST ? "Fast" : "Medium") + (c.once ? "Once" : "ForGood") +
         std::to_string(c.threads) + "Threads";
}

class FailedAllocation : public testing::TestWithParam<Case> {
 protected:
  FailedAllocation() : strip_(kVertices, kFrames) {
    rlpc_encode_options_init(&options_, sizeof options_);
    options_.profile = GetParam().profile;
    options_.preset = GetParam().preset;
    options_.target_value = 2.0;
    options_.gof_frames = kGofFrames;
    options_.keep_order = 1;
    options_.hash_mode = RLPC_HASH_MODE_FRAME;
    options_.threads = GetParam().threads;
    options_.metadata = "{\"title\":\"strip\"}";
    stream_.reserve(1 << 16);
  }

  rlpc_status encode() {
    stream_.clear();
    rlpc_encoder* encoder = nullptr;
    rlpc_status status = strip_.create(options_, stream_, &encoder);
    if (status == RLPC_OK) status = strip_.add_all(encoder);
    if (status != RLPC_OK && encoder != nullptr) {
      EXPECT_STREQ(rlpc_encoder_error_text(encoder), "out of memory");
      EXPECT_EQ(strip_.add_all(encoder), RLPC_OUT_OF_MEMORY);
      EXPECT_EQ(rlpc_encoder_finish(encoder, nullptr, 0), RLPC_OUT_OF_MEMORY);
    }
    rlpc_encoder_close(encoder);
    return status;
  }

  // Decodes all frames, and the first once more.
  rlpc_status decode(const rlpc_decode_options& options, std::vector<std::int32_t>& positions) {
    rlpc_decoder* decoder = nullptr;
    rlpc_status status =
        rlpc_decoder_open_memory(stream_.data(), stream_.size(), &options, &decoder);
    const std::size_t size = strip_.num_values();
    std::int32_t* place = positions.data();
    while (status == RLPC_OK && place < positions.data() + positions.size() - size) {
      status = rlpc_decoder_next_positions(decoder, place, size);
      place += size;
    }
    if (status == RLPC_OK) status = rlpc_decoder_seek(decoder, 0);
    if (status == RLPC_OK) status = rlpc_decoder_next_positions(decoder, place, size);
    if (status != RLPC_OK && decoder != nullptr) {
      EXPECT_STREQ(rlpc_decoder_error_text(decoder), "out of memory");
      EXPECT_EQ(rlpc_decoder_seek(decoder, 0), RLPC_OUT_OF_MEMORY);
    }
    rlpc_decoder_close(decoder);
    return status;
  }

  // Fails each call up to `all`, then samples of later calls, until there are no more. All
  // memory must be freed. A failure need not be an error: std::stable_sort and the start of
  // another thread work without their memory.
  template <class Run>
  void fail_calls(std::size_t all, const Run& run) {
    memory_count.fails_once = GetParam().once;
    std::size_t ended = 0;
    for (std::size_t calls = 0;; calls += calls < all ? 1 : 1 + calls / 40) {
      const std::size_t before = memory_count.now;
      memory_count.failures = 0;
      memory_count.calls_left = calls;
      const rlpc_status status = run();
      memory_count.calls_left = std::numeric_limits<std::size_t>::max();
      ASSERT_EQ(memory_count.now, before) << "after " << calls << " calls";
      if (status == RLPC_OK) {
        ASSERT_NO_FATAL_FAILURE(expect_result());
      } else {
        ASSERT_EQ(status, RLPC_OUT_OF_MEMORY) << "after " << calls << " calls";
        ++ended;
      }
      if (memory_count.failures > 0) continue;
      EXPECT_EQ(status, RLPC_OK);
      break;
    }
    EXPECT_GT(ended, 50U);
  }

  virtual void expect_result() = 0;

  const rlpc::WavingStrip strip_;
  rlpc_encode_options options_{};
  std::vector<std::uint8_t> stream_;
};

class EncoderWithoutMemory : public FailedAllocation {
 protected:
  void expect_result() override { ASSERT_EQ(stream_, expected_); }
  std::vector<std::uint8_t> expected_;
};

TEST_P(EncoderWithoutMemory, EndsAndFreesAllMemory) {
  ASSERT_EQ(encode(), RLPC_OK);
  expected_ = stream_;
  fail_calls(300, [this] { return encode(); });
}

class DecoderWithoutMemory : public FailedAllocation {
 protected:
  void expect_result() override { ASSERT_EQ(positions_, expected_); }
  std::vector<std::int32_t> positions_;
  std::vector<std::int32_t> expected_;
};

TEST_P(DecoderWithoutMemory, EndsAndFreesAllMemory) {
  ASSERT_EQ(encode(), RLPC_OK);
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.threads = GetParam().threads;
  positions_.resize((kFrames + 1) * strip_.num_values());
  ASSERT_EQ(decode(options, positions_), RLPC_OK);
  expected_ = positions_;
  fail_calls(2000, [&] {
    std::fill(positions_.begin(), positions_.end(), 0);
    return decode(options, positions_);
  });
}

INSTANTIATE_TEST_SUITE_P(
    Library, EncoderWithoutMemory,
    testing::Values(Case{RLPC_PROFILE_BASELINE, RLPC_PRESET_FAST, false, 1},
                    Case{RLPC_PROFILE_BASELINE, RLPC_PRESET_MEDIUM, true, 1},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_MEDIUM, false, 1},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_MEDIUM, false, 2},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_FAST, true, 1},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_FAST, true, 2}),
    name_of);
INSTANTIATE_TEST_SUITE_P(
    Library, DecoderWithoutMemory,
    testing::Values(Case{RLPC_PROFILE_BASELINE, RLPC_PRESET_FAST, false, 1},
                    Case{RLPC_PROFILE_BASELINE, RLPC_PRESET_FAST, true, 1},
                    Case{RLPC_PROFILE_BASELINE, RLPC_PRESET_FAST, false, 2},
                    Case{RLPC_PROFILE_BASELINE, RLPC_PRESET_FAST, true, 2},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_FAST, false, 1},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_FAST, true, 1},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_FAST, false, 2},
                    Case{RLPC_PROFILE_MAIN, RLPC_PRESET_FAST, true, 2}),
    name_of);

}  // namespace
