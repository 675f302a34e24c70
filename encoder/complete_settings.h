// What settings take from the animation that is encoded.
#pragma once

#include <span>
#include <string>

#include "common/codec/mesh/clip.h"
#include "encoder/codec/settings.h"

namespace rlpc {

// Returns the settings with what they leave to the animation
// (EncoderSettings::takes_from_source): its clips; its asset, unless attributes are dropped;
// how the asset uses texture coordinates.
EncoderSettings complete_settings(EncoderSettings settings, std::span<const Clip> clips,
                                  const std::string& asset);

}  // namespace rlpc
