#include "encoder/codec/sequence/sequence_coding.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/codec/bits/crc32.h"
#include "common/files/float_position.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/cluster/cluster_gof_kind.h"
#include "encoder/codec/kinds/skinned/input_rig.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/sequence/choices/gof_kinds.h"
#include "encoder/codec/spans/kind_search.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {

namespace {

// Returns the triangles of the input with the indices of decoded vertices.
std::vector<Triangle> renumber(std::span<const Triangle> triangles,
                               const std::vector<std::uint32_t>& input_vertex) {
  std::vector<std::uint32_t> decoded_vertex(input_vertex.size());
  for (std::uint32_t v = 0; v < input_vertex.size(); ++v) decoded_vertex[input_vertex[v]] = v;
  std::vector<Triangle> renumbered(triangles.begin(), triangles.end());
  for (Triangle& t : renumbered) {
    for (std::uint32_t& v : t) v = decoded_vertex[v];
  }
  return renumbered;
}

}  // namespace

SequenceCoding::SequenceCoding(const SequenceHeader& header, const EncoderSettings& settings,
                               std::span<const Triangle> triangles)
    : header_(header),
      settings_(settings),
      normal_triangles_(settings.target.max_normals > 0.0
                            ? std::vector<Triangle>(triangles.begin(), triangles.end())
                            : std::vector<Triangle>{}),
      connectivity_(write_connectivity(header.num_vertices, triangles)),
      topology_(make_topology(header.num_vertices, connectivity_.triangles)),
      input_triangles_(settings.profile == Profile::kBaseline
                           ? renumber(triangles, connectivity_.input_vertex)
                           : std::vector<Triangle>{}),
      mesh_{header_, topology_, connectivity_.triangles, input_triangles_},
      kinds_(make_gof_kinds(mesh_, settings_)),
      last_resort_(make_last_resort(mesh_, settings_)) {}

InputResult<SpanFrames> SequenceCoding::read_frames(FrameSource& source,
                                                    const FrameRange& span) const {
  auto frames = read_positions(source, span);
  if (!frames || !source.rig() || settings_.profile == Profile::kBaseline) return frames;
  const std::size_t num_bones = source.rig()->bones.size();
  std::vector<BoneMap> maps(num_bones * span.count);
  for (std::uint32_t f = 0; f < span.count; ++f) {
    source.read_bones(span.first + f, std::span(maps).subspan(f * num_bones, num_bones));
  }
  const auto rig = [&](bool may_stretch) {
    return rig_of_span(*source.rig(), maps, header_, connectivity_.input_vertex, may_stretch);
  };
  frames->input_rig = rig(settings_.profile == Profile::kHigh);
  if (frames->input_rig && frames->input_rig->stretches()) frames->rigid_rig = rig(false);
  return frames;
}

InputResult<SpanFrames> SequenceCoding::read_positions(FrameSource& source,
                                                       const FrameRange& span) const {
  const std::uint32_t n = header_.num_vertices;
  SpanFrames frames{n, span.count, std::vector<double>(std::size_t{n} * span.count * 3),
                    span.first, span.num_gofs};
  std::vector<float> input(std::size_t{n} * 3);
  const double per_step = exact_exp2(-header_.grid.log2_step);
  double* out = frames.xyz.data();
  for (std::uint32_t f = 0; f < span.count; ++f) {
    if (auto error = source.read_frame(span.first + f, input)) return *error;
    for (std::uint32_t v = 0; v < n; ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = input[3 * std::size_t{connectivity_.input_vertex[v]} + c];
        *out++ = x * per_step - header_.grid.origin[c];
      }
    }
  }
  return frames;
}

InputResult<std::vector<DecodedFrame>> SequenceCoding::nearest_frames(
    FrameSource& source, std::span<const std::uint32_t> numbers) const {
  std::vector<DecodedFrame> nearest;
  for (const std::uint32_t number : numbers) {
    const auto frames = read_positions(source, {number, 1});
    if (!frames) return frames.error();
    std::vector<std::int32_t>& positions =
        nearest.emplace_back(DecodedFrame{number, {}}).positions;
    for (std::uint32_t v = 0; v < header_.num_vertices; ++v) {
      const Vec3i p = nearest_position(frames->at(0, v), header_.position_bits);
      positions.insert(positions.end(), p.begin(), p.end());
    }
  }
  return nearest;
}

std::unique_ptr<SpanCoder> SequenceCoding::make_coder(const SpanFrames& frames,
                                                      bool is_last_resort) const {
  if (is_last_resort) return last_resort_->make_coder(frames);
  if (kinds_.size() == 1) return kinds_.front()->make_coder(frames);
  return std::make_unique<KindSearch>(kinds_, frames, settings_.preset);
}

std::optional<EncodedSpan> SequenceCoding::encode_with(const KeptRig& rig,
                                                       const SpanFrames& frames, double step,
                                                       double max_cost) const {
  for (const auto& kind : kinds_) {
    if (auto encoded = kind->encode_with(rig, frames, step, max_cost)) return encoded;
  }
  return std::nullopt;
}

