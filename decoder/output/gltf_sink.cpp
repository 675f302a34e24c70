// glTF 2.0 as one .glb file: frame 0 is the mesh, every other frame that differs from it a
// morph target with weight 1 at the time of the frame. Viewers interpolate in between (LINEAR).
//
// A target holds differences from frame 0. Where such a difference is not exact in 32-bit
// floats, the sum would miss the position. Such frames get their positions as the target,
// together with a common target that cancels frame 0.
#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "common/io/binary_numbers.h"
#include "common/io/float_position.h"
#include "common/io/output_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::uint64_t kMaxFileBytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kMaxShortVertices = 65535;  // index 65535 is reserved in glTF
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

// A growing JSON array.
class JsonArray {
 public:
  // Index of the value in the array.
  std::uint32_t add(const std::string& value) {
    if (size_ > 0) text_ += ',';
    text_ += value;
    return size_++;
  }
  std::uint32_t size() const { return size_; }
  std::string text() const { return "[" + text_ + "]"; }

 private:
  std::string text_;
  std::uint32_t size_ = 0;
};

// The binary chunk, in an unnamed temporary file: the JSON chunk precedes it, but is known only
// at the end.
class BinaryChunk {
 public:
  BinaryChunk() : file_(std::tmpfile()) {}
  BinaryChunk(const BinaryChunk&) = delete;
  BinaryChunk& operator=(const BinaryChunk&) = delete;
  ~BinaryChunk() {
    if (file_ != nullptr) std::fclose(file_);
  }

  std::uint64_t size() const { return size_; }

  // Begins at a multiple of 4. False: see errno.
  bool append(std::string_view bytes) {
    constexpr std::array<char, 4> kZeros{};
    const std::size_t padding = (4 - bytes.size() % 4) % 4;
    size_ += bytes.size() + padding;
    return file_ != nullptr &&
           std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size() &&
           std::fwrite(kZeros.data(), 1, padding, file_) == padding;
  }

  bool rewind() { return std::fseek(file_, 0, SEEK_SET) == 0; }

  std::size_t read(std::span<char> bytes) {
    return std::fread(bytes.data(), 1, bytes.size(), file_);
  }

 private:
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

// Minimum and maximum per axis, which accessors of positions must have.
std::string bounds_text(std::span<const float> xyz) {
  std::string min = "\"min\":[";
  std::string max = "\"max\":[";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low = xyz[axis];
    float high = xyz[axis];
    for (std::size_t i = axis; i < xyz.size(); i += 3) {
      low = std::min(low, xyz[i]);
      high = std::max(high, xyz[i]);
    }
    append_number(min += axis > 0 ? "," : "", low);
    append_number(max += axis > 0 ? "," : "", high);
  }
  return min + "]," + max + "]";
}

