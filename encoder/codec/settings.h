// Settings that callers of the encoder choose.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/clip.h"
#include "common/codec/syntax/gof_header.h"
#include "encoder/codec/attributes/attribute_settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Coordinates in which clusters are analysed. kAuto: the cheaper of the two for each GOF.
enum class FrameMode : std::uint8_t { kAuto, kLcf, kWorld };

// The three vertices that define a local coordinate frame: a triangle of the mesh, as in the
// paper, or distant vertices of the cluster. kTriangle: of the triangles at a vertex, the one
// with the most stable frame. kFirst: the first of the input. kAuto: if qu and qc are set, the
// cheapest of all three for each GOF, else distant vertices.
enum class SeedMode : std::uint8_t { kAuto, kTriangle, kSpread, kFirst };

// Measure of motion relative to a seed: the sum of the distances that a vertex moves between
// frames, in the coordinates of the seed, or of their squares. kAuto: if qu and qc are set, the
// cheaper of the two for each GOF, else squares.
enum class MotionMeasure : std::uint8_t { kAuto, kSquared, kPlain };

// Method that divides vertices into clusters. kSeeds: by their motion relative to seeds, as in
// the RLPCA paper. The others make parts first, then choose a seed for each. kKway: parts of
// equal size with few edges between them; kLloyd: parts of near vertices; kSpectral: parts that
// meet where the surface is concave; kMotion: parts of affine motion.
enum class PartitionMethod : std::uint8_t { kSeeds, kKway, kLloyd, kSpectral, kMotion };

// Search effort. Does not affect the syntax or the requirements on decoders.
enum class Preset : std::uint8_t { kFast, kMedium, kSlow };

// Profile of the stream; Main requires decoders of version 1.1, High of version 1.2, which is
// not released: its streams may change.
enum class Profile : std::uint8_t { kBaseline, kMain, kHigh };

// Parameters of the Baseline profile.
struct BaselineTools {
  std::uint32_t clusters = 0;    // per GOF, N of the paper, up to 1024; 0: chosen for each GOF
  bool rdo = true;               // allocate components to clusters by rate and distortion
  bool rate_in_vectors = false;  // the rate of rdo: vectors as in the paper, or estimated bits
  // Bits relative to the range of values, as in the paper; 0: steps of equal distortion. Set qu
  // and qc together, with Target::kNone and a number of components.
  int qu = 0;      // eigenshapes, up to 20
  int qc = 0;      // coefficients, up to 20
  int qdelta = 0;  // seed positions, up to 24; relative to the mean bounding box of a frame
  FrameMode frame_mode = FrameMode::kAuto;
  SeedMode seed_mode = SeedMode::kAuto;
  PartitionMethod partition = PartitionMethod::kSeeds;
  MotionMeasure motion = MotionMeasure::kAuto;  // used by kSeeds
};

// Coding of rest positions and of first frames of inter GOFs: in the order of other values, in
// an order of their own (8.18), or in that order with counterparts. Each includes those before
// it.
enum class RestTools : std::uint8_t { kPrediction, kOrder, kCounterparts };

// Parameters of the Main and High profiles. Each tool can be disabled, for comparison.
struct MainTools {
  std::uint32_t bones = 0;               // maximum per GOF, up to 1024; 0: chosen
  std::optional<Prediction> prediction;  // prediction of spatial factors; none: chosen
  std::uint32_t influences = 0;          // maximum bones per vertex, 1 to 4; 0: chosen
  bool geometry_weights = true;          // geometry weights in Prediction::kLayers
  bool outer_ring = true;                // outer rings in Prediction::kLayers
  bool layer_steps = true;               // finer quantiser steps in coarser layers
  bool temporal_weights = true;  // transmitted weights besides the four fixed predictors
  // High profile: number of trajectories whose factors adapt the prediction weights; none: all.
  std::optional<std::uint32_t> adaptive_factors;
  std::optional<RestTools> rest;  // High profile: tools allowed; none: kCounterparts
  // High profile: levels of hierarchical tracks besides level 0, 0 to 7; none: 1.
  std::optional<std::uint32_t> track_levels;
  // High profile: temporal layers of each GOF, to which a stream can be cut, 1 to 8; at most
  // track_levels + 1. If track_levels is none, it is as large as this needs.
  std::uint32_t temporal_layers = 1;
  bool cobra_steps = false;  // temporal steps of Vasa and Skala 2009, (18), (19)
  // Whether to code GOFs as clusters if that costs less. Cluster GOFs have no slices and none
  // of the tools above; if any member of this structure differs from its default, all GOFs are
  // skinned.
  bool clusters = true;
  std::uint32_t component_groups = 0;     // groups of trajectories for slices; 0: by size
  std::uint32_t layer_groups = 0;         // groups of vertex layers for slices; 0: by size
  std::vector<std::uint32_t> layer_cuts;  // as in InterTools

