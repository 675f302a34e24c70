// Tests inter GOFs (6.14, 8.19): writer against parser, the encoder against the reconstruction
// of the decoder, and frames in any order and on any number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "common/parallel/for_each.h"
#include "common/testing/random_inter_gof.h"
#include "common/testing/tube.h"
#include "conformance/testing/ample_memory.h"
#include "decoder/codec/kinds/inter/ordered_recon.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "encoder/codec/kinds/inter/closed_loop.h"
#include "encoder/codec/write/write_inter_gof.h"

namespace rlpc {
namespace {

class InterGofs : public testing::Test {
 protected:
  static constexpr std::uint32_t kFrames = 7;

  // A tube, with some vertices that have no triangle.
  InterGofs() { use_tube(14, 9); }

  void use_tube(std::uint32_t rings, std::uint32_t sides) {
    header_.profile_idc = kProfileHigh;
    header_.num_vertices = rings * sides + 2;
    header_.num_frames = kFrames;
    header_.position_bits = 16;
    const auto triangles = tube_triangles(rings, sides);
    header_.num_triangles = static_cast<std::uint32_t>(triangles.size());
    topology_ = make_topology(header_.num_vertices, triangles);
    meshes_.emplace(topology_, triangles);
  }
  const OrderedMesh& mesh() const { return (*meshes_)[Prediction::kLayers]; }

  Result<InterGof> parsed(const InterGofPayloads& payloads, const SliceCut& cut = {}) {
    InterGofParser parser(header_, mesh(), {kAmpleMemory, 0}, cut);
    BitReader r(payloads.first);
    const GofHeader gof_header = parse_gof_header(r, header_, 0);
    if (r.error()) return *r.error();
    if (const auto ok = parser.gof(r, gof_header); !ok) return ok.error();
    for (const auto& payload : payloads.frames) {
      BitReader bits(payload);
      if (const auto ok = parser.frame(bits, 0); !ok) return ok.error();
    }
    return parser.finish();
  }

  // Returns all frames, one after the other.
  std::vector<std::int32_t> decoded(const InterGof& gof, std::uint32_t threads = 1) {
    const Threads use(threads);
    const OrderedRecon recon(mesh(), gof, header_.position_bits);
    std::vector<std::int32_t> positions(kFrames * frame_size());
    recon.frames(0, kFrames, positions);
    return positions;
  }
  std::size_t frame_size() const { return 3 * std::size_t{header_.num_vertices}; }

  SequenceHeader header_;
  Topology topology_;
  std::optional<OrderedMeshes> meshes_;
};

TEST_F(InterGofs, AreParsedAsTheyWereWritten) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const InterGof gof = random_inter_gof(seed, mesh(), kFrames);
    const auto read = parsed(write_inter_gof(gof, mesh(), 1 + seed % 4));
    ASSERT_TRUE(read) << read.error().rule;
    EXPECT_EQ(static_cast<const InterSettings&>(*read), gof);
    for (std::uint32_t f = 0; f < kFrames; ++f) {
      const InterFrame& a = (*gof.frames)[f];
      const InterFrame& b = (*read->frames)[f];
      EXPECT_EQ(a.layer_groups, b.layer_groups);
      EXPECT_EQ(a.frame_crc, b.frame_crc);
      EXPECT_EQ(a.residual, b.residual) << "frame " << f;
    }
  }
}

TEST_F(InterGofs, AreTheSameHoweverFramesShareUnits) {
  std::size_t num_shared = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const InterGof gof = random_inter_gof(seed, mesh(), kFrames);
    const auto alone = write_inter_gof(gof, mesh());
    const auto read_alone = parsed(alone);
    ASSERT_TRUE(read_alone);
    for (const std::uint32_t per_unit : {2U, kFrames}) {
      const auto shared = write_inter_gof(gof, mesh(), per_unit);
      num_shared += alone.frames.size() - shared.frames.size();
      const auto read = parsed(shared);
      ASSERT_TRUE(read) << read.error().rule;
      EXPECT_EQ(decoded(*read), decoded(*read_alone));
    }
  }
  EXPECT_GT(num_shared, 20U);
}

TEST_F(InterGofs, AreTheSameOnAnyNumberOfThreadsAndInAnyOrder) {
  use_tube(40, 30);  // layers of several passes
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const auto read = parsed(write_inter_gof(random_inter_gof(seed, mesh(), kFrames), mesh()));
    ASSERT_TRUE(read);
    const auto positions = decoded(*read);
    EXPECT_EQ(decoded(*read, 3), positions);
    const OrderedRecon recon(mesh(), *read, header_.position_bits);
    for (const std::uint32_t f : {6U, 6U, 0U, 3U, 4U, 2U, 5U}) {
      std::vector<std::int32_t> frame(frame_size());
      recon.frame(f, frame);
      const auto expected = positions.begin() + static_cast<std::ptrdiff_t>(f * frame_size());
      EXPECT_TRUE(std::equal(frame.begin(), frame.end(), expected)) << "frame " << f;
    }
  }
}