// Differences of a frame from frame 0; none if some sum would not be exact.
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
      base_accessor_ = add_vectors(base_);
    } else if (const auto moves = exact_moves(base_, xyz_)) {
      add_moves(*moves);
    } else {
      add_weight(minus_base_target());
      add_weight(targets_.add(position_text(add_vectors(xyz_))));
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
    if (options_.limit != nullptr && chunk_.size() > options_.limit->left) {
      return options_.limit->exceeded(file_.path());
    }
    if (!failed_ && chunk_.size() <= kMaxFileBytes) return std::nullopt;
    if (failed_)
      return output_error(file_.path(), "store its binary part temporarily", reason_);
    return too_large();
  }

  OutputError too_large() const {
    return OutputError{file_.path() +
                       ": more than 4 GB, which a .glb file cannot hold; write fewer frames "
                       "(--frames), or a point cache"};
  }

  // `target`: bufferView.target; 0: none.
  std::uint32_t add_view(std::string_view bytes, int target) {
    std::string view = "{\"buffer\":0,\"byteOffset\":" + to_string(chunk_.size()) +
                       ",\"byteLength\":" + to_string(bytes.size());
    if (target != 0) view += ",\"target\":" + to_string(target);
    if (!failed_ && !chunk_.append(bytes)) {
      failed_ = true;
      reason_ = errno;
    }
    return views_.add(view + "}");
  }

  std::uint32_t add_floats(std::span<const float> values, int target) {
    std::string bytes;
    for (const float x : values) append_f32(bytes, x);
    return add_view(bytes, target);
  }

  static std::string accessor_text(int component, std::uint64_t count, const char* type) {
    return "{\"componentType\":" + to_string(component) + ",\"count\":" + to_string(count) +
           ",\"type\":\"" + type + "\"";
  }

  // Accessor of all values.
  std::uint32_t add_vectors(std::span<const float> xyz) {
    const std::string view = to_string(add_floats(xyz, kVertexTarget));
    return accessors_.add(accessor_text(kFloat, xyz.size() / 3, "VEC3") +
                          ",\"bufferView\":" + view + "," + bounds_text(xyz) + "}");
  }

  // The sparse part of an accessor that is zero except for `values` at `places`.
  std::string sparse_text(const std::vector<std::uint32_t>& places, std::uint64_t count,
                          std::span<const float> values) {
    const bool is_short = count <= kMaxShortVertices;
    std::string bytes;
    for (const std::uint32_t place : places) {
      append_u32(bytes, place);
      if (is_short) bytes.resize(bytes.size() - 2);
    }
    const std::string indices = to_string(add_view(bytes, 0));
    return ",\"sparse\":{\"count\":" + to_string(places.size()) +
           ",\"indices\":{\"bufferView\":" + indices +
           ",\"componentType\":" + to_string(is_short ? kUnsignedShort : kUnsignedInt) +
           "},\"values\":{\"bufferView\":" + to_string(add_floats(values, 0)) + "}}";
  }

  // Whether a sparse accessor is smaller.
  static bool is_sparse(std::uint64_t places, std::uint64_t count, std::uint64_t value_bytes) {
    const std::uint64_t index_bytes = count <= kMaxShortVertices ? 2 : 4;
    return places > 0 && places * (index_bytes + value_bytes) < count * value_bytes;
  }

  static std::string position_text(std::uint32_t accessor) {
    return "{\"POSITION\":" + to_string(accessor) + "}";
  }

  void add_moves(std::span<const float> moves) {
    std::vector<std::uint32_t> moving;
    std::vector<float> values;
    for (std::uint32_t v = 0; v < options_.num_vertices; ++v) {
      const auto move = moves.subspan(3 * std::size_t{v}, 3);
      if (move[0] == 0 && move[1] == 0 && move[2] == 0) continue;
      moving.push_back(v);
      values.insert(values.end(), move.begin(), move.end());
    }
    if (moving.empty()) return;
    if (!is_sparse(moving.size(), options_.num_vertices, 12)) {
      return add_weight(targets_.add(position_text(add_vectors(moves))));
    }
    const std::string sparse = sparse_text(moving, options_.num_vertices, values);
    add_weight(targets_.add(
        position_text(accessors_.add(accessor_text(kFloat, options_.num_vertices, "VEC3") +
                                     "," + bounds_text(moves) + sparse + "}"))));
  }

  // Comes before the targets of the frames that need it, so that sums stay exact.
  std::uint32_t minus_base_target() {
    if (!minus_base_) {
      std::vector<float> minus(base_.size());
      for (std::size_t i = 0; i < base_.size(); ++i) minus[i] = 0 - base_[i];
      minus_base_ = targets_.add(position_text(add_vectors(minus)));
    }
    return *minus_base_;
  }

  // Gives a target weight 1 in this frame.
  void add_weight(std::uint32_t target) { weights_.push_back({written_, target}); }

  std::uint32_t add_indices() {
    const bool is_short = options_.num_vertices <= kMaxShortVertices;
    std::string bytes;
    for (const Triangle& t : options_.triangles) {
      for (const std::uint32_t v : t) {
        append_u32(bytes, v);
        if (is_short) bytes.resize(bytes.size() - 2);
      }
    }
    const std::string view = to_string(add_view(bytes, kIndexTarget));
    return accessors_.add(accessor_text(is_short ? kUnsignedShort : kUnsignedInt,
                                        3 * std::uint64_t{options_.triangles.size()},
                                        "SCALAR") +
                          ",\"bufferView\":" + view + "}");
  }

  std::uint32_t add_times() {
    std::vector<float> times;
    for (std::uint32_t f = 0; f < options_.num_frames; ++f) {
      times.push_back(frame_time(options_.frame_rate, f));
    }
    const std::string view = to_string(add_floats(times, 0));
    std::string last;
    append_number(last, times.back());
    return accessors_.add(accessor_text(kFloat, times.size(), "SCALAR") +
                          ",\"bufferView\":" + view + ",\"min\":[0],\"max\":[" + last + "]}");
  }

  // The weights of all targets, per frame.
  std::uint32_t add_weights() {
    const std::uint64_t count = std::uint64_t{options_.num_frames} * targets_.size();
    std::vector<std::uint32_t> places;
    for (const Weight& w : weights_) {
      places.push_back(static_cast<std::uint32_t>(w.frame * targets_.size() + w.target));
    }
    std::string accessor = accessor_text(kFloat, count, "SCALAR");
    if (is_sparse(places.size(), count, 4)) {
      accessor += sparse_text(places, count, std::vector<float>(places.size(), 1));
    } else {
      std::vector<float> values(static_cast<std::size_t>(count));
      for (const std::uint32_t place : places) values[place] = 1;
      accessor += ",\"bufferView\":" + to_string(add_floats(values, 0));
    }
    return accessors_.add(accessor + "}");
  }

  // An animation without motion still has a duration.
  void add_target_at_rest() {
    targets_.add(
        position_text(accessors_.add(accessor_text(kFloat, options_.num_vertices, "VEC3") +
                                     ",\"min\":[0,0,0],\"max\":[0,0,0]}")));
  }

  std::string primitive_text() {
    std::string text = "{\"attributes\":" + position_text(base_accessor_);
    text += ",\"mode\":" + to_string(options_.triangles.empty() ? 0 : 4);
    if (!options_.triangles.empty()) text += ",\"indices\":" + to_string(add_indices());
    if (targets_.size() > 0) text += ",\"targets\":" + targets_.text();
    return text + ",\"material\":0}";
  }

  std::string animations_text() {
    if (options_.num_frames == 1) return "";
    const std::string input = to_string(add_times());
    return ",\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
           "\"path\":\"weights\"}}],\"samplers\":[{\"input\":" +
           input + ",\"interpolation\":\"LINEAR\",\"output\":" + to_string(add_weights()) +
           "}]}]";
  }

  std::string document() {
    const std::uint64_t most_weights =
        std::uint64_t{options_.num_frames} * (targets_.size() + 1);
    if (most_weights > kMaxFileBytes) {
      return "";  // and write_chunks() says so
    }
    if (options_.num_frames > 1 && targets_.size() == 0) add_target_at_rest();
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
    text += ",\"accessors\":" + accessors_.text() + ",\"bufferViews\":" + views_.text() +
            ",\"buffers\":[{\"byteLength\":" + to_string(chunk_.size()) + "}]}";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
  }

  std::optional<OutputError> write_chunks(const std::string& json) {
    const std::uint64_t size = 12 + 8 + json.size() + 8 + chunk_.size();
    if (json.empty() || size > kMaxFileBytes) return too_large();
    std::string head = "glTF";
    append_u32(head, 2);
    append_u32(head, static_cast<std::uint32_t>(size));
    append_u32(head, static_cast<std::uint32_t>(json.size()));
    head += "JSON" + json;
    append_u32(head, static_cast<std::uint32_t>(chunk_.size()));
    head += std::string("BIN\0", 4);
    if (auto error = file_.write(head)) return error;
    std::vector<char> block(std::size_t{1} << 16);
    std::uint64_t left = chunk_.size();
    bool ok = chunk_.rewind();
    while (ok && left > 0) {
      const std::size_t read = chunk_.read(block);
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
  BinaryChunk chunk_;
  JsonArray views_;
  JsonArray accessors_;
  JsonArray targets_;
  std::vector<Weight> weights_;  // those that are 1, ascending
  std::vector<float> base_;      // frame 0
  std::uint32_t base_accessor_ = 0;
  std::optional<std::uint32_t> minus_base_;
  std::vector<float> xyz_;
  std::uint32_t written_ = 0;
  bool failed_ = false;
  int reason_ = 0;
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
