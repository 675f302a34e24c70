#include "decoder/recon/gof_recon.h"

#include <utility>

#include "common/cluster_gof/recon/cluster_recon.h"
#include "common/skinned_gof/recon/skinned_recon.h"

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

 private:
  Recon recon_;
};

ClusterRecon recon_of(const ClusterGof& gof, const StreamContext& context,
                      const ForEach& /*for_each*/) {
  return {context.header, context.topology, gof};
}

SkinnedRecon recon_of(const SkinnedGof& gof, const StreamContext& context,
                      const ForEach& for_each) {
  return {(*context.meshes)[gof.prediction], gof, context.header.position_bits, for_each};
}

}  // namespace

std::unique_ptr<GofRecon> make_recon(const AccessUnit& access_unit,
                                     const StreamContext& context, const ForEach& for_each) {
  return std::visit(
      [&](const auto& gof) -> std::unique_ptr<GofRecon> {
        auto recon = recon_of(gof, context, for_each);
        return std::make_unique<ReconOfKind<decltype(recon)>>(std::move(recon));
      },
      access_unit.gof);
}

}  // namespace rlpc
