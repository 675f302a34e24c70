#include "encoder/codec/kinds/skinned/skinned_gof_kind.h"

#include "encoder/codec/kinds/skinned/reuse/span_reuse.h"
#include "encoder/codec/kinds/skinned/search/skinned_context.h"
#include "encoder/codec/kinds/skinned/skinned_span_coder.h"

namespace rlpc {
namespace {

class SkinnedGofKind : public KindEncoder {
 public:
  SkinnedGofKind(const SequenceMesh& mesh, const EncoderSettings& settings)
      : context_{
            mesh.header, settings, mesh.triangles,
            OrderedMeshes(mesh.topology, mesh.triangles, settings.profile == Profile::kHigh)} {}

  std::unique_ptr<SpanCoder> make_coder(const SpanFrames& frames) const override {
    return std::make_unique<SkinnedSpanCoder>(context_, frames);
  }

  std::optional<EncodedSpan> encode_with(const KeptRig& rig, const SpanFrames& frames,
                                         double step, double max_cost) const override {
    return encode_with_rig(context_, rig, frames, step, max_cost);
  }

  // Never called: if there are several kinds, this one comes first and is always encoded.

 private:
  SkinnedContext context_;
};

}  // namespace

std::unique_ptr<KindEncoder> make_skinned_gof_kind(const SequenceMesh& mesh,
                                                   const EncoderSettings& settings) {
  if (settings.profile == Profile::kBaseline || !settings.may_use(GofKind::kSkinned)) {
    return nullptr;
  }
  return std::make_unique<SkinnedGofKind>(mesh, settings);
}

}  // namespace rlpc
