#include "decoder/output/gltf/gltf_skin.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "decoder/output/gltf/gltf_animation.h"
#include "decoder/output/gltf/skin_fit.h"

namespace rlpc {
namespace {

constexpr const char* kQuantization = "KHR_mesh_quantization";

constexpr std::uint32_t kMeshNode = 0;
constexpr std::uint32_t kRootNode = 1;  // the parent of bones without one
constexpr std::uint32_t kFirstJoint = 2;

// Keys are dropped where that moves vertices by no more than this part of the tolerated error.
constexpr double kKeyTolerance = 1.0 / 8;

// A part of the error that the stream is likely to have.
constexpr double kToleratedPart = 1.0 / 4;

// The error that the stream is likely to have, RMS of a vertex: encoders choose steps so that
// all values contribute alike, a value of a vertex in all frames as much as one of a frame to
// all vertices.
double likely_rms(const SkinSource& source) {
  const Skeleton& skeleton = *source.skeleton;
  const auto num_vertices = static_cast<double>(skeleton.influences.size());
  const double values_of_vertex =
      static_cast<double>(std::max<std::size_t>(3, skeleton.values_of_vertex)) +
      static_cast<double>(source.num_values) / num_vertices;
  return std::ldexp(skeleton.step / 16.0, source.grid.log2_step) *
         std::sqrt(values_of_vertex / 12);
}

// How far each joint moves vertices from its origin, its own and those of its children.
std::vector<double> reach_of(const SkinSource& source) {
  const Skeleton& skeleton = *source.skeleton;
  const JointPlaces& places = source.places[0];
  std::vector<double> reach(skeleton.bones.size());
  for (std::size_t v = 0; v < skeleton.influences.size(); ++v) {
    const float* const xyz = &source.frames[0][3 * v];
    const Eigen::Vector3d p(xyz[0], xyz[1], xyz[2]);
    for (const SkeletonInfluence& influence : skeleton.influences[v]) {
      double& farthest = reach[influence.bone];
      farthest = std::max(farthest, (p - places[influence.bone].origin).norm());
    }
  }
  for (std::size_t j = reach.size(); j-- > 0;) {
    if (skeleton.bones[j].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(skeleton.bones[j].parent);
    const double apart = (places[j].origin - places[parent].origin).norm();
    reach[parent] = std::max(reach[parent], apart + reach[j]);
  }
  return reach;
}

// The maps of all frames; of a frame in several clips, those of the first.
std::vector<JointMaps> maps_of_frames(const JointMotion& motion, std::span<const Clip> spans,
                                      std::size_t num_frames) {
  std::vector<JointMaps> maps(num_frames);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (std::uint32_t f = 0; f < spans[i].num_frames; ++f) {
      JointMaps& of_frame = maps[spans[i].first_frame + f];
      if (of_frame.empty()) of_frame = joint_maps(motion, i, f);
    }
  }
  return maps;
}

GltfJson nodes_of(const JointMotion& motion) {
  GltfJson nodes = GltfJson::array({{{"mesh", 0}, {"skin", 0}}, {{"name", "bones"}}});
  std::vector<GltfJson> children(motion.nodes.size() + kFirstJoint, GltfJson::array());
  for (std::size_t j = 0; j < motion.nodes.size(); ++j) {
    const JointMotion::Node& node = motion.nodes[j];
    nodes.push_back({{"name", "bone " + std::to_string(j)},
                     {"rotation", node.rotation},
                     {"translation", node.translation}});
    const auto parent = static_cast<std::size_t>(
        node.parent < 0 ? std::int64_t{kRootNode} : node.parent + std::int64_t{kFirstJoint});
    children[parent].push_back(j + kFirstJoint);
  }
  for (std::size_t n = 0; n < children.size(); ++n) {
    if (!children[n].empty()) nodes[n]["children"] = std::move(children[n]);
  }
  return nodes;
}

GltfJson skin_of(const JointMotion& motion, GltfBuffers& buffers) {
  std::vector<float> inverse_bind;
  GltfJson joints = GltfJson::array();
  for (std::size_t j = 0; j < motion.nodes.size(); ++j) {
    const auto& columns = motion.inverse_bind[j];
    inverse_bind.insert(inverse_bind.end(), columns.begin(), columns.end());
    joints.push_back(j + kFirstJoint);
  }
  return {{"inverseBindMatrices", buffers.add_matrices(inverse_bind)},
          {"skeleton", kRootNode},
          {"joints", std::move(joints)}};
}

// The targets' weights in a clip, without keys between which they change linearly.
void add_weights(GltfAnimation& animation, const PrincipalShapes& shapes, double tolerance,
                 GltfBuffers& buffers) {
  const Clip& clip = animation.clip();
  const Eigen::VectorXf lengths =
      shapes.targets.colwise().norm() /
      std::sqrt(static_cast<float>(shapes.targets.rows()) / 3);  // RMS of a vertex
  const auto column = [&](std::uint32_t f) {
    return shapes.weights.col(static_cast<Eigen::Index>(clip.first_frame + f));
  };
  const std::vector<std::uint32_t> keys =
      needed_keys(clip.num_frames, [&](std::uint32_t a, std::uint32_t b) {
        for (std::uint32_t f = a + 1; f < b; ++f) {
          const float t = static_cast<float>(f - a) / static_cast<float>(b - a);
          const Eigen::VectorXf apart = column(a) + t * (column(b) - column(a)) - column(f);
          if (static_cast<double>(apart.cwiseProduct(lengths).norm()) > tolerance) return false;
        }
        return true;
      });
  std::vector<float> values;
  for (const std::uint32_t key : keys) {
    const Eigen::VectorXf weights = column(key);
    values.insert(values.end(), weights.begin(), weights.end());
  }
  const std::uint32_t output = shapes.has_short_weights
                                   ? buffers.add_short_values(values, kWeightUnit)
                                   : buffers.add_values(values, "SCALAR");
  animation.add_channel(kMeshNode, "weights", keys, output);
}

GltfJson animation_of(const Clip& clip, FrameRate frame_rate,
                      std::span<const JointMotion::OfClip> joints,
                      const PrincipalShapes& shapes, double tolerance, GltfBuffers& buffers) {
  GltfAnimation animation(buffers, clip, frame_rate);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto node = static_cast<std::uint32_t>(j + kFirstJoint);
    if (const JointTrack& track = joints[j].rotation; !track.keys.empty()) {
      animation.add_channel(node, "rotation", track.keys,
                            buffers.add_values(track.values, "VEC4"));
    }
    if (const JointTrack& track = joints[j].translation; !track.keys.empty()) {
      animation.add_channel(node, "translation", track.keys,
                            buffers.add_values(track.values, "VEC3"));
    }
  }
  if (shapes.targets.cols() > 0) add_weights(animation, shapes, tolerance, buffers);
  if (!animation.spans_clip()) {
    // An animation without motion still has a duration.
    const std::vector<std::uint32_t> ends{0, clip.num_frames - 1};
    const std::vector<float> still(6, 0.0F);
    animation.add_channel(
        kRootNode, "translation", std::span(ends).first(clip.num_frames > 1 ? 2 : 1),
        buffers.add_values(std::span(still).first(clip.num_frames > 1 ? 6 : 3), "VEC3"));
  }
  return animation.json();
}

// The attributes and morph targets of the mesh.
GltfJson mesh_of(const GltfLook& look, std::size_t num_joints, std::span<const float> rest,
                 const SkinInfluences& influences, const PrincipalShapes& shapes,
                 GltfBuffers& buffers) {
  const GltfMesh& mesh = look.mesh();
  const auto joints =
      of_output_vertices<std::uint16_t>(mesh, influences.joints, kJointsOfVertex);
  const auto weights =
      of_output_vertices<std::uint16_t>(mesh, influences.weights, kJointsOfVertex);
  GltfJson attributes = {
      {"POSITION", buffers.add_vectors(of_output_vertices(mesh, rest, 3))},
      {"JOINTS_0", buffers.add_joints(joints, static_cast<std::uint32_t>(num_joints))},
      {"WEIGHTS_0", buffers.add_joint_weights(weights)}};
  look.add_attributes(rest, attributes, buffers);
  GltfJson targets = GltfJson::array();
  GltfJson first_weights = GltfJson::array();
  for (Eigen::Index k = 0; k < shapes.targets.cols(); ++k) {
    std::vector<std::int8_t> bytes;
    for (const float x : shapes.targets.col(k)) {
      bytes.push_back(static_cast<std::int8_t>(std::lround(x / shapes.unit)));
    }
    const auto expanded = of_output_vertices<std::int8_t>(mesh, bytes, 3);
    targets.push_back({{"POSITION", buffers.add_byte_vectors(expanded, shapes.unit < 1)}});
    first_weights.push_back(shapes.weights(k, 0));
  }
  GltfJson json = {{"primitives", primitives_of(mesh, attributes, targets, buffers)}};
  if (!targets.empty()) json["weights"] = std::move(first_weights);
  return json;
}

}  // namespace

