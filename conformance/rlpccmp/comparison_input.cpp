#include "conformance/rlpccmp/comparison_input.h"

#include <cassert>
#include <optional>
#include <utility>
#include <vector>

#include "common/files/float_position.h"
#include "common/files/messages.h"
#include "decoder/describe_error.h"
#include "decoder/rlpc_decoder.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/mesh_reader.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc {

namespace {

// A stream as a sequence of float32 frames.
class StreamSource final : public FrameSource {
 public:
  StreamSource(Shape shape, std::string path, Decoder decoder)
      : FrameSource(std::move(shape)), path_(std::move(path)), decoder_(std::move(decoder)) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    if (frame != decoder_.position()) {
      if (const auto ok = decoder_.seek(frame); !ok) return complain(ok.error());
    }
    positions_.resize(xyz.size());
    if (const auto ok = decoder_.next_frame(positions_); !ok) return complain(ok.error());
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = float_position(decoder_.header().grid, i % 3, positions_[i]);
    }
    if (frame + 1 == num_frames()) {
      // The rest of the stream must be valid, too.
      if (const auto ok = decoder_.next_frame(positions_); !ok) return complain(ok.error());
    }
    return check_finite(path_, frame, xyz);
  }

 private:
  InputError complain(const Error& error) const {
    return InputError{path_ + ": " + describe_error(error)};
  }

  std::string path_;
  Decoder decoder_;
  std::vector<std::int32_t> positions_;
};

InputResult<ComparisonInput> open_stream(const std::string& path,
                                         std::uint64_t max_memory_bytes) {
  DecoderOptions options;
  std::uint64_t& max = options.limits.max_memory_bytes;
  if (max_memory_bytes != kUsualEncoderBytes) max = max_memory_bytes;
  auto bytes = file_source(path, max);
  if (!bytes) return InputError{path + ": " + describe_error(bytes.error())};
  ComparisonInput input;
  input.name = path;
  input.stream_bytes = (*bytes)->size();
  auto decoder = Decoder::open(std::move(*bytes), options);
  if (!decoder) return InputError{path + ": " + describe_error(decoder.error())};
  input.traversal_order = !decoder->has_vertex_order();
  FrameSource::Shape shape;
  shape.num_vertices = decoder->header().num_vertices;
  shape.num_frames = decoder->header().num_frames;
  shape.frame_rate = decoder->header().frame_rate;
  shape.triangles.assign(decoder->triangles().begin(), decoder->triangles().end());
  input.frames = std::make_unique<StreamSource>(std::move(shape), path, std::move(*decoder));
  return input;
}

// Adds the point cache next to it, if that explains why there are fewer frames than `frames`.
InputResult<ComparisonInput> add_cache(ComparisonInput input, const InputOptions& options,
                                       std::uint32_t frames) {
  if (input.frames->num_frames() != 1 || frames == 1) return input;
  if (!options.points.empty() || !is_mesh_extension(options.path)) {
    return input;
  }
  const std::string cache = sibling_of(options.path, InputFormat::Holds::kPoints);
  if (cache.empty()) return input;
  InputOptions with_cache = options;
  with_cache.points = cache;
  return open_comparison_input(with_cache);
}

}  // namespace

InputResult<ComparisonInput> open_comparison_input(const InputOptions& given) {
  const std::string extension = lower_extension(given.path);
  if (extension == ".rlpc") {
    if (auto error = check_gltf_options(given)) return *error;
    if (given.axes) {
      return InputError{given.path + ": a stream is compared as it is; leave out --axes"};
    }
    if (given.points.empty()) return open_stream(given.path, given.max_memory_bytes);
    return InputError{given.path + ": a stream has its own positions; leave out " +
                      given.points};
  }
  InputOptions options = given;
  options.rig = false;
  const InputFormat* const format = format_of_extension(given.path);
  const bool is_cache = format != nullptr && format->holds == InputFormat::Holds::kPoints;
  if (is_cache && given.points.empty()) {
    const std::string mesh = sibling_of(given.path, InputFormat::Holds::kMesh);
    if (!mesh.empty()) {
      options.path = mesh;
      options.points = given.path;
    }
  }
  auto source = open_frame_source(options);
  if (!source) return source.error();
  ComparisonInput input;
  input.frames = std::move(*source);
  input.name = options.path;
  if (!options.points.empty()) input.name += " with " + options.points;
  return input;
}

InputResult<ComparisonPair> open_comparison_pair(const InputOptions& options_a,
                                                 const InputOptions& options_b) {
  auto a = open_comparison_input(options_a);
  if (!a) return a.error();
  auto b = open_comparison_input(options_b);
  if (!b) return b.error();
  a = add_cache(std::move(*a), options_a, b->frames->num_frames());
  if (!a) return a.error();
  b = add_cache(std::move(*b), options_b, a->frames->num_frames());
  if (!b) return b.error();

  const auto differ = [&](const std::string& count_a, std::uint32_t count_b) {
    return InputError{a->name + " has " + count_a + ", but " + b->name + " has " +
                      std::to_string(count_b)};
  };
  if (a->frames->num_vertices() != b->frames->num_vertices()) {
    return differ(count_text(a->frames->num_vertices(), "vertex", "vertices"),
                  b->frames->num_vertices());
  }
  if (a->frames->num_frames() != b->frames->num_frames()) {
    return differ(count_text(a->frames->num_frames(), "frame"), b->frames->num_frames());
  }
  return ComparisonPair{std::move(*a), std::move(*b)};
}

}  // namespace rlpc
