#include "decoder/meshes/gltf/glb_skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "decoder/meshes/gltf/glb_animation.h"
#include "decoder/meshes/gltf/skin_fit.h"
#include "decoder/meshes/gltf/skin_normals.h"
#include "decoder/meshes/gltf/skin_targets.h"

namespace rlpc {
namespace {

constexpr const char* kQuantization = "KHR_mesh_quantization";

constexpr std::uint32_t kMeshNode = 0;
constexpr std::uint32_t kRootNode = 1;  // parent of root bones
constexpr std::uint32_t kFirstJoint = 2;

// Part of the tolerated error by which dropping keys may move vertices. 1/8 takes up to 1 %
// more bytes; with 1/2, targets that compensate take more than keys save.
constexpr double kKeyTolerance = 1.0 / 4;

// Approximate number of frames in which weights of 8 bits are tried. They may move vertices by
// the whole tolerance: the rest shape and targets compensate for most of it.
constexpr std::size_t kFramesOfWeights = 32;

// Smallest error that targets aim at, as a part of the likely error of the stream. That is
// rounding, nearly independent of the error of the skin, so that half of it adds 12 %. Between
// half and all of it, TargetPrice decides: the knight's 76 clips then take 43 targets and 3.4
// MB, instead of 256 and 7.0 MB for a total error that is 17 % smaller; files of q-spider,
// q-trex and robot become 12 to 16 % smaller.
constexpr double kToleratedPart = 1.0 / 2;

// Returns the likely error of the stream, RMS of a vertex: encoders choose steps so that all
// values contribute equally, a value of a vertex to all frames as much as a value of a frame to
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

// Returns the largest distance from the origin of each joint to its vertices and those of its
// children, in the first frame.
std::vector<double> reach_of(const SkinSource& source) {
  const Skeleton& skeleton = *source.skeleton;
  const JointPlaces& places = source.places[0];
  std::vector<double> reach(skeleton.bones.size());
  for (std::size_t v = 0; v < skeleton.influences.size(); ++v) {
    const float* const xyz = &source.frames[0][3 * v];
    const Eigen::Vector3d p(xyz[0], xyz[1], xyz[2]);
    for (const SkeletonInfluence& influence : skeleton.influences[v]) {
      for (std::int32_t bone = influence.bone; bone >= 0;) {
        const auto j = static_cast<std::size_t>(bone);
        reach[j] = std::max(reach[j], (p - places[j].origin).norm());
        bone = skeleton.bones[j].parent;
      }
    }
  }
  return reach;
}

// Returns influences of 8 bits, unless these move vertices by an RMS of more than `tolerance`.
SkinInfluences small_influences(const SkinSource& source, double tolerance) {
  SkinInfluences exact = written_influences(*source.skeleton, kShortWhole);
  SkinInfluences small = written_influences(*source.skeleton, kByteWhole);
  const auto has_places = [](const JointPlaces& places) { return !places.empty(); };
  const auto first = std::ranges::find_if(source.places, has_places);
  const auto& xyz = source.frames[static_cast<std::size_t>(first - source.places.begin())];
  const std::size_t step = 1 + source.places.size() / kFramesOfWeights;
  double left = 0;
  for (std::size_t f = 0; f < source.places.size(); f += step) {
    if (source.places[f].empty()) continue;
    JointMaps maps;
    for (std::size_t j = 0; j < first->size(); ++j) {
      maps.push_back(map_of_place(source.places[f][j].after((*first)[j].inverse())));
    }
    const double rms = rms_between(exact, small, maps, xyz);
    left += tolerance * tolerance - rms * rms;
  }
  return left >= 0 ? small : exact;
}

// Returns the maps of all frames; in a frame of several clips, those of the first clip.
std::vector<JointMaps> maps_of_frames(const JointMotion& motion, std::span<const Clip> spans,
                                      std::size_t num_frames) {
  std::vector<JointMaps> maps(num_frames);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (std::uint32_t f = 0; f < spans[i].num_frames; ++f) {
      JointMaps& frame_maps = maps[spans[i].first_frame + f];
      if (frame_maps.empty()) frame_maps = joint_maps(motion, i, f);
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
    const std::array<float, 3> unscaled{1.0F, 1.0F, 1.0F};
    if (node.scale != unscaled) nodes.back()["scale"] = node.scale;
    const auto parent = static_cast<std::size_t>(
        node.parent < 0 ? std::int64_t{kRootNode} : node.parent + std::int64_t{kFirstJoint});
    children[parent].push_back(j + kFirstJoint);
  }
  for (std::size_t n = 0; n < children.size(); ++n) {
    if (!children[n].empty()) nodes[n]["children"] = std::move(children[n]);
  }
  return nodes;
}

GltfJson skin_of(const JointMotion& motion, GlbBuffers& buffers) {
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

GltfJson animation_of(const Clip& clip, FrameRate frame_rate,
                      std::span<const JointMotion::OfClip> joints, const SkinTargets& targets,
                      const TargetTrack& weights, GlbBuffers& buffers) {
  GlbAnimation animation(buffers, clip, frame_rate);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto node = static_cast<std::uint32_t>(j + kFirstJoint);
    if (const JointTrack& track = joints[j].rotation; !track.keys.empty()) {
      animation.add_channel(node, "rotation", track.keys,
                            track.has_short_values
                                ? buffers.add_short_values(track.values, "VEC4")
                                : buffers.add_values(track.values, "VEC4"));
    }
    if (const JointTrack& track = joints[j].translation; !track.keys.empty()) {
      animation.add_channel(node, "translation", track.keys,
                            buffers.add_values(track.values, "VEC3"));
    }
    if (const JointTrack& track = joints[j].scale; !track.keys.empty()) {
      animation.add_channel(node, "scale", track.keys,
                            buffers.add_values(track.values, "VEC3"));
    }
  }
  if (targets.count() > 0) add_weights(animation, kMeshNode, targets, weights, buffers);
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

// Returns the mesh with its attributes and morph targets.
GltfJson mesh_of(const GltfLook& look, std::size_t num_joints, std::span<const float> rest,
                 const SkinInfluences& influences, std::span<const float> normals,
                 const SkinTargets& targets, GlbBuffers& buffers) {
  const GlbMesh& mesh = look.mesh();
  const auto joints = expanded_values<std::uint16_t>(mesh, influences.joints, kJointsOfVertex);
  const auto weights =
      expanded_values<std::uint16_t>(mesh, influences.weights, kJointsOfVertex);
  GltfJson attributes = {
      {"POSITION", buffers.add_vectors(expanded_values(mesh, rest, 3))},
      {"JOINTS_0", buffers.add_joints(joints, static_cast<std::uint32_t>(num_joints))},
      {"WEIGHTS_0", buffers.add_joint_weights(weights, influences.whole)}};
  if (!normals.empty()) attributes["NORMAL"] = buffers.add_normals(normals);
  look.add_values(attributes, buffers);
  const GltfJson primitive_targets = targets_of(targets, mesh, buffers);
  GltfJson json = {{"primitives", primitives_of(mesh, attributes, primitive_targets, buffers)}};
  if (targets.count() > 0) json["weights"] = first_weights(targets);
  return json;
}

// Returns the size of a file with joints alone.
double bytes_without_targets(const GltfLook& look, const JointMotion& motion,
                             std::span<const float> rest, const SkinInfluences& influences,
                             std::span<const Clip> spans, FrameRate frame_rate) {
  GlbDocument document(frame_rate);
  const std::vector<float> normals(look.has_normals() ? 3 * look.mesh().vertex.size() : 0);
  GltfJson& root = document.root;
  look.add_materials(root, document.buffers);
  root["nodes"] = nodes_of(motion);
  root["meshes"].push_back(mesh_of(look, motion.nodes.size(), rest, influences, normals,
                                   SkinTargets{}, document.buffers));
  root["skins"].push_back(skin_of(motion, document.buffers));
  for (std::size_t i = 0; i < spans.size(); ++i) {
    root["animations"].push_back(animation_of(spans[i], frame_rate, motion.clips[i],
                                              SkinTargets{}, TargetTrack{}, document.buffers));
  }
  return static_cast<double>(document.buffers.chunk().size() + glb_text(root).size());
}

}  // namespace

GlbSkin add_skin(GlbDocument& document, const GltfLook& look, SkinSource& source,
                 std::span<const Clip> spans, FrameRate frame_rate, const SkinLimits& limits) {
  GlbBuffers& buffers = document.buffers;
  const Skeleton& skeleton = *source.skeleton;
  GlbSkin skin;
  skin.num_joints = skeleton.bones.size();
  skin.stream_rms = likely_rms(source);
  const double tolerated_rms = skin.stream_rms * kToleratedPart;
  const SkinInfluences influences = small_influences(source, tolerated_rms);
  fit_places(skeleton, source.grid, influences, source.frames, source.places);
  const double key_tolerance = tolerated_rms * kKeyTolerance;
  const JointMotion motion = joint_motion(skeleton, source.grid, source.places,
                                          reach_of(source), spans, key_tolerance);
  const std::vector<JointMaps> maps = maps_of_frames(motion, spans, source.frames.size());
  const std::vector<float> rest = best_rest(influences, maps, source.frames);
  SkinTargets targets;
  const TargetPrice price{
      bytes_without_targets(look, motion, rest, influences, spans, frame_rate),
      3 * static_cast<double>(look.mesh().vertex.size()) / static_cast<double>(rest.size()),
      skin.stream_rms};
  Eigen::MatrixXf missing = missing_moves(influences, maps, rest, source.frames);
  NormalVertices vertices;
  if (look.has_normals()) vertices = normal_vertices(look.mesh(), influences, rest, missing);
  targets.places =
      principal_shapes(std::move(missing), tolerated_rms, limits.max_targets, price);
  // No targets, in all frames.
  targets.normals.weights.resize(0, static_cast<Eigen::Index>(source.frames.size()));
  SkinNormals normals;
  if (look.has_normals()) {
    normals = skin_normals(look, influences, maps, rest, source.frames, vertices,
                           {limits.max_targets - targets.count(), limits.max_normal_bytes});
    targets.normals = std::move(normals.moves);
    skin.lacks_normals = normals.lacks_moves;
  }
  std::vector<TargetTrack> weights;
  for (const Clip& clip : spans) weights.push_back(target_track(targets, clip, key_tolerance));
  skin.num_targets = targets.count();
  targets.places.weights = shown_weights(targets, weights, spans);
  skin.error = skin_error(influences, maps, rest, targets.places, source.frames);

  GltfJson& root = document.root;
  root["scene"] = 0;
  root["scenes"] = GltfJson::array({{{"nodes", GltfJson::array({kMeshNode, kRootNode})}}});
  root["nodes"] = nodes_of(motion);
  look.add_materials(root, buffers);
  if (skin.num_targets > 0) {
    root["extensionsUsed"].push_back(kQuantization);
    root["extensionsRequired"].push_back(kQuantization);
  }
  root["meshes"] = GltfJson::array(
      {mesh_of(look, skin.num_joints, rest, influences, normals.rest, targets, buffers)});
  root["skins"] = GltfJson::array({skin_of(motion, buffers)});
  if (source.frames.size() > 1) {
    GltfJson animations = GltfJson::array();
    for (std::size_t i = 0; i < spans.size(); ++i) {
      animations.push_back(
          animation_of(spans[i], frame_rate, motion.clips[i], targets, weights[i], buffers));
    }
    root["animations"] = std::move(animations);
  }
  return skin;
}

}  // namespace rlpc
