// Options for the settings of writers of mesh files and pages: SinkOptions, OutputLimit, the
// page that plays streams.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "common/cli/setting_options.h"

namespace rlpc {

inline constexpr std::array kDecoderOptions = std::to_array<SettingOption>({
    {"num_frames", "--frames, --clip"},
    {"motion", "--as"},
    {"max_targets", "--max-targets"},
    {"max_skin_bytes", "--max-memory"},
    {"max_bytes", "--max-output"},
    {"player", "--player PAGE"},
});

// Returns a message for users of rlpcdec and rlpcinfo, with options in place of settings.
inline std::string with_decoder_options(std::string_view message) {
  return with_options(message, kDecoderOptions);
}

}  // namespace rlpc
