#include "encoder/meshes/gltf/rig.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "encoder/codec/math/det_math.h"
#include "encoder/meshes/gltf/model_pose.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kStill = 0xFFFFFFFF;  // instead of a node: stays in place

// Returns the inverse; none if the map is flat, or nearly so.
std::optional<Affine> inverse(const Affine& map) {
  const auto& m = map.row;
  double largest = 0.0;
  for (const auto& row : m) {
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(row[c]));
  }
  constexpr double kFlat = 1e-9;  // fixed: above rounding errors
  const double det = determinant(map);
  if (!(std::abs(det) > kFlat * largest * largest * largest)) return std::nullopt;
  Affine result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto& a = m[(j + 1) % 3];
      const auto& b = m[(j + 2) % 3];
      const std::size_t k = (i + 1) % 3;
      const std::size_t l = (i + 2) % 3;
      result.row[i][j] = (a[k] * b[l] - a[l] * b[k]) / det;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& r = result.row[i];
    result.row[i][3] = -(r[0] * m[0][3] + r[1] * m[1][3] + r[2] * m[2][3]);
  }
  return result;
}

Affine scaling(double factor) {
  Affine map;
  for (std::size_t i = 0; i < 3; ++i) map.row[i][i] = factor;
  return map;
}

// Returns the factor by which a map scales; negative if it mirrors.
double scale_of(const Affine& map) {
  const double volume = determinant(map);
  if (volume == 0.0) return 0.0;
  const double scale = det_exp2(det_log2(std::abs(volume)) / 3.0);
  return volume < 0.0 ? -scale : scale;
}

struct Box {
  GltfVec3 min{};
  GltfVec3 max{};
  bool is_empty = true;

  void add(const GltfVec3& p) {
    for (std::size_t c = 0; c < 3; ++c) {
      min[c] = is_empty ? p[c] : std::min(min[c], p[c]);
      max[c] = is_empty ? p[c] : std::max(max[c], p[c]);
    }
    is_empty = false;
  }
  // Returns one of eight corners.
  GltfVec3 corner(unsigned number) const {
    GltfVec3 p{};
    for (std::size_t c = 0; c < 3; ++c) p[c] = (number >> c & 1U) != 0 ? max[c] : min[c];
    return p;
  }
};

// Whether two maps agree on all corners of a box, for all that can be seen.
bool agree(const Affine& a, const Affine& b, const Box& box) {
  constexpr double kSeen = 1e-5;  // fixed: rounding errors of floats; part of the image's size
  double apart = 0.0;
  Box image;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const GltfVec3 x = a(box.corner(corner));
    const GltfVec3 y = b(box.corner(corner));
    image.add(x);
    for (std::size_t c = 0; c < 3; ++c) apart = std::max(apart, std::abs(x[c] - y[c]));
  }
  double size = 0.0;
  for (std::size_t c = 0; c < 3; ++c) size = std::max(size, image.max[c] - image.min[c]);
  return apart <= kSeen * size;
}

// Returns the memory of the rest shape and its influences.
std::uint64_t memory_of_vertices(const GltfModel& model) {
  std::uint64_t sum = 0;
  for (const GltfModel::Instance& instance : model.instances) {
    const GltfGeometry& geometry = model.geometries[instance.geometry];
    const std::uint64_t num_influences =
        instance.skin ? geometry.influences.size() : geometry.num_vertices();
    sum += (3 * sizeof(double) + sizeof(std::size_t)) * geometry.num_vertices() +
           sizeof(SourceRig::Influence) * num_influences;
  }
  return sum;
}

class RigMaker {
 public:
  RigMaker(const GltfModel& model, std::span<const GltfPose* const> poses)
      : model_(model),
        poses_(poses),
        bones_of_node_(model.nodes.size()),
        joint_of_node_(model.nodes.size()) {}

  GltfRig make() {
    find_skins();
    for (std::size_t s = 0; is_usable_ && s < skins_.size(); ++s) add_skin(s);
    add_other_nodes();
    if (!is_usable_ || bones_.size() < 2) return {};
    return sorted();
  }

