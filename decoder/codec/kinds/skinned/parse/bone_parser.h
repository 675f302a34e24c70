// 6.11.2 Bone: bones and their tracks in a section, parsing side.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/kinds/skinned/slice_models.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/parse_track.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

// Models and running means are initialised by each object: in a bone section, a track section,
// and the slice of component group 0 of a temporal layer (9.8.1).
class BoneParser {
 public:
  BoneParser(SectionReader& section, const SequenceHeader& header, const SkinnedGof& gof)
      : section_(section),
        header_(header),
        frames_(track_frames(gof)),
        stretch_flag_(gof.stretch_flag),
        mean_(3 * std::size_t{gof.num_frames}, 0) {}

  // bone( b )
  Bone bone(std::uint32_t b) {
    Bone bone;
    if (b > 0) {
      const std::uint32_t parent_plus1 = section_.bypass(ceil_log2(b + 1), "bone_parent_plus1");
      if (parent_plus1 > b) section_.fail("R-BON-04", "bone_parent_plus1");
      bone.parent = static_cast<std::int32_t>(std::min(parent_plus1, b)) - 1;
    }
    for (std::int32_t& x : bone.pivot) {
      const std::uint32_t value = section_.bypass(header_.position_bits + 5, "bone_pivot");
      x = static_cast<std::int32_t>(value) - (1 << (header_.position_bits + 4));
    }
    bone.rotation_flag = section_.bin(models_.rotation_flag, "rotation_flag");
    bone.origin_flag = section_.bin(models_.origin_flag, "origin_flag");
    if (stretch_flag_) {
      bone.stretch =
          static_cast<Stretch>(section_.truncated_unary(models_.stretch_idc, "stretch_idc"));
    }
    if (bone.stretch == Stretch::kOwnAxes) {
      for (std::int32_t& x : bone.stretch_axes) {
        const std::uint32_t value = section_.bypass(kStretchAxisBits, "stretch_axes");
        x = static_cast<std::int32_t>(value) - (1 << (kStretchAxisBits - 1));
      }
    }
    return bone;
  }

  // bone_tracks( b )
  void tracks(Bone& bone) {
    if (bone.rotation_flag) {
      bone.rotation_step_idx = step_idx("rotation_step_idx");
      bone.rotation_order =
          section_.truncated_unary(models_.rotation_order, "rotation_order_minus1") + 1;
      bone.rotation_between = between(models_.rotation_between, "rotation_between");
      rotations(bone, 0);
    }
    if (bone.origin_flag) {
      bone.origin_step_idx = step_idx("origin_step_idx");
      bone.origin_order = section_.truncated_unary(models_.origin_order, "origin_order");
      bone.origin_between = between(models_.origin_between, "origin_between");
      origins(bone, 0);
    }
    if (bone.stretch != Stretch::kNone) {
      bone.stretch_step_idx = step_idx("stretch_step_idx");
      bone.stretch_order = section_.truncated_unary(models_.stretch_order, "stretch_order");
      bone.stretch_between = between(models_.stretch_between, "stretch_between");
      stretches(bone, 0);
    }
  }

  // Checks the section after each bone.
  void check_overrun(bool has_tracks = true) {
    section_.check_overrun(has_tracks ? "origin_residual" : "origin_flag");
  }

  // 6.12.5 bone_layer( b )
  void layer(Bone& bone, int temporal_layer) {
    if (bone.rotation_flag) rotations(bone, temporal_layer);
    if (bone.origin_flag) origins(bone, temporal_layer);
    if (bone.stretch != Stretch::kNone) stretches(bone, temporal_layer);
  }

 private:
  // rotation_residuals( layer )
  void rotations(Bone& bone, int temporal_layer) {
    residuals(models_.rotation, 0, bone.rotation_between, temporal_layer,
              bone.rotation_residual, "rotation_residual");
  }
  // origin_residuals( layer )
  void origins(Bone& bone, int temporal_layer) {
    residuals(models_.origin, 1, bone.origin_between, temporal_layer, bone.origin_residual,
              "origin_residual");
  }
  // stretch_residuals( layer )
  void stretches(Bone& bone, int temporal_layer) {
    residuals(models_.stretch, 2, bone.stretch_between, temporal_layer, bone.stretch_residual,
              "stretch_residual");
  }
  void residuals(TrackModels& models, std::size_t mean, int between_idc, int temporal_layer,
                 TrackResiduals& values, const char* element) {
    if (temporal_layer == 0) values.assign(frames_.count, {});
    parse_track(section_, models, std::span(mean_).subspan(mean * frames_.count, frames_.count),
                places_of_layer(frames_, between_idc, temporal_layer), values, element);
  }

  std::uint32_t step_idx(const char* element) {
    const std::uint32_t idx = section_.bypass(8, element);
    if (idx > kMaxStepIdx) section_.fail("R-BON-05", element);
    return std::min(idx, kMaxStepIdx);
  }

  int between(std::array<BitModel, kMaxBetween>& models, const char* element) {
    return frames_.levels > 0 ? section_.truncated_unary(models, element) : 0;
  }

  SectionReader& section_;
  const SequenceHeader& header_;
  TrackFrames frames_;
  bool stretch_flag_;
  BoneModels models_;
  Vector<std::uint32_t> mean_;  // RotationMean, OriginMean, StretchMean: [3][num_gof_frames]
};

}  // namespace rlpc
