// Streams for tests of the sub-stream extractor, and the frames that they decode to.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "conformance/testing/sliced_animation.h"
#include "decoder/codec/extract/sub_stream_extractor.h"

namespace rlpc {

using Frame = std::vector<std::int32_t>;

inline std::vector<Frame> decode_all(const StreamBytes& stream,
                                     const DecoderOptions& options = {}) {
  std::vector<Frame> frames;
  auto decoder = Decoder::open(memory_source(stream), options);
  EXPECT_TRUE(decoder);
  if (!decoder) return frames;
  Frame frame(3 * std::size_t{decoder->header().num_vertices});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    EXPECT_TRUE(more) << (more ? "" : more.error().rule);
    if (!more || !*more) return frames;
    frames.push_back(frame);
  }
}

// sliced_stream() with a vertex order, one hash for all of its second GOF, and an index.
inline StreamBytes ordered_stream() {
  const StreamBytes plain = sliced_stream();
  const std::vector<Frame> frames = decode_all(plain);
  const std::uint32_t num_vertices = static_cast<std::uint32_t>(frames[0].size() / 3);
  std::vector<std::uint32_t> order(num_vertices);
  for (std::uint32_t v = 0; v < num_vertices; ++v) order[v] = (7 * v + 3) % num_vertices;
  StreamBytes out(plain.begin(), plain.begin() + kStreamHeaderBytes);
  std::vector<std::size_t> gofs;
  const auto append = [&](UnitType type, const Bytes& payload) {
    if (type == UnitType::kGof) gofs.push_back(out.size());
    const Bytes unit = write_unit(type, payload);
    out.insert(out.end(), unit.begin(), unit.end());
    return unit.size();
  };
  for (const UnitPlace& unit : units_of(plain)) {
    if (unit.type == UnitType::kEndOfSequence) break;
    Bytes payload(plain.begin() + static_cast<std::ptrdiff_t>(unit.payload()),
                  plain.begin() + static_cast<std::ptrdiff_t>(unit.crc()));
    if (unit.type == UnitType::kGofHash && gofs.size() == 2) {
      const std::uint32_t crc = crc32_of_positions(frames[3], crc32_of_positions(frames[2]));
      payload = write_gof_hash(std::vector{crc}, false);
    }
    append(unit.type, payload);
    if (unit.type == UnitType::kConnectivity) {
      append(UnitType::kVertexOrder, write_vertex_order(order));
    }
  }
  const std::vector<GofEntry> entries{{2, gofs[1] - gofs[0]}, {2, out.size() - gofs[1]}};
  const std::size_t index =
      append(UnitType::kGofIndex, write_gof_index({gofs[0], entries, {}}, kProfileMain));
  append(UnitType::kEndOfSequence, write_end_of_sequence(static_cast<std::uint32_t>(index)));
  require_conforming(out);
  return out;
}

inline StreamBytes cut_stream(const StreamBytes& stream, const SliceCut& cut) {
  auto cutter = SubStreamExtractor::open(memory_source(stream), cut);
  EXPECT_TRUE(cutter);
  StreamBytes out;
  for (;;) {
    const auto bytes = cutter->next();
    EXPECT_TRUE(bytes);
    if (!bytes || bytes->empty()) return out;
    out.insert(out.end(), bytes->begin(), bytes->end());
  }
}

}  // namespace rlpc
