// Writes the units of a span of skinned GOFs, and makes the functions that decode it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/skinned/quantise/kept_rig.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_gof_encoder.h"
#include "encoder/codec/spans/span_coder.h"

namespace rlpc {

class SpanUnits {
 public:
  // Keeps a reference to the mesh, which encodings also refer to, and to the header.
  SpanUnits(const OrderedMesh& mesh, const SequenceHeader& header, int temporal_layers)
      : mesh_(mesh), header_(header), temporal_layers_(temporal_layers) {}

  // Writes the only GOF of a span, with vertices of its own.
  EncodedSpan alone(CodedSpan coded) const;
  // Writes a shared rig and the GOFs that use it.
  EncodedSpan with_rig(CodedSpan coded) const;
  // Writes the same; later spans may use the rig. rest: as decoded, 1/16 grid units.
  EncodedSpan with_kept_rig(CodedSpan coded,
                            const std::array<std::vector<std::int32_t>, 3>& rest) const;
  // Writes GOFs that use an earlier rig. local_groups [GOF].
  EncodedSpan with_earlier_rig(const KeptRig& kept, std::vector<SkinnedGof> gofs,
                               std::vector<LocalGroup> local_groups) const;

 private:
  using SharedRecon = std::shared_ptr<const RigRecon>;

  SharedRecon recon_of(const SharedRig& rig, std::span<const std::int32_t> values) const;

  void write_rig(const SharedRig& rig, EncodedSpan& encoded) const;
  void write_gofs(const SharedRecon& recon, std::vector<SkinnedGof> gofs,
                  EncodedSpan& encoded) const;

  const OrderedMesh& mesh_;
  const SequenceHeader& header_;
  int temporal_layers_;
};

}  // namespace rlpc
