// Writes pages that play a stream in a browser: the player (scripts/player) with an embedded
// stream.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "decoder/codec/units/byte_source.h"
#include "decoder/meshes/frame_sink.h"

namespace rlpc {

// Maximum size of the streams in a page; browsers fail with larger ones.
inline constexpr std::uint64_t kMaxPageStreamBytes = std::uint64_t{512} << 20;

// Reads the page of the player from `path` or, if that is empty, from its installed location or
// the build folder of this program.
OutputResult<std::string> read_player(const std::string& path);

struct PageStreams {
  std::string name;                 // name that the page shows
  ByteSource* stream = nullptr;     // not owned
  ByteSource* reference = nullptr;  // not owned; the page shows distances from it; null: none
};

// Writes the page; copies the streams in parts.
std::optional<OutputError> write_player_page(const std::string& path, const std::string& player,
                                             const PageStreams& streams,
                                             std::shared_ptr<OutputLimit> limit = nullptr);

}  // namespace rlpc
