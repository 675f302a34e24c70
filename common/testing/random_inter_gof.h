// Inter GOFs with random contents, for tests of parser, writer and reconstruction.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/ordered_mesh.h"

namespace rlpc {

// Returns any legal pattern. below(n): a random number below n.
template <class Below>
FramePattern random_frame_pattern(const Below& below) {
  FramePattern pattern;
  pattern.kind = static_cast<FramePattern::Kind>(below(4));
  if (pattern.kind == FramePattern::kDyadic)
    pattern.period_log2 = 1 + static_cast<int>(below(4));
  if (pattern.kind == FramePattern::kExplicit) {
    const std::uint32_t period = 1 + below(6);
    std::vector<std::uint32_t> depth_at(period + 1, kMaxPatternDepths);
    depth_at[0] = 0;
    while (pattern.entries.size() < period) {
      PatternEntry entry{1 + below(period), {}, 0};
      if (depth_at[entry.offset] < kMaxPatternDepths) continue;
      std::vector<std::uint32_t> before;
      std::vector<std::uint32_t> after;
      for (std::uint32_t offset = 0; offset <= period; ++offset) {
        if (depth_at[offset] < kMaxPatternDepths) {
          (offset < entry.offset ? before : after).push_back(offset);
        }
      }
      const auto one_of = [&](const std::vector<std::uint32_t>& offsets) {
        return offsets[below(static_cast<std::uint32_t>(offsets.size()))];
      };
      entry.reference.fill(one_of(before));
      if (!after.empty() && below(3) > 0) entry.reference[1] = one_of(after);
      if (!after.empty() && below(4) == 0) entry.reference[0] = entry.reference[1];
      for (const std::uint32_t offset : entry.reference) {
        entry.depth = std::max(entry.depth, depth_at[offset]);
      }
      if (entry.offset < period && entry.depth + 1 < kMaxPatternDepths) entry.depth += below(2);
      if (entry.offset == period && entry.depth > 0) {
        entry.depth = 0;
        entry.reference.fill(0);
      }
      depth_at[entry.offset] = entry.depth;
      pattern.entries.push_back(entry);
    }
  }
  pattern.temporal_layers = 1 + below(pattern.num_depths());
  return pattern;
}

// Returns any legal settings of an inter GOF. below(n): a random number below n.
template <class Below>
InterGof random_frame_settings(const OrderedMesh& mesh, std::uint32_t num_frames,
                               const Below& below) {
  InterGof gof;
  gof.kind = GofKind::kInter;
  gof.num_frames = num_frames;
  gof.pattern = random_frame_pattern(below);
  gof.exact_flag = below(3) == 0;
  gof.step.assign(gof.pattern.num_depths(), kExactInterStep);
  for (std::uint32_t& step : gof.step) {
    if (!gof.exact_flag) step = 1 + (below(4) == 0 ? below(kMaxInterStep) : below(200));
  }
  gof.learning_flag = below(3) != 0;
  gof.weights = {static_cast<int>(below(16)), static_cast<int>(below(16)),
                 static_cast<int>(below(16)), 0};
  if (gof.learning_flag) gof.prime_log2 = static_cast<int>(below(16));
  gof.frame_hash_flag = below(2) == 0;
  gof.max_earlier_distance = below(3) == 0 ? 1 + below(5) : 0;
  std::uint32_t left = mesh.num_layers();
  gof.layer_group_size.clear();
  while (left > 0) {
    const bool is_last = gof.layer_group_size.size() == 3 || below(4) == 0;
    const std::uint32_t size = is_last ? left : 1 + below(left);
    gof.layer_group_size.push_back(size);
    left -= size;
  }
  gof.layer_step.assign(mesh.num_layers(), kMaxLayerStep);
  for (std::uint8_t& step : gof.layer_step) {
    if (!gof.exact_flag) step = static_cast<std::uint8_t>(1 + below(kMaxLayerStep));
  }
  if (below(2) == 0) {
    gof.rest = {gof.exact_flag, true, static_cast<int>(below(64)), static_cast<int>(below(64)),
                below(2) == 0,  false};
  }
  if (!gof.exact_flag) gof.first_step = 1 + below(200);
  gof.step_delta_flag = !gof.exact_flag && below(2) == 0;
  if (below(2) == 0) {
    gof.num_patches = 1 + below(6);
    for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
      gof.patch_of_vertex.push_back(static_cast<std::uint16_t>(below(gof.num_patches)));
    }
  }
  return gof;
}

