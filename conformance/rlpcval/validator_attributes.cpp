// Attribute units (Annex F). Decoding positions skips them, so that no finding stops a decoder.
#include <set>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/bits/crc32.h"
#include "common/codec/mesh/clip.h"
#include "conformance/rlpcval/validator_stream.h"
#include "decoder/codec/gofs/make_recon.h"
#include "decoder/codec/parse/attributes/parse_attributes.h"

namespace rlpc {

// F.3, R-ATT-01: whether a decoder reads the unit here.
bool StreamValidator::has_place_for_attributes(const UnitHeader& unit) {
  const auto seen = [&](UnitType type) { return seen_[static_cast<std::uint8_t>(type)] > 0; };
  const char* text = nullptr;
  if (seen(UnitType::kAttributes)) {
    text = "there is an attribute unit before";
  } else if (!seen(UnitType::kConnectivity)) {
    text = "the connectivity has not been there yet";
  } else if (seen(UnitType::kGof) || seen(UnitType::kRig)) {
    text = "a GOF or a shared rig was there before";
  }
  if (text != nullptr) findings_.unchecked("R-ATT-01", "unit_type", unit.offset * 8, text);
  return text == nullptr;
}

// F.2.1 attributes( )
void StreamValidator::attributes(const UnitHeader& unit, const Payload& payload) {
  if (!has_place_for_attributes(unit) || !can_read()) return;
  if (!lead_.has_connectivity) {
    report_.complete = false;
    return;
  }
  findings_.suspect(findings_.suspect() || lead_.connectivity_suspect);
  BitReader r(payload, unit.payload_offset() * 8);
  const auto coded =
      parse_attributes(r, lead_.header->header.num_vertices, lead_.triangles, memory_limit());
  if (!coded) {
    const Error& error = coded.error();
    if (error.code == Errc::kLimitExceeded) return findings_.error(error);
    return findings_.unchecked(error.rule, error.element, error.bit_pos,
                               "decoders that leave attributes alone do not notice");
  }
  report_.attribute_sets = static_cast<std::uint32_t>(coded->sets.size());
  check_attribute_names(unit, *coded);
  if (!coded->uses_positions()) return;
  first_frame_ = {coded->first_frame_crc,
                  FindingUnit{report_.units, unit.type_byte, unit.offset},
                  unit.payload_offset() * 8};
}

void StreamValidator::check_attribute_names(const UnitHeader& unit,
                                            const CodedAttributes& coded) {
  std::set<std::string> names;
  for (const CodedAttributeSet& set : coded.sets) {
    const std::string& name = set.header.name;
    const std::size_t at = find_clip_name_error(name);
    const bool is_new = names.insert(name).second;
    if (at == name.size() && is_new) continue;
    const std::string which = " of the name of set " + std::to_string(names.size() - is_new);
    findings_.unchecked(
        "R-ATT-09", "attribute_name_byte", unit.payload_offset() * 8,
        is_new ? "byte " + std::to_string(at) + which : "two sets have the name " + name);
    return;
  }
}

// R-ATT-08, once the GOF of the first frame is complete.
void StreamValidator::compare_first_frame(const AccessUnit& access_unit) {
  if (!first_frame_.place) return;
  const FirstFrame expected = first_frame_;
  first_frame_ = {};
  const auto recon = make_recon(access_unit, lead_.context, *recons_);
  std::vector<std::int32_t> positions(3 * std::size_t{lead_.header->header.num_vertices});
  recon->frame(0, positions);
  const std::uint32_t crc = crc32_of_positions(positions, 0);
  if (crc == expected.crc) return;
  findings_.in_unit(expected.place);
  findings_.unchecked("R-ATT-08", "first_frame_crc", expected.bit_pos,
                      "first_frame_crc is " + std::to_string(expected.crc) +
                          ", the first frame gives " + std::to_string(crc));
  findings_.in_unit(gof_.place);
}

}  // namespace rlpc