 private:
  struct Bone {
    std::uint32_t node = 0;
    Affine from_rest;
  };
  struct Joint {
    std::size_t skin = 0;
    std::size_t joint = 0;
  };
  // A skin of the scene: what its joints carry, and how its meshes become the rest shape.
  struct Skin {
    std::vector<double> mass;         // [joint], sum of the weights
    Box box;                          // of the meshes
    Affine to_rest;                   // from a mesh
    std::vector<std::uint32_t> bone;  // [joint], those with mass
  };

  // Of the poses, returns the one in which a node is largest; the first of several.
  const GltfPose& largest_pose(std::uint32_t node) const {
    constexpr double kClearly = 8.0;  // fixed: twice the size
    const GltfPose* best = poses_[0];
    for (const GltfPose* pose : poses_) {
      const double volume = std::abs(determinant(pose->to_scene[node]));
      if (volume > kClearly * std::abs(determinant(best->to_scene[node]))) best = pose;
    }
    return *best;
  }

  // Returns the positions of a mesh before joints or nodes move it.
  std::vector<double> shape_of(const GltfModel::Instance& instance) const {
    const GltfGeometry& geometry = model_.geometries[instance.geometry];
    std::vector<double> positions;
    morph(geometry.base, geometry.targets, target_weights(model_, instance.node, *poses_[0]),
          positions);
    return positions;
  }

  void find_skins() {
    skins_.resize(model_.skins.size());
    for (std::size_t s = 0; s < skins_.size(); ++s) {
      skins_[s].mass.resize(model_.skins[s].joints.size());
      skins_[s].bone.resize(model_.skins[s].joints.size());
    }
    for (const GltfModel::Instance& instance : model_.instances) {
      if (!instance.skin) continue;
      Skin& skin = skins_[*instance.skin];
      for (const GltfInfluence& i : model_.geometries[instance.geometry].influences) {
        skin.mass[i.joint] += static_cast<double>(i.weight);
      }
      const std::vector<double> shape = shape_of(instance);
      for (std::size_t i = 0; i < shape.size(); i += 3) {
        skin.box.add({shape[i], shape[i + 1], shape[i + 2]});
      }
    }
    for (std::size_t s = 0; s < skins_.size(); ++s) {
      if (skins_[s].box.is_empty) continue;
      const std::vector<std::uint32_t>& joints = model_.skins[s].joints;
      for (std::size_t j = 0; j < joints.size(); ++j) {
        if (!joint_of_node_[joints[j]]) joint_of_node_[joints[j]] = Joint{s, j};
      }
    }
  }

  // Adds the bones of a skin, placed so that as many as possible are those of earlier skins.
  void add_skin(std::size_t s) {
    Skin& skin = skins_[s];
    const GltfModel::Skin& from = model_.skins[s];
    // The joint that carries most, of those with a bone if there are any.
    const auto rank = [&](std::size_t j) {
      return std::pair(skin.mass[j] > 0.0 && has_bone(from.joints[j]), skin.mass[j]);
    };
    std::size_t heaviest = 0;
    for (std::size_t j = 1; j < skin.mass.size(); ++j) {
      if (rank(j) > rank(heaviest)) heaviest = j;
    }
    if (skin.mass.empty() || skin.mass[heaviest] == 0.0) return;
    const std::uint32_t node = from.joints[heaviest];
    const Affine& bind = from.inverse_bind[heaviest];
    std::optional<Affine> from_rest;
    if (has_bone(node)) {
      const auto back = inverse(bones_[bones_of_node_[node].front()].from_rest);
      if (back) skin.to_rest = *back * bind;
      if (back) from_rest = inverse(skin.to_rest);
    }
    if (!from_rest) {
      const double scale = scale_of(largest_pose(node).to_scene[node] * bind);
      skin.to_rest = scaling(scale == 0.0 ? 1.0 : scale);
      from_rest = inverse(skin.to_rest);
    }
    if (!from_rest) {
      is_usable_ = false;
      return;
    }
    Box rest;
    for (unsigned corner = 0; corner < 8; ++corner) {
      rest.add(skin.to_rest(skin.box.corner(corner)));
    }
    for (std::size_t j = 0; j < skin.mass.size(); ++j) {
      if (skin.mass[j] == 0.0) continue;
      skin.bone[j] = bone_of(from.joints[j], from.inverse_bind[j] * *from_rest, rest);
    }
  }

