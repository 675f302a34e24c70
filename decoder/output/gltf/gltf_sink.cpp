// glTF 2.0 as one .glb file.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "common/io/float_position.h"
#include "common/io/output_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/gltf/gltf_animation.h"
#include "decoder/output/gltf/gltf_document.h"
#include "decoder/output/gltf/gltf_mesh.h"
#include "decoder/output/gltf/gltf_morph.h"
#include "decoder/output/gltf/gltf_skin.h"

namespace rlpc {

namespace {

using std::to_string;

// Beyond about so many targets, three.js shows none: graphics cards have 2,048 layers.
constexpr std::size_t kMostTargetsShown = 2000;
// A skin is made from all frames at once, which are there twice as floats.
constexpr std::uint64_t kSkinBytesOfPosition = 24;

// Places, keys and maps of a bone in a frame.
constexpr std::uint64_t kSkinBytesOfBone = 512;

// What sinks for glTF have in common.
class GltfSink : public FrameSink {
 public:
  GltfSink(SinkOptions options, OutputFile file)
      : options_(std::move(options)),
        file_(std::move(file)),
        mesh_(plain_mesh(options_.num_vertices, options_.triangles)),
        spans_(animation_spans(options_.clips, options_.num_frames, options_.first_number)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) final {
    assert(positions.size() == 3 * std::size_t{options_.num_vertices});
    assert(written_ < options_.num_frames);
    std::vector<float> xyz(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      xyz[i] = float_position(options_.grid, i % 3, positions[i]);
      if (std::isfinite(xyz[i])) continue;
      return OutputError{file_.path() + ": frame " + to_string(written_) +
                         " (from 0), vertex " + to_string(i / 3) +
                         ": too large for glTF, whose positions are floats"};
    }
    ++written_;
    return add_frame(std::move(xyz));
  }

  std::vector<std::string> remarks() const final { return remarks_; }

 protected:
  virtual std::optional<OutputError> add_frame(std::vector<float> xyz) = 0;

  std::optional<OutputError> failure(const GltfDocument& document) const {
    return failure_of(document, file_.path(), options_.limit);
  }
  std::optional<OutputError> finish_morph(GltfDocument& document, GltfMorph& morph) {
    assert(written_ == options_.num_frames);
    if (!morph.finish(spans_, options_.frame_rate)) return too_large_for_glb(file_.path());
    if (morph.num_targets() > kMostTargetsShown) {
      remarks_.push_back(file_.path() + ": " + to_string(morph.num_targets()) +
                         " morph targets, more than the 2,000 or so that viewers such as "
                         "three.js can hold; write fewer frames (--frames, --clip), or bones "
                         "(--as skin)");
    }
    return write(document);
  }
  std::optional<OutputError> write(GltfDocument& document) {
    if (auto error = failure(document)) return error;
    return write_glb(document, file_);
  }

  SinkOptions options_;
  OutputFile file_;
  GltfMesh mesh_;
  std::vector<Clip> spans_;
  std::vector<std::string> remarks_;
  std::uint32_t written_ = 0;
};

// Every frame as a morph target.
class GltfMorphSink final : public GltfSink {
 public:
  GltfMorphSink(SinkOptions options, OutputFile file)
      : GltfSink(std::move(options), std::move(file)),
        document_(options_.frame_rate),
        morph_(document_, mesh_) {}

  std::optional<OutputError> finish() override { return finish_morph(document_, morph_); }

 private:
  std::optional<OutputError> add_frame(std::vector<float> xyz) override {
    morph_.add_frame(xyz);
    return failure(document_);
  }

  GltfDocument document_;
  GltfMorph morph_;
};

// Bones, or whichever is smaller.
class GltfSkinSink final : public GltfSink {
 public:
  using GltfSink::GltfSink;

  bool wants_poses() const override { return true; }
  void set_pose(std::optional<SkeletonPose> pose) override { pose_ = std::move(pose); }

  std::optional<OutputError> finish() override {
    if (!choose_skeleton()) {
      if (is_required()) {
        return OutputError{file_.path() + ": --as skin: " + why_no_skin(), true};
      }
      return finish_as_morph("");
    }
    GltfDocument document(options_.frame_rate);
    const GltfSkin skin =
        add_skin(document, mesh_, source_, spans_, options_.frame_rate, options_.max_targets);
    if (!is_required() && skin.error.rms > 2 * skin.tolerated_rms) {
      return finish_as_morph("bones and " + to_string(skin.num_targets) +
                             " morph targets would leave an error (" + text_of(skin.error) +
                             "); written as a morph target for each frame");
    }
    if (!is_required() && document.buffers.chunk().size() >= morph_bytes_) {
      return finish_as_morph("");
    }
    const auto plural = [](std::size_t n) { return n == 1 ? "" : "s"; };
    remarks_.push_back(file_.path() + ": " + to_string(skin.num_joints) + " bone" +
                       plural(skin.num_joints) + " and " + to_string(skin.num_targets) +
                       " morph target" + plural(skin.num_targets) +
                       "; differs from the stream by " + text_of(skin.error));
    return write(document);
  }

