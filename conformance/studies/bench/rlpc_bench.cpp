// Speed and peak memory of encoding and decoding, in vertex-frames per second on one thread;
// for the High profile also with two threads and fewer adaptive factors, and the time of single
// frames, in several orders.
//
// It also reports multiply-adds per second: for decoding, and for the sums of 8.5.3 with each
// loop that the machine can run, the plain loop first.
//
// Animations: the bundled ones and, if present next to the project, two from the literature.
// Peak memory is measured on the programs doing the same work.

#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/codec/kernels/component_sum.h"
#include "conformance/studies/bench/bench_animation.h"
#include "conformance/studies/bench/frame_bench.h"
#include "conformance/studies/bench/high_bench.h"
#include "conformance/studies/bench/latency_bench.h"
#include "decoder/rlpc_decoder.h"
#include "encoder/rlpc_encoder.h"

namespace {

using rlpc::bench::animations;
using rlpc::bench::BenchAnimation;
using rlpc::bench::Bytes;
using rlpc::bench::decode;
using rlpc::bench::encode;
using rlpc::bench::stop;

// Multiply-adds per vertex in the sums, over all frames of a stream of the Main profile.
class MultiplyAddCounter final : public rlpc::Trace {
 public:
  void begin(const char*, std::uint64_t) override {}
  void element(const char* name, std::int64_t value, std::uint64_t) override {
    if (std::string_view(name) == "num_gof_frames_minus1") gof_frames_ = value + 1;
    if (std::string_view(name) == "temporal_predictor") count_ += 3 * gof_frames_;
  }
  std::int64_t count() const { return count_; }

 private:
  std::int64_t gof_frames_ = 0;
  std::int64_t count_ = 0;
};

double multiply_adds(const Bytes& stream) {
  MultiplyAddCounter counter;
  rlpc::DecoderOptions options;
  options.trace = &counter;
  auto decoder = rlpc::Decoder::open(rlpc::memory_source(stream), options);
  if (!decoder || !decoder->parse_rest()) stop("the encoded stream does not parse");
  return static_cast<double>(counter.count()) * decoder->header().num_vertices;
}

// Runs the programs to measure their peak memory. A process is charged with the memory of the
// process that forked it, so a small process, forked before anything else, runs the programs
// on request.
class Launcher {
 public:
  Launcher() {
    std::array<int, 2> requests{};
    std::array<int, 2> answers{};
    if (pipe(requests.data()) != 0 || pipe(answers.data()) != 0) stop("no pipe");
    if (fork() == 0) {
      close(requests[1]);
      serve(requests[0], answers[1]);
    }
    close(requests[0]);
    requests_ = requests[1];
    answers_ = answers[0];
  }

  // Returns the peak memory of a shell command, in MB.
  double peak_megabytes(const std::string& command) const {
    const std::string line = std::string(RLPC_TOOL_DIR) + "/" + command;
    std::array<char, kMaxCommand> request{};
    if (line.size() >= request.size()) stop("command too long");
    line.copy(request.data(), line.size());
    long kilobytes = -1;
    if (write(requests_, request.data(), request.size()) != kMaxCommand ||
        read(answers_, &kilobytes, sizeof kilobytes) != sizeof kilobytes || kilobytes < 0) {
      stop("failed: " + line);
    }
    return static_cast<double>(kilobytes) / 1024.0;
  }

 private:
  static constexpr std::size_t kMaxCommand = 2048;  // a pipe accepts this much in one write

  [[noreturn]] static void serve(int requests, int answers) {
    std::array<char, kMaxCommand> request{};
    while (read(requests, request.data(), request.size()) == kMaxCommand) {
      const pid_t child = fork();
      if (child == 0) {
        const std::string line = "exec " + std::string(request.data());
        execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
        _exit(127);
      }
      int status = 0;
      rusage usage{};
      wait4(child, &status, 0, &usage);
      const long kilobytes = status == 0 ? usage.ru_maxrss : -1;
      if (write(answers, &kilobytes, sizeof kilobytes) != sizeof kilobytes) break;
    }
    _exit(0);
  }

