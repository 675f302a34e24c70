// The time of each frame, played in several orders: counters p50_ms, p90_ms and largest_ms.
// Streams have GOFs of at most 64 frames, as a player that seeks would ask for.
#include "conformance/studies/bench/latency_bench.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <utility>

namespace rlpc::bench {
namespace {

constexpr std::uint32_t kGofFrames = 64;
constexpr std::uint64_t kCachedBytes = std::uint64_t{64} << 20;

using Order = std::vector<std::uint32_t> (*)(Decoder& decoder);

std::vector<std::uint32_t> forward(Decoder& decoder) {
  std::vector<std::uint32_t> frames(decoder.num_frames().value_or(0));
  for (std::uint32_t f = 0; f < frames.size(); ++f) frames[f] = f;
  return frames;
}

std::vector<std::uint32_t> backward(Decoder& decoder) {
  auto frames = forward(decoder);
  std::reverse(frames.begin(), frames.end());
  return frames;
}

std::vector<std::uint32_t> random(Decoder& decoder) {
  constexpr std::size_t kSeeks = 200;
  std::mt19937 generator(1);
  const std::uint32_t num_frames = decoder.num_frames().value_or(1);
  std::vector<std::uint32_t> frames(kSeeks);
  for (std::uint32_t& f : frames) f = static_cast<std::uint32_t>(generator() % num_frames);
  return frames;
}

// Alternates between the first GOF and the last, one frame further each time.
std::vector<std::uint32_t> alternating(Decoder& decoder) {
  const auto gofs = decoder.gofs();
  if (!gofs) stop("the encoded stream has no GOFs");
  const std::uint32_t count = std::min(gofs->front().num_frames, gofs->back().num_frames);
  std::vector<std::uint32_t> frames;
  for (std::uint32_t f = 0; f < count; ++f) {
    frames.push_back(gofs->front().first_frame + f);
    frames.push_back(gofs->back().first_frame + f);
  }
  return frames;
}

// Streams are encoded once for all orders.
const Bytes& stream_of(const BenchAnimation& animation, Profile profile) {
  static std::map<std::pair<std::string, Profile>, Bytes> all;
  const auto [at, is_new] = all.try_emplace({animation.name, profile});
  if (!is_new) return at->second;
  EncoderSettings settings;
  settings.profile = profile;
  settings.preset = Preset::kFast;
  settings.target = {Target::kKg, 0.1};
  settings.gof_frames = kGofFrames;
  if (profile == Profile::kHigh) settings.gof_kind = GofKind::kInter;
  at->second = encode(animation, settings);
  return at->second;
}

void measure(benchmark::State& state, const Bytes& stream, Order order, std::uint32_t threads,
             std::uint64_t cached_bytes) {
  DecoderOptions options;
  options.threads = threads;
  options.max_cached_bytes = cached_bytes;
  std::vector<double> ms;
  for (auto _ : state) {
    auto decoder = Decoder::open(memory_source(stream), options);
    if (!decoder) stop("the encoded stream does not open");
    std::vector<std::int32_t> positions(3 * std::size_t{decoder->num_vertices()});
    for (const std::uint32_t f : order(*decoder)) {
      const auto start = std::chrono::steady_clock::now();
      if (!decoder->frame(f, positions)) stop("the encoded stream does not decode");
      ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
    }
  }
  std::sort(ms.begin(), ms.end());
  double sum = 0;
  for (const double t : ms) sum += t;
  state.counters["mean_ms"] = sum / static_cast<double>(ms.size());
  state.counters["p50_ms"] = ms[ms.size() / 2];
  state.counters["p90_ms"] = ms[ms.size() * 9 / 10];
  state.counters["largest_ms"] = ms.back();
}

}  // namespace

void register_latency(const BenchAnimation& animation) {
  constexpr std::pair<const char*, Order> kOrders[] = {{"forward", forward},
                                                       {"backward", backward},
                                                       {"random", random},
                                                       {"alternating", alternating}};
  for (const auto& [profile, kind] :
       {std::pair{Profile::kMain, "main"}, std::pair{Profile::kHigh, "frames"}}) {
    for (const auto& [name, order] : kOrders) {
      for (const std::uint32_t threads : {1U, 2U}) {
        for (const std::uint64_t cached : {std::uint64_t{0}, kCachedBytes}) {
          const std::string what = std::string("Latency/") + kind + "/" + name +
                                   "/threads:" + std::to_string(threads) +
                                   "/cached_MiB:" + std::to_string(cached >> 20) + "/" +
                                   animation.name;
          const Profile of = profile;
          const Order in = order;
          benchmark::RegisterBenchmark(what.c_str(),
                                       [=](benchmark::State& state) {
                                         measure(state, stream_of(animation, of), in, threads,
                                                 cached);
                                       })
              ->Unit(benchmark::kMillisecond)
              ->UseRealTime()
              ->Iterations(1);
        }
      }
    }
  }
}

}  // namespace rlpc::bench
