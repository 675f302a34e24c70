#include "encoder/meshes/gltf/source.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "encoder/meshes/gltf/attributes.h"
#include "encoder/meshes/gltf/frame_grid.h"
#include "encoder/meshes/gltf/model_pose.h"
#include "encoder/meshes/gltf/rig.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/weld.h"

namespace rlpc {

namespace {

using std::to_string;

// Returns the first frame of each clip in the sequence, then the total number of frames.
InputResult<std::vector<std::uint32_t>> first_frames(const GltfModel& model,
                                                     const GltfFrameGrid& grid,
                                                     const std::string& path,
                                                     const GltfLimits& limits) {
  const std::uint64_t max =
      std::min(limits.max_frames, limits.max_positions / model.num_vertices);
  std::vector<std::uint32_t> first{0};
  for (const GltfClip& clip : model.clips) {
    const double frames = first.back() + grid.num_frames(clip);
    if (frames > static_cast<double>(max)) {
      return InputError{path + ": animations: found more frames of " +
                        to_string(model.num_vertices) + " vertices than the " + to_string(max) +
                        " that are expected at most; the last time is " + to_string(clip.end) +
                        " s: choose one animation, or a lower 'frame_rate'"};
    }
    first.push_back(static_cast<std::uint32_t>(frames));
  }
  if (model.clips.empty()) first.push_back(1);
  return first;
}

GltfPose pose_at(const GltfModel& model, const std::vector<std::uint32_t>& first_frame,
                 const GltfFrameGrid& grid, std::uint32_t frame) {
  const auto next = std::upper_bound(first_frame.begin(), first_frame.end(), frame);
  const auto number = static_cast<std::size_t>(next - first_frame.begin()) - 1;
  const GltfClip* const clip = model.clips.empty() ? nullptr : &model.clips[number];
  const double time = clip ? grid.time_of(frame - first_frame[number], *clip) : 0.0;
  return pose_of(model.nodes, model.scene, clip, time);
}

// Returns the number of frames whose normals are compared; fewer for large models.
std::size_t frames_with_normals(const GltfModel& model, std::uint64_t max_memory_bytes) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 27;  // fixed: memory
  constexpr std::uint64_t kPart = 64;                          // fixed: divides the limit
  constexpr std::uint64_t kMax = 15;                           // fixed: time
  const std::uint64_t bytes = std::min(kMaxBytes, max_memory_bytes / kPart);
  return std::clamp<std::uint64_t>(bytes / (3 * sizeof(float) * model.num_vertices), 2, kMax);
}

// Returns the triangles. Mirroring nodes flip them, so that they keep facing the same side
// (glTF 2.0, 3.7.2.1); also nodes of skinned meshes, although joints alone place their
// vertices.
std::vector<Triangle> triangles_of(const GltfModel& model,
                                   const std::vector<bool>& is_mirrored) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < model.instances.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(model.instances[i].first_vertex);
    for (Triangle t : model.geometries[model.instances[i].geometry].triangles) {
      for (std::uint32_t& v : t) v += first;
      if (is_mirrored[i]) std::swap(t[1], t[2]);
      triangles.push_back(t);
    }
  }
  return triangles;
}

// Returns the name of an animation in a clip table.
std::string clip_name(const std::string& name, std::size_t number) {
  std::string text;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t good = find_clip_name_error(name.substr(at));
    text += name.substr(at, good);
    at += good;
    if (at < name.size()) text += ' ', ++at;
  }
  if (text.size() > kMaxClipNameBytes) {
    text.resize(kMaxClipNameBytes);
    text.resize(find_clip_name_error(text));
  }
  return text.empty() ? "animation " + to_string(number) : text;
}

// Returns the clips; none for a single animation without a name.
std::vector<Clip> clips_of(const GltfModel& model, const std::vector<std::uint32_t>& first) {
  std::vector<Clip> clips;
  if (model.clips.size() == 1 && model.clips[0].name.empty()) return clips;
  for (std::size_t i = 0; i < model.clips.size(); ++i) {
    clips.push_back({clip_name(model.clips[i].name, i), first[i], first[i + 1] - first[i]});
  }
  return clips;
}

void add_notes_of_time(const GltfModel& model, const GltfFrameGrid& grid,
                       std::vector<std::string>& notes) {
  const auto num_early = std::count_if(model.clips.begin(), model.clips.end(),
                                       [](const GltfClip& clip) { return clip.first < 0.0; });
  if (num_early > 0) {
    notes.push_back("dropped what " + to_string(num_early) +
                    (num_early == 1 ? " animation has" : " animations have") +
                    " before time 0, where animations begin");
  }
  if (!grid.note.empty()) notes.push_back(grid.note);
}

