// Validates EncoderSettings.
#pragma once

#include <optional>

#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Why the settings cannot be used, naming the option of rlpcenc for the setting at fault; none
// if they are valid.
std::optional<InputError> check_settings(const EncoderSettings& settings);

}  // namespace rlpc