  bool operator==(const MainTools&) const = default;
};

// Weights that predict a vertex of an inter GOF from others: learned from the frames before;
// derived from the first frame (8.11); or equal for its whole ring, as in Stefanoski et al.
// 2007.
enum class InterWeights : std::uint8_t { kLearned, kGeometry, kPlain };

// Parameters of inter GOFs, of the High profile.
struct InterTools {
  // Frames that each frame is predicted from; none: for each GOF, the cheapest of several
  // patterns. FramePattern::temporal_layers is not used.
  std::optional<FramePattern> pattern;
  std::uint32_t temporal_layers = 1;  // 1 to 8; a stream can be cut to fewer
  InterWeights weights = InterWeights::kLearned;
  std::uint32_t layer_groups = 1;  // groups of vertex layers to which a stream can be cut
  // Wanted numbers of vertices up to the cuts, which the ends of layers come near: as many as
  // there are cuts, ascending, or none (from an eighth of the vertices on, by equal factors).
  std::vector<std::uint32_t> layer_cuts;
  // Number of patches, parts of the mesh that can each follow one affine motion in a frame, up
  // to 1024; 0: no patches; none: for each GOF, the cheapest of several numbers.
  std::optional<std::uint32_t> patches;
  PartitionMethod partition = PartitionMethod::kMotion;  // makes the patches; not kSeeds
  std::optional<RestTools> rest;  // tools for the first frame of a GOF; none: kCounterparts
  // Maximum number of frames in a frame unit; none: about 4 kB of frames, or one frame with low
  // delay.
  std::optional<std::uint32_t> frames_per_unit;

  bool operator==(const InterTools&) const = default;
};

// Hashes of decoded positions in the stream: none, one per GOF, one per frame.
enum class HashMode : std::uint8_t { kNone, kGof, kFrame };

// Error or rate that the encoder aims for. If possible, the result is at most 0.6 % below it,
// or 2 % if it is the largest error, or the KG error with preset fast. It exceeds the target
// only if that cannot be met (EncodeReport::target_met).
struct Target {
  enum Kind : std::uint8_t {
    kNone,  // no search; quantisers as set
    kKg,    // KG error in per cent
    kBpvf,  // bits per vertex per frame
    // Maximum distance of a vertex from its original, in units. May be further below the
    // target, as this error jumps with the quantiser step, or if that saves bytes.
    kMaxError,
    // High profile: positions without loss, on a grid of `value` bits, 2 to 24, for the largest
    // extent of the bounding box; 0: on the coarsest grid that contains all coordinates.
    kLossless,
  };
  Kind kind = kKg;
  double value = 0.1;  // above zero and finite, except for kNone and kLossless
  // kKg: a second bound, of the RMS deviation of vertex normals (vertex_normals.h), in degrees;
  // 0: none. The result comes near one of the bounds. Normals alone would not do: they do not
  // change where a part moves as a whole, or within its plane.
  double max_normals = 0.0;
  // kKg with max_normals: KG error at which the bounds are expected to be met, which encode()
  // sets; 0: not known.
  double expected_kg = 0.0;

