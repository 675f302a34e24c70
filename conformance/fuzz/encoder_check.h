// Checks what the encoder does with an animation and settings: the status of each call, and
// that the stream conforms, decodes, and has the error that the report states.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fuzz/encoder_case.h"

namespace rlpc {

// What an encoder has written and reported.
struct EncodedCase {
  std::vector<std::uint8_t> bytes;
  rlpc_encode_report report{};
  std::vector<std::uint32_t> input_vertex;
};

// For a legal case: what is wrong with the stream; empty if nothing is.
std::string check_encoded(const EncoderCase& c, const EncodedCase& encoded);

// Encodes and checks; empty if nothing is wrong. result: none if an error was expected.
std::string check_encoder(const EncoderCase& c, std::optional<EncodedCase>* result = nullptr);

}  // namespace rlpc
