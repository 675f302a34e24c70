// 8.19.5 Motion of patches, written as the pseudo-code is, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/inter/patch_motion.h"

namespace rlpc {

struct PatchesOfText {
  using List = std::vector<std::int64_t>;

  std::uint32_t num_patches = 0;
  PatchOfVertex patch_of_vertex;  // ClusterOfVertex
  int position_bits = 0;
  std::vector<std::vector<std::uint32_t>> vertices;  // PatchVertices
  List reach;                                        // PatchReach
  std::vector<std::vector<List>> motion;             // PatchMotion: [depth][patch][12]
  // State of the current frame:
  List reference;
  std::uint32_t depth = 0;
  std::vector<PatchMode> modes;  // PatchModes; empty: no patch moves
  std::vector<List> centre;      // PatchCentre

  // StartPatches( )
  void start(std::span<const std::uint32_t> lowest_group, const List& first,
             std::uint32_t num_depths) {
    motion.assign(num_depths, std::vector<List>(num_patches, List(12, 0)));
    vertices.assign(num_patches, {});
    reach.clear();
    for (const std::uint32_t v : lowest_group) vertices[patch_of_vertex[v]].push_back(v);
    for (std::uint32_t p = 0; p < num_patches; ++p) {
      if (vertices[p].empty()) vertices[p].assign(lowest_group.begin(), lowest_group.end());
      const List from = centre_of(p, first);
      std::int64_t sum = 0;
      for (const std::uint32_t v : vertices[p]) {
        std::int64_t largest = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          largest = std::max(largest, std::abs(first[3 * std::size_t{v} + c] - from[c]));
        }
        sum += largest;
      }
      reach.push_back(std::max<std::int64_t>(1, rounded(sum, size_of(p))));
    }
  }

  // MovePatches( f )
  void move(const List& frame_values, std::uint32_t depth_of_frame, std::int64_t step,
            const FramePatches& patches) {
    reference = frame_values;
    depth = depth_of_frame;
    modes.clear();
    centre.clear();
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
      modes.push_back(patches[p].mode);
      centre.push_back(centre_of(p, reference));
      if (patches[p].mode == PatchMode::kNeighbours) continue;
      List& numbers = motion[depth][p];
      for (std::size_t i = 0; i < 12; ++i) {
        const std::int64_t difference = patches[p].residual[i] * step;
        if (i < 3) {
          // Round2( difference, 2 )
          const std::int64_t quarter = floor_of(difference + 2, 4);
          numbers[i] = std::clamp<std::int64_t>(numbers[i] + quarter, -(1 << 29), 1 << 29);
        } else {
          const std::int64_t turn = rounded(difference * (1 << 14), reach[p]);
          numbers[i] = std::clamp<std::int64_t>(numbers[i] + turn, -(1 << 18), 1 << 18);
        }
      }
    }
  }

  PatchMode mode_of_vertex(std::uint32_t v) const {
    return modes.empty() ? PatchMode::kNeighbours : modes[patch_of_vertex[v]];
  }

  // MovedByPatch( f, v, c )
  std::int64_t moved(std::uint32_t v, std::size_t c) const {
    const std::size_t p = patch_of_vertex[v];
    const List& numbers = motion[depth][p];
    std::int64_t sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += numbers[3 + 3 * c + k] * (reference[3 * std::size_t{v} + k] - centre[p][k]);
    }
    const std::int64_t half = std::int64_t{1} << (position_bits + 4);
    const std::int64_t turned = floor_of(sum + (1 << 15), 1 << 16);
    return std::clamp(reference[3 * std::size_t{v} + c] + numbers[c] + turned, -half, half - 1);
  }

 private:
  // The greatest integer that is not greater than x / n.
  static std::int64_t floor_of(std::int64_t x, std::int64_t n) {
    return x / n - (x % n < 0 ? 1 : 0);
  }
  // DivRound( x, n )
  static std::int64_t rounded(std::int64_t x, std::int64_t n) {
    return floor_of(2 * x + n, 2 * n);
  }
  std::int64_t size_of(std::uint32_t p) const {
    return static_cast<std::int64_t>(vertices[p].size());
  }
  // CentreOfPatch( p, values )
  List centre_of(std::uint32_t p, const List& values) const {
    List mean;
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t sum = 0;
      for (const std::uint32_t v : vertices[p]) sum += values[3 * std::size_t{v} + c];
      mean.push_back(rounded(sum, size_of(p)));
    }
    return mean;
  }
};

}  // namespace rlpc