// Returns an inter GOF with any legal settings, residuals of any size, and layer groups and
// frames that are absent from some frame on.
inline InterGof random_inter_gof(std::uint64_t seed, const OrderedMesh& mesh,
                                 std::uint32_t num_frames) {
  // Returns the high bits of Knuth's linear congruential generator.
  const auto random = [&seed] {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>(seed >> 32);
  };
  const auto below = [&](std::uint32_t n) { return random() % n; };
  InterGof gof = random_frame_settings(mesh, num_frames, below);
  auto frames = std::make_shared<std::vector<InterFrame>>(num_frames);
  const auto num_groups = static_cast<std::uint32_t>(gof.layer_group_size.size());
  std::vector<std::uint32_t> max_groups(gof.pattern.temporal_layers, num_groups);
  const std::uint32_t max_bits = below(4) == 0 ? 28 : 6;
  const FrameOrder order(gof.pattern, num_frames);
  for (std::uint32_t place = 0; place < num_frames; ++place) {
    InterFrame& frame = (*frames)[order[place].frame];
    // At most as many layer groups as earlier frames of the same and lower temporal layers.
    std::uint32_t& groups = max_groups[gof.pattern.temporal_layer(order[place].depth)];
    if (below(8) == 0) groups = below(groups + 1);
    for (std::size_t t = 1; t < max_groups.size(); ++t)
      max_groups[t] = std::min(max_groups[t], max_groups[t - 1]);
    if (groups == 0) continue;
    const bool is_in_order = place == 0 && gof.rest.order_flag;
    frame.layer_groups = is_in_order ? num_groups : groups;
    if (place > 0 && gof.max_earlier_distance > 0 && below(4) == 0) {
      const std::uint32_t distance = 1 + below(std::min(place, gof.max_earlier_distance));
      const FramePlace& before = order[place - distance];
      if (gof.pattern.temporal_layer(before.depth) <=
          gof.pattern.temporal_layer(order[place].depth)) {
        if (below(2) == 0) {
          frame.repeated = before.frame;
          frame.layer_groups = (*frames)[before.frame].layer_groups;
          continue;
        }
        frame.reference = before.frame;
      }
    }
    if (gof.step_delta_flag && place > 0 && below(2) == 0) {
      frame.step_delta = kMinStepDelta + static_cast<std::int32_t>(
                                             below(below(2) == 0 ? 30 : kMaxStepDelta + 16));
    }
    for (std::uint32_t p = 0; place > 0 && p < gof.num_patches; ++p) {
      PatchMotion& patch = frame.patches.emplace_back();
      patch.mode = static_cast<PatchMode>(below(kPatchModes));
      for (std::int32_t& residual : patch.residual) {
        if (patch.mode == PatchMode::kNeighbours) break;
        residual = static_cast<std::int32_t>(random() & ((1U << below(max_bits + 1)) - 1));
        if (below(2) == 0) residual = -residual;
      }
    }
    frame.residual = CompactResiduals(3 * std::size_t{mesh.num_vertices()});
    std::uint32_t layers = 0;
    for (std::uint32_t j = 0; j < frame.layer_groups; ++j) layers += gof.layer_group_size[j];
    for (const std::uint32_t v : mesh.vertices_of_layers(0, layers)) {
      if (mode_of(frame.patches, gof.patch_of_vertex, v) == PatchMode::kAlone) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto magnitude =
            static_cast<std::int32_t>(random() & ((1U << below(max_bits + 1)) - 1));
        if (magnitude == 0) continue;
        frame.residual.set(3 * std::size_t{v} + c, below(2) == 0 ? magnitude : -magnitude);
      }
    }
    frame.residual.sort();
    if (gof.frame_hash_flag && frame.layer_groups == num_groups) {
      frame.frame_crc = FrameCrc{random(), 0};
    }
  }
  gof.frames = std::move(frames);
  return gof;
}

}  // namespace rlpc
