// Compares a sequence header with the limits of the caller.
#pragma once

#include <cstdint>
#include <optional>

#include "common/codec/syntax/sequence_header.h"
#include "common/result.h"
#include "decoder/codec/options.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"

namespace rlpc {

// Returns the error of the first element that exceeds a limit; none if none does. stream_bytes:
// memory of the stream without GOFs.
inline std::optional<Error> find_exceeded_limit(const SequenceHeader& header,
                                                const SequenceHeaderPlaces& places,
                                                const DecodeLimits& limits,
                                                std::uint64_t stream_bytes) {
  const auto exceeded = [](const char* element, std::uint64_t at, std::uint64_t bytes = 0) {
    return Error{Errc::kLimitExceeded, "", element, at, bytes};
  };
  if (header.num_vertices > limits.max_vertices) {
    return exceeded("num_vertices_minus1", places.num_vertices_minus1);
  }
  if (header.num_triangles > limits.max_triangles) {
    return exceeded("num_triangles", places.num_triangles);
  }
  if (header.num_frames > limits.max_frames) {
    return header.open_end_flag ? exceeded("open_end_flag", places.open_end_flag)
                                : exceeded("num_frames_minus1", places.num_frames_minus1);
  }
  if (stream_bytes > limits.max_memory_bytes) {
    return exceeded("num_vertices_minus1", places.num_vertices_minus1, stream_bytes);
  }
  return std::nullopt;
}

}  // namespace rlpc
