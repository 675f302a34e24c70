#include "decoder/codec/units/access_unit_parser.h"

#include <utility>

#include "decoder/codec/kinds/kinds.h"
#include "decoder/codec/parse/parse_gof_hash.h"
#include "decoder/codec/parse/parse_gof_header.h"

namespace rlpc {

AccessUnitParser::AccessUnitParser(const StreamContext& context, const MemoryLimit& memory,
                                   const SliceCut& cut)
    : context_(context), memory_(memory), cut_(cut) {}

Result<bool> AccessUnitParser::gof(BitReader& r, std::uint32_t first_frame,
                                   const RigSlots& rigs, std::uint64_t unit_bytes) {
  const GofHeader header = parse_gof_header(r, context_.header, first_frame);
  if (r.error()) return *r.error();
  kind_ = header.kind;
  num_frames_ = header.num_frames;
  access_unit_.gof_bytes = unit_bytes;
  with_decoder(header.kind,
               [&](auto decoder) { parser_ = decoder.make_parser(context_, memory_, cut_); });
  return parser_->gof(r, header, rigs);
}

bool AccessUnitParser::drops(BitReader& r) { return parser_->drops(r); }

Result<bool> AccessUnitParser::slice(BitReader& r, std::uint64_t unit_bit_pos,
                                     std::uint64_t unit_bytes) {
  const std::size_t before = access_unit_.slices.size();
  if (auto ok = parser_->slice(r, unit_bit_pos, access_unit_.slices); !ok) return ok;
  if (access_unit_.slices.size() > before) access_unit_.slices.back().bytes = unit_bytes;
  return true;
}

Result<bool> AccessUnitParser::hash(BitReader& r) {
  auto hash = parse_gof_hash(r, num_frames_);
  if (!hash) return hash.error();
  access_unit_.hash = std::move(*hash);
  return true;
}

std::uint64_t AccessUnitParser::memory_bytes() const {
  return parser_ ? parser_->memory_bytes() : 0;
}

AccessUnit AccessUnitParser::finish() {
  access_unit_.is_cut = parser_->is_cut();
  access_unit_.gof = parser_->take_gof();
  return std::move(access_unit_);
}

}  // namespace rlpc
