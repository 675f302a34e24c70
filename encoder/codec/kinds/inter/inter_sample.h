// Estimates from a part of the mesh what an inter GOF takes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/codec/kinds/inter/frame_order.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/mesh/topology.h"
#include "encoder/codec/kinds/inter/trial_maker.h"
#include "encoder/codec/partition/mesh_sample.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"
#include "encoder/codec/spans/step_cache.h"

namespace rlpc {

// Codes consecutive frames of regions of the mesh. First frames take a few bits more than those
// of the whole mesh, which may be predicted from counterparts.
class InterSample {
 public:
  // What the whole GOF is expected to take.
  struct Estimate {
    InterChoice choice;  // its steps are scaled so that it errs about as much as the rival
    double ratio;        // of its bits to those of the rival
  };

  // max_vertices: maximum number of vertices of the sample; no more than half of the mesh are
  // taken. Keeps a reference to the header of the mesh.
  InterSample(const SequenceMesh& mesh, const EncoderSettings& settings,
              const SpanFrames& frames, std::uint32_t max_vertices);
  InterSample(const InterSample&) = delete;
  InterSample& operator=(const InterSample&) = delete;

  // Whether the sample is a small part of the mesh.
  static bool saves_time(std::uint32_t num_vertices);
  // Returns the maximum number of vertices of a sample that costs little.
  static std::uint32_t usual_vertices(std::uint32_t num_frames);

  std::uint32_t num_vertices() const { return frames_.num_vertices; }
  // Estimates what the cheapest choice takes; none if that is clearly more than `limit` times
  // the bits of the rival. step: as in SpanCoder::encode().
  std::optional<Estimate> cheapest_choice(double step, const SpanCost& rival, double limit);
  // Estimates what one choice takes, from steps that are `choice.step_scale` times as large.
  Estimate estimate(const InterChoice& choice, double step, const SpanCost& rival);
  // Returns the pattern that costs least without patches.
  const FramePattern& cheapest_pattern(double step);

 private:
  SpanCost whole(const InterTrial& trial) const;
  Estimate at_equal_error(std::unique_ptr<InterTrial> trial, double step,
                          const SpanCost& rival);
  bool is_far_off(InterTrial& trial, const SpanCost& rival, double limit) const;
  std::vector<InterChoice> without_patches() const;
  std::unique_ptr<InterTrial> cheapest_of(const std::vector<InterChoice>& choices, double step);
  std::uint32_t patches_of_sample(std::uint32_t count) const;

  const std::uint32_t num_vertices_;  // of the whole mesh
  const std::uint32_t num_frames_;    // of the whole GOF
  const FrameRange window_;           // frames that are coded
  const MeshSample sample_;
  const SpanFrames frames_;
  const std::vector<FramePattern> patterns_;  // to compare
  const std::vector<std::uint32_t> patches_;  // numbers of patches of the whole mesh to compare
  const EncoderSettings settings_;
  const Topology topology_;
  const OrderedMeshes meshes_;
  const SequenceMesh mesh_;
  TrialMaker maker_;
  StepCache<FramePattern> pattern_;
};

}  // namespace rlpc