  int requests_ = -1;
  int answers_ = -1;
};

const Launcher& launcher() {
  static const Launcher kLauncher;
  return kLauncher;
}

void add_counters(benchmark::State& state, std::uint64_t vertex_frames, std::size_t bytes,
                  const std::string& command) {
  state.counters["vertex_frames/s"] = benchmark::Counter(
      static_cast<double>(vertex_frames), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bpvf"] =
      8.0 * static_cast<double>(bytes) / static_cast<double>(vertex_frames);
  state.counters["peak_MB"] = launcher().peak_megabytes(command);
}

void bench_decode(benchmark::State& state, const BenchAnimation& animation, double kg,
                  bool hashes) {
  rlpc::EncoderSettings settings;
  settings.target = {rlpc::Target::kKg, kg};
  const Bytes stream = encode(animation, settings);
  std::uint64_t vertex_frames = 0;
  for (auto _ : state) vertex_frames = decode(stream, hashes, 1);
  state.counters["multiply_adds/s"] =
      benchmark::Counter(multiply_adds(stream), benchmark::Counter::kIsIterationInvariantRate);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("rlpc_bench_" + std::to_string(getpid()));
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(stream.data()),
             static_cast<std::streamsize>(stream.size()));
  add_counters(state, vertex_frames, stream.size(),
               "rlpcdec '" + file.string() + "' --verify -q");
  std::filesystem::remove(file);
}

// `options`: options of rlpcenc that are equivalent to `settings`.
void bench_encode(benchmark::State& state, const BenchAnimation& animation,
                  const rlpc::EncoderSettings& settings, const std::string& options) {
  Bytes stream;
  for (auto _ : state) stream = encode(animation, settings);
  add_counters(state, decode(stream, false, 1), stream.size(),
               "rlpcenc '" + animation.mesh + "' --points '" + animation.points +
                   "' -o /dev/null -q --threads 1 " + options);
}

// Sums of narrow or wide components, 16 frames of 4096 vertices at a time.
void bench_sums(benchmark::State& state, const rlpc::Kernels& loops, int temporal_bits) {
  constexpr std::size_t kVertices = 4096;
  constexpr std::size_t kRows = 48;
  constexpr std::size_t kComponents = 100;
  const auto spatial = std::make_shared<rlpc::SpatialFactors>(kVertices);
  for (std::size_t k = 0; k < kComponents; ++k) {
    spatial->add(std::vector<std::int32_t>(kVertices, -77), 8);
  }
  const std::vector<std::int32_t> values(kRows, (1 << (temporal_bits - 1)) - 1);
  const std::vector<rlpc::TemporalFactor> temporal(kComponents, {values, temporal_bits});
  const rlpc::ComponentSum factors(spatial, temporal, kRows, loops);
  std::vector<std::int64_t> sums(kRows * rlpc::kTileValues);
  for (auto _ : state) {
    for (std::size_t tile = 0; tile < kVertices / rlpc::kTileValues; ++tile) {
      factors.add_tile(tile, 0, kRows, sums);
      benchmark::DoNotOptimize(sums.data());
    }
  }
  state.counters["multiply_adds/s"] =
      benchmark::Counter(static_cast<double>(kVertices * kRows * kComponents),
                         benchmark::Counter::kIsIterationInvariantRate);
}

void register_sums() {
  for (std::size_t i = 0; i < rlpc::kernels().size(); ++i) {
    for (const int bits : {14, 18}) {
      const std::string name =
          "Sums/temporal_bits:" + std::to_string(bits) + "/loops:" + std::to_string(i);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& s) {
        bench_sums(s, rlpc::kernels()[i], bits);
      })->Unit(benchmark::kMillisecond);
    }
  }
}

void register_all(const BenchAnimation& a) {
  const auto add = [&](const std::string& what, auto&& function) {
    benchmark::RegisterBenchmark((what + "/" + a.name).c_str(), function)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  for (const double kg : {0.1, 0.3, 1.0}) {
    char what[32];
    std::snprintf(what, sizeof what, "Decode/kg:%.1f", kg);
    add(what, [=](benchmark::State& s) { bench_decode(s, a, kg, false); });
  }
  add("DecodeAndHash/kg:0.3", [=](benchmark::State& s) { bench_decode(s, a, 0.3, true); });
  rlpc::EncoderSettings given;
  given.profile = rlpc::Profile::kBaseline;
  given.target.kind = rlpc::Target::kNone;
  given.baseline.clusters = 24;
  given.components = 10;
  given.baseline.qu = given.baseline.qc = given.baseline.qdelta = 12;
  given.baseline.rdo = false;
  given.baseline.frame_mode = rlpc::FrameMode::kLcf;
  const std::string given_options =
      "--profile baseline --clusters 24 --components 10 --qu 12 --qc 12 --qdelta 12 --no-rdo "
      "--frame lcf";
  add("EncodeGiven/N:24/L:10",
      [=](benchmark::State& s) { bench_encode(s, a, given, given_options); });
  for (const auto& [name, preset] :
       {std::pair{"fast", rlpc::Preset::kFast}, {"medium", rlpc::Preset::kMedium}}) {
    for (const char* kg : {"0.1", "0.3", "1.0"}) {
      rlpc::EncoderSettings target;
      target.target = {rlpc::Target::kKg, std::atof(kg)};
      target.preset = preset;
      const std::string options = std::string("--kg ") + kg + " --preset " + name;
      add(std::string("EncodeTarget/kg:") + kg + "/" + name,
          [=](benchmark::State& s) { bench_encode(s, a, target, options); });
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  launcher();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 64;
  register_sums();
  for (const BenchAnimation& animation : animations()) {
    register_all(animation);
    rlpc::bench::register_high(animation);
    rlpc::bench::register_frames(animation);
  }
  for (const BenchAnimation& animation : rlpc::bench::latency_animations()) {
    rlpc::bench::register_latency(animation);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
