// Chooses the motion of patches in a frame, and the mode of each patch by its cost.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/inter_contexts.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/inter/patch_contexts.h"
#include "common/codec/kinds/inter/recon/inter_recon.h"
#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

class PatchSearch {
 public:
  // The mesh must have layers; mesh and settings, which have patches, must outlive it.
  // to_nearest: residuals are rounded to nearest, and no coordinate has a larger error than
  // that.
  PatchSearch(const OrderedMesh& mesh, const InterSettings& settings, bool to_nearest);

  // Chooses the patches of the frame that recon has started, not the first of its GOF; xyz
  // [num_vertices][3], in grid units. contexts: those of the writer, which has started the
  // frame. Predicts all vertices from neighbours, for comparison; coding the frame overwrites
  // this in recon. Takes about as long as coding the frame.
  FramePatches choose(std::span<const double> xyz, std::uint32_t depth,
                      const PatchContexts& contexts, InterRecon& recon);

 private:
  using Costs = std::vector<double>;  // [num_patches], in bits

  void predict_from_neighbours(std::span<const double> xyz, InterRecon& recon);
  PatchMotion cheapest_motion(std::size_t patch, std::span<const double> xyz,
                              std::uint32_t depth, const InterRecon& recon,
                              PatchContexts& contexts);
  void choose_modes(const Costs& neighbour_costs, const Costs& motion_costs,
                    PatchContexts contexts, FramePatches& patches) const;
  double cost_alone(std::size_t patch) const;
  PatchMotion fit(std::size_t patch, std::span<const double> xyz, std::uint32_t depth,
                  const InterRecon& recon) const;
  double error(std::size_t patch, std::span<const double> xyz, std::uint32_t depth,
               const InterRecon& recon, const PatchMotion& motion,
               std::vector<double>* left) const;
  Costs costs(InterContexts& contexts, std::uint32_t place, std::uint32_t depth,
              const std::vector<double>& wanted) const;

  const OrderedMesh& mesh_;
  const InterSettings& settings_;
  double max_alone_;  // error of a coordinate of a patch without residuals, in steps
  std::vector<std::vector<std::uint32_t>> vertices_;  // [patch]
  // [num_vertices][3]: residuals in steps, from neighbours and from motions.
  std::vector<double> wanted_;
  std::vector<double> left_;
  // Contexts as if all vertices were predicted in one way in all frames: the cost of a mode in
  // a patch does not depend on the mode that was chosen for it.
  InterContexts neighbour_contexts_;
  InterContexts motion_contexts_;
};

}  // namespace rlpc
