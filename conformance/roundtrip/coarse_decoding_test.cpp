// Decoding of coarse meshes (8.9.8): frames are those of the whole mesh at the vertices that
// stay, whether or not slices were dropped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/coarse_mesh.h"
#include "conformance/testing/cut_streams.h"
#include "conformance/testing/small_animation.h"
#include "conformance/testing/stream_summary.h"

namespace rlpc {
namespace {

struct Coarse {
  std::uint32_t num_layers = 0;
  std::vector<std::uint32_t> vertices;
  std::vector<Triangle> triangles;
  std::vector<Frame> frames;
  bool was_cut = false;
  std::uint32_t compared = 0;
  std::vector<bool> is_read;  // for each byte of the stream

  auto num_read() const { return std::count(is_read.begin(), is_read.end(), true); }
};

// Notes which bytes are read.
class NotingSource final : public ByteSource {
 public:
  NotingSource(const StreamBytes& stream, std::vector<bool>& is_read)
      : stream_(stream), is_read_(is_read) {
    is_read_.resize(stream.size());
  }
  std::uint64_t size() const override { return stream_.size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > size() || out.size() > size() - offset) return false;
    const auto first = static_cast<std::ptrdiff_t>(offset);
    std::fill_n(is_read_.begin() + first, out.size(), true);
    std::copy_n(stream_.begin() + first, out.size(), out.begin());
    return true;
  }

 private:
  const StreamBytes& stream_;
  std::vector<bool>& is_read_;
};

Coarse decode_coarse(const StreamBytes& stream, const DecoderOptions& options) {
  Coarse coarse;
  auto decoder = Decoder::open(std::make_unique<NotingSource>(stream, coarse.is_read), options);
  EXPECT_TRUE(decoder);
  if (!decoder) return coarse;
  coarse.num_layers = decoder->num_layers();
  const auto vertices = decoder->coarse_vertices();
  coarse.vertices.assign(vertices.begin(), vertices.end());
  const auto triangles = decoder->triangles();
  coarse.triangles.assign(triangles.begin(), triangles.end());
  EXPECT_EQ(coarse.vertices.size(), decoder->num_vertices());
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    EXPECT_TRUE(more) << (more ? "" : more.error().rule);
    if (!more || !*more) break;
    coarse.frames.push_back(frame);
    coarse.compared += decoder->compared_frames();
  }
  coarse.was_cut = decoder->was_cut();
  return coarse;
}

DecoderOptions coarse_options(std::uint32_t layers, const SliceCut& cut = {}) {
  DecoderOptions options;
  options.coarse_layers = layers;
  options.cut = cut;
  return options;
}

std::vector<Frame> picked(const std::vector<Frame>& frames,
                          const std::vector<std::uint32_t>& vertices) {
  std::vector<Frame> result;
  for (const Frame& frame : frames) {
    result.emplace_back();
    for (const std::uint32_t v : vertices) {
      const auto first = frame.begin() + 3 * std::ptrdiff_t{v};
      result.back().insert(result.back().end(), first, first + 3);
    }
  }
  return result;
}

// Returns the coarse mesh in output order, its vertices as output indices.
CoarseMesh expected_mesh(const StreamBytes& stream, std::uint32_t layers) {
  StreamReader reader(memory_source(stream), {});
  EXPECT_TRUE(reader.open());
  const std::uint32_t n = reader.header().num_vertices;
  std::vector<std::uint32_t> order(reader.vertex_order().begin(), reader.vertex_order().end());
  if (order.empty()) {
    order.resize(n);
    std::iota(order.begin(), order.end(), 0U);
  }
  std::vector<std::uint32_t> decoded(n);
  for (std::uint32_t v = 0; v < n; ++v) decoded[order[v]] = v;
  std::vector<Triangle> triangles(reader.triangles().begin(), reader.triangles().end());
  for (Triangle& t : triangles) t = {decoded[t[0]], decoded[t[1]], decoded[t[2]]};
  CoarseMesh mesh = CoarseMeshes(n, triangles).mesh(layers, order);
  for (std::uint32_t& v : mesh.vertices) v = order[v];
  return mesh;
}

// Whether a GOF or shared rig has slices that a coarse mesh does not need.
bool drops_slices(const StreamBytes& stream, std::uint32_t layers) {
  const StreamSummary summary = summary_of(stream);
  const auto drops = [&](const SlicedSummary& of) {
    return std::any_of(of.slices.begin(), of.slices.end(), [&](const SliceEntry& slice) {
      const auto first = of.layer_group_size.begin();
      return std::accumulate(first, first + slice.layer_group_idx, 0U) >= layers;
    });
  };
  return std::any_of(summary.gofs.begin(), summary.gofs.end(), drops) ||
         std::any_of(summary.rigs.begin(), summary.rigs.end(),
                     [&](const auto& rig) { return drops(*rig); });
}

