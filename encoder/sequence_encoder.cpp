#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "common/coded_mesh.h"
#include "common/crc32.h"
#include "common/layers.h"
#include "common/topology.h"
#include "encoder/check_settings.h"
#include "encoder/det_math.h"
#include "encoder/gof_cuts.h"
#include "encoder/gof_search.h"
#include "encoder/grid_choice.h"
#include "encoder/grid_value.h"
#include "encoder/main_gof_search.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/target_search.h"
#include "encoder/write_connectivity.h"
#include "encoder/write_stream.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kDefaultGofFrames = 128;
// Searches keep the analyses of all GOFs if their frames take no more than this many bytes.
constexpr std::uint64_t kKeepBytes = std::uint64_t{1} << 30;
// Below this number of GOFs, an index saves nothing.
constexpr std::size_t kMinIndexedGofs = 16;
constexpr std::uint64_t kMaxIndexedBytes = 0xFFFFFFFE;  // of index_gof_bytes

// One encoding of the whole sequence.
struct SequenceTrial {
  std::vector<std::vector<std::uint8_t>> gof_units;  // GOF and hash units, GOF by GOF
  std::uint64_t gof_bytes = 0;
  std::uint64_t hash_bytes = 0;
  std::uint32_t clusters = 0;
  std::uint32_t components = 0;
  Metrics metrics;
};

class SequenceEncoder {
 public:
  SequenceEncoder(FrameSource& source, const EncoderSettings& settings,
                  const Progress& progress)
      : source_(source), settings_(settings), progress_(progress) {}

  InputResult<EncodeReport> run(const ByteSink& sink);

 private:
  struct GofState {
    GofFrames frames;
    std::unique_ptr<GofCoder> coder;
    std::optional<GofChoice> choice;  // of the Baseline profile
    MainChoice main;                  // of the Main profile
  };

  std::optional<InputError> prepare();
  std::optional<InputError> cut_gofs(std::uint32_t longest);
  TargetSearch first_search() const;
  std::optional<InputError> set_level();
  std::optional<InputError> raise_level(const GofSpan& span, const EncodedGof& encoded);
  void make_coder(std::size_t g);
  std::optional<InputError> load(std::size_t g);
  InputResult<SequenceTrial> encode_at(double step, double analysis_step);
  std::optional<InputError> encode_gof(std::size_t g, double step, double analysis_step,
                                       SequenceTrial& trial, MetricsAccumulator& metrics);
  std::optional<InputError> measure(const GofSpan& span, const EncodedGof& encoded,
                                    SequenceTrial& trial, MetricsAccumulator& metrics);
  double measured(const SequenceTrial& trial) const;
  std::uint64_t total_bytes(const SequenceTrial& trial) const;
  InputResult<EncodeReport> write(const SequenceTrial& trial, double step,
                                  const ByteSink& sink);

  FrameSource& source_;
  const EncoderSettings& settings_;
  const Progress& progress_;
  SequenceHeader header_;
  ConnectivityCode connectivity_;
  Topology topology_;
  std::optional<EncodingContext> context_;
  VertexLayers layers_;  // of the Main profile
  std::optional<BoneContext> bone_context_;
  double rms_spread_ = 0.0;  // grid steps, per coordinate
  std::vector<GofSpan> spans_;
  std::vector<GofState> gofs_;
  bool keep_coders_ = false;
  std::uint32_t trials_ = 0;
  std::vector<std::vector<std::uint8_t>> lead_;  // units before the first GOF
};

