#include "encoder/skinned_gof/skinned_gof_kind.h"

#include "common/mesh/vertex_layers.h"
#include "encoder/skinned_gof/search/skinned_context.h"
#include "encoder/skinned_gof/skinned_gof_coder.h"

namespace rlpc {
namespace {

class SkinnedGofKind : public GofEncoder {
 public:
  SkinnedGofKind(const SequenceMesh& mesh, const EncoderSettings& settings)
      : layers_(make_layers(mesh.header.num_vertices, mesh.triangles)),
        context_{mesh.header, settings, mesh.triangles, {}} {
    for (const Prediction prediction : {Prediction::kNone, Prediction::kParallelogram,
                                        Prediction::kParallelograms, Prediction::kLayers}) {
      context_.meshes.emplace_back(prediction, mesh.topology, layers_);
    }
  }

  std::unique_ptr<GofCoder> make_coder(const GofFrames& frames) const override {
    return std::make_unique<SkinnedGofCoder>(context_, frames);
  }

  // The first kind wherever there is more than one.
  std::optional<double> estimate_cost(const GofFrames& /*frames*/, const EncodedGof& /*best*/,
                                      double /*step*/) const override {
    return std::nullopt;
  }

 private:
  VertexLayers layers_;
  SkinnedContext context_;
};

}  // namespace

std::unique_ptr<GofEncoder> make_skinned_gof_kind(const SequenceMesh& mesh,
                                                  const EncoderSettings& settings) {
  if (settings.profile != Profile::kMain) return nullptr;
  return std::make_unique<SkinnedGofKind>(mesh, settings);
}

}  // namespace rlpc
