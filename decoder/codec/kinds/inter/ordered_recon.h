// Reconstructs inter GOFs, which are decoded in order.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/inter/recon/inter_recon.h"
#include "common/memory/owned.h"
#include "decoder/codec/recon/gof_recon.h"

namespace rlpc {

// Keeps the last frame, the keep_frames() frames before it, and frames decoded before their
// turn. Decoding an earlier frame restarts the GOF, unless frames are independent.
class OrderedRecon final : public GofRecon {
 public:
  // The mesh must outlive it.
  OrderedRecon(const OrderedMesh& mesh, InterGof gof, int position_bits)
      : mesh_(mesh),
        gof_(std::move(gof)),
        order_(gof_.pattern, gof_.num_frames),
        position_bits_(position_bits) {}

  std::uint32_t num_frames() const override { return gof_.num_frames; }
  bool is_ordered() const override { return true; }
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const override;
  void keep_frames(std::uint32_t count) override { num_kept_ = count; }
  void make_ready(std::uint32_t f) const override;

 private:
  bool can_go_back_to(std::uint32_t place) const;
  void go_to(std::uint32_t frame) const;

  const OrderedMesh& mesh_;
  InterGof gof_;
  FrameOrder order_;
  int position_bits_;
  std::uint32_t num_kept_ = 0;
  mutable std::mutex decoding_;
  mutable std::optional<InterRecon> recon_;
  // Positions by frame: the last frame returned, the frames kept before it, and later frames
  // that have been decoded.
  mutable Map<std::uint32_t, Vector<std::int32_t>> decoded_;
};

}  // namespace rlpc