  // Returns the bone of a node that moves the rest shape by `from_rest`: one that does so for
  // all vertices in a box, or a new one.
  std::uint32_t bone_of(std::uint32_t node, const Affine& from_rest, const Box& box) {
    constexpr std::size_t kMaxBonesOfNode = 16;  // fixed: time; then the rig is of no use
    for (const std::uint32_t b : bones_of_node_[node]) {
      if (agree(bones_[b].from_rest, from_rest, box)) return b;
    }
    if (bones_of_node_[node].size() == kMaxBonesOfNode) {
      is_usable_ = false;
      return bones_of_node_[node].front();
    }
    return new_bone(node, from_rest);
  }

  std::uint32_t new_bone(std::uint32_t node, const Affine& from_rest) {
    const auto b = static_cast<std::uint32_t>(bones_.size());
    bones_of_node_[node].push_back(b);
    bones_.push_back({node, from_rest});
    return b;
  }

  // Adds bones of nodes that move meshes, and of all nodes above those that have bones: they
  // may join what follows them.
  void add_other_nodes() {
    std::vector<bool> is_needed(model_.nodes.size());
    for (std::uint32_t n = 0; n < is_needed.size(); ++n) is_needed[n] = has_bone(n);
    for (const GltfModel::Instance& instance : model_.instances) {
      if (!instance.skin) is_needed[instance.node] = true;
    }
    const auto& order = model_.scene.parents_first;
    for (auto n = order.rbegin(); n != order.rend(); ++n) {
      if (is_needed[*n] && model_.scene.parent[*n]) is_needed[*model_.scene.parent[*n]] = true;
    }
    // In the scene, the first bone below each node; none: no bone.
    std::vector<std::optional<std::uint32_t>> below(model_.nodes.size());
    for (auto n = order.rbegin(); n != order.rend(); ++n) {
      if (has_bone(*n)) below[*n] = bones_of_node_[*n].front();
      const auto parent = model_.scene.parent[*n];
      if (parent && below[*n]) below[*parent] = below[*n];
    }
    for (const std::uint32_t n : order) {
      if (is_needed[n] && !has_bone(n)) add_node(n, below[n]);
    }
  }

  bool has_bone(std::uint32_t node) const { return !bones_of_node_[node].empty(); }

  // Adds the bone of a node that no weight belongs to. It has the place of a joint in the skin;
  // otherwise, in one pose, it agrees with the nearest bone above it, or else with one below.
  void add_node(std::uint32_t node, std::optional<std::uint32_t> below) {
    if (const auto bind = bind_of(node)) {
      new_bone(node, *bind);
      return;
    }
    const GltfPose& pose = largest_pose(node);
    const auto from_scene = inverse(pose.to_scene[node]);
    if (!from_scene) {
      new_bone(node, Affine{});
      return;
    }
    const auto near = bone_above(node) ? bone_above(node) : below;
    const bool can_agree = near && inverse(map_of(*near, pose));
    new_bone(node, can_agree ? *from_scene * map_of(*near, pose) : *from_scene);
  }

  // Returns how a joint moves the rest shape, by the first skin in use that it belongs to.
  std::optional<Affine> bind_of(std::uint32_t node) const {
    const auto& place = joint_of_node_[node];
    if (!place) return std::nullopt;
    const auto from_rest = inverse(skins_[place->skin].to_rest);
    if (!from_rest) return std::nullopt;
    return model_.skins[place->skin].inverse_bind[place->joint] * *from_rest;
  }

  Affine map_of(std::uint32_t bone, const GltfPose& pose) const {
    return pose.to_scene[bones_[bone].node] * bones_[bone].from_rest;
  }

  // Returns the bone of the nearest node above a node that has one.
  std::optional<std::uint32_t> bone_above(std::uint32_t node) const {
    for (auto n = model_.scene.parent[node]; n; n = model_.scene.parent[*n]) {
      if (!bones_of_node_[*n].empty()) return bones_of_node_[*n].front();
    }
    return std::nullopt;
  }

  // Returns the place of the node of a bone in the rest shape.
  std::array<double, 3> pivot_of(std::uint32_t bone) const {
    const auto to_rest = inverse(bones_[bone].from_rest);
    return to_rest ? (*to_rest)({0, 0, 0}) : std::array<double, 3>{};
  }

