// Tests that the encoder's verification of its own streams finds faults.
#include "encoder/codec/sequence/stream_verifier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/syntax/stream_format.h"
#include "common/verify/stream_rules.h"
#include "conformance/testing/small_animation.h"

namespace rlpc {
namespace {

struct Written {
  EncoderSettings settings;
  StreamBytes bytes;
  EncodeReport report;
};

Written write_lossless(FrameSource& source, bool keep_order) {
  Written written;
  written.settings.profile = Profile::kHigh;
  written.settings.target = {Target::kLossless, 14.0};
  written.settings.keep_order = keep_order;
  written.settings.gof_frames = 3;
  written.bytes = encode_to_memory(source, written.settings, &written.report);
  return written;
}

std::shared_ptr<StreamBuffer> buffer_of(const StreamBytes& bytes) {
  auto buffer = std::make_shared<StreamBuffer>(StreamBuffer::Keep::kAll);
  // Passes the stream in pieces, as it is written.
  for (std::size_t at = 0; at < bytes.size(); at += 7) {
    buffer->add(std::span(bytes).subspan(at, std::min<std::size_t>(7, bytes.size() - at)));
  }
  return buffer;
}

// Returns the error, or "" if there is none.
std::string verify(const Written& written, FrameSource& source) {
  StreamVerifier verifier(written.settings, written.report.header, written.report.input_vertex,
                          buffer_of(written.bytes), 2);
  auto error = verifier.check_frames(source, 0, source.num_frames());
  if (!error) error = verifier.finish(written.report.metrics);
  EXPECT_TRUE(!error || error->is_fault);
  return error ? error->message : "";
}

// Returns a tube with a changed coordinate in one frame.
MemoryFrames changed_tube(std::uint32_t frame, std::size_t coordinate, float by) {
  MemoryFrames tube = bending_tube(6, 7);
  std::vector<std::vector<float>> frames(tube.num_frames());
  for (std::uint32_t f = 0; f < tube.num_frames(); ++f) {
    frames[f].resize(3 * std::size_t{tube.num_vertices()});
    tube.read_frame(f, frames[f]);
  }
  frames[frame][coordinate] += by;
  FrameSource::Shape shape = tube.shape();
  return {std::move(shape), std::move(frames)};
}

TEST(StreamVerifier, AcceptsWhatIsRight) {
  for (const bool keep_order : {false, true}) {
    MemoryFrames tube = bending_tube(6, 7);
    EXPECT_EQ(verify(write_lossless(tube, keep_order), tube), "");
  }
}

TEST(StreamVerifier, NamesTheCoordinateThatDiffers) {
  for (const bool keep_order : {false, true}) {
    MemoryFrames tube = bending_tube(6, 7);
    const Written written = write_lossless(tube, keep_order);
    MemoryFrames other = changed_tube(4, 3 * 17 + 1, 0.01F);
    const std::string error = verify(written, other);
    EXPECT_NE(error.find("frame 4, vertex 17 (from 0): y becomes"), std::string::npos) << error;
  }
}

TEST(StreamVerifier, NoticesOtherErrorsThanReported) {
  MemoryFrames tube = bending_tube(6, 7);
  Written written = write_lossless(tube, true);
  written.report.metrics.max_error *= 0.5;
  EXPECT_NE(verify(written, tube).find("the largest error is"), std::string::npos);
  written = write_lossless(tube, true);
  written.settings.target = {Target::kKg, 0.1};
  MemoryFrames other = changed_tube(5, 3, 0.01F);
  EXPECT_NE(verify(written, other).find("the RMS error"), std::string::npos);
}

TEST(StreamVerifier, NoticesADamagedStream) {
  MemoryFrames tube = bending_tube(6, 7);
  const Written right = write_lossless(tube, true);
  for (std::size_t at = 12; at < right.bytes.size(); at += 13) {
    Written damaged = right;
    damaged.bytes[at] ^= 4;
    EXPECT_NE(verify(damaged, tube), "") << at;
  }
  for (std::size_t left = 0; left < right.bytes.size(); left += 13) {
    Written cut = right;
    cut.bytes.resize(left);
    EXPECT_NE(verify(cut, tube), "") << left;
  }
}

TEST(StreamVerifier, DecodesFramesWhoseOriginalsAreGone) {
  MemoryFrames tube = bending_tube(6, 7);
  const Written written = write_lossless(tube, false);
  StreamVerifier verifier(written.settings, written.report.header, written.report.input_vertex,
                          buffer_of(written.bytes), 1);
  std::vector<double> original(3 * std::size_t{tube.num_vertices()});
  std::vector<std::int32_t> positions(original.size());
  const double per_step = static_cast<double>(1 << -written.report.header.grid.log2_step);
  for (std::uint32_t f = 0; f < tube.num_frames(); ++f) {
    tube.read_exact(f, original);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::size_t from = 3 * std::size_t{written.report.input_vertex[i / 3]} + i % 3;
      positions[i] = static_cast<std::int32_t>(std::floor(original[from] * per_step + 0.5)) -
                     written.report.header.grid.origin[i % 3];
    }
    if (f == 5) positions[7] += 2;
    const auto refused = verifier.expect(positions, original);
    EXPECT_EQ(refused.has_value(), f == 5);
    EXPECT_TRUE(!refused || refused->message.find("frame 5, vertex") != std::string::npos);
    const auto error = verifier.check_expected();
    EXPECT_FALSE(error) << error->message;
    if (f == 5) break;
  }
}

TEST(StreamVerifier, NoticesPositionsThatDecodersDoNotFind) {
  MemoryFrames tube = bending_tube(6, 7);
  Written written = write_lossless(tube, false);
  written.settings.target = {Target::kKg, 0.1};
  StreamVerifier verifier(written.settings, written.report.header, written.report.input_vertex,
                          buffer_of(written.bytes), 1);
  const std::vector<double> original(3 * std::size_t{tube.num_vertices()});
  EXPECT_FALSE(verifier.expect(std::vector<std::int32_t>(original.size()), original));
  const auto error = verifier.check_expected();
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("decoded to other positions"), std::string::npos);
}

