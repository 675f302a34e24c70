#include "decoder/codec/parse/gof_parser.h"

namespace rlpc {

// A kind without slices.
Result<bool> GofParser::slice(BitReader& r, std::uint64_t unit_bit_pos, Vector<SliceEntry>&) {
  r.fail(Errc::kInvalid, "R-UNT-05", "slice_unit", unit_bit_pos);
  return *r.error();
}

}  // namespace rlpc
