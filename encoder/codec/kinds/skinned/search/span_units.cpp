#include "encoder/codec/kinds/skinned/search/span_units.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/search/temporal_cut.h"
#include "encoder/codec/write/write_skinned_gof.h"

namespace rlpc {
namespace {

void add_units(SkinnedGofPayloads payloads, UnitType first, EncodedSpan& encoded) {
  encoded.units.push_back({first, std::move(payloads.first)});
  for (std::size_t i = 0; i < payloads.slices.size(); ++i) {
    encoded.units.push_back(
        {UnitType::kSlice, std::move(payloads.slices[i]), payloads.temporal_layer_idx[i]});
  }
}

DecodeFrame frames_of(std::shared_ptr<const SkinnedRecon> recon) {
  return [recon = std::move(recon)](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
}

// Decodes GOFs one after the other.
DecodeFrame frames_of(std::vector<std::shared_ptr<const SkinnedRecon>> recons) {
  return [recons = std::move(recons)](std::uint32_t f, std::span<std::int32_t> positions) {
    auto recon = recons.begin();
    while (f >= (*recon)->num_frames()) f -= (*recon++)->num_frames();
    (*recon)->frame(f, positions);
  };
}

// Counts the factors of a span; local component groups add trajectories with their own.
void count(const SharedRig& rig, std::uint64_t num_vertices, std::span<const SkinnedGof> gofs,
           EncodedSpan& encoded) {
  const std::uint64_t num_bones = rig.bones.size();
  const std::uint64_t shared = rig.trajectories.size();
  encoded.clusters = static_cast<std::uint32_t>(num_bones);
  encoded.max_clusters = encoded.clusters;
  encoded.components = static_cast<std::uint32_t>(shared);
  encoded.adaptive_values = rig.weights.num_adaptive_factors * num_vertices;
  for (const SkinnedGof& gof : gofs) {
    const std::uint64_t all = std::max<std::uint64_t>(shared, gof.trajectories.size());
    encoded.components += static_cast<std::uint32_t>(all - shared);
    encoded.max_components = std::max(encoded.max_components, static_cast<std::uint32_t>(all));
    encoded.num_factors =
        std::max(encoded.num_factors, (kRestFactors + all) * num_vertices +
                                          (6 * num_bones + 3 * all) * gof.num_frames);
  }
}

}  // namespace

// values: spatial values if known, or empty.
SpanUnits::SharedRecon SpanUnits::recon_of(const SharedRig& rig,
                                           std::span<const std::int32_t> values) const {
  return values.empty() ? std::make_shared<RigRecon>(mesh_, rig, header_.position_bits, false)
                        : std::make_shared<RigRecon>(mesh_, rig, header_.position_bits, values);
}

EncodedSpan SpanUnits::alone(CodedSpan coded) const {
  EncodedSpan encoded;
  count(coded.rig, mesh_.num_vertices(), coded.gofs, encoded);
  const std::vector<std::int32_t> values = std::move(coded.values);
  auto gof = std::make_shared<SkinnedGof>(merge_into_gof(std::move(coded)));
  set_temporal_layers(temporal_layers_, *gof);
  SkinnedGofPayloads payloads;
  std::shared_ptr<const SkinnedRecon> recon;
  for_each(2, [&](std::size_t i) {
    if (i == 0) recon = std::make_shared<SkinnedRecon>(recon_of(*gof, values), *gof);
    if (i == 1) payloads = write_skinned_gof(*gof, mesh_, header_);
  });
  add_units(std::move(payloads), UnitType::kGof, encoded);
  if (temporal_layers_ > 1) {
    encoded.cut = [&mesh = mesh_, gof, position_bits = header_.position_bits](int layers) {
      return frames_of(
          std::make_shared<SkinnedRecon>(mesh, without_layers(*gof, layers), position_bits));
    };
  }
  encoded.frame = frames_of(std::move(recon));
  return encoded;
}

void SpanUnits::write_rig(const SharedRig& rig, EncodedSpan& encoded) const {
  add_units(write_shared_rig(rig, kRigIdx, mesh_, header_), UnitType::kRig, encoded);
}

// Writes skinned GOFs with shared rigs, complete except for temporal layers.
void SpanUnits::write_gofs(const SharedRecon& recon, std::vector<SkinnedGof> gofs,
                           EncodedSpan& encoded) const {
  std::vector<std::shared_ptr<const SkinnedRecon>> recons;
  for (SkinnedGof& gof : gofs) {
    set_temporal_layers(temporal_layers_, gof);
    add_units(write_tracks(gof, mesh_, header_), UnitType::kGof, encoded);
    recons.push_back(std::make_shared<SkinnedRecon>(recon, gof));
  }
  if (temporal_layers_ > 1) {
    encoded.cut = [recon, gofs = std::move(gofs)](int layers) {
      std::vector<std::shared_ptr<const SkinnedRecon>> cut;
      for (const SkinnedGof& gof : gofs) {
        cut.push_back(std::make_shared<SkinnedRecon>(recon, without_layers(gof, layers)));
      }
      return frames_of(std::move(cut));
    };
  }
  encoded.frame = frames_of(std::move(recons));
}

EncodedSpan SpanUnits::with_rig(CodedSpan coded) const {
  EncodedSpan encoded;
  count(coded.rig, mesh_.num_vertices(), coded.gofs, encoded);
  const auto rig = std::make_shared<const SharedRig>(std::move(coded.rig));
  write_rig(*rig, encoded);
  const SharedRecon recon = recon_of(*rig, coded.values);
  for (SkinnedGof& gof : coded.gofs) use_rig(rig, gof);
  write_gofs(recon, std::move(coded.gofs), encoded);
  return encoded;
}

EncodedSpan SpanUnits::with_kept_rig(
    CodedSpan coded, const std::array<std::vector<std::int32_t>, 3>& rest) const {
  EncodedSpan encoded;
  count(coded.rig, mesh_.num_vertices(), coded.gofs, encoded);
  write_rig(coded.rig, encoded);
  auto kept = std::make_shared<KeptRig>();
  kept->recon = std::make_shared<const RigRecon>(mesh_, coded.rig, header_.position_bits, true);
  coded.rig.vertex_residual = {};
  coded.rig.counterparts = {};
  kept->rig = std::make_shared<const SharedRig>(std::move(coded.rig));
  kept->rest = rest;
  for (SkinnedGof& gof : coded.gofs) use_rig(kept->rig, gof);
  write_gofs(kept->recon, std::move(coded.gofs), encoded);
  encoded.rig = std::move(kept);
  return encoded;
}

EncodedSpan SpanUnits::with_earlier_rig(const KeptRig& kept, std::vector<SkinnedGof> gofs,
                                        std::vector<LocalGroup> local_groups) const {
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    use_rig(kept.rig, gofs[g]);
    add_local_group(std::move(local_groups[g]), gofs[g]);
  }
  EncodedSpan encoded;
  count(*kept.rig, mesh_.num_vertices(), gofs, encoded);
  write_gofs(kept.recon, std::move(gofs), encoded);
  return encoded;
}

}  // namespace rlpc
