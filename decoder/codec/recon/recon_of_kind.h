// Reconstruction of GOFs whose frames are decoded in any order.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/recon/gof_recon.h"

namespace rlpc {

template <class Recon>
class ReconOfKind final : public GofRecon {
 public:
  explicit ReconOfKind(Recon recon) : recon_(std::move(recon)) {}
  std::uint32_t num_frames() const override { return recon_.num_frames(); }
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const override {
    recon_.frames(first, count, positions);
  }
  std::optional<Skeleton> skeleton() const override { return recon_.skeleton(); }
  Vector<BonePlace> places(std::uint32_t f) const override { return recon_.places(f); }
  std::size_t values_of_frame() const override { return recon_.values_of_frame(); }

 private:
  Recon recon_;
};

template <class Recon>
std::unique_ptr<GofRecon> recon_of_kind(Recon recon) {
  return std::make_unique<ReconOfKind<Recon>>(std::move(recon));
}

}  // namespace rlpc
