#include "common/codec/syntax/write_units.h"

#include <algorithm>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/crc32.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// 6.1 stream( )
Bytes write_stream_header(std::uint32_t profile_idc) {
  Bytes bytes(kSignature.begin(), kSignature.end());
  bytes.push_back(kVersionMajor);
  bytes.push_back(static_cast<std::uint8_t>(profile_idc));
  return bytes;
}

// 6.2 unit_header( ), unit_body( )
Bytes write_unit(UnitType type, const Bytes& payload) {
  BitWriter w;
  w.u(8, static_cast<std::uint32_t>(type));
  w.u(32, static_cast<std::uint32_t>(payload.size()));
  w.append(payload);
  Bytes unit = w.take();
  BitWriter crc;
  crc.u(32, crc32_of(unit));
  const Bytes crc_bytes = crc.take();
  unit.insert(unit.end(), crc_bytes.begin(), crc_bytes.end());
  return unit;
}

// 6.7 gof_hash( )
Bytes write_gof_hash(std::span<const std::uint32_t> position_crc, bool per_frame) {
  BitWriter w;
  w.flag(per_frame);
  w.byte_alignment();
  for (const std::uint32_t crc : position_crc) w.u(32, crc);
  return w.take();
}

bool GofIndexEntries::fits() const {
  constexpr std::uint64_t kMax = 0xFFFFFFFE;
  std::uint64_t previous = 0;
  for (const RigIndexEntry& rig : rigs) {
    if (rig.offset - previous > kMax) return false;
    previous = rig.offset;
  }
  return first_gof_offset <= kMax &&
         std::all_of(gofs.begin(), gofs.end(),
                     [](const GofEntry& gof) { return gof.bytes <= kMax; });
}

// 6.9 gof_index( )
Bytes write_gof_index(const GofIndexEntries& index, std::uint32_t profile_idc) {
  BitWriter w;
  w.ue(static_cast<std::uint32_t>(index.gofs.size() - 1));
  w.ue(static_cast<std::uint32_t>(index.first_gof_offset));
  for (const GofEntry& gof : index.gofs) {
    w.ue(gof.num_frames - 1);
    w.ue(static_cast<std::uint32_t>(gof.bytes));
  }
  if (profile_idc >= kProfileHigh) {
    w.ue(static_cast<std::uint32_t>(index.rigs.size()));
    std::uint64_t previous = 0;
    for (const RigIndexEntry& rig : index.rigs) {
      w.u(3, rig.rig_idx);
      w.ue(static_cast<std::uint32_t>(rig.offset - previous));
      previous = rig.offset;
    }
  }
  w.byte_alignment();
  return w.take();
}

// 6.8 end_of_sequence( )
Bytes write_end_of_sequence(std::uint32_t index_distance,
                            std::optional<std::uint32_t> num_frames) {
  BitWriter w;
  w.u(32, index_distance);
  if (num_frames) w.u(32, *num_frames);
  return w.take();
}

}  // namespace rlpc
