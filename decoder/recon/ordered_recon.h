// Reconstructs GOFs of frames, which are decoded in order.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "common/frame_gof/frame_gof.h"
#include "common/frame_gof/recon/frame_recon.h"
#include "decoder/recon/gof_recon.h"

namespace rlpc {

// Keeps the last frame: the same and the next one are there at once, an earlier one begins with
// the GOF again.
class OrderedRecon final : public GofRecon {
 public:
  // The mesh must outlive it.
  OrderedRecon(const CodedMesh& mesh, FrameGof gof, int position_bits)
      : mesh_(mesh), gof_(std::move(gof)), position_bits_(position_bits) {}

  std::uint32_t num_frames() const override { return gof_.num_frames; }
  bool is_ordered() const override { return true; }
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const override;

 private:
  void go_to(std::uint32_t frame) const;

  const CodedMesh& mesh_;
  FrameGof gof_;
  int position_bits_;
  mutable std::mutex decoding_;
  mutable std::optional<FrameRecon> recon_;
};

}  // namespace rlpc
