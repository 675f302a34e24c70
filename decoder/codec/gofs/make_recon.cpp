#include "decoder/codec/gofs/make_recon.h"

#include "decoder/codec/kinds/kinds.h"

namespace rlpc {

std::unique_ptr<GofRecon> make_recon(const AccessUnit& access_unit,
                                     const StreamContext& context, RigRecons& rigs) {
  std::unique_ptr<GofRecon> recon;
  visit_gof(access_unit.gof, [&](auto decoder, const auto& gof) {
    recon = decoder.make_recon(gof, context, rigs);
  });
  return recon;
}

}  // namespace rlpc
