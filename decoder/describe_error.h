// Describes stream errors in words.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/result.h"

namespace rlpc {

// Limit that an Errc::kLimitExceeded refers to.
enum class ExceededLimit : std::uint8_t { kVertices, kTriangles, kFrames, kMemory };

// Returns the limit that an error of code kLimitExceeded refers to.
inline ExceededLimit exceeded_limit(const Error& error) {
  const std::string_view element = error.element;
  if (error.needed_bytes > 0) return ExceededLimit::kMemory;
  if (element == "num_vertices_minus1") return ExceededLimit::kVertices;
  if (element == "num_triangles") return ExceededLimit::kTriangles;
  if (element == "num_frames_minus1" || element == "open_end_flag")
    return ExceededLimit::kFrames;
  return ExceededLimit::kMemory;
}

// Describes the limit that an error exceeds: "more vertices than the limit".
inline std::string describe_limit(const Error& error) {
  switch (exceeded_limit(error)) {
    case ExceededLimit::kVertices:
      return "more vertices than the limit";
    case ExceededLimit::kTriangles:
      return "more triangles than the limit";
    case ExceededLimit::kFrames:
      return "more frames than the limit";
    case ExceededLimit::kMemory:
      break;
  }
  if (error.needed_bytes == 0) return "needs more memory than the limit";
  constexpr std::uint64_t kManyKib = 10240;
  const std::uint64_t kib = (error.needed_bytes + 1023) / 1024;
  return "needs at least " +
         (kib < kManyKib ? std::to_string(kib) + " KiB"
                         : std::to_string((kib + 1023) / 1024) + " MiB") +
         " of memory, more than the limit";
}

// Describes an error with its place, its rule and the remedy: "bit 960: seed_vertex: not a
// conforming stream (rule R-GOF-06); the file is damaged, or its encoder has a bug".
inline std::string describe_error(const Error& error) {
  const std::string where = "bit " + std::to_string(error.bit_pos) + ": " + error.element;
  const std::string rule =
      error.rule[0] == '\0' ? "" : " (rule " + std::string(error.rule) + ")";
  switch (error.code) {
    case Errc::kTruncated:
      return where + ": the stream ends too early" + rule + "; the file was cut off";
    case Errc::kInvalid:
      if (std::string_view(error.rule) == "R-STR-01") {
        return "not an RLPC stream" + rule;
      }
      return where + ": not a conforming stream" + rule +
             "; the file is damaged, or its encoder has a bug";
    case Errc::kUnsupported:
      return where + ": not supported by this version" + rule + "; use a newer decoder";
    case Errc::kLimitExceeded:
      return where + ": " + describe_limit(error);
    case Errc::kIo:
      break;
  }
  if (error.bit_pos == 0) return "cannot read the stream: " + std::string(error.element);
  return where + ": cannot read the stream here; the file or the disk is at fault";
}

}  // namespace rlpc
