// GOFs of frames with random contents, for tests of parser, writer and reconstruction.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/frame_gof/frame_gof.h"
#include "common/mesh/coded_mesh.h"

namespace rlpc {

// Any legal settings, residuals of any size, and layer groups and frames that are absent from
// some frame on.
inline FrameGof random_frame_gof(std::uint64_t seed, const CodedMesh& mesh,
                                 std::uint32_t num_frames) {
  // The high bits of Knuth's linear congruential generator.
  const auto random = [&seed] {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>(seed >> 32);
  };
  const auto below = [&](std::uint32_t n) { return random() % n; };
  FrameGof gof;
  gof.kind = GofKind::kFrames;
  gof.num_frames = num_frames;
  gof.reference = static_cast<FrameReference>(below(2));
  gof.exact_flag = below(3) == 0;
  if (!gof.exact_flag) gof.step = 1 + (below(4) == 0 ? below(kMaxFrameStep) : below(200));
  gof.learning_flag = below(3) != 0;
  gof.weights = {static_cast<int>(below(16)), static_cast<int>(below(16)),
                 static_cast<int>(below(16)), 0};
  if (gof.learning_flag) gof.prime_log2 = static_cast<int>(below(16));
  gof.frame_hash_flag = below(2) == 0;
  std::uint32_t left = mesh.num_layers();
  gof.layer_group_size.clear();
  while (left > 0) {
    const std::uint32_t size = gof.layer_group_size.size() == 3 ? left : 1 + below(left);
    gof.layer_group_size.push_back(size);
    left -= size;
  }
  gof.layer_step.assign(mesh.num_layers(), kMaxLayerStep);
  for (std::uint8_t& step : gof.layer_step) {
    if (!gof.exact_flag) step = static_cast<std::uint8_t>(1 + below(kMaxLayerStep));
  }
  auto frames = std::make_shared<std::vector<CodedFrame>>(num_frames);
  auto groups = static_cast<std::uint32_t>(gof.layer_group_size.size());
  const std::uint32_t most_bits = below(4) == 0 ? 28 : 6;
  for (CodedFrame& frame : *frames) {
    if (below(8) == 0) groups = below(groups + 1);
    frame.layer_groups = groups;
    if (groups == 0) continue;
    frame.residual = CompactResiduals(3 * std::size_t{mesh.num_vertices()});
    std::uint32_t layers = 0;
    for (std::uint32_t j = 0; j < groups; ++j) layers += gof.layer_group_size[j];
    for (const std::uint32_t v : mesh.vertices_of_layers(0, layers)) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto magnitude =
            static_cast<std::int32_t>(random() & ((1U << below(most_bits + 1)) - 1));
        if (magnitude == 0) continue;
        frame.residual.set(3 * std::size_t{v} + c, below(2) == 0 ? magnitude : -magnitude);
      }
    }
    frame.residual.sort();
    if (gof.frame_hash_flag && groups == gof.layer_group_size.size()) {
      frame.frame_crc = FrameCrc{random(), 0};
    }
  }
  gof.frames = std::move(frames);
  return gof;
}

}  // namespace rlpc
