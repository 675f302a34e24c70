// The memory that a decoder allocates stays below what it estimates (decoder/codec/parse/
// memory_estimate.h), which it compares with DecodeLimits::max_memory_bytes.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/codec/mesh/vertex_layers.h"
#include "common/testing/triangle_mesh.h"
#include "conformance/testing/count_memory.h"
#include "conformance/testing/small_animation.h"
#include "conformance/tools/make_worst_case.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

using worst_case::Kind;
using worst_case::Plan;
using worst_case::Size;

constexpr std::uint32_t kAround = worst_case::kAround;

StreamBytes worst_case_stream(const Plan& plan) {
  StreamBytes stream;
  worst_case::write_stream(plan, [&](const Bytes& bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
  });
  return stream;
}

struct Memory {
  std::uint64_t estimate = 0;
  std::uint64_t peak = 0;
};

// Decodes all frames under the limit of memory.estimate. Returns the error, and sets the peak
// of allocated memory.
std::optional<Error> decode_with_limit(const StreamBytes& stream, Memory& memory,
                                       std::uint32_t coarse_layers = SliceCut::kAll) {
  auto source = memory_source(StreamBytes(stream));
  DecoderOptions options;
  options.coarse_layers = coarse_layers;
  options.limits.max_memory_bytes = memory.estimate + source->memory_bytes();
  const std::size_t before = memory_count.now;
  memory_count.peak = before;
  const auto result = [&]() -> Result<bool> {
    auto decoder = Decoder::open(std::move(source), options);
    if (!decoder) return decoder.error();
    std::vector<std::int32_t> positions(3 * std::size_t{decoder->num_vertices()});
    Result<bool> more = true;
    while (more && *more) more = decoder->next_frame(positions);
    return more;
  }();
  memory.peak = memory_count.peak - before;
  return result ? std::nullopt : std::optional(result.error());
}

// Returns the least limit with which a stream is decoded: each error names the memory needed so
// far. Lower limits must hold too: no more is allocated, apart from the decoder itself.
Memory memory_for(const StreamBytes& stream, std::uint32_t coarse_layers = SliceCut::kAll) {
  constexpr std::uint64_t kDecoderBytes = 4096;
  Memory memory;
  for (;;) {
    const auto error = decode_with_limit(stream, memory, coarse_layers);
    EXPECT_LT(memory.peak, memory.estimate + kDecoderBytes);
    if (!error) return memory;
    EXPECT_EQ(error->code, Errc::kLimitExceeded) << error->rule << ' ' << error->element;
    EXPECT_GT(error->needed_bytes, memory.estimate);
    if (testing::Test::HasFailure()) return memory;
    memory.estimate = error->needed_bytes;
  }
}

void expect_within_estimate(const Plan& plan, double min_share = 0.0) {
  const Memory memory = memory_for(worst_case_stream(plan));
  // A limit that is far too high would refuse streams without need.
  EXPECT_GT(static_cast<double>(memory.peak), min_share * static_cast<double>(memory.estimate));
}

std::vector<Triangle> tube(std::uint32_t num_vertices) {
  return worst_case::make_mesh(num_vertices, 4 * num_vertices);
}

constexpr std::uint32_t kTubeVertices = 10 * kAround;

TEST(MemoryLimit, HoldsForClusters) {
  const std::uint32_t vertices = 3 * kAround;
  const Size many_factors{kTubeVertices, 4, 129, 1, 0};
  const Size many_frames{vertices, 512, 100, 1, 0};
  for (const Size& size : {many_factors, many_frames}) {
    SCOPED_TRACE(size.vertices);
    expect_within_estimate({1, Kind::kCluster, size, tube(size.vertices)}, 0.4);
  }
}

TEST(MemoryLimit, HoldsForSkinnedGofs) {
  const std::uint32_t vertices = 3 * kAround;
  const Size sizes[] = {{kTubeVertices, 1, 1, 200, 1},  // eight influences for each vertex
                        {vertices, 256, 1, 100, 1},     // tracks of bones
                        {vertices, 256, 100, 2, 20},    // tracks of trajectories
                        {kTubeVertices, 4, 65, 20, 20},
                        {kTubeVertices, 4, 129, 20, 20}};
  for (const Kind kind : {Kind::kSkinned, Kind::kSharedRig}) {
    for (const Size& size : sizes) {
      SCOPED_TRACE(size.frames + size.components);
      expect_within_estimate({1, kind, size, tube(size.vertices)}, 0.3);
    }
  }
}

TEST(MemoryLimit, HoldsForFrames) {
  const std::uint32_t vertices = 3 * kAround;
  const Size sizes[] = {{kTubeVertices, 2, 1, 0, 0, 0},  // filters
                        {kTubeVertices, 3, 8, 0, 0, 0},  // filters of many temporal layers
                        {vertices, 100, 1, 0, 0, 0},     // residuals
                        {vertices, 70, 2, 0, 0, 60}};    // frames that can be repeated
  for (const Size& size : sizes) {
    SCOPED_TRACE(size.frames + size.components);
    expect_within_estimate({1, Kind::kInter, size, tube(size.vertices)}, 0.3);
  }
}

constexpr Size kRigSize{3 * kAround, 1, 10, 50, 10};

