#include "encoder/complete_settings.h"

#include "encoder/meshes/texels.h"

namespace rlpc {

EncoderSettings complete_settings(EncoderSettings settings, std::span<const Clip> clips,
                                  const std::string& asset) {
  if (settings.takes_from_source) {
    if (settings.clips.empty()) settings.clips.assign(clips.begin(), clips.end());
    if (settings.asset.empty() && !settings.attributes.dropped) settings.asset = asset;
  }
  if (settings.attributes.uv_uses.empty() && !settings.attributes.dropped) {
    settings.attributes.uv_uses = uses_of_uv(settings.asset, settings.max_memory_bytes);
  }
  return settings;
}

}  // namespace rlpc
