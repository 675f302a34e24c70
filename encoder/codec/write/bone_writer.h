// 6.11.2 Bone: bones and their tracks in a section, writing side.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/kinds/skinned/slice_models.h"
#include "encoder/codec/write/section_writer.h"

namespace rlpc {

// Writes rotation_between, origin_between, stretch_between or temporal_between.
inline void write_between(SectionWriter& section, const TrackFrames& frames,
                          std::array<BitModel, kMaxBetween>& models, int between) {
  if (frames.levels > 0) section.truncated_unary(models, between);
}

// Writes bones and their tracks. Models and running means start with each object: in a bone
// section, a track section, and the slice of component group 0 of a temporal layer (9.8.1).
class BoneWriter {
 public:
  // stretch_flag: that of the GOF or shared rig.
  BoneWriter(SectionWriter& section, const TrackFrames& frames, bool stretch_flag)
      : section_(section),
        frames_(frames),
        stretch_flag_(stretch_flag),
        rotation_mean_(frames.count, 0),
        origin_mean_(frames.count, 0),
        stretch_mean_(frames.count, 0) {}

  // bone( b )
  void bone(const Bone& bone, std::size_t b, int position_bits) {
    assert(bone.parent < static_cast<std::int32_t>(b));
    if (b > 0) section_.bypass(ceil_log2(b + 1), static_cast<std::uint32_t>(bone.parent + 1));
    for (const std::int32_t x : bone.pivot) {
      section_.bypass(rest_bits(position_bits),
                      static_cast<std::uint32_t>(x + (1 << (rest_bits(position_bits) - 1))));
    }
    section_.bin(models_.rotation_flag, bone.rotation_flag);
    section_.bin(models_.origin_flag, bone.origin_flag);
    if (stretch_flag_) {
      section_.truncated_unary(models_.stretch_idc, static_cast<int>(bone.stretch));
    }
    if (bone.stretch == Stretch::kOwnAxes) {
      for (const std::int32_t x : bone.stretch_axes) {
        section_.bypass(kStretchAxisBits,
                        static_cast<std::uint32_t>(x + (1 << (kStretchAxisBits - 1))));
      }
    }
  }

  // bone_tracks( b )
  void tracks(const Bone& bone) {
    if (bone.rotation_flag) {
      section_.bypass(8, bone.rotation_step_idx);
      section_.truncated_unary(models_.rotation_order, bone.rotation_order - 1);
      write_between(section_, frames_, models_.rotation_between, bone.rotation_between);
      rotations(bone, 0);
    }
    if (bone.origin_flag) {
      section_.bypass(8, bone.origin_step_idx);
      section_.truncated_unary(models_.origin_order, bone.origin_order);
      write_between(section_, frames_, models_.origin_between, bone.origin_between);
      origins(bone, 0);
    }
    if (bone.stretch != Stretch::kNone) {
      section_.bypass(8, bone.stretch_step_idx);
      section_.truncated_unary(models_.stretch_order, bone.stretch_order);
      write_between(section_, frames_, models_.stretch_between, bone.stretch_between);
      stretches(bone, 0);
    }
  }

  // 6.12.5 bone_layer( b )
  void layer(const Bone& bone, int temporal_layer) {
    if (bone.rotation_flag) rotations(bone, temporal_layer);
    if (bone.origin_flag) origins(bone, temporal_layer);
    if (bone.stretch != Stretch::kNone) stretches(bone, temporal_layer);
  }

 private:
  // rotation_residuals( layer )
  void rotations(const Bone& bone, int temporal_layer) {
    section_.track(models_.rotation, rotation_mean_,
                   places_of_layer(frames_, bone.rotation_between, temporal_layer),
                   bone.rotation_residual);
  }
  // origin_residuals( layer )
  void origins(const Bone& bone, int temporal_layer) {
    section_.track(models_.origin, origin_mean_,
                   places_of_layer(frames_, bone.origin_between, temporal_layer),
                   bone.origin_residual);
  }
  // stretch_residuals( layer )
  void stretches(const Bone& bone, int temporal_layer) {
    section_.track(models_.stretch, stretch_mean_,
                   places_of_layer(frames_, bone.stretch_between, temporal_layer),
                   bone.stretch_residual);
  }

  SectionWriter& section_;
  TrackFrames frames_;
  bool stretch_flag_;
  BoneModels models_;
  std::vector<std::uint32_t> rotation_mean_;
  std::vector<std::uint32_t> origin_mean_;
  std::vector<std::uint32_t> stretch_mean_;
};

}  // namespace rlpc
