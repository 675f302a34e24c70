// Pages that play a stream in a browser: the player (scripts/player) with the stream in it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "decoder/output/frame_sink.h"
#include "decoder/stream/byte_source.h"

namespace rlpc {

// More would be too much for a browser to read as text.
inline constexpr std::uint64_t kMaxPageStreamBytes = std::uint64_t{512} << 20;

// The text of the player, from `path`; if that is empty, from where it is installed or was
// built beside this program.
OutputResult<std::string> read_player(const std::string& path);

struct PageStreams {
  std::string name;                 // to be shown
  ByteSource* stream = nullptr;     // not owned, as the next
  ByteSource* reference = nullptr;  // or null; of the same mesh, to see distances from it
};

// Writes the page. Streams are copied a part at a time.
std::optional<OutputError> write_player_page(const std::string& path, const std::string& player,
                                             const PageStreams& streams,
                                             std::shared_ptr<OutputLimit> limit = nullptr);

}  // namespace rlpc
