#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "decoder/output/gltf/gltf_sink.h"
#include "decoder/output/gltf/gltf_skin.h"

namespace rlpc {

namespace {

using std::to_string;

// Places, keys and maps of a bone in a frame.
constexpr std::uint64_t kSkinBytesOfBone = 512;
constexpr std::size_t kMostJointsShown = 256;
// Of the RMS that is aimed at: as much as bones may leave before frames are written instead.
constexpr double kMostLeft = 2;

// The poses of the frames so far.
class Poses {
 public:
  explicit Poses(std::uint64_t max_bytes) : left_(max_bytes) {}

  void add(const std::optional<SkeletonPose>& pose) {
    const std::uint64_t bytes = pose ? kSkinBytesOfBone * pose->places.size() : 0;
    if (bytes > left_) {
      is_full_ = true;
      poses_.clear();
    }
    if (is_full_) return;
    left_ -= bytes;
    poses_.push_back(pose);
    if (!pose) return;
    const auto found = std::ranges::find(uses_, pose->skeleton, &Use::skeleton);
    if (found == uses_.end()) {
      uses_.push_back({pose->skeleton, 1});
    } else {
      ++found->frames;
    }
  }

  // Why there is no skeleton; empty: there is one.
  std::string why_none() const {
    if (is_full_) return "the bones need more memory than is allowed (--max-memory)";
    if (!uses_.empty()) return "";
    return "the stream has no bones, only frames predicted from frames; write --as morph, or "
           "encode with rlpcenc --profile main";
  }

  // The skeleton of most frames, and its places.
  void take(SkinSource& source) {
    source.skeleton = std::ranges::max_element(uses_, {}, &Use::frames)->skeleton;
    for (std::optional<SkeletonPose>& pose : poses_) {
      JointPlaces& places = source.places.emplace_back();
      if (pose && pose->skeleton == source.skeleton) {
        source.num_values += pose->num_values;
        for (const BonePlace& place : pose->places) {
          places.push_back(joint_place(place, source.grid));
        }
      }
      pose.reset();
    }
  }

 private:
  struct Use {
    std::shared_ptr<const Skeleton> skeleton;
    std::size_t frames;
  };

  std::uint64_t left_;
  bool is_full_ = false;
  std::vector<std::optional<SkeletonPose>> poses_;  // [frame]
  std::vector<Use> uses_;
};

std::string plural(std::size_t n, const char* word) {
  return to_string(n) + " " + word + (n == 1 ? "" : "s");
}

std::string text_of(const SkinError& error) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "KG error %.4g %%, RMS %.4g, largest %.4g",
                error.kg_percent, error.rms, error.largest);
  return text.data();
}

class GltfSkinSink final : public GltfSink {
 public:
  GltfSkinSink(SinkOptions of_sink, OutputFile file)
      : GltfSink(std::move(of_sink), std::move(file)), poses_(options().max_skin_bytes) {
    source_.grid = options().grid;
  }

  bool wants_poses() const override { return true; }
  void set_pose(const std::optional<SkeletonPose>& pose) override { pose_ = pose; }

  std::optional<OutputError> finish() override {
    const bool is_required = options().motion == GltfMotion::kSkin;
    if (const std::string why = poses_.why_none(); !why.empty()) {
      if (is_required) return OutputError{name() + ": --as skin: " + why, true};
      return finish_as_morph();
    }
    poses_.take(source_);
    GltfDocument document(options().frame_rate);
    const GltfSkin skin =
        add_skin(document, look(), source_, spans(), options().frame_rate, limits());
    const std::string means =
        plural(skin.num_joints, "bone") + " and " + plural(skin.num_targets, "morph target");
    if (!is_required) {
      if (skin.error.rms > kMostLeft * skin.tolerated_rms) {
        remark(means + " would leave an error (" + text_of(skin.error) +
               "); written as a morph target for each frame");
        return finish_as_morph();
      }
      if (document.buffers.chunk().size() >= morph_bytes_) return finish_as_morph();
    }
    remark(means + "; differs from the stream by " + text_of(skin.error));
    if (skin.lacks_normals) {
      remark(
          "normals move with the bones alone: those of all frames need more memory than is "
          "allowed (--max-memory)");
    }
    warn_of_targets(skin.num_targets, "fewer (--max-targets)");
    if (skin.num_joints > kMostJointsShown) {
      remark("more than the 256 bones that some viewers can hold; write --as morph");
    }
    return write(document);
  }

 private:
  std::optional<OutputError> add_frame(std::vector<float> xyz) override {
    if (!source_.frames.empty()) morph_bytes_ += target_bytes(xyz);
    source_.frames.push_back(std::move(xyz));
    poses_.add(pose_);
    return std::nullopt;
  }

  SkinLimits limits() const {
    const std::uint64_t bytes_of_frames =
        3 * sizeof(float) * options().num_vertices * std::uint64_t{options().num_frames};
    return {options().max_targets, options().max_skin_bytes - bytes_of_frames};
  }

  // Of a frame as a morph target, nearly.
  std::uint64_t target_bytes(const std::vector<float>& xyz) const {
    const std::vector<float>& base = source_.frames[0];
    std::uint64_t moving = 0;
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      moving += !std::equal(&xyz[i], &xyz[i] + 3, &base[i]);
    }
    return std::min<std::uint64_t>(14 * moving, 4 * xyz.size());
  }

  std::optional<OutputError> finish_as_morph() {
    GltfDocument document(options().frame_rate);
    GltfMorph morph(document, look());
    for (std::vector<float>& xyz : source_.frames) {
      morph.add_frame(xyz);
      if (auto error = failure(document)) return error;
      xyz = {};
    }
    return finish_morph(document, morph);
  }

  std::optional<SkeletonPose> pose_;  // of the next frame
  Poses poses_;
  SkinSource source_;
  std::uint64_t morph_bytes_ = 0;
};

}  // namespace

std::unique_ptr<FrameSink> make_skin_sink(SinkOptions options, OutputFile file) {
  return std::make_unique<GltfSkinSink>(std::move(options), std::move(file));
}

}  // namespace rlpc
