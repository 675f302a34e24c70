// Assets (7.16). Decoding positions skips them, so that no finding stops a decoder.
#include "common/files/glb.h"
#include "conformance/rlpcval/validator_stream.h"
#include "decoder/codec/parse/sequence/parse_asset.h"

namespace rlpc {
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
  if (const auto view = view_glb(*glb); !view) {
    findings_.unchecked("R-AST-02", "asset_format", unit.payload_offset() * 8, view.error());
  }
}

}  // namespace rlpc
