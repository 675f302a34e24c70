// A GOF of clusters or of bones, ready to give its frames.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <variant>

#include "common/cluster_gof/recon/cluster_recon.h"
#include "common/skinned_gof/recon/skinned_recon.h"

namespace rlpc {

class FrameRecon {
 public:
  // is_cut: some of its slices were left out.
  template <class Recon>
  explicit FrameRecon(Recon recon, bool is_cut = false)
      : recon_(std::move(recon)), is_cut_(is_cut) {}

  // Frames first to first + count - 1 of the GOF, in decoded order, [count][num_vertices][3].
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const {
    std::visit([&](const auto& recon) { recon.frames(first, count, positions); }, recon_);
  }
  bool is_cut() const { return is_cut_; }
  std::uint32_t num_frames() const {
    return std::visit([](const auto& recon) { return recon.num_frames(); }, recon_);
  }

 private:
  std::variant<ClusterRecon, SkinnedRecon> recon_;
  bool is_cut_;
};

}  // namespace rlpc
