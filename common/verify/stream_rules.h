// Checks a written stream against the rules of the specification. The encoder calls it, the
// validator (conformance/rlpcval/) implements it, and the linker connects them: see
// frame_reader.h.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/verify/stream_buffer.h"

namespace rlpc {

enum class RuleScope : std::uint8_t {
  kAll,       // the whole stream
  kContents,  // contents of the input, not of the codec: attributes, asset, metadata and clips
};

// Returns the first rule that the first `end` bytes of a stream break, in one line: the rule,
// the place, and its meaning. With kContents, they may end after any GOF. Takes about as long
// as decoding them.
std::optional<std::string> find_broken_rule(const std::shared_ptr<StreamBuffer>& stream,
                                            std::uint64_t end, RuleScope scope);

}  // namespace rlpc
