// Attributes and asset of a stream as rlpcinfo lists them.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

struct ListedAttributes {
  Vector<AttributeSet> sets;
  std::string problem;            // error that prevents decoding them; empty: none
  std::uint64_t asset_bytes = 0;  // 0: no asset

  // Decodes the attributes of a stream that otherwise conforms.
  static ListedAttributes of(ByteSource& source, std::uint64_t max_memory_bytes);

  // Returns lines such as "uv0: corners, 2 integers of 12 bits, 345 values".
  std::vector<std::string> lines() const;
  void add_to(nlohmann::ordered_json& json) const;
};

}  // namespace rlpc
