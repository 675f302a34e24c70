#include "conformance/studies/bench/bench_animation.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <utility>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc::bench {

namespace {

const std::filesystem::path kSource = RLPC_SOURCE_DIR;

// Adds an animation if its files exist.
void add(std::vector<BenchAnimation>& to, const std::filesystem::path& folder,
         const char* name) {
  const std::filesystem::path stem = folder / name;
  const BenchAnimation a{name, stem.string() + ".obj", stem.string() + ".pc2"};
  if (std::filesystem::exists(a.mesh) && std::filesystem::exists(a.points)) to.push_back(a);
}

void add_bundled(std::vector<BenchAnimation>& to, const char* name) {
  add(to, kSource / "streams" / "inputs", name);
}

void add_handed_out(std::vector<BenchAnimation>& to, const char* name) {
  add(to, kSource.parent_path() / "shared" / "data" / "sequences", name);
}

}  // namespace

std::vector<BenchAnimation> animations() {
  std::vector<BenchAnimation> found;
  for (const char* name : {"elephant", "curtain", "robot_arm"}) add_bundled(found, name);
  for (const char* name : {"cow", "samba"}) add_handed_out(found, name);
  return found;
}

std::vector<BenchAnimation> latency_animations() {
  std::vector<BenchAnimation> found;
  add_bundled(found, "curtain");
  for (const char* name : {"cow", "samba", "knight"}) add_handed_out(found, name);
  return found;
}

void stop(const std::string& message) {
  std::fprintf(stderr, "rlpc_bench: %s\n", message.c_str());
  std::exit(1);
}

Bytes encode(const BenchAnimation& animation, const EncoderSettings& settings) {
  auto source = open_frame_source({animation.mesh, animation.points, {}});
  if (!source) stop(source.error().message);
  Bytes stream;
  const auto report = encode(**source, settings, [&](std::span<const std::uint8_t> bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    return true;
  });
  if (!report) stop(report.error().message);
  return stream;
}

Decoder open_decoder(const Bytes& stream, bool verify_hashes, std::uint32_t threads) {
  DecoderOptions options;
  options.verify_hashes = verify_hashes;
  options.threads = threads;
  auto decoder = Decoder::open(memory_source(stream), options);
  if (!decoder) stop("the encoded stream does not open");
  return std::move(*decoder);
}

std::uint64_t decode(const Bytes& stream, bool verify_hashes, std::uint32_t threads) {
  Decoder decoder = open_decoder(stream, verify_hashes, threads);
  std::vector<std::int32_t> positions(3 * std::size_t{decoder.header().num_vertices});
  for (;;) {
    const auto more = decoder.next_frame(positions);
    if (!more) stop("the encoded stream does not decode");
    if (!*more) break;
  }
  return std::uint64_t{decoder.header().num_vertices} * decoder.header().num_frames;
}

}  // namespace rlpc::bench