// Measures `some` frames of a span; `before`: the original of the frame before them, empty if
// there is none.
InputResult<std::vector<SequenceCoding::MeasuredFrame>> SequenceCoding::measure_frames(
    const SharedSource& source, const FrameRange& span, const FrameRange& some,
    const DecodeFrame& decode, std::span<const double> before) const {
  const std::size_t values = std::size_t{header_.num_vertices} * 3;
  std::vector<MeasuredFrame> frames(some.count,
                                    {{}, {}, MetricsAccumulator(header_.num_vertices)});
  for (std::uint32_t i = 0; i < some.count; ++i) {
    frames[i].original.resize(values);
    if (auto error = source.read_frame(span.first + some.first + i, frames[i].original)) {
      return *error;
    }
  }
  for_each(some.count, [&](std::size_t i) {
    MeasuredFrame& frame = frames[i];
    frame.positions.resize(values);
    decode(some.first + static_cast<std::uint32_t>(i), frame.positions);
    std::vector<float> decoded(values);
    to_input(frame.positions, decoded);
    frame.metrics.follow(i > 0 ? frames[i - 1].original : before);
    frame.metrics.add_frame(frame.original, decoded,
                            normal_deviation(normal_triangles_, frame.original, decoded));
  });
  return frames;
}

InputResult<std::vector<Bytes>> SequenceCoding::measure(const SharedSource& source,
                                                        const FrameRange& span,
                                                        const DecodeFrame& decode,
                                                        MetricsAccumulator& metrics) const {
  const Stage stage("metrics");
  constexpr std::uint32_t kTogether = 16;  // fixed: memory
  std::vector<double> before(metrics.last_original().begin(), metrics.last_original().end());
  if (before.empty() && span.first > 0) {
    before.resize(std::size_t{header_.num_vertices} * 3);
    if (auto error = source.read_frame(span.first - 1, before)) return *error;
  }
  std::vector<Bytes> hash_units;
  for (const FrameRange& gof : equal_ranges(span.count, span.num_gofs)) {
    std::vector<std::uint32_t> crc;
    for (std::uint32_t done = 0; done < gof.count; done += kTogether) {
      const FrameRange some{gof.first + done, std::min(kTogether, gof.count - done)};
      auto frames = measure_frames(source, span, some, decode, before);
      if (!frames) return frames.error();
      for (const MeasuredFrame& frame : *frames) {
        if (settings_.hash_mode == HashMode::kFrame || crc.empty()) {
          crc.push_back(crc32_of_positions(frame.positions));
        } else {
          crc.back() = crc32_of_positions(frame.positions, crc.back());
        }
        metrics.append(frame.metrics);
      }
      before = std::move(frames->back().original);
    }
    hash_units.emplace_back();
    if (settings_.hash_mode == HashMode::kNone) continue;
    hash_units.back() = write_unit(
        UnitType::kGofHash, write_gof_hash(crc, settings_.hash_mode == HashMode::kFrame));
  }
  return hash_units;
}

// Writes positions as floats, in the order of the input.
void SequenceCoding::to_input(std::span<const std::int32_t> positions,
                              std::span<float> decoded) const {
  for (std::size_t v = 0; v < header_.num_vertices; ++v) {
    const std::size_t to = 3 * std::size_t{connectivity_.input_vertex[v]};
    for (std::size_t c = 0; c < 3; ++c) {
      decoded[to + c] = float_position(header_.grid, c, positions[3 * v + c]);
    }
  }
}

std::vector<GofBytes> write_gof_units(const EncodedSpan& encoded, const FrameRange& span,
                                      bool is_open_ended) {
  std::vector<GofBytes> gofs;
  Bytes rig;
  for (const auto& unit : encoded.units) {
    const Bytes bytes = write_unit(unit.type, unit.payload);
    if (unit.type == UnitType::kGof)
      gofs.push_back({0, std::exchange(rig, {}), {}, {}, false, {}});
    if (unit.type == UnitType::kFrame && is_open_ended) gofs.back().has_own_hashes = true;
    Bytes& out = gofs.empty() ? rig : gofs.back().units;
    out.insert(out.end(), bytes.begin(), bytes.end());
    if (unit.temporal_layer_idx == 0) continue;
    std::vector<std::uint64_t>& layer_bytes = gofs.back().layer_bytes;
    layer_bytes.resize(std::max<std::size_t>(layer_bytes.size(), unit.temporal_layer_idx));
    layer_bytes[unit.temporal_layer_idx - 1] += bytes.size();
  }
  const std::vector<FrameRange> parts = equal_ranges(span.count, span.num_gofs);
  for (std::size_t g = 0; g < gofs.size(); ++g) gofs[g].num_frames = parts[g].count;
  return gofs;
}

}  // namespace rlpc