std::optional<InputError> SequenceEncoder::prepare() {
  header_.profile_idc = settings_.profile == Profile::kMain ? kProfileMain : kProfileBaseline;
  header_.num_vertices = source_.num_vertices();
  header_.num_triangles = static_cast<std::uint32_t>(source_.triangles().size());
  header_.num_frames = source_.num_frames();
  header_.frame_rate = source_.frame_rate();
  const auto extent = measure_extent(source_);
  if (!extent) return extent.error();
  // A rate may allow any error, so that the grid is as fine as it can be.
  double finest = 0.0;
  if (settings_.target.kind == Target::kKg) {
    finest = extent->rms_spread * settings_.target.value / 100.0;
  } else if (settings_.target.kind == Target::kMaxError) {
    finest = settings_.target.value;
  } else if (settings_.target.kind == Target::kBpvf) {
    finest = std::numeric_limits<double>::min();
  }
  const auto grid = choose_grid(*extent, finest);
  header_.grid = grid.grid;
  header_.position_bits = grid.position_bits;
  rms_spread_ = extent->rms_spread * exact_exp2(-header_.grid.log2_step);

  const std::uint32_t longest =
      settings_.gof_frames == 0 ? kDefaultGofFrames : settings_.gof_frames;
  if (auto error = cut_gofs(longest)) return error;
  if (auto error = set_level()) return error;
  gofs_.resize(spans_.size());
  keep_coders_ = std::uint64_t{header_.num_vertices} * header_.num_frames * 24 <= kKeepBytes;

  connectivity_ = write_connectivity(header_.num_vertices, source_.triangles());
  topology_ = make_topology(header_.num_vertices, connectivity_.triangles);
  context_.emplace(EncodingContext{header_, topology_, connectivity_.triangles});
  if (header_.profile_idc == kProfileMain) {
    layers_ = make_layers(header_.num_vertices, connectivity_.triangles);
    bone_context_.emplace(BoneContext{{}, connectivity_.triangles, header_.position_bits});
    for (const Prediction prediction : {Prediction::kNone, Prediction::kParallelogram,
                                        Prediction::kParallelograms, Prediction::kLayers}) {
      bone_context_->meshes.emplace_back(prediction, topology_, layers_);
    }
  }
  lead_.push_back(write_stream_header(header_.profile_idc));
  lead_.push_back(write_unit(UnitType::kSequenceHeader, write_sequence_header(header_)));
  if (!settings_.metadata.empty()) {
    lead_.push_back(write_unit(UnitType::kMetadata, write_metadata(settings_.metadata)));
  }
  lead_.push_back(write_unit(UnitType::kConnectivity, connectivity_.payload));
  if (settings_.keep_order) {
    lead_.push_back(
        write_unit(UnitType::kVertexOrder, write_vertex_order(connectivity_.input_vertex)));
  }
  return std::nullopt;
}

// By expected cost where there is time for it, and a step to expect.
std::optional<InputError> SequenceEncoder::cut_gofs(std::uint32_t longest) {
  if (header_.num_frames > kMaxFrames) {
    return InputError{"a sequence has at most " + std::to_string(kMaxFrames) +
                      " frames (specification, Annex B), not " +
                      std::to_string(header_.num_frames) + "; split it"};
  }
  if (header_.profile_idc != kProfileMain || settings_.preset == Preset::kFast) {
    spans_ = equal_gofs(header_.num_frames, longest);
    return std::nullopt;
  }
  auto spans = cheapest_gofs(source_, longest,
                             first_search().step() * exact_exp2(header_.grid.log2_step));
  if (!spans) return spans.error();
  spans_ = std::move(*spans);
  return std::nullopt;
}

TargetSearch SequenceEncoder::first_search() const {
  double step_of_error = 6.0;
  if (header_.profile_idc == kProfileMain && settings_.target.kind == Target::kKg) {
    // At larger errors more components are left out, which err less than coded ones would.
    constexpr double kUsualError = 0.1;  // per cent
    step_of_error = 9.0 * det_exp2(0.2 * det_log2(settings_.target.value / kUsualError));
  }
  return {settings_.target, rms_spread_, exact_exp2(-header_.grid.log2_step), step_of_error};
}

// The lowest level that allows this sequence.
std::optional<InputError> SequenceEncoder::set_level() {
  std::uint32_t longest = 0;
  for (const GofSpan& span : spans_) longest = std::max(longest, span.count);
  for (header_.level_idc = 1; header_.level_idc <= kMaxLevelIdc; ++header_.level_idc) {
    const Level& level = header_.level();
    if (header_.num_vertices <= level.max_vertices &&
        header_.num_triangles <= level.max_triangles && longest <= level.max_gof_frames &&
        std::max(settings_.baseline.clusters, settings_.main.bones) <= level.max_clusters &&
        settings_.components <= level.max_components &&
        std::uint64_t{longest} * header_.num_vertices <= level.max_gof_values) {
      return std::nullopt;
    }
  }
  return InputError{"no level allows " + std::to_string(header_.num_vertices) + " vertices, " +
                    std::to_string(header_.num_triangles) + " triangles and GOFs of " +
                    std::to_string(longest) +
                    " frames (specification, Annex B); use a smaller --gof, or split the mesh"};
}

// The frames of a GOF, in decoded vertex order and grid units.
std::optional<InputError> SequenceEncoder::load(std::size_t g) {
  GofState& state = gofs_[g];
  const std::uint32_t n = header_.num_vertices;
  state.frames = {n, spans_[g].count,
                  std::vector<double>(std::size_t{n} * spans_[g].count * 3)};
  std::vector<float> input(std::size_t{n} * 3);
  const double per_step = exact_exp2(-header_.grid.log2_step);
  double* out = state.frames.xyz.data();
  for (std::uint32_t f = 0; f < spans_[g].count; ++f) {
    if (auto error = source_.read_frame(spans_[g].first + f, input)) return error;
    for (std::uint32_t v = 0; v < n; ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = input[3 * std::size_t{connectivity_.input_vertex[v]} + c];
        *out++ = x * per_step - header_.grid.origin[c];
      }
    }
  }
  return std::nullopt;
}

