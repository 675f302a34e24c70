// The animations of the benchmarks, and their streams.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decoder/rlpc_decoder.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc::bench {

using Bytes = std::vector<std::uint8_t>;

struct BenchAnimation {
  std::string name;
  std::string mesh;
  std::string points;
};

// Returns the bundled animations and, if present next to the project, two from the literature.
std::vector<BenchAnimation> animations();

// Returns animations with long GOFs to wait for: some bundled ones, and if present one of a
// game character.
std::vector<BenchAnimation> latency_animations();

// Prints the message and ends the program.
[[noreturn]] void stop(const std::string& message);

Bytes encode(const BenchAnimation& animation, const EncoderSettings& settings);

Decoder open_decoder(const Bytes& stream, bool verify_hashes, std::uint32_t threads);

// Decodes all frames. Returns the number of vertex-frames.
std::uint64_t decode(const Bytes& stream, bool verify_hashes, std::uint32_t threads);

}  // namespace rlpc::bench