GltfSkin add_skin(GltfDocument& document, const GltfLook& look, SkinSource& source,
                  std::span<const Clip> spans, FrameRate frame_rate, std::size_t max_targets) {
  GltfBuffers& buffers = document.buffers;
  const Skeleton& skeleton = *source.skeleton;
  GltfSkin skin;
  skin.num_joints = skeleton.bones.size();
  skin.tolerated_rms = likely_rms(source) * kToleratedPart;
  const SkinInfluences influences = written_influences(skeleton);
  fit_places(skeleton, source.grid, influences, source.frames, source.places);
  const double key_tolerance = skin.tolerated_rms * kKeyTolerance;
  const JointMotion motion = joint_motion(skeleton, source.grid, source.places,
                                          reach_of(source), spans, key_tolerance);
  const std::vector<JointMaps> maps = maps_of_frames(motion, spans, source.frames.size());
  const std::vector<float> rest = best_rest(influences, maps, source.frames);
  const PrincipalShapes shapes = principal_shapes(
      missing_moves(influences, maps, rest, source.frames), skin.tolerated_rms, max_targets);
  skin.num_targets = static_cast<std::size_t>(shapes.targets.cols());
  skin.error = skin_error(influences, maps, rest, shapes, source.frames);

  GltfJson& root = document.root;
  root["scene"] = 0;
  root["scenes"] = GltfJson::array({{{"nodes", GltfJson::array({kMeshNode, kRootNode})}}});
  root["nodes"] = nodes_of(motion);
  look.add_materials(root, buffers);
  if (skin.num_targets > 0) {
    root["extensionsUsed"].push_back(kQuantization);
    root["extensionsRequired"].push_back(kQuantization);
  }
  root["meshes"] =
      GltfJson::array({mesh_of(look, skin.num_joints, rest, influences, shapes, buffers)});
  root["skins"] = GltfJson::array({skin_of(motion, buffers)});
  if (source.frames.size() > 1) {
    GltfJson animations = GltfJson::array();
    for (std::size_t i = 0; i < spans.size(); ++i) {
      animations.push_back(
          animation_of(spans[i], frame_rate, motion.clips[i], shapes, key_tolerance, buffers));
    }
    root["animations"] = std::move(animations);
  }
  return skin;
}

}  // namespace rlpc
