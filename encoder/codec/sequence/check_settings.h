// Validates EncoderSettings.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/mesh/clip.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Returns why the settings cannot be used, naming the settings at fault in quotes, as members
// of EncoderSettings and of rlpc_encode_options are called; none if they are valid.
std::optional<InputError> check_settings(const EncoderSettings& settings);
// Returns why the clips cannot be used. num_frames: kMaxFrames if not known.
std::optional<InputError> check_clips(std::span<const Clip> clips, std::uint32_t num_frames);
// Returns why attributes cannot be coded; none if they can, or are to be dropped.
std::optional<InputError> check_attributes(const AttributeSettings& settings,
                                           const SourceAttributes& attributes);

}  // namespace rlpc
