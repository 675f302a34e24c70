#include "encoder/sequence/sequence_coding.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/bitstream/crc32.h"
#include "common/io/float_position.h"
#include "common/io/messages.h"
#include "common/parallel/for_each.h"
#include "encoder/cluster_gof/cluster_gof_kind.h"
#include "encoder/frame_gof/pattern_search.h"
#include "encoder/gof/gof_kind_search.h"
#include "encoder/math/det_math.h"
#include "encoder/sequence/choices/gof_kinds.h"

namespace rlpc {

namespace {

// Per position of the span being coded. Measured with random motion: 90 to 150. Real motion
// needs 40.
constexpr std::uint64_t kBytesOfPosition = 150;  // fixed: memory
// Of a skinned model that later spans may use: factors of two or four bytes, of at most three
// trajectories for each frame.
constexpr std::uint64_t kFactorsOfModel = 12;  // fixed: memory

// Frames that can be coded at once.
std::uint64_t frames_in_memory(const EncoderSettings& settings, std::uint32_t num_vertices,
                               std::uint64_t bytes_of_position) {
  constexpr std::uint64_t kMostPositions = std::uint64_t{1} << 26;  // fixed: memory
  constexpr std::uint64_t kPart = 2;  // fixed: they take at most half of the limit
  const std::uint64_t positions =
      std::min(kMostPositions, settings.max_memory_bytes / (kPart * bytes_of_position));
  return std::min<std::uint64_t>(positions / num_vertices, kMaxFrames);
}

// The triangles of the input by the indices of decoded vertices.
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

std::uint32_t longest_gof(const EncoderSettings& settings, std::uint32_t num_vertices) {
  if (settings.gof_frames > 0) return settings.gof_frames;
  if (settings.profile == Profile::kHigh) return kDefaultTrackFrames;
  return settings.clips.size() < 2 ? kDefaultGofFrames
                                   : longest_gof_of_all(settings, num_vertices);
}

std::uint32_t longest_gof_of_all(const EncoderSettings& settings, std::uint32_t num_vertices) {
  if (settings.gof_frames > 0) return settings.gof_frames;
  if (settings.profile == Profile::kHigh) return kDefaultTrackFrames;
  if (settings.profile == Profile::kBaseline) return kDefaultGofFrames;
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(frames_in_memory(settings, num_vertices, kBytesOfPosition),
                                kDefaultGofFrames, kClipFrames));
}

std::uint32_t longest_span(const EncoderSettings& settings, const SequenceHeader& header) {
  const std::uint32_t longest = longest_gof(settings, header.num_vertices);
  if (settings.profile != Profile::kHigh) return longest;
  const auto frames = [&](std::uint64_t bytes_of_position) {
    return std::max<std::uint64_t>(
        longest, frames_in_memory(settings, header.num_vertices, bytes_of_position));
  };
  const std::uint64_t alone = frames(kBytesOfPosition);
  // With several spans, there are two skinned models besides: one in force and a new one.
  return static_cast<std::uint32_t>(
      header.num_frames <= alone ? alone : frames(kBytesOfPosition + 2 * kFactorsOfModel));
}

namespace {

// Of a vertex of a GOF of frames, or a span of them, that a thread encodes by each choice that
// is compared: positions, as doubles and floats and decoded, and what each encoding learns.
std::uint64_t bytes_of_frames(const EncoderSettings& settings, const SequenceHeader& header,
                              std::uint32_t num_frames) {
  constexpr std::uint64_t kOfFrame = 36;     // fixed: memory; without decoded positions
  constexpr std::uint64_t kDecoded = 12;     // fixed: memory
  constexpr std::uint64_t kOfFilter = 2100;  // fixed: memory
  const KindChoice kinds = settings.usable_kinds();
  if (settings.profile != Profile::kHigh ||
      (kinds != KindChoice::kAuto && kinds != KindChoice::kFrames)) {
    return 0;
  }
  std::size_t choices = 1;
  if (!settings.low_delay) {
    const auto patterns = patterns_of(settings, header.open_end_flag, num_frames);
    const auto patches = patches_of(settings, header.open_end_flag, num_frames);
    choices = std::max(patterns.size(), choices_of_patches(patterns, patches).size());
  }
  return kOfFrame * num_frames +
         choices * (kDecoded * num_frames + kOfFilter * settings.frames.temporal_layers);
}

}  // namespace

InputResult<std::uint32_t> check_memory(const EncoderSettings& settings,
                                        const SequenceHeader& header, std::uint32_t longest_gof,
                                        std::uint32_t kept_frames, std::uint64_t source_bytes) {
  // Measured with random motion: 70 bytes per position of a kept analysis. Real motion
  // needs 10.
  constexpr std::uint64_t kFixed = std::uint64_t{16} << 20;  // fixed: memory
  constexpr std::uint64_t kOfVertex = 700;                   // fixed: memory
  constexpr std::uint64_t kOfTriangle = 250;                 // fixed: memory
  constexpr std::uint64_t kKept = 70;                        // fixed: memory
  // The rest of such a model: rest position, influences, two sets of weights of prediction.
  constexpr std::uint64_t kOfModel = 400;  // fixed: memory
  const bool has_models = settings.profile == Profile::kHigh && longest_gof < header.num_frames;
  const std::uint64_t of_model =
      has_models ? header.num_vertices * (kOfModel + kFactorsOfModel * longest_gof) : 0;
  // Each thread has a GOF of its own, or a candidate for one; another model is in force.
  const std::uint64_t of_thread =
      header.num_vertices * std::max(kBytesOfPosition * longest_gof,
                                     bytes_of_frames(settings, header, longest_gof)) +
      of_model;
  const std::uint64_t of_vertex = kOfVertex + kKept * kept_frames;
  const std::uint64_t needed = kFixed + source_bytes + header.num_vertices * of_vertex +
                               header.num_triangles * kOfTriangle + of_thread + of_model;
  if (needed <= settings.max_memory_bytes) {
    const std::uint64_t others = (settings.max_memory_bytes - needed) / of_thread;
    const std::uint32_t wanted = std::clamp(settings.threads, 1U, kMaxEncoderThreads);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, others + 1));
  }
  return InputError{"encoding may need " + std::to_string((needed >> 20) + 1) +
                        " MiB of memory; the limit is " + size_text(settings.max_memory_bytes) +
                        " (--max-memory). A shorter --gof needs less",
                    true};
}

