#include "encoder/sequence/sequence_coding.h"

#include <utility>
#include <vector>

#include "common/bitstream/crc32.h"
#include "common/mesh/coded_mesh.h"
#include "encoder/input/grid_value.h"
#include "encoder/math/det_math.h"

namespace rlpc {

std::uint32_t longest_gof(const EncoderSettings& settings) {
  return settings.gof_frames == 0 ? kDefaultGofFrames : settings.gof_frames;
}

TargetSearch search_for(const EncoderSettings& settings, const SequenceHeader& header,
                        double rms_spread) {
  const double steps_per_unit = exact_exp2(-header.grid.log2_step);
  double step_of_error = 6.0;
  AnalysisRange analysis_range;
  if (header.profile_idc == kProfileMain && settings.target.kind == Target::kKg) {
    // At larger errors more components are left out, which err less than coded ones would.
    constexpr double kUsualError = 0.1;  // per cent
    step_of_error = 9.0 * det_exp2(0.2 * det_log2(settings.target.value / kUsualError));
  }
  if (header.profile_idc == kProfileMain && settings.preset == Preset::kFast) {
    // Analyses for finer steps than are needed cost less than others.
    analysis_range = {.finest = 0.9, .made_for = 1.25, .coarsest = 1.65};
    step_of_error *= 0.92;
  }
  return {settings.target, rms_spread * steps_per_unit, steps_per_unit, step_of_error,
          analysis_range};
}

SequenceCoding::SequenceCoding(const SequenceHeader& header, const EncoderSettings& settings,
                               std::span<const Triangle> triangles)
    : header_(header),
      settings_(settings),
      connectivity_(write_connectivity(header.num_vertices, triangles)),
      topology_(make_topology(header.num_vertices, connectivity_.triangles)),
      context_{header_, topology_, connectivity_.triangles} {
  if (header_.profile_idc != kProfileMain) return;
  layers_ = make_layers(header_.num_vertices, connectivity_.triangles);
  bone_context_.emplace(SkinnedContext{{}, connectivity_.triangles, header_.position_bits});
  for (const Prediction prediction : {Prediction::kNone, Prediction::kParallelogram,
                                      Prediction::kParallelograms, Prediction::kLayers}) {
    bone_context_->meshes.emplace_back(prediction, topology_, layers_);
  }
}

void SequenceCoding::set_header(const SequenceHeader& header) {
  header_ = header;
  if (bone_context_) bone_context_->position_bits = header_.position_bits;
}

InputResult<GofFrames> SequenceCoding::read_frames(FrameSource& source,
                                                   const GofSpan& span) const {
  const std::uint32_t n = header_.num_vertices;
  GofFrames frames{n, span.count, std::vector<double>(std::size_t{n} * span.count * 3)};
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

std::unique_ptr<GofCoder> SequenceCoding::make_coder(const GofFrames& frames,
                                                     std::uint32_t first_frame,
                                                     GofMemory& memory) const {
  if (header_.profile_idc == kProfileMain) {
    return std::make_unique<GofKindSearch>(*bone_context_, context_, frames, first_frame,
                                           settings_, memory.main);
  }
  return std::make_unique<ClusterGofSearch>(context_, frames, first_frame, settings_,
                                            memory.clusters);
}

InputResult<Bytes> SequenceCoding::measure(FrameSource& source, const GofSpan& span,
                                           const DecodeFrame& decode,
                                           MetricsAccumulator& metrics) const {
  const std::size_t values = std::size_t{header_.num_vertices} * 3;
  std::vector<std::int32_t> positions(values);
  std::vector<float> original(values);
  std::vector<float> decoded(values);
  std::vector<std::uint32_t> crc;
  for (std::uint32_t f = 0; f < span.count; ++f) {
    decode(f, positions);
    if (settings_.hash_mode == HashMode::kFrame || crc.empty()) {
      crc.push_back(crc32_of_positions(positions));
    } else {
      crc.back() = crc32_of_positions(positions, crc.back());
    }
    if (auto error = source.read_frame(span.first + f, original)) return *error;
    for (std::size_t v = 0; v < header_.num_vertices; ++v) {
      const std::size_t to = 3 * std::size_t{connectivity_.input_vertex[v]};
      for (std::size_t c = 0; c < 3; ++c) {
        decoded[to + c] = grid_value(header_.grid, c, positions[3 * v + c]);
      }
    }
    metrics.add_frame(original, decoded);
  }
  if (settings_.hash_mode == HashMode::kNone) return Bytes{};
  return write_unit(UnitType::kGofHash,
                    write_gof_hash(crc, settings_.hash_mode == HashMode::kFrame));
}

Bytes write_gof_units(const EncodedGof& encoded) {
  Bytes units;
  for (const auto& unit : encoded.units) {
    const Bytes bytes = write_unit(unit.type, unit.payload);
    units.insert(units.end(), bytes.begin(), bytes.end());
  }
  return units;
}

}  // namespace rlpc