// Returns the number of coarse meshes for which slices were dropped.
std::uint32_t check(const StreamBytes& stream, const SliceCut& cut = {}) {
  DecoderOptions whole_options;
  whole_options.cut = cut;
  const std::vector<Frame> whole = decode_all(stream, whole_options);
  std::uint32_t num_cut = 0;
  std::uint32_t num_layers = 1;
  for (std::uint32_t layers = 1; layers <= num_layers + 1; ++layers) {
    SCOPED_TRACE(layers);
    const Coarse coarse = decode_coarse(stream, coarse_options(layers, cut));
    num_layers = coarse.num_layers;
    EXPECT_GT(num_layers, 1U);
    const CoarseMesh mesh = expected_mesh(stream, layers);
    EXPECT_EQ(coarse.vertices, mesh.vertices);
    EXPECT_TRUE(std::is_sorted(mesh.vertices.begin(), mesh.vertices.end()));
    EXPECT_EQ(coarse.triangles, mesh.triangles);
    EXPECT_EQ(coarse.frames, picked(whole, mesh.vertices));
    EXPECT_FALSE(coarse.frames.empty());
    DecoderOptions threaded = coarse_options(layers, cut);
    threaded.threads = 3;
    EXPECT_EQ(decode_coarse(stream, threaded).frames, coarse.frames);
    DecoderOptions sparse = coarse_options(layers, cut);
    sparse.read_dropped_slices = false;
    const Coarse without = decode_coarse(stream, sparse);
    EXPECT_EQ(without.frames, coarse.frames);
    EXPECT_EQ(without.was_cut, coarse.was_cut);
    if (cut.cuts()) continue;
    EXPECT_EQ(without.num_read() < coarse.num_read(), coarse.was_cut);
    EXPECT_EQ(coarse.was_cut, drops_slices(stream, layers));
    EXPECT_EQ(coarse.compared == coarse.frames.size(), !coarse.was_cut);
    if (coarse.was_cut) ++num_cut;
  }
  return num_cut;
}

StreamBytes stream_with_layers(Profile profile, std::uint32_t gof_frames,
                               std::uint32_t layer_groups) {
  MemoryFrames source = bending_tube(16, 20);
  EncoderSettings settings;
  settings.profile = profile;
  settings.preset = Preset::kFast;
  settings.target = {Target::kKg, 0.3};
  settings.gof_frames = gof_frames;
  settings.keep_order = profile != Profile::kMain;
  settings.hash_mode = HashMode::kFrame;
  settings.main.layer_groups = layer_groups;
  return encode_to_memory(source, settings);
}

TEST(CoarseDecoding, NeedsOnlyTheLayerGroupsOfItsLayers) {
  EXPECT_EQ(check(sliced_stream()), 1U) << "its second layer group begins with layer 1";
  EXPECT_EQ(check(ordered_stream()), 1U);
  EXPECT_EQ(check(mixed_stream()), 1U);
  EXPECT_GT(check(stream_with_layers(Profile::kMain, 20, 4)), 2U);
}

TEST(CoarseDecoding, WorksWithSharedRigsAndRestOrder) {
  const StreamBytes stream = stream_with_layers(Profile::kHigh, 5, 4);
  EXPECT_FALSE(summary_of(stream).rigs.empty());
  EXPECT_GT(check(stream), 2U);
}

TEST(CoarseDecoding, WorksWhereNothingCanBeDropped) {
  EXPECT_EQ(check(stream_with_layers(Profile::kBaseline, 7, 0)), 0U);
  EXPECT_EQ(check(rich_stream()), 0U);
  EXPECT_EQ(check(stream_with_layers(Profile::kMain, 20, 1)), 0U);
}

TEST(CoarseDecoding, CombinesWithCuts) {
  check(sliced_stream(), {1, SliceCut::kAll});
  check(sliced_stream(), {SliceCut::kAll, 1});
  const StreamBytes stream = stream_with_layers(Profile::kHigh, 5, 4);
  for (const std::uint32_t layers : {1U, 3U}) check(stream, {2, layers});
}

TEST(CoarseDecoding, SeeksAsTheWholeMeshDoes) {
  const StreamBytes stream = stream_with_layers(Profile::kHigh, 5, 4);
  const Coarse all = decode_coarse(stream, coarse_options(2));
  auto decoder = Decoder::open(memory_source(stream), coarse_options(2));
  ASSERT_TRUE(decoder);
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  for (const std::uint32_t f : {13U, 4U, 19U, 0U}) {
    ASSERT_TRUE(decoder->seek(f));
    ASSERT_TRUE(decoder->next_frame(frame));
    EXPECT_EQ(frame, all.frames[f]);
  }
}

TEST(CoarseDecoding, TheWholeMeshSaysHowManyLayersItHas) {
  for (const Profile profile : {Profile::kBaseline, Profile::kMain}) {
    const StreamBytes stream = stream_with_layers(profile, 20, 0);
    const auto decoder = Decoder::open(memory_source(stream));
    ASSERT_TRUE(decoder);
    const Coarse coarse = decode_coarse(stream, coarse_options(1));
    EXPECT_EQ(decoder->num_layers(), profile == Profile::kMain ? coarse.num_layers : 0);
    EXPECT_EQ(decoder->num_vertices(), decoder->header().num_vertices);
    EXPECT_LT(coarse.vertices.size(), decoder->num_vertices());
    EXPECT_TRUE(decoder->coarse_vertices().empty());
  }
}

// Damage in a slice that is not needed is found by its CRC alone, as in one that a cut drops.
TEST(CoarseDecoding, SlicesThatAreNotNeededAreNotParsed) {
  StreamBytes stream = sliced_stream();
  const auto units = units_of(stream);
  const auto slice = std::find_if(units.rbegin(), units.rend(), [&](const UnitPlace& unit) {
    // component_group_idx and layer_group_idx as ue(v): 0, then 1
    return unit.type == UnitType::kSlice && stream[unit.payload()] >> 4 == 0b1010;
  });
  ASSERT_NE(slice, units.rend());
  for (std::size_t at = slice->payload() + 1; at < slice->crc(); ++at) stream[at] = 0xFF;
  repair_crcs(stream);
  auto decoder = Decoder::open(memory_source(stream));
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  EXPECT_FALSE(decoder->next_frame(frame));
  EXPECT_EQ(decode_coarse(stream, coarse_options(1)).frames,
            decode_coarse(sliced_stream(), coarse_options(1)).frames);
}

}  // namespace
}  // namespace rlpc
