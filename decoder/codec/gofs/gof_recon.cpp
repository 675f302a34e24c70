#include "decoder/codec/gofs/gof_recon.h"

#include <utility>

#include "common/codec/kinds/cluster/recon/cluster_recon.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/memory/owned.h"
#include "decoder/codec/gofs/ordered_recon.h"

namespace rlpc {
namespace {

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
std::unique_ptr<GofRecon> of_kind(Recon recon) {
  return std::make_unique<ReconOfKind<Recon>>(std::move(recon));
}

std::unique_ptr<GofRecon> recon_of(const ClusterGof& gof, const StreamContext& context,
                                   RigRecons&) {
  return of_kind(ClusterRecon(context.header, context.topology, gof));
}

std::unique_ptr<GofRecon> recon_of(const SkinnedGof& gof, const StreamContext& context,
                                   RigRecons& rigs) {
  if (gof.rig) return of_kind(SkinnedRecon(rigs.of(gof.rig), gof));
  return of_kind(
      SkinnedRecon((*context.meshes)[gof.prediction], gof, context.header.position_bits));
}

std::unique_ptr<GofRecon> recon_of(const InterGof& gof, const StreamContext& context,
                                   RigRecons&) {
  return std::make_unique<OrderedRecon>((*context.meshes)[Prediction::kLayers], gof,
                                        context.header.position_bits);
}

}  // namespace

std::unique_ptr<GofRecon> make_recon(const AccessUnit& access_unit,
                                     const StreamContext& context, RigRecons& rigs) {
  return std::visit([&](const auto& gof) { return recon_of(gof, context, rigs); },
                    access_unit.gof);
}

}  // namespace rlpc
