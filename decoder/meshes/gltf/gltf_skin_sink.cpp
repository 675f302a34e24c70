#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "common/parallel/for_each.h"
#include "decoder/meshes/gltf/glb_skin.h"
#include "decoder/meshes/gltf/gltf_sink.h"

namespace rlpc {

namespace {

using std::to_string;

// Memory of places, keys and maps of a bone in a frame.
constexpr std::uint64_t kSkinBytesOfBone = 512;
constexpr std::size_t kMaxJointsShown = 256;
// fixed: a price. If the residual of bones is N > 1 times the error of the stream, frames may
// take N times this many times their bytes. Half and twice choose bones for the same 14
// streams.
constexpr double kMaxTimes = 4;

// Poses of the frames so far.
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

  // Returns why the frames have no skeleton; empty if they have one.
  std::string why_none() const {
    if (is_full_) return "the bones need more memory than is allowed ('max_skin_bytes')";
    if (!uses_.empty()) return "";
    return "the stream has no bones, only frames predicted from frames; write 'motion = "
           "morph', "
           "or encode with the Main profile";
  }

  // Moves the skeleton of most frames and its places to `source`.
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
  GltfSkinSink(SinkOptions sink_options, OutputFile file)
      : GltfSink(std::move(sink_options), std::move(file)), poses_(options().max_skin_bytes) {
    source_.grid = options().grid;
  }

  bool wants_poses() const override { return true; }
  void set_pose(const std::optional<SkeletonPose>& pose) override { pose_ = pose; }

  std::optional<OutputError> finish() override {
    const bool is_required = options().motion == GltfMotion::kSkin;
    if (const std::string why = poses_.why_none(); !why.empty()) {
      if (is_required) return OutputError{name() + ": 'motion = skin': " + why, true};
      return finish_as_morph();
    }
    const Threads threads(options().threads);
    poses_.take(source_);
    GlbDocument document(options().frame_rate);
    const GlbSkin skin =
        add_skin(document, look(), source_, spans(), options().frame_rate, limits());
    const std::string means =
        plural(skin.num_joints, "bone") + " and " + plural(skin.num_targets, "morph target");
    const bool is_near = skin.error.rms <= skin.stream_rms;
    if (!is_required && frames_are_better(document, skin)) {
      if (!is_near) {
        remark(means + " would leave an error (" + text_of(skin.error) +
               "); written as a morph target for each frame");
      }
      return finish_as_morph();
    }
    remark(means + "; differs from the stream by " + text_of(skin.error));
    if (!is_required && !is_near) {
      remark(
          "this is more than the stream is likely to differ from its source; 'motion = morph' "
          "is "
          "exact, but takes " +
          to_string(num_moving_) + " morph targets, about " +
          to_string((morph_bytes_ + 999'999) / 1'000'000) + " MB");
    }
    if (skin.lacks_normals) {
      remark(
          "normals move with the bones alone: those of all frames need more memory than is "
          "allowed ('max_skin_bytes')");
    }
    warn_of_targets(skin.num_targets, "fewer ('max_targets')");
    if (skin.num_joints > kMaxJointsShown) {
      remark("more than the 256 bones that some viewers can hold; write 'motion = morph'");
    }
    return write(document);
  }

 private:
  std::optional<OutputError> add_frame(std::vector<float> xyz) override {
    if (const std::uint64_t bytes = source_.frames.empty() ? 0 : target_bytes(xyz)) {
      morph_bytes_ += bytes;
      ++num_moving_;
    }
    source_.frames.push_back(std::move(xyz));
    poses_.add(pose_);
    return std::nullopt;
  }

  SkinLimits limits() const {
    const std::uint64_t bytes_of_frames =
        3 * sizeof(float) * options().num_vertices * std::uint64_t{options().num_frames};
    return {options().max_targets, options().max_skin_bytes - bytes_of_frames};
  }

  // Returns whether to write a morph target per frame instead of bones: never more of them than
  // viewers support, however few bytes they take.
  bool frames_are_better(const GlbDocument& document, const GlbSkin& skin) const {
    if (num_moving_ > kMaxTargetsShown) return false;
    const double times = static_cast<double>(morph_bytes_) /
                         static_cast<double>(document.buffers.chunk().size());
    return times <= 1 || (skin.error.rms > skin.stream_rms &&
                          times <= kMaxTimes * skin.error.rms / skin.stream_rms);
  }

  // Returns about the bytes of a frame as a morph target; 0 if it equals the first frame.
  std::uint64_t target_bytes(const std::vector<float>& xyz) const {
    const std::vector<float>& base = source_.frames[0];
    std::uint64_t moving = 0;
    for (const std::uint32_t v : look().mesh().vertex) {
      const std::size_t i = 3 * std::size_t{v};
      moving += !std::equal(&xyz[i], &xyz[i] + 3, &base[i]);
    }
    if (moving == 0) return 0;
    const std::uint64_t all = 12 * std::uint64_t{look().mesh().vertex.size()};
    return std::min(14 * moving, all) + (look().has_normals() ? all : 0);
  }

  std::optional<OutputError> finish_as_morph() {
    GlbDocument document(options().frame_rate);
    GltfMorph morph(document, look());
    for (std::vector<float>& xyz : source_.frames) {
      morph.add_frame(xyz);
      if (auto error = failure(document)) return error;
      xyz = {};
    }
    return finish_morph(document, morph);
  }

  std::optional<SkeletonPose> pose_;  // pose of the next frame
  Poses poses_;
  SkinSource source_;
  std::uint64_t morph_bytes_ = 0;  // bytes of the morph targets of all frames
  std::size_t num_moving_ = 0;     // number of frames that need one
};

}  // namespace

std::unique_ptr<FrameSink> make_skin_sink(SinkOptions options, OutputFile file) {
  return std::make_unique<GltfSkinSink>(std::move(options), std::move(file));
}

}  // namespace rlpc