  // Returns the rig with parents before children. Bones without a bone above them follow one
  // that stays in place, if there are several.
  GltfRig sorted() {
    GltfRig result;
    auto rig = std::make_shared<SourceRig>();
    std::vector<std::uint32_t> place(bones_.size());
    std::size_t num_roots = 0;
    for (std::uint32_t b = 0; b < bones_.size(); ++b) num_roots += is_root(b) ? 1U : 0U;
    const bool has_still_root = num_roots > 1;
    if (has_still_root) {
      result.bones.push_back({kStill, {}});
      rig->bones.push_back({});
    }
    for (const std::uint32_t node : model_.scene.parents_first) {
      for (const std::uint32_t b : bones_of_node_[node]) {
        place[b] = static_cast<std::uint32_t>(rig->bones.size());
        std::int32_t parent = has_still_root ? 0 : -1;
        if (b != bones_of_node_[node].front()) {
          parent = static_cast<std::int32_t>(place[bones_of_node_[node].front()]);
        } else if (const auto above = bone_above(node)) {
          parent = static_cast<std::int32_t>(place[*above]);
        }
        rig->bones.push_back({parent, pivot_of(b)});
        result.bones.push_back({bones_[b].node, bones_[b].from_rest});
      }
    }
    rig->first_influence.push_back(0);
    for (const GltfModel::Instance& instance : model_.instances) {
      add_vertices(instance, place, *rig);
    }
    if (is_usable_) result.rig = std::move(rig);
    return result;
  }

  bool is_root(std::uint32_t b) const {
    const std::uint32_t node = bones_[b].node;
    return b == bones_of_node_[node].front() && !bone_above(node);
  }

  void add_vertices(const GltfModel::Instance& instance, std::span<const std::uint32_t> place,
                    SourceRig& rig) {
    const GltfGeometry& geometry = model_.geometries[instance.geometry];
    const std::vector<double> shape = shape_of(instance);
    const std::uint32_t own =
        bones_of_node_[instance.node].empty() ? 0 : bones_of_node_[instance.node].front();
    const auto to_rest = instance.skin ? std::optional(skins_[*instance.skin].to_rest)
                                       : inverse(bones_[own].from_rest);
    if (!to_rest) {
      is_usable_ = false;
      return;
    }
    for (std::size_t v = 0; v < geometry.num_vertices(); ++v) {
      const GltfVec3 rest = (*to_rest)({shape[3 * v], shape[3 * v + 1], shape[3 * v + 2]});
      rig.rest.insert(rig.rest.end(), rest.begin(), rest.end());
      if (instance.skin) {
        const Skin& skin = skins_[*instance.skin];
        for (auto i = geometry.first_influence[v]; i < geometry.first_influence[v + 1]; ++i) {
          const GltfInfluence& from = geometry.influences[static_cast<std::size_t>(i)];
          rig.influences.push_back({place[skin.bone[from.joint]], from.weight});
        }
      } else {
        rig.influences.push_back({place[own], 1.0F});
      }
      rig.first_influence.push_back(rig.influences.size());
    }
  }

  const GltfModel& model_;
  std::span<const GltfPose* const> poses_;
  std::vector<Skin> skins_;
  std::vector<Bone> bones_;
  std::vector<std::vector<std::uint32_t>> bones_of_node_;
  std::vector<std::optional<Joint>> joint_of_node_;  // in the first skin in use that has it
  bool is_usable_ = true;
};

}  // namespace

GltfRig gltf_rig(const GltfModel& model, std::span<const GltfPose* const> poses,
                 std::uint64_t max_memory_bytes) {
  // Poses of so many bones take less memory than the vertices that they move.
  constexpr std::uint64_t kVerticesOfBone = 4;  // fixed: memory
  if (memory_of_vertices(model) > max_memory_bytes) return {};
  GltfRig rig = RigMaker(model, poses).make();
  return kVerticesOfBone * rig.bones.size() <= model.num_vertices ? rig : GltfRig{};
}

void map_bones(const GltfRig& rig, const GltfPose& pose, std::span<BoneMap> maps) {
  for (std::size_t b = 0; b < rig.bones.size(); ++b) {
    const GltfRig::Bone& bone = rig.bones[b];
    maps[b] =
        bone.node == kStill ? Affine{}.row : (pose.to_scene[bone.node] * bone.from_rest).row;
  }
}

}  // namespace rlpc
