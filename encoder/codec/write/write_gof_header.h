// 6.5 gof( ), writing side: the elements common to all kinds of GOF.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

void write_gof_header(BitWriter& w, const GofHeader& gof, std::uint32_t profile_idc);

}  // namespace rlpc