 private:
  bool is_required() const { return options_.motion == GltfMotion::kSkin; }

  static std::string text_of(const SkinError& error) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "KG error %.4g %%, RMS %.4g, largest %.4g",
                  error.kg_percent, error.rms, error.largest);
    return text.data();
  }

  std::optional<OutputError> add_frame(std::vector<float> xyz) override {
    if (!source_.frames.empty()) morph_bytes_ += target_bytes(xyz);
    source_.frames.push_back(std::move(xyz));
    add_pose();
    return std::nullopt;
  }

  // Of a frame as a morph target.
  std::uint64_t target_bytes(const std::vector<float>& xyz) const {
    const std::vector<float>& base = source_.frames[0];
    std::uint64_t moving = 0;
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      moving += !std::equal(&xyz[i], &xyz[i] + 3, &base[i]);
    }
    return std::min<std::uint64_t>(14 * moving, 4 * xyz.size());
  }

  // Drops the places of bones where they would take too much memory.
  void add_pose() {
    if (pose_) pose_bytes_ += kSkinBytesOfBone * pose_->places.size();
    if (pose_bytes_ > options_.max_skin_bytes) {
      poses_.clear();
      frames_of_skeleton_.clear();
      return;
    }
    if (pose_) ++frames_of_skeleton_[pose_->skeleton];
    poses_.push_back(pose_);
  }

  std::string why_no_skin() const {
    if (pose_bytes_ > options_.max_skin_bytes) {
      return "too many bones for the memory allowed (--max-memory)";
    }
    return "the stream has no bones, only frames predicted from frames; write --as morph, or "
           "encode with rlpcenc --profile main";
  }

  // The bones of most frames become those of the skin; false if no frame has any.
  bool choose_skeleton() {
    for (const auto& [skeleton, frames] : frames_of_skeleton_) {
      if (!source_.skeleton || frames > frames_of_skeleton_[source_.skeleton])
        source_.skeleton = skeleton;
    }
    for (std::size_t f = 0; f < poses_.size() && source_.skeleton; ++f) {
      JointPlaces& places = source_.places.emplace_back();
      if (!poses_[f] || poses_[f]->skeleton != source_.skeleton) continue;
      source_.num_values += poses_[f]->num_values;
      for (const BonePlace& place : poses_[f]->places) {
        places.push_back(joint_place(place, options_.grid));
      }
    }
    poses_.clear();
    return source_.skeleton != nullptr;
  }

  std::optional<OutputError> finish_as_morph(const std::string& why) {
    if (!why.empty()) remarks_.push_back(file_.path() + ": " + why);
    GltfDocument document(options_.frame_rate);
    GltfMorph morph(document, mesh_);
    for (std::vector<float>& xyz : source_.frames) {
      morph.add_frame(xyz);
      if (auto error = failure(document)) return error;
      xyz = {};
    }
    return finish_morph(document, morph);
  }

  std::optional<SkeletonPose> pose_;  // of the next frame
  SkinSource source_{{}, options_.grid, {}, {}, 0};
  std::vector<std::optional<SkeletonPose>> poses_;  // [frame]
  std::map<std::shared_ptr<const Skeleton>, std::size_t> frames_of_skeleton_;
  std::uint64_t pose_bytes_ = 0;
  std::uint64_t morph_bytes_ = 0;
};

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_gltf_sink(const std::string& path,
                                                        SinkOptions options) {
  auto file = OutputFile::create(path, options.limit);
  if (!file) return file.error();
  std::unique_ptr<FrameSink> sink;
  const std::uint64_t bytes =
      kSkinBytesOfPosition * options.num_vertices * std::uint64_t{options.num_frames};
  if (options.motion == GltfMotion::kSkin && bytes > options.max_skin_bytes) {
    return OutputError{path + ": --as skin needs " + to_string(bytes >> 20) +
                           " MiB of memory, for all frames at once; write fewer frames "
                           "(--frames, --clip), allow more (--max-memory), or write --as morph",
                       false, true};
  }
  if (options.motion == GltfMotion::kMorph || bytes > options.max_skin_bytes) {
    sink = std::make_unique<GltfMorphSink>(std::move(options), std::move(*file));
  } else {
    sink = std::make_unique<GltfSkinSink>(std::move(options), std::move(*file));
  }
  return sink;
}

}  // namespace rlpc