TEST_F(InterGofs, CutToFewerLayersEqualThoseWithoutTheirUnits) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    InterGof gof = random_inter_gof(seed, mesh(), kFrames);
    gof.frame_hash_flag = false;
    const auto cut = parsed(write_inter_gof(gof, mesh()), {SliceCut::kAll, 1, SliceCut::kAll});
    ASSERT_TRUE(cut);
    auto frames = *gof.frames;
    for (InterFrame& frame : frames) {
      frame.layer_groups = std::min(frame.layer_groups, 1U);
      frame.frame_crc.reset();
    }
    gof.frames = std::make_shared<const std::vector<InterFrame>>(std::move(frames));
    const auto without = parsed(write_inter_gof(gof, mesh()));
    ASSERT_TRUE(without);
    EXPECT_EQ(decoded(*cut), decoded(*without));
  }
}

TEST_F(InterGofs, RefuseMoreMemoryThanAllowed) {
  const auto payloads = write_inter_gof(random_inter_gof(1, mesh(), kFrames), mesh());
  InterGofParser parser(header_, mesh(), {1000, 0});
  BitReader r(payloads.first);
  const auto ok = parser.gof(r, parse_gof_header(r, header_, 0));
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().code, Errc::kLimitExceeded);
}

// Tests that the frames the encoder expects are those that a decoder decodes.
class CodedFrames : public InterGofs, public testing::WithParamInterface<unsigned> {
 protected:
  // A tube that bends and waves.
  std::vector<double> animation() const {
    std::vector<double> xyz;
    for (std::uint32_t f = 0; f < kFrames; ++f) {
      for (std::uint32_t v = 0; v < header_.num_vertices; ++v) {
        const std::uint32_t ring = v / 9;
        const double along = ring;
        const double around = 0.7 * (v % 9);
        const double bend = 0.02 * f * along;
        xyz.push_back(300 * std::cos(around) + 90 * along * bend);
        xyz.push_back(300 * std::sin(around) + 20 * std::sin(0.5 * f + along));
        xyz.push_back(150 * along);
      }
    }
    return xyz;
  }
};

TEST_P(CodedFrames, AreDecodedAsTheEncoderExpects) {
  InterSettings settings;
  settings.pattern.kind = static_cast<FramePattern::Kind>(GetParam() & 3U);
  settings.pattern.entries = {{2, {0, 0}, 0}, {1, {0, 2}, 1}};
  settings.pattern.temporal_layers = settings.pattern.num_depths();
  settings.learning_flag = (GetParam() & 4U) != 0;
  settings.exact_flag = (GetParam() & 8U) != 0;
  settings.frame_hash_flag = true;
  settings.step.assign(settings.pattern.num_depths(),
                       settings.exact_flag ? kExactInterStep : 40);
  settings.weights = {6, 3, 3, 0};
  settings.prime_log2 = settings.learning_flag ? 6 : 0;
  settings.layer_group_size = {1, mesh().num_layers() - 1};
  settings.layer_step.assign(mesh().num_layers(), kMaxLayerStep);
  const std::vector<double> xyz = animation();
  InterGofPayloads payloads;
  payloads.first =
      write_inter_gof_unit({GofKind::kInter, 0, kFrames}, settings, mesh().topology());
  std::vector<std::int32_t> expected(kFrames * frame_size());
  const Threads use(2);
  ClosedLoop coding(mesh(), settings, header_, kFrames);
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const std::uint32_t f = coding.next_place().frame;
    auto units = coding.code(std::span(xyz).subspan(f * frame_size(), frame_size()),
                             std::span(expected).subspan(f * frame_size(), frame_size()));
    ASSERT_EQ(units.size(), 2U);
    for (auto& unit : units) payloads.frames.push_back(std::move(unit.payload));
  }
  const auto gof = parsed(payloads);
  ASSERT_TRUE(gof) << gof.error().rule;
  EXPECT_EQ(decoded(*gof), expected);
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    if (settings.exact_flag) {
      ASSERT_EQ(expected[i], std::floor(xyz[i] + 0.5));
    } else {
      ASSERT_NEAR(expected[i], xyz[i], 4.0);  // steps of 2.5, and the dead zone
    }
  }
  for (const InterFrame& frame : *gof->frames) EXPECT_TRUE(frame.frame_crc);
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, CodedFrames, testing::Range(0U, 16U));

}  // namespace
}  // namespace rlpc
