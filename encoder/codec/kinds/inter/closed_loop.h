// Codes an inter GOF (6.14, 8.19): frame by frame, layer by layer, in closed loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/inter/recon/inter_recon.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/inter/patch_search.h"
#include "encoder/codec/rest/rest_coding.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/write/write_inter_gof.h"

namespace rlpc {

// Size at which a frame unit ends: it has so many frames or bytes. It also ends after the first
// frame of a GOF and, in an open-ended stream, before a frame of another temporal layer.
struct UnitLimits {
  std::uint32_t frames = 1;
  std::size_t bytes = 0;
};

// How the residual of a coordinate is chosen.
enum class ResidualRule : std::uint8_t {
  kNearest,     // rounded to nearest
  kCheapest,    // by rate and distortion
  kFollowRing,  // by rate and distortion, following the errors of the ring
};

// Codes one frame after the other. Needs the memory of a decoder, and of the predictions of two
// layers. Vertices of a layer are predicted, and adapt, on several threads.
class ClosedLoop {
 public:
  // The mesh must have layers; mesh and settings must outlive it. num_frames: length of the
  // GOF. rule: not used if positions are exact.
  ClosedLoop(const OrderedMesh& mesh, const InterSettings& settings,
             const SequenceHeader& header, std::uint32_t num_frames,
             const UnitLimits& limits = {}, ResidualRule rule = ResidualRule::kCheapest);

  // Return the frame that comes next in coding order, and the one so many places before it.
  const FramePlace& next_place() const { return order_[recon_.place()]; }
  std::uint32_t frame_before(std::uint32_t distance) const {
    return order_[recon_.place() - distance].frame;
  }
  // Sets frame_step_delta of the next frames but the first, if the settings have it.
  void set_step_delta(std::int32_t delta) { step_delta_ = delta; }
  // Codes the next frame; xyz [num_vertices][3], in grid units, unrounded. Returns the frame
  // units that end with it, and writes its positions as a decoder outputs them. coded: unless
  // null, set to the frame as a parser would return it. distance: unless 0, the frame is
  // predicted from the one so many places before, at most max_earlier_distance, whose temporal
  // layer must not be higher.
  std::vector<EncodedSpan::Unit> code(std::span<const double> xyz,
                                      std::span<std::int32_t> positions,
                                      InterFrame* coded = nullptr, std::uint32_t distance = 0);
  // Codes the first frame in an order of its own, which the settings must have.
  std::vector<EncodedSpan::Unit> code_in_order(const RestEncoding& first,
                                               std::span<std::int32_t> positions,
                                               InterFrame* coded = nullptr);
  // Repeats the frame so many places before, under the same conditions.
  std::vector<EncodedSpan::Unit> repeat(std::uint32_t distance,
                                        std::span<std::int32_t> positions,
                                        InterFrame* coded = nullptr);
  // Returns the bytes of the frame units that have not ended.
  std::size_t unit_bytes() const;

 private:
  // The vertices of a layer, with their predictions.
  struct Layer {
    std::span<const std::uint32_t> vertices;
    std::vector<VertexMotion> motions;
    std::vector<std::uint16_t> expected;
  };

  void predict(Layer& layer, std::uint32_t index);
  // Sets the position of a vertex. original: its three coordinates, grid units.
  void set(std::uint32_t v, VertexMotion& motion, const Vec3i& position,
           const double* original);
  // Returns what is added to a coordinate before its residual is chosen (kRingError).
  double feedback(std::uint32_t v, std::size_t coordinate, std::uint32_t expected) const;
  void choose(Layer& layer, std::span<const double> xyz, InterFrame* coded);
  void adapt(Layer& layer, std::size_t first, std::size_t end);
  // Ends the unit if necessary; called after a frame, or after each of several layer groups.
  std::vector<EncodedSpan::Unit> end_units(std::uint32_t number);

  const OrderedMesh& mesh_;
  const InterSettings& settings_;
  UnitLimits limits_;
  bool is_open_ended_;
  ResidualRule rule_;
  std::int32_t step_delta_ = 0;
  FrameOrder order_;
  InterRecon recon_;
  FrameUnitWriter writer_;
  std::optional<PatchSearch> patch_search_;  // none without patches
  FramePatches patches_;                     // patches of the frame
  std::vector<double> errors_;  // [vertex][3] in this frame, grid units; empty: no feedback
  Layer layers_[2];             // one adapts while residuals of the other are chosen
};

}  // namespace rlpc
