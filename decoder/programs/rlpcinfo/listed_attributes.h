// The attributes and the asset of a stream, as rlpcinfo lists them.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

struct ListedAttributes {
  Vector<AttributeSet> sets;
  std::string problem;            // why they cannot be decoded; empty: they can
  std::uint64_t asset_bytes = 0;  // 0: there is none

  // Decodes them; the stream has been found to conform otherwise.
  static ListedAttributes of(ByteSource& source, std::uint64_t max_memory_bytes);

  // "uv0: corners, 2 integers of 12 bits, 345 values"
  std::vector<std::string> lines() const;
  void add_to(nlohmann::ordered_json& json) const;
};

}  // namespace rlpc
