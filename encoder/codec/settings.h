// What callers of the encoder choose.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/clip.h"
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

// How the distances that a vertex moves between frames, in the coordinates of a seed, add up:
// themselves, or their squares. kAuto: if qu and qc are set, the cheaper of the two for each
// GOF, else squares.
enum class MotionMeasure : std::uint8_t { kAuto, kSquared, kPlain };

// How vertices are divided into clusters. kSeeds: by their motion relative to seeds, as in the
// RLPCA paper. The others make the parts first, and then choose a seed for each: parts of equal
// size with few edges between them; parts of near vertices; parts that meet where the surface
// is concave; parts of affine motion.
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
  // Bits relative to the range of values, as in the paper; 0: steps of equal distortion. qu and
  // qc must be set together, with Target::kNone and a number of components.
  int qu = 0;      // eigenshapes, up to 20
  int qc = 0;      // coefficients, up to 20
  int qdelta = 0;  // seed positions, up to 24; of the mean bounding box of the GOF's frames
  FrameMode frame_mode = FrameMode::kAuto;
  SeedMode seed_mode = SeedMode::kAuto;
  PartitionMethod partition = PartitionMethod::kSeeds;
  MotionMeasure motion = MotionMeasure::kAuto;  // of kSeeds
};

// How rest positions, and first frames of inter GOFs, may be coded: as the other values, in
// an order of their own (8.18), or that with counterparts. Each includes those before it.
enum class RestTools : std::uint8_t { kPrediction, kOrder, kCounterparts };

// Parameters of the Main and High profiles. Each tool can be disabled, for comparison.
struct MainTools {
  std::uint32_t bones = 0;               // maximum per GOF, up to 1024; 0: chosen
  std::optional<Prediction> prediction;  // of spatial factors; none: chosen
  std::uint32_t influences = 0;          // maximum bones per vertex, 1 to 4; 0: chosen
  bool geometry_weights = true;          // geometry weights in Prediction::kLayers
  bool outer_ring = true;                // outer rings in Prediction::kLayers
  bool layer_steps = true;               // finer quantiser steps in coarser layers
  bool temporal_weights = true;  // transmitted weights besides the four fixed predictors
  // High profile: trajectories whose factors adapt the weights of prediction; none: all.
  std::optional<std::uint32_t> adaptive_factors;
  std::optional<RestTools> rest;  // High profile: at most; none: kCounterparts
  // High profile: levels of hierarchical tracks besides level 0, 0 to 7; none: 1.
  std::optional<std::uint32_t> track_levels;
  // High profile: temporal layers of each GOF, 1 to 8, to which a stream can be cut; at most
  // one more than there are track_levels, which are as many as that takes if they are none.
  std::uint32_t temporal_layers = 1;
  bool cobra_steps = false;  // temporal steps of Vasa and Skala 2009, (18), (19)
  // Code GOFs as clusters if that costs less. Cluster GOFs have no slices and none of the tools
  // above; if any member of this structure differs from its default, all GOFs are skinned.
  bool clusters = true;
  std::uint32_t component_groups = 0;  // groups of trajectories for slices; 0: by size
  std::uint32_t layer_groups = 0;      // groups of vertex layers for slices; 0: by size

  bool operator==(const MainTools&) const = default;
};

// Kinds of GOF that the encoder chooses from. kAuto: all that profile and settings allow, the
// cheapest for each GOF.
enum class KindChoice : std::uint8_t { kAuto, kCluster, kSkinned, kInter };

// Weights with which a vertex of an inter GOF is predicted from others: learned from the
// frames before; those of 8.11, from the first frame; or equal ones for its ring, as in
// Stefanoski et al. 2007.
enum class InterWeights : std::uint8_t { kLearned, kGeometry, kPlain };

// Parameters of inter GOFs, of the High profile.
struct InterTools {
  // From which frames each is predicted; none: the cheapest of several patterns, for each GOF.
  // FramePattern::temporal_layers is not used.
  std::optional<FramePattern> pattern;
  std::uint32_t temporal_layers = 1;  // to which a stream can be cut, 1 to 8
  InterWeights weights = InterWeights::kLearned;
  std::uint32_t layer_groups = 1;  // groups of vertex layers to which a stream can be cut
  // Parts of the mesh that can each move by one affine motion in a frame, up to 1024; 0: none;
  // not given: the cheapest of several numbers, for each GOF.
  std::optional<std::uint32_t> patches;
  PartitionMethod partition = PartitionMethod::kMotion;  // what makes patches; not kSeeds
  std::optional<RestTools> rest;  // of the first frame of a GOF; at most; none: kCounterparts
  // Frames that share a frame unit, at most; not given: some 4 kB of them, one if frames are
  // written as they come. Frames of several layer groups share none.
  std::optional<std::uint32_t> frames_per_unit;

