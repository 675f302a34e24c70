// Decides which normals follow from the positions of each frame, and which are stored as unit
// vectors (F.8.5).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/attributes/sectors.h"
#include "encoder/codec/attributes/attribute_settings.h"
#include "encoder/codec/attributes/normal_error.h"
#include "encoder/codec/attributes/smoothing_search.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

struct NormalTask {
  const SourceAttributes& source;
  std::span<const float> values;  // values of the set of normals
  std::span<const Triangle> triangles;
  std::uint32_t num_vertices = 0;
  std::span<const std::uint32_t> corner_map;  // map_corners()
  std::span<const std::uint32_t> edge_mates;
  const std::vector<bool>& seams;
  const Sectors& sectors;
  std::span<const std::uint32_t> value_of_sector;  // index of the value, or kNoSector
  std::span<const std::int32_t> first_frame;       // decoded positions
  // Later frames for which the source has normals; may be empty.
  std::span<const DecodedFrame> later_frames;
  bool is_animated = true;  // the sequence has several frames
  std::uint32_t value_bits = 8;
};

struct NormalPlan {
  Smoothing smoothing;
  bool is_smoothing = false;  // no normals are stored
  // [sector], whether its normal follows from positions.
  std::vector<bool> follows;
  // [sector], whether its normal must not follow from positions, which would be clearly worse.
  // A point that is the predicted one would follow (F.8.5).
  std::vector<bool> must_turn;
  // [sector], points of the octahedron; without meaning for sectors that follow.
  std::vector<std::array<std::uint32_t, 2>> points;
  std::vector<NormalError> errors;  // in the first frame and in later_frames
  double rms_error = 0.0;           // RMS of all of them, degrees
};

NormalPlan plan_normals(const NormalTask& task, const AttributeSettings& settings);

}  // namespace rlpc
