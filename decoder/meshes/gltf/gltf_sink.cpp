#include "decoder/meshes/gltf/gltf_sink.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "common/files/float_position.h"
#include "decoder/meshes/gltf/glb_animation.h"

namespace rlpc {

namespace {

using std::to_string;

// Memory per position of a skin, which is made from all frames at once, held twice as floats.
constexpr std::uint64_t kSkinBytesOfPosition = 24;

// Writes every frame as a morph target.
class GltfMorphSink final : public GltfSink {
 public:
  // why: a remark; may be empty.
  GltfMorphSink(SinkOptions sink_options, OutputFile file, const std::string& why)
      : GltfSink(std::move(sink_options), std::move(file)),
        document_(options().frame_rate),
        morph_(document_, look()) {
    if (!why.empty()) remark(why);
  }

  std::optional<OutputError> finish() override { return finish_morph(document_, morph_); }

 private:
  std::optional<OutputError> add_frame(std::vector<float> xyz) override {
    morph_.add_frame(xyz);
    return failure(document_);
  }

  GlbDocument document_;
  GltfMorph morph_;
};

}  // namespace

GltfSink::GltfSink(SinkOptions options, OutputFile file)
    : options_(std::move(options)),
      file_(std::move(file)),
      look_(options_.attributes, options_.triangles, options_.num_vertices, options_.asset),
      spans_(animation_spans(options_.clips, options_.num_frames, options_.first_number)) {
  if (!look_.problem().empty()) remark(look_.problem());
}

std::string GltfSink::name() const {
  return file_.path() == "-" ? "standard output" : file_.path();
}

std::optional<OutputError> GltfSink::write_frame(std::span<const std::int32_t> positions) {
  assert(positions.size() == 3 * std::size_t{options_.num_vertices});
  assert(written_ < options_.num_frames);
  std::vector<float> xyz(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    xyz[i] = float_position(options_.grid, i % 3, positions[i]);
    if (std::isfinite(xyz[i])) continue;
    return OutputError{file_.path() + ": frame " + to_string(written_) + " (from 0), vertex " +
                       to_string(i / 3) + ": too large for glTF, whose positions are floats"};
  }
  ++written_;
  return add_frame(std::move(xyz));
}

void GltfSink::warn_of_targets(std::size_t num_targets, const char* remedy) {
  if (num_targets <= kMaxTargetsShown) return;
  remark(to_string(num_targets) +
         " morph targets, more than the 2,000 or so that viewers such as three.js can hold; "
         "write " +
         remedy);
}

std::optional<OutputError> GltfSink::finish_morph(GlbDocument& document, GltfMorph& morph) {
  assert(written_ == options_.num_frames);
  if (!morph.finish(spans_, options_.frame_rate)) return too_large_for_glb(file_.path());
  warn_of_targets(morph.num_targets(),
                  "fewer frames ('num_frames'), or bones ('motion = skin')");
  return write(document);
}

std::optional<OutputError> GltfSink::write(GlbDocument& document) {
  if (auto error = failure(document)) return error;
  return write_glb(document, file_);
}

OutputResult<std::unique_ptr<FrameSink>> open_gltf_sink(const std::string& path,
                                                        SinkOptions options) {
  auto file = OutputFile::create(path, options.limit);
  if (!file) return file.error();
  const std::uint64_t bytes =
      kSkinBytesOfPosition * options.num_vertices * std::uint64_t{options.num_frames};
  std::string why;
  if (options.motion != GltfMotion::kMorph && bytes > options.max_skin_bytes) {
    why = "bones need " + to_string(bytes >> 20) +
          " MiB of memory, for all frames at once, more than is allowed; write fewer frames "
          "('num_frames'), or allow more ('max_skin_bytes')";
  }
  if (options.motion == GltfMotion::kSkin && !why.empty()) {
    return OutputError{path + ": 'motion = skin': " + why, false, true};
  }
  if (options.motion == GltfMotion::kMorph || !why.empty()) {
    return std::unique_ptr<FrameSink>(
        std::make_unique<GltfMorphSink>(std::move(options), std::move(*file), why));
  }
  return make_skin_sink(std::move(options), std::move(*file));
}

}  // namespace rlpc