// What an earlier coder of the same GOF has chosen holds.
void SequenceEncoder::make_coder(std::size_t g) {
  GofState& state = gofs_[g];
  if (header_.profile_idc == kProfileMain) {
    state.coder = std::make_unique<MainGofSearch>(*bone_context_, *context_, state.frames,
                                                  spans_[g].first, settings_, state.main);
  } else {
    state.coder = std::make_unique<GofSearch>(*context_, state.frames, spans_[g].first,
                                              settings_, state.choice);
  }
}

// Raises the level where a coded GOF needs more than set_level( ) could foresee.
std::optional<InputError> SequenceEncoder::raise_level(const GofSpan& span,
                                                       const EncodedGof& encoded) {
  std::size_t bytes = 0;  // of the largest unit
  for (const auto& unit : encoded.units) bytes = std::max(bytes, unit.payload.size());
  for (std::uint32_t level_idc = header_.level_idc; level_idc <= kMaxLevelIdc; ++level_idc) {
    const Level& level = kLevels[level_idc - 1];
    if (encoded.num_factors > level.max_gof_factors || bytes > level.max_unit_bytes ||
        encoded.clusters > level.max_clusters ||
        encoded.most_components > level.max_components) {
      continue;
    }
    header_.level_idc = level_idc;
    return std::nullopt;
  }
  return InputError{"a GOF of " + std::to_string(span.count) + " frames has " +
                    std::to_string(encoded.num_factors) + " factors and units of " +
                    std::to_string(bytes) +
                    " bytes, more than any level allows (specification, Annex B); use a " +
                    "smaller --gof or fewer --components"};
}

// Decodes what was written, as a decoder would, and compares with the input.
std::optional<InputError> SequenceEncoder::measure(const GofSpan& span,
                                                   const EncodedGof& encoded,
                                                   SequenceTrial& trial,
                                                   MetricsAccumulator& metrics) {
  const std::size_t values = std::size_t{header_.num_vertices} * 3;
  std::vector<std::int32_t> positions(values);
  std::vector<float> original(values);
  std::vector<float> decoded(values);
  std::vector<std::uint32_t> crc;
  for (std::uint32_t f = 0; f < span.count; ++f) {
    encoded.frame(f, positions);
    if (settings_.hash_mode == HashMode::kFrame || crc.empty()) {
      crc.push_back(crc32_of_positions(positions));
    } else {
      crc.back() = crc32_of_positions(positions, crc.back());
    }
    if (auto error = source_.read_frame(span.first + f, original)) return error;
    for (std::size_t v = 0; v < header_.num_vertices; ++v) {
      const std::size_t to = 3 * std::size_t{connectivity_.input_vertex[v]};
      for (std::size_t c = 0; c < 3; ++c) {
        decoded[to + c] = grid_value(header_.grid, c, positions[3 * v + c]);
      }
    }
    metrics.add_frame(original, decoded);
  }
  if (settings_.hash_mode != HashMode::kNone) {
    const auto unit = write_unit(UnitType::kGofHash,
                                 write_gof_hash(crc, settings_.hash_mode == HashMode::kFrame));
    trial.hash_bytes += unit.size();
    auto& units = trial.gof_units.back();
    units.insert(units.end(), unit.begin(), unit.end());
  }
  return std::nullopt;
}

std::optional<InputError> SequenceEncoder::encode_gof(std::size_t g, double step,
                                                      double analysis_step,
                                                      SequenceTrial& trial,
                                                      MetricsAccumulator& metrics) {
  GofState& state = gofs_[g];
  const bool needed = !state.coder || state.coder->needs_frames(step, analysis_step);
  if (needed && state.frames.xyz.empty()) {
    if (auto error = load(g)) return error;
  }
  if (!state.coder) make_coder(g);
  const EncodedGof encoded = state.coder->encode(step, analysis_step);
  if (!keep_coders_) state.coder.reset();
  if (!keep_coders_ || !state.coder->needs_frames(step, analysis_step)) state.frames = {};
  if (auto error = raise_level(spans_[g], encoded)) return error;
  Bytes units;
  for (const auto& unit : encoded.units) {
    const Bytes bytes = write_unit(unit.type, unit.payload);
    units.insert(units.end(), bytes.begin(), bytes.end());
  }
  trial.gof_bytes += units.size();
  trial.gof_units.push_back(std::move(units));
  trial.clusters += encoded.clusters;
  trial.components += encoded.components;
  return measure(spans_[g], encoded, trial, metrics);
}

