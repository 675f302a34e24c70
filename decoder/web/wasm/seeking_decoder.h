// Decodes the frames of a stream in any order.
//
// Bytes of the stream may be missing: reading them makes a function fail with Errc::kIo. Once
// they have arrived, the function can be called again, and continues.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/surface/drawn_mesh.h"

namespace rlpc {

class SeekingDecoder {
 public:
  // Opens the source, again in each call.
  using OpenSource = std::function<std::unique_ptr<ByteSource>()>;

  SeekingDecoder(OpenSource open_source, const DecoderOptions& options);

  // On failure, the functions below return false and set error().
  bool open();
  // Finds the access units and shared rigs (6.9): landmarks().
  bool find_index();
  // Decodes a frame below num_frames; seeks unless it is the next one. A frame that does not
  // match its hash is still decoded: returns true and sets hash_differs() and error().
  bool decode(std::uint32_t frame);
  // Checks the rest of the stream. Must be called after the last frame.
  bool finish();
  // Decodes the attributes on the first call: drawn() and sets(). positions() stay the same;
  // the next frame needs a seek.
  bool decode_attributes();
  // Reads the asset on the first call: asset().
  bool read_asset();
  const Error& error() const { return error_; }

  // Valid after open().
  const Decoder& decoder() const { return *decoder_; }
  // Returns the number of frames; of an open-ended stream that was cut off, the frames of its
  // whole GOFs, or 1. May read; missing bytes count as cut off.
  std::uint32_t num_frames();
  // Returns the offsets of the GOF and rig units in the GOF index, and the end of the last of
  // their access units, ascending; empty if the stream has no index.
  std::span<const std::uint64_t> landmarks() const { return landmarks_; }

  // Return the frame that was decoded last, grid units, and the results of its hash check.
  std::span<const std::int32_t> positions() const { return positions_; }
  bool hash_differs() const { return hash_differs_; }
  std::uint32_t compared_frames() const { return decoder_->compared_frames(); }

  // Valid after decode_attributes(); none in a coarse mesh.
  const Vector<AttributeSet>& sets() const { return *sets_; }
  // Returns the drawn mesh with all drawable sets.
  DrawnMesh& drawn() { return *drawn_; }
  // Valid after read_asset(); empty: none.
  const String& asset() const { return *asset_; }

 private:
  std::optional<Decoder> open_decoder(bool verify_hashes);
  bool decode_with(std::optional<Decoder>& decoder, std::uint32_t frame);

  OpenSource open_source_;
  DecoderOptions options_;
  std::optional<Decoder> decoder_;
  std::optional<Decoder> unchecked_;  // decoder of frames that do not match their hash
  std::uint32_t frame_ = 0;
  bool failed_ = false;  // decoder_ has a sticky error and needs a seek
  bool hash_differs_ = false;
  Error error_;
  std::vector<std::uint64_t> landmarks_;
  std::vector<std::int32_t> positions_;
  std::optional<Vector<AttributeSet>> sets_;
  std::optional<DrawnMesh> drawn_;
  std::optional<String> asset_;
};

}  // namespace rlpc
