// Bones of a frame (decoder/c_api/rlpc_pose.h).
#include "decoder/c_api/rlpc_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "common/codec/mesh/skeleton.h"
#include "decoder/c_api/decoder_handle.h"
#include "decoder/c_api/vector3.h"

namespace rlpc {
namespace {

// Map x -> turn * x + move; turn has columns.
struct AffineMap {
  std::array<Vec3d, 3> turn{};
  Vec3d move{};

  Vec3d operator()(const Vec3d& x) const {
    Vec3d y = move;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) y[k] += turn[c][k] * x[c];
    }
    return y;
  }
};

// Returns the map first(second(x)).
AffineMap product(const AffineMap& first, const AffineMap& second) {
  AffineMap map;
  map.move = first(second.move);
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3d end = first(second.turn[c]);
    for (std::size_t k = 0; k < 3; ++k) map.turn[c][k] = end[k] - first.move[k];
  }
  return map;
}

// Solves turn * x = y by least squares; `damping` keeps x small where the columns of turn
// nearly coincide.
Vec3d solve(const std::array<Vec3d, 3>& turn, const Vec3d& y, double damping) {
  std::array<Vec3d, 3> squares{};
  Vec3d sums{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) squares[a][b] = dot(turn[a], turn[b]);
    squares[a][a] += damping;
    sums[a] = dot(turn[a], y);
  }
  const std::array<Vec3d, 3> minors{cross(squares[1], squares[2]),
                                    cross(squares[2], squares[0]),
                                    cross(squares[0], squares[1])};
  const double determinant = dot(squares[0], minors[0]);
  Vec3d x{};
  for (std::size_t a = 0; a < 3; ++a) {  // symmetric: columns are rows
    for (std::size_t b = 0; b < 3; ++b) x[b] += minors[a][b] * sums[a] / determinant;
  }
  return x;
}

// Returns the map from the coordinates of a bone to those of the encoder's input.
AffineMap map_of(const BonePlace& place, const Grid& grid) {
  constexpr double kAxisUnit = 1.0 / (std::int64_t{1} << 30);
  constexpr double kOriginFractions = 16;
  AffineMap map;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      map.turn[c][k] = static_cast<double>(place.axes[c][k]) * kAxisUnit;
    }
    const double steps = static_cast<double>(place.origin[k]) / kOriginFractions;
    map.move[k] = std::ldexp(steps + grid.origin[k], grid.log2_step);
  }
  return map;
}

// Returns the map from the rest shape to the frame. Bind places are rigid.
AffineMap skin_map(const BonePlace& bind, const BonePlace& place, const Grid& grid) {
  const AffineMap from = map_of(bind, grid);
  AffineMap back;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) back.turn[c][k] = from.turn[k][c];
    back.move[c] = -dot(from.turn[c], from.move);
  }
  return product(map_of(place, grid), back);
}

void write_matrix(const AffineMap& map, float* out) {
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3d& column = c < 3 ? map.turn[c] : map.move;
    for (std::size_t k = 0; k < 3; ++k) out[4 * c + k] = static_cast<float>(column[k]);
    out[4 * c + 3] = c < 3 ? 0 : 1;
  }
}

// Lists the strongest influences, at most `slots`. Returns the sum of their weights.
double strongest(const Vector<SkeletonInfluence>& all, std::size_t slots,
                 Vector<SkeletonInfluence>& list) {
  list = all;
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  list.resize(std::min(list.size(), slots));
  double sum = 0;
  for (const SkeletonInfluence& influence : list) sum += influence.weight;
  return sum;
}

rlpc_status bad_pose(rlpc_decoder& handle, const std::string& what) {
  return handle.error.set(RLPC_BAD_ARGUMENT, what);
}

// Returns RLPC_OK if the pose has bones, and slots are in range.
rlpc_status check_pose(rlpc_decoder& handle, std::uint32_t slots = 1) {
  constexpr std::uint32_t kMaxSlots = 65536;
  if (!handle.pose) return bad_pose(handle, "the pose has no bones: see rlpc_decoder_pose");
  if (slots >= 1 && slots <= kMaxSlots) return RLPC_OK;
  return bad_pose(handle, "slots: " + std::to_string(slots) + " is not in the range of 1 to " +
                              std::to_string(kMaxSlots));
}

std::uint32_t max_influences(const Skeleton& skeleton) {
  std::size_t max = 0;
  for (const auto& list : skeleton.influences) max = std::max(max, list.size());
  return static_cast<std::uint32_t>(max);
}

void write_influences(const Skeleton& skeleton, std::size_t slots, std::uint16_t* bones,
                      float* weights) {
  Vector<SkeletonInfluence> list;
  for (const auto& all : skeleton.influences) {
    const double sum = strongest(all, slots, list);
    for (std::size_t k = 0; k < slots; ++k) {
      *bones++ = k < list.size() ? list[k].bone : std::uint16_t{0};
      *weights++ = k < list.size() ? static_cast<float>(list[k].weight / sum) : 0;
    }
  }
}

