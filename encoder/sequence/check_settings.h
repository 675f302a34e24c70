// What an encoder can be asked for.
#pragma once

#include <optional>

#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Why settings cannot be used, with the option of rlpcenc that sets the one that is wrong; none
// if they can.
std::optional<InputError> check_settings(const EncoderSettings& settings);

}  // namespace rlpc
