// Outputs of a decoder besides positions: attributes, assets and bones.
#include <algorithm>
#include <utility>

#include "common/codec/attributes/recon/attribute_recon.h"
#include "common/codec/bits/crc32.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/attributes/parse_attributes.h"
#include "decoder/codec/parse/sequence/parse_asset.h"
#include "decoder/decoder_impl.h"

namespace rlpc {

Result<Vector<std::int32_t>> Decoder::Impl::decode_first_frame() {
  if (auto ok = stream_.seek(0); !ok) return ok.error();
  const auto unit = stream_.find_gof();
  if (!unit) return unit.error();
  Vector<std::int32_t> positions(3 * std::size_t{stream_.header().num_vertices});
  const auto live = is_live(**unit);
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
  make_recon(*access_unit, stream_.context(), rigs_)->frame(0, positions);
  return positions;
}

Result<Vector<std::int32_t>> Decoder::Impl::first_frame() {
  const ThreadPool::Use use(threads_);
  const SliceCut cut = stream_.access_units().cut();
  if (gof_ && gof_->has_frame(0) && !cut.cuts()) {
    Vector<std::int32_t> positions(3 * std::size_t{stream_.header().num_vertices});
    gof_->gof.recon->frame(0, positions);
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
  if (!unit || coarse_) return Vector<AttributeSet>();
  const auto payload = stream_.units().payload(*unit);
  if (!payload) return payload.error();
  BitReader r = stream_.units().bits(*unit, *payload);
  // Triangles in decoded order.
  Vector<Triangle> triangles(stream_.triangles().begin(), stream_.triangles().end());
  const auto order = stream_.vertex_order();
  Vector<std::uint32_t> decoded(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) decoded[order[v]] = v;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = order.empty() ? v : decoded[v];
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
      to_output_order(positions, set.first_positions);
    }
    if (set.header.domain != AttributeDomain::kVertex || order.empty()) continue;
    const Vector<std::uint32_t> values = set.values;
    const std::size_t n = set.header.num_components;
    for (std::size_t v = 0; v < order.size(); ++v) {
      for (std::size_t c = 0; c < n; ++c) set.values[order[v] * n + c] = values[v * n + c];
    }
  }
  return sets;
}

std::optional<SkeletonPose> Decoder::Impl::pose() {
  if (!gof_ || position_ == 0 || !has_frame(position_ - 1)) return std::nullopt;
  const std::uint32_t first = gof_->header().first_frame;
  if (gof_with_skeleton_ != first) {
    std::optional<Skeleton> skeleton = gof_->gof.recon->skeleton();
    if (!skeleton) return std::nullopt;
    // Maps decoded indices of vertices, passed as positions, to output order.
    Vector<std::int32_t> decoded(3 * std::size_t{stream_.header().num_vertices});
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      decoded[i] = static_cast<std::int32_t>(i / 3);
    }
    Vector<std::int32_t> in_output(3 * std::size_t{num_vertices()});
    to_output_order(decoded, in_output);
    Vector<Vector<SkeletonInfluence>> influences;
    for (std::size_t v = 0; v < num_vertices(); ++v) {
      influences.push_back(skeleton->influences[static_cast<std::size_t>(in_output[3 * v])]);
    }
    skeleton->influences = std::move(influences);
    if (!skeleton_ || *skeleton_ != *skeleton)
      skeleton_ = make_shared_owned<const Skeleton>(std::move(*skeleton));
    gof_with_skeleton_ = first;
  }
  return SkeletonPose{skeleton_, gof_->gof.recon->places(position_ - 1 - first),
                      gof_->gof.recon->values_of_frame()};
}

}  // namespace rlpc