// The limit also holds if each rig is used, and then replaced by another.
TEST(MemoryLimit, HoldsForSharedRigs) {
  for (const std::uint32_t num_rigs : {1U, 8U}) {
    SCOPED_TRACE(num_rigs);
    expect_within_estimate(
        {1, Kind::kSharedRig, kRigSize, tube(kRigSize.vertices), num_rigs, 2}, 0.3);
  }
}

// Replaced rigs and their reconstructions are not kept: one is in memory at a time.
TEST(MemoryLimit, ReplacedRigsTakeNone) {
  Plan plan{1, Kind::kSharedRig, {3 * kAround, 1, 64, 10, 2}, tube(3 * kAround), 8, 1};
  Memory once{1U << 30, 0};
  EXPECT_FALSE(decode_with_limit(worst_case_stream(plan), once));
  plan.num_rounds = 2;
  Memory twice{1U << 30, 0};
  EXPECT_FALSE(decode_with_limit(worst_case_stream(plan), twice));
  EXPECT_LT(twice.peak, once.peak * 9 / 8);
}

// Triangles without common edges in opposite directions, so that each is a component.
std::vector<Triangle> triangles_apart(std::uint32_t num_vertices, std::uint32_t count) {
  std::mt19937 random(1);
  const std::uint32_t third = num_vertices / 3;
  std::vector<Triangle> triangles(count);
  for (Triangle& t : triangles) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      t[k] = k * third + static_cast<std::uint32_t>(random() % third);
    }
  }
  return triangles;
}

// Tetrahedra without common edges: each edge belongs to exactly two triangles.
std::vector<Triangle> tetrahedra(std::uint32_t num_vertices, std::size_t count) {
  std::mt19937 random(1);
  std::vector<Triangle> triangles;
  std::vector<bool> taken(std::size_t{num_vertices} * num_vertices);
  while (triangles.size() < 4 * count) {
    std::array<std::uint32_t, 4> c{};
    for (std::uint32_t& v : c) v = static_cast<std::uint32_t>(random() % num_vertices);
    const auto edge = [&](std::size_t i, std::size_t j) {
      return taken[std::size_t{c[i]} * num_vertices + c[j]];
    };
    bool free = true;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) free = free && c[i] != c[j] && !edge(i, j);
    }
    if (!free) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) edge(i, j) = true;
    }
    for (const Triangle& t :
         {Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 1}, Triangle{1, 3, 2}}) {
      triangles.push_back({c[t[0]], c[t[1]], c[t[2]]});
    }
  }
  return triangles;
}

// Vertices that each have six triangles with six of the others, which have twelve.
std::vector<Triangle> wheels(std::uint32_t num_vertices) {
  std::mt19937 random(1);
  const std::uint32_t num_hubs = num_vertices / 2;
  std::vector<std::uint32_t> hubs;
  for (std::uint32_t i = 0; i < 6 * num_hubs; ++i) hubs.push_back(i % num_hubs);
  for (std::size_t i = 0; i < hubs.size(); ++i) {
    std::swap(hubs[i], hubs[i + random() % (hubs.size() - i)]);
  }
  std::vector<Triangle> triangles;
  for (std::uint32_t v = num_hubs; v < num_vertices; ++v) {
    const std::uint32_t* const around = &hubs[std::size_t{6} * (v - num_hubs)];
    for (std::uint32_t k = 0; k < 6; ++k) {
      triangles.push_back({v, around[k], around[(k + 1) % 6]});
    }
  }
  return triangles;
}

// Meshes with these numbers of vertices. In some, growing lists would have just doubled: the
// nodes of 11,000 triangles apart, the 6 * 1,366 edges of tetrahedra.
std::vector<TriangleMesh> meshes_of_any_kind() {
  const std::uint32_t few = 3 * kAround;
  return {{kTubeVertices, {}},
          {kTubeVertices, tube(kTubeVertices)},
          {kTubeVertices, triangles_apart(kTubeVertices, 2 * kTubeVertices)},
          {few, triangles_apart(few, 11000)},
          {few, tetrahedra(few, 1366)},
          {kTubeVertices, wheels(kTubeVertices)}};
}

TEST(MemoryLimit, HoldsForMeshesOfAnyKind) {
  for (const Kind kind : {Kind::kCluster, Kind::kSkinned, Kind::kSharedRig, Kind::kInter}) {
    SCOPED_TRACE(static_cast<int>(kind));
    for (const TriangleMesh& mesh : meshes_of_any_kind()) {
      expect_within_estimate({1, kind, {mesh.num_vertices, 1, 1, 1, 0}, mesh.triangles});
    }
  }
}

// A coarse mesh that is nearly the whole mesh takes the most.
TEST(MemoryLimit, HoldsForCoarseMeshes) {
  for (const Kind kind : {Kind::kCluster, Kind::kSharedRig}) {
    SCOPED_TRACE(static_cast<int>(kind));
    for (const TriangleMesh& mesh : meshes_of_any_kind()) {
      const Plan plan{1, kind, {mesh.num_vertices, 1, 1, 1, 0}, mesh.triangles};
      for (const std::uint32_t layers : {1U, kMaxLayers}) {
        memory_for(worst_case_stream(plan), layers);
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
