// RLPC encoder: the public interface.
//
//   rlpc::EncoderSettings settings;
//   settings.target = {rlpc::Target::kKg, 0.1};
//   const auto report = rlpc::encode(source, settings, [&](auto bytes) { return write(bytes);
//   }); if (!report) return complain(report.error().message);
//
// The same input and settings give the same bytes on every compiler and machine. Memory is that
// of the raw GOFs being searched over; frames are read from the source as often as needed.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/mesh.h"
#include "common/skinned_gof/skinned_gof.h"
#include "common/syntax/sequence_header.h"
#include "encoder/input/frame_source.h"
#include "encoder/metrics/metrics.h"

namespace rlpc {

// In which coordinates clusters are analysed; kAuto compares.
enum class FrameMode : std::uint8_t { kAuto, kLcf, kWorld };

// Which three vertices carry a local frame: a triangle of the mesh, as in the paper, or
// vertices spread over the cluster. kAuto: triangles with qu and qc, else spread.
enum class SeedMode : std::uint8_t { kAuto, kTriangle, kSpread };

// How hard the encoder searches. The syntax is the same.
enum class Preset : std::uint8_t { kFast, kMedium, kSlow };

// Which tools a stream uses; Main needs decoders of version 1.1.
enum class Profile : std::uint8_t { kBaseline, kMain };

// Parameters that only the Baseline profile has.
struct BaselineTools {
  std::uint32_t clusters = 0;    // N of the paper; 0: chosen for each GOF
  bool rdo = true;               // components go to clusters by rate and distortion
  bool rate_in_vectors = false;  // as the paper counts it; else in estimated bits
  int qu = 0;  // bits of eigenshapes, coefficients and seed positions relative to
  int qc = 0;  // their ranges, as in the paper; 0: steps of equal distortion
  int qdelta = 0;
  FrameMode frame_mode = FrameMode::kAuto;
  SeedMode seed_mode = SeedMode::kAuto;
};

// Parameters that only the Main profile has; each tool can be left out, for comparison.
struct MainTools {
  std::uint32_t bones = 0;               // of a GOF; 0: chosen
  std::optional<Prediction> prediction;  // of spatial factors; none: chosen
  std::uint32_t influences = 0;          // most bones of a vertex, 1 to 4; 0: chosen
  bool geometry_weights = true;          // in the prediction by layers
  bool outer_ring = true;                // likewise
  bool layer_steps = true;               // finer steps in coarser layers
  bool temporal_weights = true;          // transmitted ones, beside the four fixed predictors
  bool cobra_steps = false;  // of basis vectors: those of Vasa and Skala 2009, (18), (19)
  // Cluster GOFs where they cost less. They have none of the tools above, and no slices: if
  // anything here is not as by default, all GOFs are of bones.
  bool clusters = true;
  std::uint32_t component_groups = 0;  // slices: 0 for the default
  std::uint32_t layer_groups = 0;

  bool operator==(const MainTools&) const = default;
};

enum class HashMode : std::uint8_t { kNone, kGof, kFrame };

// What the settings of the quantisers are searched for.
struct Target {
  enum Kind : std::uint8_t {
    kNone,  // quantisers as given
    kKg,    // KG error in per cent: reached from below, within 2 %
    kBpvf,  // bits per vertex and frame: likewise
    // Largest distance of a vertex from its original, in units: likewise, or as close as was
    // found where it jumps, or less where that saves bytes.
    kMaxError,
  };
  Kind kind = kKg;
  double value = 0.1;  // above zero and finite
};

struct EncoderSettings {
  static constexpr std::uint32_t kWholeSequence = std::numeric_limits<std::uint32_t>::max();

  Profile profile = Profile::kMain;
  Target target;
  Preset preset = Preset::kMedium;
  // Per cluster (L of the paper) or, of the Main profile, per GOF; 0: by rate and distortion.
  std::uint32_t components = 0;
  BaselineTools baseline;        // as by default unless profile is kBaseline
  MainTools main;                // as by default unless it is kMain
  std::uint32_t gof_frames = 0;  // longest GOF; 0: the default; kWholeSequence: one GOF
  bool keep_order = false;       // restore the vertex order of the input
  HashMode hash_mode = HashMode::kGof;
  std::string metadata;  // JSON text for a metadata unit; empty: none
  // What needs more is an error before it is begun. Estimated, for animations that compress
  // badly; with what the source keeps.
  std::uint64_t max_memory_bytes = kUsualEncoderBytes;
};

// Bits of the stream by what they are for.
struct PartBits {
  std::uint64_t headers = 0;  // signature, unit headers and CRCs, sequence header, end
  std::uint64_t connectivity = 0;
  std::uint64_t vertex_order = 0;
  std::uint64_t gofs = 0;
  std::uint64_t hashes = 0;
  std::uint64_t metadata = 0;
};

struct EncodeReport {
  SequenceHeader header;
  Metrics metrics;  // of the decoded float32 positions, in input vertex order
  std::uint64_t bytes = 0;
  double bpvf = 0.0;
  PartBits bits;
  std::uint32_t num_gofs = 0;
  std::uint32_t clusters = 0;  // or bones, over all GOFs
  std::uint32_t components = 0;
  double step = 0.0;         // units; 0 with qu and qc
  std::uint32_t trials = 0;  // encodings made in search of the target
  bool target_met = true;
  std::vector<std::uint32_t> input_vertex;  // per decoded vertex, its index in the input
};

// Takes the next bytes of the stream; false stops the encoder (disk full, for example).
using ByteSink = std::function<bool(std::span<const std::uint8_t>)>;
// Called now and then with the fraction done, 0 to 1, for people who wait.
using Progress = std::function<void(double)>;

// Encodes a whole sequence. Errors: what the source reports; what no level allows; settings
// that contradict each other, or that the profile does not have; a sink that failed.
InputResult<EncodeReport> encode(FrameSource& source, const EncoderSettings& settings,
                                 const ByteSink& sink, const Progress& progress = {});

}  // namespace rlpc
