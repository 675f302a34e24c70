// Codes the attributes of a source once its first frame has been decoded.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/codec/attributes/encode_attributes.h"
#include "encoder/codec/sequence/stream_assembly.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

class AttributeStage {
 public:
  // triangles: in the order of the source. is_animated: the sequence has, or may have, several
  // frames. Keeps references to source and connectivity.
  AttributeStage(const SourceAttributes& source, std::span<const Triangle> triangles,
                 const EncoderSettings& settings, const ConnectivityCode& connectivity,
                 bool is_animated = true);

  bool has_sets() const { return !source_.sets.empty() && !settings_.dropped; }
  // Returns the frames that encode() uses, ascending; none without sets.
  std::vector<std::uint32_t> frames() const;
  // Replaces the attribute unit of the stream. decoded: the first frame, and perhaps others of
  // frames(); call it again if they have changed.
  void encode(std::span<const DecodedFrame> decoded, StreamAssembly& stream);
  // Returns the reports of the last encode().
  const std::vector<AttributeReport>& reports() const { return reports_; }

 private:
  const SourceAttributes& source_;
  AttributeSettings settings_;
  const ConnectivityCode& connectivity_;
  std::vector<std::uint32_t> corner_map_;
  bool is_animated_;
  std::vector<AttributeReport> reports_;
};

}  // namespace rlpc
