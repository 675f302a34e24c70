// glTF 2.0 as one .glb file: frame 0 is the mesh, every other frame that differs from it a
// morph target with weight 1 at the time of the frame. Viewers interpolate in between (LINEAR).
//
// A target holds differences from frame 0. Where such a difference is not exact in 32-bit
// floats, the sum would miss the position. Such frames get their positions as the target,
// together with a common target that cancels frame 0.
#include <cassert>
#include <cerrno>
#include <cmath>
#include <limits>
#include <utility>

#include "common/io/binary_numbers.h"
#include "common/io/float_position.h"
#include "common/io/output_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/gltf_buffers.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::uint64_t kMaxFileBytes = std::numeric_limits<std::uint32_t>::max();

// Differences of a frame from frame 0; none if any sum would not be exact.
std::optional<std::vector<float>> exact_moves(std::span<const float> from,
                                              std::span<const float> to) {
  std::vector<float> moves(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    moves[i] = to[i] - from[i];
    if (double{from[i]} + double{moves[i]} != double{to[i]}) return std::nullopt;
  }
  return moves;
}

class GltfSink : public FrameSink {
 public:
  GltfSink(SinkOptions options, OutputFile file)
      : options_(std::move(options)), file_(std::move(file)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    assert(positions.size() == 3 * std::size_t{options_.num_vertices});
    assert(written_ < options_.num_frames);
    xyz_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      xyz_[i] = float_position(options_.grid, i % 3, positions[i]);
      if (std::isfinite(xyz_[i])) continue;
      return OutputError{file_.path() + ": frame " + to_string(written_) +
                         " (from 0), vertex " + to_string(i / 3) +
                         ": too large for glTF, whose positions are floats"};
    }
    if (written_ == 0) {
      base_ = xyz_;
      base_accessor_ = buffers_.add_vectors(base_);
    } else if (const auto moves = exact_moves(base_, xyz_)) {
      if (const auto accessor = buffers_.add_moves(*moves)) {
        add_weight(targets_.add(position_text(*accessor)));
      }
    } else {
      add_weight(minus_base_target());
      add_weight(targets_.add(position_text(buffers_.add_vectors(xyz_))));
    }
    ++written_;
    return failure();
  }

  std::optional<OutputError> finish() override {
    assert(written_ == options_.num_frames);
    const std::string json = document();
    if (auto error = failure()) return error;
    if (auto error = write_chunks(json)) return error;
    if (auto error = file_.close()) return error;
    return file_.commit();
  }

 private:
  std::optional<OutputError> failure() const {
    const std::uint64_t size = buffers_.chunk().size();
    if (options_.limit != nullptr && size > options_.limit->left) {
      return options_.limit->exceeded(file_.path());
    }
    if (const auto reason = buffers_.failure()) {
      return output_error(file_.path(), "store its binary part temporarily", *reason);
    }
    if (size > kMaxFileBytes) return too_large();
    return std::nullopt;
  }

  OutputError too_large() const {
    return OutputError{file_.path() +
                       ": more than 4 GB, which a .glb file cannot hold; write fewer frames "
                       "(--frames), or a point cache"};
  }

  static std::string position_text(std::uint32_t accessor) {
    return "{\"POSITION\":" + to_string(accessor) + "}";
  }

  // Comes before the targets of the frames that need it, so that sums stay exact.
  std::uint32_t minus_base_target() {
    if (!minus_base_) {
      std::vector<float> minus(base_.size());
      for (std::size_t i = 0; i < base_.size(); ++i) minus[i] = 0 - base_[i];
      minus_base_ = targets_.add(position_text(buffers_.add_vectors(minus)));
    }
    return *minus_base_;
  }

  // Gives a target weight 1 in this frame.
  void add_weight(std::uint32_t target) { weights_.push_back({written_, target}); }

  // The weights of all targets, per frame.
  std::uint32_t add_weights() {
    std::vector<std::uint32_t> places;
    for (const Weight& w : weights_) {
      places.push_back(static_cast<std::uint32_t>(w.frame * targets_.size() + w.target));
    }
    return buffers_.add_ones(places, std::uint64_t{options_.num_frames} * targets_.size());
  }

  std::string primitive_text() {
    std::string text = "{\"attributes\":" + position_text(base_accessor_);
    text += ",\"mode\":" + to_string(options_.triangles.empty() ? 0 : 4);
    if (!options_.triangles.empty()) {
      text += ",\"indices\":" +
              to_string(buffers_.add_indices(options_.triangles, options_.num_vertices));
    }
    if (targets_.size() > 0) text += ",\"targets\":" + targets_.text();
    return text + ",\"material\":0}";
  }

  std::string animations_text() {
    if (options_.num_frames == 1) return "";
    std::vector<float> times;
    for (std::uint32_t f = 0; f < options_.num_frames; ++f) {
      times.push_back(frame_time(options_.frame_rate, f));
    }
    const std::string input = to_string(buffers_.add_times(times));
    return ",\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
           "\"path\":\"weights\"}}],\"samplers\":[{\"input\":" +
           input + ",\"interpolation\":\"LINEAR\",\"output\":" + to_string(add_weights()) +
           "}]}]";
  }

  std::string document() {
    const std::uint64_t most_weights =
        std::uint64_t{options_.num_frames} * (targets_.size() + 1);
    if (most_weights > kMaxFileBytes) {
      return "";  // write_chunks() reports it
    }
    if (options_.num_frames > 1 && targets_.size() == 0) {
      // An animation without motion still has a duration.
      targets_.add(position_text(buffers_.add_zero_vectors(options_.num_vertices)));
    }
    std::string weights;
    for (std::uint32_t t = 0; t < targets_.size(); ++t) weights += t > 0 ? ",0" : "0";
    std::string text =
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"rlpcdec\",\"extras\":{"
        "\"frame_rate\":\"" +
        frame_rate_text(options_.frame_rate) +
        "\"}},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"materials\":[{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0}}"
        "],\"meshes\":[{\"primitives\":[" +
        primitive_text() + "]";
    if (!weights.empty()) text += ",\"weights\":[" + weights + "]";
    text += "}]" + animations_text();
    text += ",\"accessors\":" + buffers_.accessors_text() +
            ",\"bufferViews\":" + buffers_.views_text() +
            ",\"buffers\":[{\"byteLength\":" + to_string(buffers_.chunk().size()) + "}]}";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
  }

  std::optional<OutputError> write_chunks(const std::string& json) {
    BinaryChunk& chunk = buffers_.chunk();
    const std::uint64_t size = 12 + 8 + json.size() + 8 + chunk.size();
    if (json.empty() || size > kMaxFileBytes) return too_large();
    std::string head = "glTF";
    append_u32(head, 2);
    append_u32(head, static_cast<std::uint32_t>(size));
    append_u32(head, static_cast<std::uint32_t>(json.size()));
    head += "JSON" + json;
    append_u32(head, static_cast<std::uint32_t>(chunk.size()));
    head += std::string("BIN\0", 4);
    if (auto error = file_.write(head)) return error;
    std::vector<char> block(std::size_t{1} << 16);
    std::uint64_t left = chunk.size();
    bool ok = chunk.rewind();
    while (ok && left > 0) {
      const std::size_t read = chunk.read(block);
      if (auto error = file_.write({block.data(), read})) return error;
      ok = read > 0;
      left -= read;
    }
    if (ok) return std::nullopt;
    return output_error(file_.path(), "read its binary part back", errno);
  }

  struct Weight {
    std::uint32_t frame;
    std::uint32_t target;
  };

  SinkOptions options_;
  OutputFile file_;
  GltfBuffers buffers_;
  JsonArray targets_;
  std::vector<Weight> weights_;  // those that are 1, ascending
  std::vector<float> base_;      // frame 0
  std::uint32_t base_accessor_ = 0;
  std::optional<std::uint32_t> minus_base_;
  std::vector<float> xyz_;
  std::uint32_t written_ = 0;
};

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_gltf_sink(const std::string& path,
                                                        SinkOptions options) {
  auto file = OutputFile::create(path, options.limit);
  if (!file) return file.error();
  return std::unique_ptr<FrameSink>(
      std::make_unique<GltfSink>(std::move(options), std::move(*file)));
}

}  // namespace rlpc