InputResult<SequenceTrial> SequenceEncoder::encode_at(double step, double analysis_step) {
  ++trials_;
  SequenceTrial trial;
  MetricsAccumulator metrics(header_.num_vertices);
  for (std::size_t g = 0; g < spans_.size(); ++g) {
    if (auto error = encode_gof(g, step, analysis_step, trial, metrics)) return *error;
    if (progress_) {
      // A search converges: each trial is worth half of what is left.
      const double within = static_cast<double>(g + 1) / static_cast<double>(spans_.size());
      progress_(settings_.target.kind == Target::kNone
                    ? within
                    : 1.0 - exact_exp2(-static_cast<int>(trials_)) * (2.0 - within));
    }
  }
  trial.metrics = metrics.result();
  return trial;
}

std::uint64_t SequenceEncoder::total_bytes(const SequenceTrial& trial) const {
  std::uint64_t bytes = trial.gof_bytes + trial.hash_bytes;
  for (const auto& unit : lead_) bytes += unit.size();
  bytes += write_unit(UnitType::kEndOfSequence, write_end_of_sequence(0)).size();
  return bytes;
}

double SequenceEncoder::measured(const SequenceTrial& trial) const {
  switch (settings_.target.kind) {
    case Target::kKg:
      return trial.metrics.kg_error_percent;
    case Target::kMaxError:
      return trial.metrics.max_error;
    case Target::kBpvf:
      return bits_per_vertex_per_frame(total_bytes(trial), header_.num_vertices,
                                       header_.num_frames);
    case Target::kNone:
      break;
  }
  return 0.0;
}

InputResult<EncodeReport> SequenceEncoder::write(const SequenceTrial& trial, double step,
                                                 const ByteSink& sink) {
  EncodeReport report;
  const auto put = [&](std::span<const std::uint8_t> bytes) {
    report.bytes += bytes.size();
    return sink(bytes);
  };
  lead_[1] = write_unit(UnitType::kSequenceHeader, write_sequence_header(header_));
  bool ok = true;
  for (const auto& unit : lead_) ok = ok && put(unit);
  const std::uint64_t first_gof = report.bytes;
  std::vector<GofEntry> index;
  for (std::size_t g = 0; g < trial.gof_units.size(); ++g) {
    ok = ok && put(trial.gof_units[g]);
    index.push_back({spans_[g].count, trial.gof_units[g].size()});
  }
  std::uint32_t index_distance = 0;
  if (index.size() >= kMinIndexedGofs && report.bytes <= kMaxIndexedBytes) {
    const Bytes unit = write_unit(UnitType::kGofIndex, write_gof_index(first_gof, index));
    index_distance = static_cast<std::uint32_t>(unit.size());
    ok = ok && put(unit);
  }
  ok = ok && put(write_unit(UnitType::kEndOfSequence, write_end_of_sequence(index_distance)));
  if (!ok) return InputError{"the stream could not be written"};

  report.header = header_;
  report.metrics = trial.metrics;
  report.bpvf =
      bits_per_vertex_per_frame(report.bytes, header_.num_vertices, header_.num_frames);
  report.bits.gofs = 8 * trial.gof_bytes;
  report.bits.hashes = 8 * trial.hash_bytes;
  const std::uint64_t unit_overhead = kUnitHeaderBytes + kUnitCrcBytes;
  report.bits.connectivity = 8 * (connectivity_.payload.size() + unit_overhead);
  if (settings_.keep_order) report.bits.vertex_order = 8 * lead_.back().size();
  if (!settings_.metadata.empty()) report.bits.metadata = 8 * lead_[2].size();
  report.bits.headers = 8 * report.bytes - report.bits.gofs - report.bits.hashes -
                        report.bits.connectivity - report.bits.vertex_order -
                        report.bits.metadata;
  report.num_gofs = static_cast<std::uint32_t>(spans_.size());
  report.clusters = trial.clusters;
  report.components = trial.components;
  if (settings_.baseline.qu == 0) report.step = step * exact_exp2(header_.grid.log2_step);
  report.trials = trials_;
  report.input_vertex = connectivity_.input_vertex;
  return report;
}

InputResult<EncodeReport> SequenceEncoder::run(const ByteSink& sink) {
  if (auto error = prepare()) return *error;
  TargetSearch search = first_search();
  std::optional<SequenceTrial> best;
  double best_step = search.step();
  for (;;) {
    auto trial = encode_at(search.step(), search.analysis_step());
    if (!trial) return trial.error();
    const bool better = search.report(measured(*trial));
    if (better || !best) {
      best = std::move(*trial);
      best_step = search.last_step();
    }
    if (search.finished()) break;
  }
  auto report = write(*best, best_step, sink);
  if (report) report->target_met = search.met();
  if (report && progress_) progress_(1.0);
  return report;
}

}  // namespace

InputResult<EncodeReport> encode(FrameSource& source, const EncoderSettings& settings,
                                 const ByteSink& sink, const Progress& progress) {
  if (auto error = check_settings(settings)) return *error;
  return SequenceEncoder(source, settings, progress).run(sink);
}

}  // namespace rlpc
