// Animations of a few vertices and their streams, for tests that decode thousands of times.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/crc32.h"
#include "common/codec/syntax/stream_format.h"
#include "common/testing/tube.h"
#include "conformance/rlpcval/validator.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

using StreamBytes = std::vector<std::uint8_t>;

// Frames that are held in memory.
class MemoryFrames final : public FrameSource {
 public:
  MemoryFrames(Shape shape, std::vector<std::vector<float>> frames)
      : FrameSource(with_count(std::move(shape), frames)), frames_(std::move(frames)) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    std::copy(frames_[frame].begin(), frames_[frame].end(), xyz.begin());
    return std::nullopt;
  }

 private:
  static Shape with_count(Shape shape, const std::vector<std::vector<float>>& frames) {
    shape.num_vertices = static_cast<std::uint32_t>(frames[0].size() / 3);
    shape.num_frames = static_cast<std::uint32_t>(frames.size());
    return shape;
  }

  std::vector<std::vector<float>> frames_;
};

// A tube of `rings` rings of 5 vertices, open at both ends, that bends and breathes.
inline MemoryFrames bending_tube(std::uint32_t rings, std::uint32_t num_frames) {
  FrameSource::Shape shape;
  shape.frame_rate = {24, 1};
  shape.triangles = tube_triangles(rings, 5);
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    std::vector<float> xyz;
    const double bend = 0.4 * std::sin(0.7 * f);
    for (std::uint32_t v = 0; v < 5 * rings; ++v) {
      const std::uint32_t ring = v / 5;
      const double along = ring / static_cast<double>(rings);
      const double turn = 1.2566 * (v % 5);
      const double radius = 0.2 + 0.03 * std::sin(f + 2.0 * along) + 0.004 * ((7 * v + f) % 5);
      const double x = along * std::cos(bend * along) - 0.1 * f;
      const double y = radius * std::cos(turn) + along * std::sin(bend * along);
      const double z = radius * std::sin(turn);
      for (const double c : {x, y, z}) xyz.push_back(static_cast<float>(c));
    }
    frames.push_back(std::move(xyz));
  }
  return {std::move(shape), std::move(frames)};
}

// A bending tube with normals, which are predicted from the first frame.
inline MemoryFrames tube_with_normals(std::uint32_t rings, std::uint32_t num_frames) {
  MemoryFrames plain = bending_tube(rings, num_frames);
  FrameSource::Shape shape;
  shape.frame_rate = plain.frame_rate();
  shape.triangles.assign(plain.triangles().begin(), plain.triangles().end());
  std::vector<std::vector<float>> frames(plain.num_frames());
  for (std::uint32_t f = 0; f < plain.num_frames(); ++f) {
    frames[f].resize(3 * std::size_t{plain.num_vertices()});
    plain.read_frame(f, frames[f]);
  }
  SourceAttribute& normal = shape.attributes.sets.emplace_back();
  normal.name = "normal";
  normal.domain = AttributeDomain::kVertex;
  normal.kind = SourceAttribute::Kind::kNormals;
  normal.num_components = 3;
  for (std::uint32_t v = 0; v < plain.num_vertices(); ++v) {
    const double turn = 1.2566 * (v % 5) + 0.1 * std::sin(3.0 * v);
    normal.values.push_back(0.0F);
    normal.values.push_back(static_cast<float>(std::cos(turn)));
    normal.values.push_back(static_cast<float>(std::sin(turn)));
  }
  return {std::move(shape), std::move(frames)};
}

// Throws, which fails the test, if the stream does not conform.
inline void require_conforming(const StreamBytes& bytes) {
  const auto source = memory_source(bytes);
  const ValidationReport report = validate(*source);
  for (const Finding& f : report.findings) {
    if (f.severity == Severity::kWarning) continue;
    throw std::logic_error("the encoder broke " + std::string(f.id) + " at bit " +
                           std::to_string(f.bit_pos) + " (" + f.element + "): " + f.detail);
  }
  if (!report.complete) throw std::logic_error("the validator did not check all of a stream");
}

// Returns the stream; empty if the encoder reports an error.
inline StreamBytes encode_to_memory(FrameSource& source, const EncoderSettings& settings,
                                    EncodeReport* report = nullptr) {
  StreamBytes bytes;
  auto result = encode(source, settings, [&](std::span<const std::uint8_t> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  });
  if (!result) return {};
  require_conforming(bytes);
  if (report != nullptr) *report = std::move(*result);
  return bytes;
}