// Returns the offset of the payload of the first unit of a type.
std::size_t payload_of(const StreamBytes& bytes, UnitType type) {
  std::size_t at = kStreamHeaderBytes;
  while (at + kUnitHeaderBytes < bytes.size() && bytes[at] != static_cast<std::uint8_t>(type)) {
    std::size_t size = 0;
    for (std::size_t i = 1; i < kUnitHeaderBytes; ++i) size = size << 8 | bytes[at + i];
    at += kUnitHeaderBytes + size + kUnitCrcBytes;
  }
  return at + kUnitHeaderBytes;
}

TEST(StreamRules, ABrokenRuleIsNamed) {
  MemoryFrames tube = tube_with_normals(6, 4);
  EncoderSettings settings;
  settings.metadata = R"({"title":"tube"})";
  const StreamBytes bytes = encode_to_memory(tube, settings);
  const auto find = [&](const StreamBytes& changed, RuleScope scope) {
    return find_broken_rule(buffer_of(changed), changed.size(), scope).value_or("");
  };
  EXPECT_EQ(find(bytes, RuleScope::kAll), "");
  EXPECT_EQ(find(bytes, RuleScope::kContents), "");
  for (const auto type : {UnitType::kMetadata, UnitType::kAttributes}) {
    StreamBytes damaged = bytes;
    damaged.at(payload_of(bytes, type) + 1) ^= 1;
    for (const auto scope : {RuleScope::kAll, RuleScope::kContents}) {
      EXPECT_NE(find(damaged, scope).find("breaks rule R-UNT-03"), std::string::npos);
    }
  }
  StreamBytes damaged = bytes;
  damaged.at(payload_of(bytes, UnitType::kGof) + 1) ^= 1;
  EXPECT_NE(find(damaged, RuleScope::kAll), "");
  StreamBytes cut = bytes;
  cut.resize(cut.size() - 20);
  EXPECT_NE(find(cut, RuleScope::kAll), "");
  EXPECT_EQ(find(cut, RuleScope::kContents), "");
}

}  // namespace
}  // namespace rlpc
