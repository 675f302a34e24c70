// Number of frames that are encoded at a time, and the memory that they need.
#pragma once

#include <cstdint>

#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

inline constexpr std::uint32_t kDefaultGofFrames = 128;  // fixed: how far a seek decodes
// With shared rigs, a seek only parses the tracks of a GOF, some milliseconds. Compared with
// a single GOF, this length takes up to 6 % more bytes (morph-stress), half of it up to 12 %,
// at a KG error of 0.1 %; sequences of twice the length were not available.
inline constexpr std::uint32_t kDefaultTrackFrames = 256;  // fixed: how far a seek parses

// Several clips of one character: each GOF of the Main profile repeats its shape. kB with GOFs
// of at most 512 / 1024 / 4096 frames, with attributes, at a KG error of 0.1 %: knight 302 /
// 247 / 184, robot 29 / 25 / 25, morph-stress 179 / 177 / 177. A first seek into the knight's
// 2818 frames as one GOF takes 60 ms more than into 512; in GOFs of 128, it takes 563 kB.
inline constexpr std::uint32_t kClipFrames = kLevels[2].max_gof_frames;  // fixed: level 3

// Returns the maximum number of frames per GOF under the settings.
std::uint32_t longest_gof(const EncoderSettings& settings, std::uint32_t num_vertices);
// Returns the same for a sequence of which all frames are known: if it is more than
// longest_gof(), choose_longest_gof() decides.
std::uint32_t longest_gof_of_all(const EncoderSettings& settings, std::uint32_t num_vertices);
// Memory that the source of an encoding holds, and frames that are encoded before any is
// written.
struct SourceMemory {
  std::uint64_t bytes = 0;
  std::uint64_t bytes_of_position = 0;  // for each vertex and frame of the longest span
  std::uint32_t encoded_frames = 0;     // 0: those of a span
};

// Returns the maximum number of frames per span: in the High profile, the GOFs that can use one
// shared rig, as many as memory allows.
std::uint32_t longest_span(const EncoderSettings& settings, const SequenceHeader& header,
                           const SourceMemory& source);

// Returns the threads of the settings, or as many as their memory limit allows. Error: even one
// may need more. span_frames: length of the longest span; kept_frames: number of frames whose
// analyses stay in memory.
InputResult<std::uint32_t> check_memory(const EncoderSettings& settings,
                                        const SequenceHeader& header, std::uint32_t span_frames,
                                        std::uint32_t kept_frames, const SourceMemory& source);

}  // namespace rlpc
