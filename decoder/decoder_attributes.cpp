// Outputs of a decoder besides positions: attributes, assets and bones.
#include <algorithm>
#include <utility>

#include "common/codec/attributes/recon/attribute_recon.h"
#include "common/codec/bits/crc32.h"
#include "common/memory/owned.h"
#include "decoder/codec/gofs/make_recon.h"
#include "decoder/codec/parse/attributes/parse_attributes.h"
#include "decoder/codec/parse/sequence/parse_asset.h"
#include "decoder/decoder_impl.h"

namespace rlpc {

Result<Vector<std::int32_t>> Decoder::Impl::decode_first_frame() {
  if (auto ok = stream_.seek(0); !ok) return ok.error();
  const auto unit = stream_.find_gof();
  if (!unit) return unit.error();
  Vector<std::int32_t> positions(3 * std::size_t{stream_.header().num_vertices});
  const auto live = gofs_.is_live(**unit);
  if (!live) return live.error();
  if (*live) {
    LiveGof gof(stream_, {});
    if (auto ok = gof.begin(**unit); !ok) return ok.error();
    if (auto ok = gof.next(); !ok) return ok.error();
    positions.assign(gof.positions().begin(), gof.positions().end());
    return positions;
  }
  auto access_unit = stream_.read(**unit);
  if (!access_unit) return access_unit.error();
  make_recon(*access_unit, stream_.context(), gofs_.rigs())->frame(0, positions);
  return positions;
}

Result<Vector<std::int32_t>> Decoder::Impl::first_frame() {
  const ThreadPool::Use use(threads_);
  const SliceCut cut = stream_.access_units().cut();
  if (const LoadedGof* gof = gofs_.gof(); gof != nullptr && gof->has_frame(0) && !cut.cuts()) {
    Vector<std::int32_t> positions(3 * std::size_t{stream_.header().num_vertices});
    gof->gof.recon->frame(0, positions);
    return positions;
  }
  const StreamReader::Place here = stream_.place();
  stream_.access_units().set_cut({});
  auto positions = decode_first_frame();
  stream_.access_units().set_cut(cut);
  stream_.return_to(here);
  return positions;
}

Result<String> Decoder::Impl::asset() {
  const auto& unit = stream_.asset_unit();
  if (!unit) return String();
  const auto payload = stream_.units().payload(*unit);
  if (!payload) return payload.error();
  BitReader r = stream_.units().bits(*unit, *payload);
  return parse_asset(r, stream_.access_units().memory_limit());
}

Result<Vector<AttributeSet>> Decoder::Impl::attributes() {
  const auto& unit = stream_.attribute_unit();
  if (!unit || output_.coarse()) return Vector<AttributeSet>();
  const auto payload = stream_.units().payload(*unit);
  if (!payload) return payload.error();
  BitReader r = stream_.units().bits(*unit, *payload);
  // Triangles in decoded order.
  Vector<Triangle> triangles(stream_.triangles().begin(), stream_.triangles().end());
  if (!stream_.vertex_order().empty()) {
    const Vector<std::uint32_t> decoded = output_.decoded_indices();
    for (Triangle& t : triangles) {
      for (std::uint32_t& v : t) v = decoded[v];
    }
  }
  const std::uint32_t num_vertices = stream_.header().num_vertices;
  const auto coded =
      parse_attributes(r, num_vertices, triangles, stream_.access_units().memory_limit());
  if (!coded) return coded.error();
  Vector<std::int32_t> positions;
  if (coded->uses_positions()) {
    auto first = first_frame();
    if (!first) return first.error();
    positions = std::move(*first);
    if (crc32_of_positions(positions) != coded->first_frame_crc) {
      return Error{Errc::kInvalid, "R-ATT-08", "first_frame_crc", unit->payload_offset() * 8};
    }
  }
  auto sets = recon_attributes(*coded, num_vertices, triangles, positions);
  for (AttributeSet& set : sets) {
    if (set.header.kind == ValueKind::kUnitVectors && set.header.has_faces()) {
      set.first_positions.resize(positions.size());
      output_.to_output<std::int32_t>(positions, set.first_positions, 3);
    }
    if (set.header.domain != AttributeDomain::kVertex) continue;
    const Vector<std::uint32_t> values = set.values;
    output_.to_output<std::uint32_t>(values, set.values, set.header.num_components);
  }
  return sets;
}

std::optional<SkeletonPose> Decoder::Impl::pose() {
  const LoadedGof* const gof = gofs_.gof();
  if (gof == nullptr || position_ == 0 || !gofs_.has_frame(position_ - 1)) return std::nullopt;
  const std::uint32_t first = gof->header().first_frame;
  if (last_skeleton_.first_frame != first) {
    std::optional<Skeleton> skeleton = gof->gof.recon->skeleton();
    if (!skeleton) return std::nullopt;
    Vector<Vector<SkeletonInfluence>> influences;
    for (const std::uint32_t v : output_.decoded_indices()) {
      influences.push_back(std::move(skeleton->influences[v]));
    }
    skeleton->influences = std::move(influences);
    auto& last = last_skeleton_.skeleton;
    if (!last || *last != *skeleton) {
      last = make_shared_owned<const Skeleton>(std::move(*skeleton));
    }
    last_skeleton_.first_frame = first;
  }
  return SkeletonPose{last_skeleton_.skeleton, gof->gof.recon->places(position_ - 1 - first),
                      gof->gof.recon->values_of_frame()};
}

}  // namespace rlpc
