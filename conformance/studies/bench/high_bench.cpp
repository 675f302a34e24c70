#include "conformance/studies/bench/high_bench.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <tuple>

namespace rlpc::bench {
namespace {

constexpr std::uint32_t kAllFactors = 1024;

// Streams are encoded once for all benchmarks.
const Bytes& stream_of(const BenchAnimation& animation, double kg, std::uint32_t factors) {
  static std::map<std::tuple<std::string, double, std::uint32_t>, Bytes> streams;
  const auto [at, is_new] = streams.try_emplace({animation.name, kg, factors});
  if (is_new) {
    EncoderSettings settings;
    settings.profile = Profile::kHigh;
    settings.target = {Target::kKg, kg};
    settings.main.adaptive_factors = factors;
    settings.main.clusters = false;
    settings.threads = kMaxEncoderThreads;
    at->second = encode(animation, settings);
  }
  return at->second;
}

void bench_factors(benchmark::State& state, const Bytes& stream, std::uint32_t threads) {
  std::uint64_t vertex_frames = 0;
  for (auto _ : state) {
    vertex_frames = decode(stream, false, threads);
  }
  state.counters["vertex_frames/s"] = benchmark::Counter(
      static_cast<double>(vertex_frames), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bpvf"] =
      8.0 * static_cast<double>(stream.size()) / static_cast<double>(vertex_frames);
}

double milliseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

// Time that next_frame takes, after the first frame.
void bench_next_frame(benchmark::State& state, const Bytes& stream, std::uint32_t threads) {
  double longest = 0.0;
  for (auto _ : state) {
    Decoder decoder = open_decoder(stream, true, threads);
    std::vector<std::int32_t> positions(3 * std::size_t{decoder.header().num_vertices});
    for (bool first = true;; first = false) {
      const auto start = std::chrono::steady_clock::now();
      const auto more = decoder.next_frame(positions);
      const double time = milliseconds(std::chrono::steady_clock::now() - start);
      if (!more) stop("the encoded stream does not decode");
      if (!*more) break;
      if (!first) longest = std::max(longest, time);
    }
  }
  state.counters["longest_ms"] = longest;
}

// Time to seek to random frames and to decode the frame there.
void bench_seek(benchmark::State& state, const Bytes& stream) {
  Decoder decoder = open_decoder(stream, true, 1);
  std::vector<std::int32_t> positions(3 * std::size_t{decoder.header().num_vertices});
  std::mt19937 random(1);
  std::vector<double> times;
  for (auto _ : state) {
    const auto frame = static_cast<std::uint32_t>(random() % decoder.header().num_frames);
    const auto start = std::chrono::steady_clock::now();
    if (!decoder.seek(frame) || !decoder.next_frame(positions)) stop("seeking fails");
    times.push_back(milliseconds(std::chrono::steady_clock::now() - start));
  }
  const auto tenth = times.begin() + static_cast<std::ptrdiff_t>(times.size() * 9 / 10);
  std::nth_element(times.begin(), tenth, times.end());
  state.counters["percentile_90_ms"] = *tenth;
}

}  // namespace

void register_high(const BenchAnimation& animation) {
  const auto add = [&](const std::string& name, auto&& function) {
    return benchmark::RegisterBenchmark((name + "/" + animation.name).c_str(), function)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  for (const auto& [name, kg] : {std::pair{"0.1", 0.1}, {"0.3", 0.3}}) {
    const std::string target = std::string("/kg:") + name;
    for (const std::uint32_t factors : {0U, 16U, 32U, kAllFactors}) {
      const std::string some = factors == kAllFactors ? "all" : std::to_string(factors);
      for (const std::uint32_t threads : {1U, 2U}) {
        add("DecodeHigh" + target + "/factors:" + some + "/threads:" + std::to_string(threads),
            [=](benchmark::State& state) {
              bench_factors(state, stream_of(animation, kg, factors), threads);
            });
      }
    }
  }
  for (const std::uint32_t threads : {1U, 2U}) {
    add("NextFrame/kg:0.1/threads:" + std::to_string(threads), [=](benchmark::State& state) {
      bench_next_frame(state, stream_of(animation, 0.1, kAllFactors), threads);
    });
  }
  add("Seek/kg:0.1", [=](benchmark::State& state) {
    bench_seek(state, stream_of(animation, 0.1, kAllFactors));
  })->Iterations(200);
}

}  // namespace rlpc::bench
