// Tests that the libraries need no more stack than their headers say.
#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "conformance/testing/waving_strip.h"
#include "decoder/c_api/rlpc_attributes.h"
#include "decoder/c_api/rlpc_c_decoder.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RLPC_LARGER_FRAMES 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer)
#define RLPC_LARGER_FRAMES 1
#endif
#endif

namespace rlpc {
namespace {

constexpr std::size_t kDecoderStack = std::size_t{64} << 10;
constexpr std::size_t kEncoderStack = std::size_t{256} << 10;

void* call(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

// Returns the bytes of stack that a thread uses for some work, with what the system takes.
std::size_t stack_of(const std::function<void()>& work) {
  constexpr std::size_t kSize = std::size_t{4} << 20;
  constexpr unsigned char kUnused = 0xA5;
  auto* const stack = static_cast<unsigned char*>(std::aligned_alloc(4096, kSize));
  std::fill_n(stack, kSize, kUnused);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstack(&attributes, stack, kSize);
  pthread_t thread{};
  auto* const argument = const_cast<std::function<void()>*>(&work);
  EXPECT_EQ(pthread_create(&thread, &attributes, call, argument), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  const auto* const first =
      std::find_if(stack, stack + kSize, [](unsigned char c) { return c != kUnused; });
  const auto used = static_cast<std::size_t>(stack + kSize - first);
  std::free(stack);
  return used;
}

void expect_within(std::size_t used, std::size_t max, const std::string& what) {
#ifdef RLPC_LARGER_FRAMES
  EXPECT_GT(used, 0U) << what << max;
#else
  EXPECT_LE(used, max) << what;
#endif
}

// Decodes all data of a stream.
void decode(const std::string& path, std::uint32_t threads) {
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.threads = threads;
  rlpc_decoder* decoder = nullptr;
  if (rlpc_decoder_open_file(path.c_str(), &options, &decoder) == RLPC_OK) {
    rlpc_stream_info info;
    rlpc_decoder_info(decoder, &info, sizeof info);
    std::vector<float> xyz(3 * std::size_t{info.num_vertices});
    rlpc_frame_output output;
    rlpc_frame_output_init(&output, sizeof output);
    output.positions = {xyz.data(), sizeof(float) * xyz.size(), 0, RLPC_FORMAT_FLOAT};
    std::uint32_t num_sets = 0;
    rlpc_decoder_attributes(decoder, &num_sets);
    std::uint32_t num_drawn = 0;
    rlpc_decoder_split(decoder, &num_drawn);
    const void* bytes = nullptr;
    std::size_t num_bytes = 0;
    rlpc_decoder_asset(decoder, &bytes, &num_bytes);
    while (rlpc_decoder_next(decoder, &output) == RLPC_OK) {
    }
    rlpc_decoder_frame(decoder, 0, &output);
  }
  rlpc_decoder_close(decoder);
}

TEST(SmallStack, SufficesForTheDecoder) {
  std::size_t num_streams = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(RLPC_SOURCE_DIR "/streams")) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".rlpc" || path.find("/v1.") == path.npos) continue;
    for (const std::uint32_t threads : {1U, 3U}) {
      expect_within(stack_of([&] { decode(path, threads); }), kDecoderStack, path);
    }
    ++num_streams;
  }
  EXPECT_GT(num_streams, 500U);
}

TEST(SmallStack, SufficesForTheEncoder) {
  const WavingStrip strip(300, 24);
  std::vector<std::uint8_t> stream;
  stream.reserve(1 << 20);
  for (const std::uint32_t profile : {0U, 1U, 2U}) {
    for (const std::uint32_t preset : {RLPC_PRESET_FAST, RLPC_PRESET_SLOW}) {
      for (const double kg : {0.0, 0.5}) {
        rlpc_encode_options options;
        rlpc_encode_options_init(&options, sizeof options);
        options.profile = profile;
        options.preset = preset;
        options.target = kg > 0 ? RLPC_TARGET_KG : RLPC_TARGET_MAX_ERROR;
        options.target_value = kg > 0 ? kg : 1e-4;
        stream.clear();
        const std::size_t used = stack_of([&] {
          rlpc_encoder* encoder = nullptr;
          EXPECT_EQ(strip.create(options, stream, &encoder), RLPC_OK);
          EXPECT_EQ(strip.add_all(encoder), RLPC_OK) << rlpc_encoder_error_text(encoder);
          rlpc_encoder_close(encoder);
        });
        expect_within(used, kEncoderStack,
                      "profile " + std::to_string(profile) + ", preset " +
                          std::to_string(preset) + ", kg " + std::to_string(kg));
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
