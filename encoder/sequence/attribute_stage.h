// Codes the attributes of a source when its first frame has been decoded.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/attributes/encode_attributes.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/stream_assembly.h"

namespace rlpc {

class AttributeStage {
 public:
  // triangles: of the source. Keeps references to source and connectivity.
  AttributeStage(const SourceAttributes& source, std::span<const Triangle> triangles,
                 const EncoderSettings& settings, const ConnectivityCode& connectivity);

  bool has_sets() const { return !source_.sets.empty() && !settings_.dropped; }
  // Positions of the first frame of the source, nearest on the grid, in decoded order: what the
  // ways to code normals are judged by. Before encode(), or those of encode() count.
  void set_source_frame(std::vector<std::int32_t> positions) {
    source_frame_ = std::move(positions);
  }
  // Replaces the attribute unit of the stream. first_frame: positions on the grid, in decoded
  // order; to be called again if they have changed.
  void encode(std::span<const std::int32_t> first_frame, StreamAssembly& stream);
  // Of the last call.
  const std::vector<AttributeReport>& reports() const { return reports_; }

 private:
  const SourceAttributes& source_;
  AttributeSettings settings_;
  const ConnectivityCode& connectivity_;
  std::vector<std::uint32_t> corner_map_;
  std::vector<std::int32_t> source_frame_;
  std::vector<AttributeReport> reports_;
};

}  // namespace rlpc
