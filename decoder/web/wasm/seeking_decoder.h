// Decodes the frames of a stream in any order.
//
// Bytes of the stream may be missing: a read that finds none makes a function fail with
// Errc::kIo. Once the bytes are there, the function can be called again, and goes on.
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
  // Opens the source again whenever it is called.
  using OpenSource = std::function<std::unique_ptr<ByteSource>()>;

  SeekingDecoder(OpenSource open_source, const DecoderOptions& options);

  // The functions below return false if there is an error, which is then in error().
  bool open();
  // Finds where access units and shared rigs begin (6.9): landmarks().
  bool find_index();
  // Decodes a frame below num_frames; seeks unless it is the next one. A frame that does not
  // match its hash is decoded nevertheless: returns true and sets hash_differs() and error().
  bool decode(std::uint32_t frame);
  // Checks the rest of the stream; to be called after the last frame.
  bool finish();
  // Decodes the attributes, once, from the first frame: drawn() and sets(). The frame that was
  // decoded last stays; the next one needs a seek.
  bool decode_attributes();
  // Reads the asset, once: asset().
  bool read_asset();
  const Error& error() const { return error_; }

  // Valid after open().
  const Decoder& decoder() const { return *decoder_; }
  // Of an open-ended stream that has been cut off, the frames of all GOFs that are whole, or 1.
  // It may read: bytes that are missing count as cut off.
  std::uint32_t num_frames();
  // Offsets of GOF and rig units in the GOF index, and of what comes after the last
  // of their access units, ascending; empty if the stream has no index.
  std::span<const std::uint64_t> landmarks() const { return landmarks_; }

  // The frame that was decoded last, grid units:
  std::span<const std::int32_t> positions() const { return positions_; }
  bool hash_differs() const { return hash_differs_; }
  std::uint32_t compared_frames() const { return decoder_->compared_frames(); }

  // Valid after decode_attributes(); none in a coarse mesh.
  const Vector<AttributeSet>& sets() const { return *sets_; }
  // With the values of all sets that vertices can have.
  DrawnMesh& drawn() { return *drawn_; }
  // Valid after read_asset(); empty: none.
  const String& asset() const { return *asset_; }

 private:
  std::optional<Decoder> open_decoder(bool verify_hashes);
  bool decode_with(std::optional<Decoder>& decoder, std::uint32_t frame);

  OpenSource open_source_;
  DecoderOptions options_;
  std::optional<Decoder> decoder_;
  std::optional<Decoder> unchecked_;  // for frames that do not match their hash
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