struct Encoded {
  StreamBytes bytes;
  EncodeReport report;
};

// Throws, which fails the test, if the encoder reports an error.
inline Encoded encode_with_report(FrameSource& source, const EncoderSettings& settings) {
  Encoded out;
  out.bytes = encode_to_memory(source, settings, &out.report);
  if (out.bytes.empty()) throw std::logic_error("the encoder reports an error");
  return out;
}

// A ByteSink for streams that are not needed.
inline bool discard(std::span<const std::uint8_t> /*bytes*/) { return true; }

// Settings that use all syntax of the Baseline profile: clusters with local frames, vertex
// order, metadata, a hash for each frame. Streams of 30 vertices and 6 frames have 2 GOFs.
inline EncoderSettings rich_settings() {
  EncoderSettings settings;
  settings.profile = Profile::kBaseline;
  settings.target = {Target::kNone, 0.0};
  settings.baseline.clusters = 2;
  settings.components = 2;
  settings.baseline.qu = settings.baseline.qc = 8;
  settings.baseline.qdelta = 10;
  settings.baseline.frame_mode = FrameMode::kLcf;
  settings.gof_frames = 3;
  settings.keep_order = true;
  settings.hash_mode = HashMode::kFrame;
  settings.metadata = R"({"title":"tube","tags":["small","small","small"]})";
  return settings;
}
inline StreamBytes rich_stream() {
  MemoryFrames source = bending_tube(6, 6);
  return encode_to_memory(source, rich_settings());
}

// A stream with an index: 16 GOFs of one frame, one hash for each GOF, world coordinates.
inline StreamBytes indexed_stream() {
  MemoryFrames source = bending_tube(2, 16);
  EncoderSettings settings;
  settings.profile = Profile::kBaseline;
  settings.target = {Target::kKg, 10.0};
  settings.baseline.clusters = 1;
  settings.baseline.frame_mode = FrameMode::kWorld;
  settings.gof_frames = 1;
  return encode_to_memory(source, settings);
}

struct UnitPlace {
  std::size_t offset = 0;
  std::size_t size = 0;  // bytes of the payload
  UnitType type = UnitType::kEndOfSequence;

  std::size_t payload() const { return offset + kUnitHeaderBytes; }
  std::size_t crc() const { return payload() + size; }
  std::size_t end() const { return crc() + kUnitCrcBytes; }
};

// The units of a stream, as far as their sizes make sense.
inline std::vector<UnitPlace> units_of(const StreamBytes& bytes) {
  std::vector<UnitPlace> units;
  std::size_t at = kStreamHeaderBytes;
  while (at + kUnitHeaderBytes + kUnitCrcBytes <= bytes.size()) {
    UnitPlace unit{at, 0, static_cast<UnitType>(bytes[at])};
    for (std::size_t i = 1; i < kUnitHeaderBytes; ++i) {
      unit.size = (unit.size << 8) | bytes[at + i];
    }
    if (unit.size > bytes.size() || unit.end() > bytes.size()) break;
    units.push_back(unit);
    at = unit.end();
  }
  return units;
}

inline std::vector<UnitPlace> units_of_type(const StreamBytes& bytes, UnitType type) {
  std::vector<UnitPlace> units = units_of(bytes);
  std::erase_if(units, [type](const UnitPlace& unit) { return unit.type != type; });
  return units;
}

inline void repair_crcs(StreamBytes& bytes) {
  for (const UnitPlace& unit : units_of(bytes)) {
    const std::uint32_t crc =
        crc32_of(std::span(bytes).subspan(unit.offset, unit.crc() - unit.offset));
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[unit.crc() + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    }
  }
}

// The stream with another payload in one unit; sizes and CRCs fit.
inline StreamBytes with_payload(const StreamBytes& bytes, const UnitPlace& unit,
                                std::span<const std::uint8_t> payload) {
  StreamBytes out(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(unit.payload()));
  for (std::size_t i = 0; i < 4; ++i) {
    out[unit.offset + 1 + i] = static_cast<std::uint8_t>(payload.size() >> (24 - 8 * i));
  }
  out.insert(out.end(), payload.begin(), payload.end());
  out.insert(out.end(), bytes.begin() + static_cast<std::ptrdiff_t>(unit.crc()), bytes.end());
  repair_crcs(out);
  return out;
}

}  // namespace rlpc