class GltfSource : public FrameSource {
 public:
  GltfSource(Shape shape, std::string path, GltfModel model, GltfRig rig, GltfFrameGrid grid,
             std::vector<std::uint32_t> first_frame)
      : FrameSource(std::move(shape)),
        path_(std::move(path)),
        model_(std::move(model)),
        rig_(std::move(rig)),
        grid_(std::move(grid)),
        first_frame_(std::move(first_frame)) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    read(frame, xyz);
    return check_finite(path_, frame, xyz);
  }
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    read(frame, xyz);
    return std::nullopt;
  }
  bool is_finer_than_floats() const override { return true; }
  void read_bones(std::uint32_t frame, std::span<BoneMap> maps) override {
    map_bones(rig_, pose_at(model_, first_frame_, grid_, frame), maps);
  }

  std::string file_of(std::uint32_t /*frame*/) const override { return path_; }

 private:
  template <class T>
  void read(std::uint32_t frame, std::span<T> xyz) const {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    const GltfPose pose = pose_at(model_, first_frame_, grid_, frame);
    PosedModel posed(model_, pose);
    for (const GltfModel::Instance& instance : model_.instances) {
      const GltfGeometry& geometry = model_.geometries[instance.geometry];
      const auto out = xyz.subspan(3 * static_cast<std::size_t>(instance.first_vertex),
                                   geometry.base.size());
      posed.positions(instance, out);
    }
  }

  std::string path_;
  GltfModel model_;
  GltfRig rig_;
  GltfFrameGrid grid_;
  std::vector<std::uint32_t> first_frame_;  // [clip], then the total number of frames
};

}  // namespace

InputResult<std::unique_ptr<FrameSource>> open_gltf(const InputOptions& options,
                                                    const GltfLimits& limits) {
  auto model = read_gltf_model(options, limits);
  if (!model) return model.error();
  const GltfFrameGrid grid =
      choose_frame_grid(model->clips, options.frame_rate, model->frame_rate);
  align_steps(grid, model->clips);
  FrameSource::Shape shape;
  shape.frame_rate = grid.rate;
  const std::string name = name_of_input(options.path);
  auto first_frame = first_frames(*model, grid, name, limits);
  if (!first_frame) return first_frame.error();
  shape.num_vertices = static_cast<std::uint32_t>(model->num_vertices);
  shape.num_frames = first_frame->back();
  const auto pose = [&](std::uint32_t frame) {
    return pose_at(*model, *first_frame, grid, frame);
  };
  const SampledPoses sampled = sample_poses(
      *model, shape.num_frames, frames_with_normals(*model, options.max_memory_bytes), pose);
  shape.triangles = triangles_of(*model, sampled.is_mirrored);
  shape.notes = model->notes;
  add_notes_of_time(*model, grid, shape.notes);
  if (const std::size_t count = sampled.num_turning_over) {
    shape.notes.push_back(to_string(count) + " primitive" + (count == 1 ? "" : "s") +
                          " mirrored by scales of nodes in some frames, not in others: there, "
                          "triangles show their back");
  }
  shape.asset = std::move(model->asset);
  const GltfPose first_pose = pose(0);
  shape.attributes = gltf_attributes(*model, shape.triangles, first_pose, sampled);
  std::vector<const GltfPose*> poses{&first_pose};
  for (const SampledPoses::Later& later : sampled.later) poses.push_back(&later.pose);
  shape.files = model->files;
  shape.clips = clips_of(*model, *first_frame);
  shape.memory_bytes = model->memory_bytes;
  // Decoded positions of these frames are kept too.
  for (const PosedNormals& later : shape.attributes.later_normals)
    shape.memory_bytes += 4 * sizeof(float) * later.normals.size();
  const std::uint64_t left_bytes =
      options.max_memory_bytes - std::min(options.max_memory_bytes, shape.memory_bytes);
  GltfRig rig = options.rig ? gltf_rig(*model, poses, left_bytes) : GltfRig{};
  shape.rig = rig.rig;
  if (shape.rig) shape.memory_bytes += shape.rig->memory_bytes();
  if (!options.weld) drop_degenerate(shape);
  std::unique_ptr<FrameSource> source = std::make_unique<GltfSource>(
      std::move(shape), name, std::move(*model), std::move(rig), grid, std::move(*first_frame));
  if (options.weld) {
    auto welded = weld(std::move(source));
    if (!welded) return welded;
    source = std::move(*welded);
  }
  if (source->triangles().empty()) {
    return InputError{name + ": expected a mesh with triangles; all of them are degenerate"};
  }
  return source;
}

namespace {

constexpr std::array<std::string_view, 2> kGltfExtensions{".glb", ".gltf"};

}  // namespace

const InputFormat kGltfFormat{
    .holds = InputFormat::Holds::kAnimation,
    .extensions = kGltfExtensions,
    .begins =
        [](std::string_view beginning) {
          return beginning.starts_with("glTF") || after_blanks(beginning).starts_with("{");
        },
    .has_clips = true,
    .open = [](const InputOptions& options) { return open_gltf(options); },
};

}  // namespace rlpc