  bool operator==(const InterTools&) const = default;
};

// Hashes of decoded positions in the stream: none, one per GOF, one per frame.
enum class HashMode : std::uint8_t { kNone, kGof, kFrame };

// The error or rate that the encoder aims for. It stays at most 2 % below, if possible, or with
// a KG error in the High profile, 4 %; and exceeds the target only if that cannot be met
// (EncodeReport::target_met).
struct Target {
  enum Kind : std::uint8_t {
    kNone,  // no search; quantisers as set
    kKg,    // KG error in per cent
    kBpvf,  // bits per vertex per frame
    // Maximum distance of a vertex from its original, in units. May end further below the
    // target, as this error jumps with the quantiser step, or if that saves bytes.
    kMaxError,
    // Positions without loss, in the High profile: on a grid of `value` bits, 2 to 24, for the
    // largest extent of the bounding box; 0: on the coarsest grid that all coordinates lie on.
    kLossless,
  };
  Kind kind = kKg;
  double value = 0.1;  // above zero and finite, but for kNone and kLossless

  // Whether a quantiser step has to be searched for.
  bool has_search() const { return kind != kNone && kind != kLossless; }
};

inline constexpr std::uint32_t kMaxEncoderThreads = 256;  // fixed: a guard

struct EncoderSettings {
  static constexpr std::uint32_t kWholeSequence = std::numeric_limits<std::uint32_t>::max();

  Profile profile = Profile::kMain;
  Target target;
  Preset preset = Preset::kMedium;
  // Baseline: average per cluster (L of the paper). Main: maximum per GOF. Up to 1024; 0:
  // chosen by rate and distortion.
  std::uint32_t components = 0;
  BaselineTools baseline;  // must be left at its defaults unless profile is kBaseline
  MainTools main;          // must be left at its defaults if profile is kBaseline
  // kSkinned: Main and High profile; kInter: High profile, main left at its defaults.
  KindChoice kinds = KindChoice::kAuto;
  // FrameEncoder only: codes and passes on each frame when it is added. High profile, all GOFs
  // are of frames that are predicted from the one before; the target is a KG error, a maximum
  // error or lossless, and is not searched for.
  bool low_delay = false;
  InterTools inter;  // must be left at its defaults unless profile is kHigh
  // Maximum frames per GOF; 0: 128; 256 in the High profile; in the Main profile up to 4096
  // (fewer for large meshes) with several clips and, in encode(), where long GOFs cost less;
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
  // Of the attributes that the source has.
  AttributeSettings attributes;
  // Encodings that may need more memory fail before they start. The estimate is for animations
  // that compress badly, and includes the memory held by the source.
  std::uint64_t max_memory_bytes = kUsualEncoderBytes;
  // Threads, including the caller's; the stream does not depend on it. Each needs memory for a
  // GOF: fewer are used where that would exceed max_memory_bytes. Clamped to 1 to
  // kMaxEncoderThreads.
  std::uint32_t threads = 1;
  // Holds the whole stream against the rules of the specification before it is passed on, which
  // takes as long as to decode it. Attributes, assets, metadata and clips are checked anyway.
#ifdef NDEBUG
  bool check_rules = false;
#else
  bool check_rules = true;
#endif

  // Temporal layers that the stream can be cut to.
  std::uint32_t temporal_layers() const {
    return usable_kinds() == KindChoice::kInter ? inter.temporal_layers : main.temporal_layers;
  }
  // Whether cut points were asked for at which a cut changes the first frame.
  bool has_detail_layers() const {
    return main.component_groups > 1 || main.layer_groups > 1 || inter.layer_groups > 1;
  }
  // The kinds of GOF that the target leaves.
  KindChoice usable_kinds() const {
    return low_delay || target.kind == Target::kLossless ? KindChoice::kInter : kinds;
  }
};

}  // namespace rlpc
