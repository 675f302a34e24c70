// Holds a stream that has been written against the rules of the specification. The encoder
// calls it, the validator (conformance/rlpcval/) implements it, and they meet when a program is
// linked: see frame_reader.h.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/verify/stream_buffer.h"

namespace rlpc {

enum class RuleScope : std::uint8_t {
  kAll,       // the whole stream
  kContents,  // what the input brings, not the codec: attributes, asset, metadata and clips
};

// Returns the first rule that the first `end` bytes of a stream break, in one line: the rule,
// where, and what it means. With kContents, they may end after any GOF. Takes about as long as
// to decode them.
std::optional<std::string> find_broken_rule(const std::shared_ptr<StreamBuffer>& stream,
                                            std::uint64_t end, RuleScope scope);

}  // namespace rlpc