void write_rest(rlpc_decoder& handle, std::size_t slots, float* xyz) {
  constexpr double kDamping = 1e-12;
  const Grid& grid = handle.decoder->header().grid;
  const SkeletonPose& pose = *handle.pose;
  Vector<AffineMap> maps;
  for (std::size_t b = 0; b < pose.places.size(); ++b) {
    maps.push_back(skin_map(pose.skeleton->bones[b].bind, pose.places[b], grid));
  }
  Vector<SkeletonInfluence> list;
  for (std::size_t v = 0; v < pose.skeleton->influences.size(); ++v) {
    const double sum = strongest(pose.skeleton->influences[v], slots, list);
    AffineMap map;
    for (const auto& [bone, weight] : list) {
      const double share = weight / sum;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 3; ++c) map.turn[c][k] += share * maps[bone].turn[c][k];
        map.move[k] += share * maps[bone].move[k];
      }
    }
    Vec3d from{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double steps = static_cast<double>(handle.positions[3 * v + k]) + grid.origin[k];
      from[k] = std::ldexp(steps, grid.log2_step) - map.move[k];
    }
    const Vec3d rest = solve(map.turn, from, kDamping);
    for (const double x : rest) *xyz++ = static_cast<float>(x);
  }
}

}  // namespace
}  // namespace rlpc

rlpc_status rlpc_decoder_pose(rlpc_decoder* decoder, rlpc_pose* pose, size_t struct_size) {
  return rlpc::guarded(decoder, [&] {
    if (pose == nullptr || struct_size < sizeof(std::size_t)) {
      return rlpc::bad_pose(*decoder, "pose is null, or struct_size too small");
    }
    if (!decoder->has_frame || decoder->blend.is_shown ||
        decoder->decoder->position() != decoder->next_of_frame) {
      return rlpc::bad_pose(*decoder, "decode a frame first: rlpc_decoder_frame or _next");
    }
    auto found = decoder->decoder->pose();
    rlpc_pose ours{};
    if (found) {
      const bool is_same = decoder->pose && decoder->pose->skeleton == found->skeleton;
      if (!is_same) ++decoder->num_skeletons;
      ours.num_bones = static_cast<std::uint32_t>(found->places.size());
      ours.max_influences = rlpc::max_influences(*found->skeleton);
      ours.skeleton = decoder->num_skeletons;
    }
    decoder->pose = std::move(found);
    decoder->next_of_pose = decoder->next_of_frame;
    decoder->error.clear();
    rlpc::give_struct(ours, pose, struct_size);
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_bone(rlpc_decoder* decoder, uint32_t bone, rlpc_bone* info,
                              size_t struct_size) {
  return rlpc::guarded(decoder, [&] {
    if (const auto status = rlpc::check_pose(*decoder); status != RLPC_OK) return status;
    const auto& bones = decoder->pose->skeleton->bones;
    if (info == nullptr || struct_size < sizeof(std::size_t) || bone >= bones.size()) {
      return rlpc::bad_pose(*decoder, bone < bones.size()
                                          ? "info is null, or struct_size too small"
                                          : "expected a bone below " +
                                                std::to_string(bones.size()) + ", got " +
                                                std::to_string(bone));
    }
    rlpc_bone ours{};
    ours.parent = bones[bone].parent;
    rlpc::write_matrix(rlpc::map_of(bones[bone].bind, decoder->decoder->header().grid),
                       ours.bind);
    rlpc::give_struct(ours, info, struct_size);
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_bone_matrices(rlpc_decoder* decoder, float* matrices,
                                       size_t num_floats) {
  return rlpc::guarded(decoder, [&] {
    if (const auto status = rlpc::check_pose(*decoder); status != RLPC_OK) return status;
    const rlpc::SkeletonPose& pose = *decoder->pose;
    if (!rlpc::check_buffer(*decoder, matrices, num_floats, 16 * pose.places.size())) {
      return RLPC_BAD_ARGUMENT;
    }
    for (std::size_t b = 0; b < pose.places.size(); ++b) {
      rlpc::write_matrix(rlpc::skin_map(pose.skeleton->bones[b].bind, pose.places[b],
                                        decoder->decoder->header().grid),
                         matrices + 16 * b);
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_influences(rlpc_decoder* decoder, uint32_t slots, uint16_t* bones,
                                    float* weights, size_t num_values) {
  return rlpc::guarded(decoder, [&] {
    if (const auto status = rlpc::check_pose(*decoder, slots); status != RLPC_OK) {
      return status;
    }
    const rlpc::Skeleton& skeleton = *decoder->pose->skeleton;
    const std::size_t wanted = std::size_t{slots} * skeleton.influences.size();
    if (!rlpc::check_buffer(*decoder, bones, num_values, wanted) ||
        !rlpc::check_buffer(*decoder, weights, num_values, wanted)) {
      return RLPC_BAD_ARGUMENT;
    }
    rlpc::write_influences(skeleton, slots, bones, weights);
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_rest_floats(rlpc_decoder* decoder, uint32_t slots, float* xyz,
                                     size_t num_floats) {
  return rlpc::guarded(decoder, [&] {
    if (const auto status = rlpc::check_pose(*decoder, slots); status != RLPC_OK) {
      return status;
    }
    if (!rlpc::check_buffer(*decoder, xyz, num_floats,
                            3 * decoder->pose->skeleton->influences.size())) {
      return RLPC_BAD_ARGUMENT;
    }
    if (!decoder->has_frame || decoder->next_of_pose != decoder->next_of_frame) {
      return rlpc::bad_pose(*decoder, "another frame has been decoded since rlpc_decoder_pose");
    }
    rlpc::write_rest(*decoder, slots, xyz);
    return RLPC_OK;
  });
}