SequenceCoding::SequenceCoding(const SequenceHeader& header, const EncoderSettings& settings,
                               std::span<const Triangle> triangles)
    : header_(header),
      settings_(settings),
      connectivity_(write_connectivity(header.num_vertices, triangles)),
      topology_(make_topology(header.num_vertices, connectivity_.triangles)),
      input_triangles_(settings.profile == Profile::kBaseline
                           ? renumber(triangles, connectivity_.input_vertex)
                           : std::vector<Triangle>{}),
      mesh_{header_, topology_, connectivity_.triangles, input_triangles_},
      kinds_(make_gof_kinds(mesh_, settings_)),
      last_resort_(make_last_resort(mesh_, settings_)) {}

InputResult<GofFrames> SequenceCoding::read_frames(FrameSource& source,
                                                   const GofSpan& span) const {
  const std::uint32_t n = header_.num_vertices;
  GofFrames frames{n, span.count, std::vector<double>(std::size_t{n} * span.count * 3),
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
    const auto frames = read_frames(source, {number, 1});
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

std::unique_ptr<GofCoder> SequenceCoding::make_coder(const GofFrames& frames,
                                                     bool is_last_resort) const {
  if (is_last_resort) return last_resort_->make_coder(frames);
  if (kinds_.size() == 1) return kinds_.front()->make_coder(frames);
  return std::make_unique<GofKindSearch>(kinds_, frames, settings_.preset);
}

std::optional<EncodedGof> SequenceCoding::encode_with(const KeptModel& model,
                                                      const GofFrames& frames, double step,
                                                      double most) const {
  for (const auto& kind : kinds_) {
    if (auto encoded = kind->encode_with(model, frames, step, most)) return encoded;
  }
  return std::nullopt;
}

// Measures `some` frames of a span; `before`: the original of the frame before them, empty if
// there is none.
InputResult<std::vector<SequenceCoding::MeasuredFrame>> SequenceCoding::measure_frames(
    const SharedSource& source, const GofSpan& span, const GofSpan& some,
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
    frame.metrics.add_frame(frame.original, decoded);
  });
  return frames;
}

InputResult<std::vector<Bytes>> SequenceCoding::measure(const SharedSource& source,
                                                        const GofSpan& span,
                                                        const DecodeFrame& decode,
                                                        MetricsAccumulator& metrics) const {
  constexpr std::uint32_t kTogether = 16;  // fixed: memory
  std::vector<double> before(metrics.last_original().begin(), metrics.last_original().end());
  if (before.empty() && span.first > 0) {
    before.resize(std::size_t{header_.num_vertices} * 3);
    if (auto error = source.read_frame(span.first - 1, before)) return *error;
  }
  std::vector<Bytes> hash_units;
  for (const GofSpan& gof : equal_spans(span.count, span.num_gofs)) {
    std::vector<std::uint32_t> crc;
    for (std::uint32_t done = 0; done < gof.count; done += kTogether) {
      const GofSpan some{gof.first + done, std::min(kTogether, gof.count - done)};
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

// Positions as floats, in the order of the input.
void SequenceCoding::to_input(std::span<const std::int32_t> positions,
                              std::span<float> decoded) const {
  for (std::size_t v = 0; v < header_.num_vertices; ++v) {
    const std::size_t to = 3 * std::size_t{connectivity_.input_vertex[v]};
    for (std::size_t c = 0; c < 3; ++c) {
      decoded[to + c] = float_position(header_.grid, c, positions[3 * v + c]);
    }
  }
}

std::vector<GofBytes> write_gof_units(const EncodedGof& encoded, const GofSpan& span,
                                      bool is_open_ended) {
  std::vector<GofBytes> gofs;
  Bytes model;
  for (const auto& unit : encoded.units) {
    const Bytes bytes = write_unit(unit.type, unit.payload);
    if (unit.type == UnitType::kGof)
      gofs.push_back({0, std::exchange(model, {}), {}, {}, false, {}});
    if (unit.type == UnitType::kFrame && is_open_ended) gofs.back().has_own_hashes = true;
    Bytes& out = gofs.empty() ? model : gofs.back().units;
    out.insert(out.end(), bytes.begin(), bytes.end());
    if (unit.temporal_layer_idx == 0) continue;
    std::vector<std::uint64_t>& of_layer = gofs.back().layer_bytes;
    of_layer.resize(std::max<std::size_t>(of_layer.size(), unit.temporal_layer_idx));
    of_layer[unit.temporal_layer_idx - 1] += bytes.size();
  }
  const std::vector<GofSpan> parts = equal_spans(span.count, span.num_gofs);
  for (std::size_t g = 0; g < gofs.size(); ++g) gofs[g].num_frames = parts[g].count;
  return gofs;
}

}  // namespace rlpc
