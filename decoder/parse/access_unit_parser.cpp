#include "decoder/parse/access_unit_parser.h"

#include <utility>

#include "decoder/parse/parse_cluster_gof.h"
#include "decoder/parse/parse_gof_hash.h"
#include "decoder/parse/parse_gof_header.h"

namespace rlpc {

Result<bool> AccessUnitParser::gof(BitReader& r, std::uint32_t first_frame,
                                   std::uint64_t unit_bytes) {
  const GofHeader header = parse_gof_header(r, context_.header, first_frame);
  if (r.error()) return *r.error();
  num_frames_ = header.num_frames;
  access_unit_.gof_bytes = unit_bytes;
  switch (header.kind) {
    case GofKind::kClusters: {
      auto gof =
          parse_clusters(r, context_.header, context_.topology, header, max_memory_bytes_);
      if (!gof) return gof.error();
      access_unit_.gof = std::move(*gof);
      break;
    }
    case GofKind::kSkinned:
      skinned_.emplace(context_.header, *context_.meshes, max_memory_bytes_, cut_);
      if (auto ok = skinned_->bones(r, header); !ok) return ok;
      break;
  }
  return true;
}

Result<bool> AccessUnitParser::slice(BitReader& r, std::uint64_t unit_bit_pos,
                                     std::uint64_t unit_bytes) {
  if (auto ok = skinned_->slice(r, unit_bit_pos); !ok) return ok;
  if (skinned_->last_slice()) {
    access_unit_.slices.push_back(*skinned_->last_slice());
    access_unit_.slices.back().bytes = unit_bytes;
  }
  return true;
}

Result<bool> AccessUnitParser::hash(BitReader& r) {
  auto hash = parse_gof_hash(r, num_frames_);
  if (!hash) return hash.error();
  access_unit_.hash = std::move(*hash);
  return true;
}

AccessUnit AccessUnitParser::finish() {
  if (skinned_) {
    access_unit_.is_cut = skinned_->is_cut();
    access_unit_.gof = skinned_->finish();
  }
  return std::move(access_unit_);
}

}  // namespace rlpc
