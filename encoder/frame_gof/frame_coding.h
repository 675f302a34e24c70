// Codes a GOF of frames (6.14, 8.19): frame by frame, layer by layer, in closed loop.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/frame_gof/frame_gof.h"
#include "common/frame_gof/recon/frame_recon.h"
#include "common/mesh/coded_mesh.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/write/write_frame_gof.h"

namespace rlpc {

// Codes one frame after the other. Memory is that of a decoder, and the predictions of two
// layers. Vertices of a layer are predicted, and adapt, on several threads.
class FrameCoding {
 public:
  // The mesh must have layers; mesh and settings must outlive it.
  FrameCoding(const CodedMesh& mesh, const FrameSettings& settings, int position_bits);

  // Codes the next frame; xyz [num_vertices][3], in grid units, unrounded. Returns its frame
  // units, and writes its positions as a decoder outputs them.
  std::vector<EncodedGof::Unit> code(std::span<const double> xyz,
                                     std::span<std::int32_t> positions);

 private:
  // The vertices of a layer, with their predictions.
  struct Layer {
    std::span<const std::uint32_t> vertices;
    std::vector<VertexMotion> motions;
    std::vector<std::uint16_t> expected;
  };

  void predict(Layer& layer, std::uint32_t index);
  void choose(Layer& layer, std::span<const double> xyz);
  void adapt(const Layer& layer, std::size_t first, std::size_t end);

  const CodedMesh& mesh_;
  const FrameSettings& settings_;
  FrameRecon recon_;
  FrameUnitWriter writer_;
  Layer layers_[2];  // of which one adapts while residuals of the other are chosen
};

}  // namespace rlpc
