// Checks what the encoder does with an animation and settings: the status of each call, and
// that the stream conforms, decodes, and has the error that the report states.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "conformance/fuzz/encoder_case.h"

namespace rlpc {

// Stream and report of an encoder.
struct EncodedCase {
  std::vector<std::uint8_t> bytes;
  rlpc_encode_report report{};
  std::vector<std::uint32_t> input_vertex;
};

// Returns what is wrong with the stream of a legal case; empty if nothing is.
std::string check_encoded(const EncoderCase& c, const EncodedCase& encoded);

// Encodes and checks. Returns what is wrong, or nothing. result: none if an error was expected.
std::string check_encoder(const EncoderCase& c, std::optional<EncodedCase>* result = nullptr);

}  // namespace rlpc
