// Decodes streams with three decoders at a time, each with three threads that prefetch: one
// forwards, one to random frames, one that announces random frames and caches GOFs. All must
// return the frames and the errors of a decoder with a single thread. The preset `tsan` runs it
// on all conformance streams; other presets only compare results.
//
//   threads_replay FILE...      exit code 1 where a decoder differs; deterministic requests

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "decoder/rlpc_decoder.h"

namespace {

using Bytes = rlpc::Vector<std::uint8_t>;
using Frame = std::vector<std::int32_t>;

constexpr std::uint32_t kThreads = 3;
constexpr int kRandomFrames = 40;
constexpr std::uint64_t kCachedBytes = 1 << 22;
// Memory limit: streams at the limits of a level declare more than a test can hold.
constexpr std::uint64_t kMaxMemoryBytes = 1ULL << 30;

struct Decoded {
  std::vector<Frame> frames;
  std::string error;  // empty: the stream is complete

  bool operator==(const Decoded&) const = default;
};

std::string text_of(const rlpc::Error& error) {
  return std::string(error.rule) + " " + error.element + " at bit " +
         std::to_string(error.bit_pos);
}

Bytes bytes_of(const char* path) {
  Bytes bytes;
  std::FILE* const file = std::fopen(path, "rb");
  if (file == nullptr) {
    std::perror(path);
    std::exit(1);
  }
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    bytes.push_back(static_cast<std::uint8_t>(c));
  }
  std::fclose(file);
  return bytes;
}

rlpc::DecoderOptions options_for(std::uint32_t threads, std::uint64_t cached_bytes) {
  rlpc::DecoderOptions options;
  options.threads = threads;
  options.max_cached_bytes = cached_bytes;
  options.limits.max_memory_bytes = kMaxMemoryBytes;
  return options;
}

Decoded decode(const Bytes& stream, std::uint32_t threads) {
  Decoded decoded;
  auto decoder =
      rlpc::Decoder::open(rlpc::memory_source(Bytes(stream)), options_for(threads, 0));
  if (!decoder) {
    decoded.error = text_of(decoder.error());
    return decoded;
  }
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    if (!more) decoded.error = text_of(more.error());
    if (!more || !*more) return decoded;
    decoded.frames.push_back(frame);
  }
}

// Returns the outcomes of requests for random frames below num_frames: the frame, or none for
// an error. seed: selects the requests. Announces other frames if GOFs are cached.
std::vector<std::optional<Frame>> random_frames(const Bytes& stream, std::size_t num_frames,
                                                std::uint32_t threads,
                                                std::uint64_t cached_bytes, unsigned seed) {
  std::vector<std::optional<Frame>> outcomes;
  auto decoder = rlpc::Decoder::open(rlpc::memory_source(Bytes(stream)),
                                     options_for(threads, cached_bytes));
  if (!decoder || num_frames == 0) return outcomes;
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  std::minstd_rand numbers(seed);
  for (int i = 0; i < kRandomFrames; ++i) {
    const auto wanted = static_cast<std::uint32_t>(numbers() % num_frames);
    const auto announced = static_cast<std::uint32_t>(numbers() % num_frames);
    if (cached_bytes > 0) static_cast<void>(decoder->prefetch(announced));
    const auto found = decoder->frame(wanted, frame);
    outcomes.push_back(found ? std::optional<Frame>(frame) : std::nullopt);
  }
  return outcomes;
}

// Returns whether outcomes equal those of a decoder with a single thread. Several threads
// decode announced frames earlier or later, and then fail where a stream lacks rigs: if any
// request of the single thread fails, only frames that both return are compared.
bool are_equal(const std::vector<std::optional<Frame>>& outcomes,
               const std::vector<std::optional<Frame>>& single) {
  const bool has_failed =
      std::any_of(single.begin(), single.end(), [](const auto& one) { return !one; });
  for (std::size_t i = 0; i < std::min(outcomes.size(), single.size()); ++i) {
    if (outcomes[i] && single[i] ? *outcomes[i] != *single[i] : !has_failed) return false;
  }
  return outcomes.size() == single.size();
}

// Returns the name of the first decoder that differs from `whole`; none if all agree.
std::optional<std::string> differing_decoder(const Bytes& stream, const Decoded& whole) {
  bool forwards = false;
  bool random = false;
  bool kept = false;
  std::thread first([&] { forwards = decode(stream, kThreads) == whole; });
  const std::size_t num_frames = whole.frames.size();
  const auto agree = [&](std::uint64_t cached_bytes, unsigned seed) {
    return are_equal(random_frames(stream, num_frames, kThreads, cached_bytes, seed),
                     random_frames(stream, num_frames, 1, cached_bytes, seed));
  };
  std::thread second([&] { random = agree(0, 1); });
  std::thread third([&] { kept = agree(kCachedBytes, 2); });
  first.join();
  second.join();
  third.join();
  if (!forwards) return "forwards";
  if (!random) return "to random frames";
  if (!kept) return "to random frames, with GOFs kept";
  return std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  int differing = 0;
  std::size_t frames = 0;
  for (int i = 1; i < argc; ++i) {
    const Bytes stream = bytes_of(argv[i]);
    const Decoded whole = decode(stream, 1);
    frames += whole.frames.size();
    if (const auto name = differing_decoder(stream, whole)) {
      std::printf("%s: decoding %s differs\n", argv[i], name->c_str());
      ++differing;
    }
  }
  std::printf("%d files, %zu frames, %d differ\n", argc - 1, frames, differing);
  return argc > 1 && frames > 0 && differing == 0 ? 0 : 1;
}
