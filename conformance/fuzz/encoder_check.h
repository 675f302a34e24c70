// Whether the encoder keeps its word for an animation and settings: the status of each call,
// and a stream that conforms, decodes, and is as far from the input as the report says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fuzz/encoder_case.h"

namespace rlpc {

// What an encoder has written, and says of it.
struct EncodedCase {
  std::vector<std::uint8_t> bytes;
  rlpc_encode_report report{};
  std::vector<std::uint32_t> input_vertex;
};

// Of a legal case: what does not hold for the stream; empty if all does.
std::string check_encoded(const EncoderCase& c, const EncodedCase& encoded);

// Encodes, and checks. Empty if all holds. result: none where an error was due.
std::string check_encoder(const EncoderCase& c, std::optional<EncodedCase>* result = nullptr);

}  // namespace rlpc