  // Returns the KG error for which choices are made.
  double likely_kg() const { return expected_kg > 0.0 ? expected_kg : value; }
  // Whether a quantiser step has to be searched for.
  bool has_search() const { return kind != kNone && kind != kLossless; }
};

inline constexpr std::uint32_t kMaxEncoderThreads = 256;  // fixed: a guard

struct EncoderSettings {
  static constexpr std::uint32_t kWholeSequence = std::numeric_limits<std::uint32_t>::max();

  Profile profile = Profile::kMain;
  Target target;
  Preset preset = Preset::kMedium;
  // Number of components. Baseline: average per cluster (L of the paper). Main: maximum per
  // GOF. Up to 1024; 0: chosen by rate and distortion.
  std::uint32_t components = 0;
  BaselineTools baseline;  // must be left at its defaults unless profile is kBaseline
  MainTools main;          // must be left at its defaults if profile is kBaseline
  // Kind of all GOFs, one of kKindChoices (kind_choices.h); none: for each GOF, the cheapest
  // that profile and settings allow. With kInter, `main` must be left at its defaults.
  std::optional<GofKind> gof_kind;
  // FrameEncoder only: codes and passes on each frame when it is added. High profile; all GOFs
  // are inter GOFs, with each frame predicted from the one before; the target is a KG error, a
  // maximum error or lossless, and is not searched for.
  bool low_delay = false;
  InterTools inter;  // must be left at its defaults unless profile is kHigh
  // Maximum frames per GOF. 0: 128; 256 in the High profile; up to 4096 in the Main profile
  // (fewer for large meshes) with several clips or, in encode(), if long GOFs cost less.
  // kWholeSequence: one GOF.
  std::uint32_t gof_frames = 0;
  bool keep_order = false;  // restore the vertex order of the input
  HashMode hash_mode = HashMode::kGof;
  std::string metadata;  // JSON text, not validated, up to 1 MiB; empty: no metadata unit
  // Names of parts of the sequence, up to kMaxClips; empty: those of the animation, if
  // takes_from_source, otherwise no clip table. Not checked against the number of frames if
  // that is not known beforehand.
  std::vector<Clip> clips;
  // A GLB without geometry (7.16), not validated, below 2^31 bytes; empty: that of the
  // animation, if takes_from_source and attributes are not dropped, otherwise no asset unit.
  std::string asset;
  // The animation is a FrameSource, or the FrameFormat of a FrameEncoder.
  bool takes_from_source = true;
  // Settings for the attributes of the source.
  AttributeSettings attributes;
  // Encodings that may need more memory fail before they start. The estimate assumes an
  // animation that compresses badly, and includes the memory held by the source.
  std::uint64_t max_memory_bytes = kUsualEncoderBytes;
  // Threads, including the caller's; the stream does not depend on their number. Each needs
  // memory for a GOF: fewer are used where that would exceed max_memory_bytes. Clamped to 1 to
  // kMaxEncoderThreads.
  std::uint32_t threads = 1;
  // Checks the whole stream against the rules of the specification before it is passed on,
  // which takes as long as decoding it. Attributes, assets, metadata and clips are always
  // checked.
#ifdef NDEBUG
  bool check_rules = false;
#else
  bool check_rules = true;
#endif

  // Number of temporal layers that the stream can be cut to.
  std::uint32_t temporal_layers() const {
    return usable_kind() == GofKind::kInter ? inter.temporal_layers : main.temporal_layers;
  }
  // Whether the stream gets cut points at which a cut changes the first frame.
  bool has_detail_layers() const {
    return main.component_groups > 1 || main.layer_groups > 1 || inter.layer_groups > 1;
  }
  // Returns the only kind of GOF that low_delay, the target and gof_kind allow; none: several.
  std::optional<GofKind> usable_kind() const {
    return low_delay || target.kind == Target::kLossless ? GofKind::kInter : gof_kind;
  }
  bool may_use(GofKind k) const { return usable_kind().value_or(k) == k; }
};

}  // namespace rlpc
