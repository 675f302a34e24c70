#include "conformance/studies/bench/frame_bench.h"

#include <benchmark/benchmark.h>

#include <map>
#include <span>
#include <utility>

#include "encoder/frame_encoder.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc::bench {
namespace {

struct Frames {
  FrameFormat format;
  std::vector<std::vector<float>> xyz;

  std::uint64_t vertex_frames() const {
    return std::uint64_t{format.num_vertices} * xyz.size();
  }
};

// Frames are read once for all benchmarks.
const Frames& frames_of(const BenchAnimation& animation) {
  static std::map<std::string, Frames> all;
  const auto [at, is_new] = all.try_emplace(animation.name);
  Frames& frames = at->second;
  if (!is_new) return frames;
  auto source = open_frame_source({animation.mesh, animation.points, {}});
  if (!source) stop(source.error().message);
  FrameSource& from = **source;
  FrameFormat& format = frames.format;
  format.num_vertices = from.num_vertices();
  format.num_frames = from.num_frames();
  format.frame_rate = from.frame_rate();
  format.triangles.assign(from.triangles().begin(), from.triangles().end());
  for (std::uint32_t f = 0; f < from.num_frames(); ++f) {
    auto& xyz = frames.xyz.emplace_back(3 * std::size_t{format.num_vertices});
    if (const auto error = from.read_frame(f, xyz)) stop(error->message);
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      float& low = format.box_min[i % 3];
      float& high = format.box_max[i % 3];
      low = f == 0 && i < 3 ? xyz[i] : std::min(low, xyz[i]);
      high = f == 0 && i < 3 ? xyz[i] : std::max(high, xyz[i]);
    }
  }
  return frames;
}

EncoderSettings settings_of(InterWeights weights, std::uint32_t threads) {
  EncoderSettings settings;
  settings.profile = Profile::kHigh;
  settings.low_delay = true;
  settings.target = {Target::kKg, 0.1};
  settings.inter.weights = weights;
  settings.gof_frames = EncoderSettings::kWholeSequence;
  settings.threads = threads;
  return settings;
}

Bytes encode_frames(const Frames& frames, const EncoderSettings& settings) {
  Bytes stream;
  auto encoder =
      FrameEncoder::create(frames.format, settings, [&](std::span<const std::uint8_t> bytes) {
        stream.insert(stream.end(), bytes.begin(), bytes.end());
        return true;
      });
  if (!encoder) stop(encoder.error().message);
  for (const auto& xyz : frames.xyz) {
    if (const auto error = encoder->add_frame(xyz)) stop(error->message);
  }
  if (const auto report = encoder->finish(); !report) stop(report.error().message);
  return stream;
}

void add_counters(benchmark::State& state, const Frames& frames, std::size_t bytes) {
  const auto vertex_frames = static_cast<double>(frames.vertex_frames());
  state.counters["vertex_frames/s"] =
      benchmark::Counter(vertex_frames, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bpvf"] = 8.0 * static_cast<double>(bytes) / vertex_frames;
}

}  // namespace

void register_frames(const BenchAnimation& animation) {
  const auto add = [&](const std::string& name, auto&& function) {
    benchmark::RegisterBenchmark((name + "/" + animation.name).c_str(), function)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  for (const auto& [name, weights] :
       {std::pair{"learned", InterWeights::kLearned}, {"geometry", InterWeights::kGeometry}}) {
    for (const std::uint32_t threads : {1U, 2U}) {
      const std::string what =
          std::string("/weights:") + name + "/threads:" + std::to_string(threads);
      add("EncodeLowDelay" + what, [=](benchmark::State& state) {
        const Frames& frames = frames_of(animation);
        std::size_t bytes = 0;
        for (auto _ : state)
          bytes = encode_frames(frames, settings_of(weights, threads)).size();
        add_counters(state, frames, bytes);
      });
      add("DecodeLowDelay" + what, [=](benchmark::State& state) {
        const Frames& frames = frames_of(animation);
        const Bytes stream = encode_frames(frames, settings_of(weights, 1));
        for (auto _ : state) decode(stream, false, threads);
        add_counters(state, frames, stream.size());
      });
    }
  }
}

}  // namespace rlpc::bench
