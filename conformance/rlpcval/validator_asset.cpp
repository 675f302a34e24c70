// Assets (7.16). Decoding positions skips them, so that no finding stops a decoder.
#include <string>

#include "common/files/binary_numbers.h"
#include "conformance/rlpcval/validator_stream.h"
#include "decoder/codec/parse/sequence/parse_asset.h"

namespace rlpc {
namespace {

// Returns what is wrong with the container of a GLB; empty: nothing.
std::string glb_problem(const std::string& glb) {
  constexpr std::size_t kHeaderBytes = 12;
  constexpr std::size_t kChunkBytes = 8;
  const auto number = [&](std::size_t at) { return load_u32(glb, at); };
  if (glb.size() < kHeaderBytes + kChunkBytes) return "it ends within its first chunk";
  if (!glb.starts_with("glTF")) return "it does not begin with \"glTF\"";
  if (number(4) != 2) return "its version is " + std::to_string(number(4)) + ", not 2";
  if (number(8) != glb.size()) {
    return "it has " + std::to_string(glb.size()) + " bytes, but says " +
           std::to_string(number(8));
  }
  if (glb.compare(16, 4, "JSON") != 0) return "its first chunk is not JSON";
  for (std::size_t at = kHeaderBytes; at < glb.size();) {
    if (glb.size() - at < kChunkBytes || number(at) > glb.size() - at - kChunkBytes) {
      return "a chunk goes past its end";
    }
    at += kChunkBytes + number(at);
  }
  return "";
}

}  // namespace

// 6.16 asset( )
void StreamValidator::asset(const UnitHeader& unit, const Payload& payload) {
  const auto seen = [&](UnitType type) { return seen_[static_cast<std::uint8_t>(type)] > 0; };
  if (seen(UnitType::kAsset) || !seen(UnitType::kConnectivity) || seen(UnitType::kGof) ||
      seen(UnitType::kRig)) {
    findings_.unchecked(
        "R-AST-03", "unit_type", unit.offset * 8,
        "an asset comes once, after the connectivity unit and before the first GOF "
        "or shared rig");
    return;
  }
  BitReader r(payload, unit.payload_offset() * 8);
  const auto glb = parse_asset(r, memory_limit());
  if (!glb) {
    const Error& error = glb.error();
    if (error.code == Errc::kLimitExceeded) return findings_.error(error);
    return findings_.unchecked(error.rule, error.element, error.bit_pos,
                               "decoders that leave assets alone do not notice");
  }
  if (glb->empty()) return;  // another asset_format
  if (const std::string problem = glb_problem(*glb); !problem.empty()) {
    findings_.unchecked("R-AST-02", "asset_format", unit.payload_offset() * 8, problem);
  }
}

}  // namespace rlpc
