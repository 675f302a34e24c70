// Encodes bytes as base64, for embedding in pages.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace rlpc {

// Encodes bytes by RFC 4648, section 4: with padding, in one line.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace rlpc
