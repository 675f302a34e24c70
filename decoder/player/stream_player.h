// Decodes the frames of a stream in any order, for display by a player.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decoder/player/frame_surface.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

using Vec3d = std::array<double, 3>;

// The map from grid positions to drawing coordinates: position * scale + offset.
struct Placement {
  double scale = 1;
  Vec3d offset{};
};

// Maps the range of position_bits to the cube from -1 to 1.
Placement placement_of(const SequenceHeader& header);
// Maps the positions of `header` to the cube of another stream.
Placement placement_in(const SequenceHeader& header, const SequenceHeader& other);

// Computes the drawing coordinates of a frame relative to the centre of its box, and returns
// that centre. So the 24 bits of a float on the graphics card resolve the mesh, not its
// distance from the origin. positions and coordinates have the same size.
Vec3d centred_coordinates(std::span<const std::int32_t> positions, const Placement& placement,
                          std::span<float> coordinates);

class StreamPlayer {
 public:
  // Opens the stream again; called at most twice.
  using OpenSource = std::unique_ptr<ByteSource> (*)(std::uint32_t stream,
                                                     std::uint64_t num_bytes);

  StreamPlayer(OpenSource open_source, std::uint32_t stream, std::uint64_t num_bytes);

  // The functions below return false if the stream has an error, which is then in error().
  bool open();
  // Decodes a frame below num_frames; seeks unless it is the next one. A frame that does not
  // match its hash is decoded nevertheless: returns true and sets hash_differs() and error().
  bool decode(std::uint32_t frame);
  // Checks the rest of the stream; to be called after the last frame.
  bool finish();
  const Error& error() const { return error_; }

  // Valid after open().
  const Decoder& decoder() const { return *decoder_; }
  void set_placement(const Placement& placement) { placement_ = placement; }

  // The frame that was decoded last:
  std::span<const std::int32_t> positions() const { return positions_; }
  std::span<const float> coordinates() const { return coordinates_; }  // relative to the centre
  const Vec3d& centre() const { return centre_; }
  bool hash_differs() const { return hash_differs_; }
  std::uint32_t compared_frames() const { return decoder_->compared_frames(); }

 private:
  std::optional<Decoder> open_decoder(bool verify_hashes);
  bool decode_with(std::optional<Decoder>& decoder, std::uint32_t frame);

  OpenSource open_source_;
  std::uint32_t stream_;
  std::uint64_t num_bytes_;
  std::optional<Decoder> decoder_;
  std::optional<Decoder> unchecked_;  // for frames that do not match their hash
  bool failed_ = false;               // decoder_ has a sticky error and needs a seek
  bool hash_differs_ = false;
  Error error_;
  Placement placement_;
  std::vector<std::int32_t> positions_;
  std::vector<float> coordinates_;
  Vec3d centre_{};
};

}  // namespace rlpc
