// Attributes of a mesh that do not change from frame to frame: texture coordinates, normals,
// colours, materials (Annex F).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::uint32_t kMaxAttributeSets = 64;  // R-ATT-02
inline constexpr std::size_t kMaxAttributeComponents = 4;
inline constexpr std::size_t kMaxAttributeNameBytes = 256;

// F.3: values of the syntax elements.
enum class AttributeDomain : std::uint8_t { kVertex, kCorner, kTriangle };
enum class ValueKind : std::uint8_t { kIntegers, kUnitVectors, kFloats, kSmoothing };
enum class ValueScale : std::uint8_t { kNone, kGrid, kNormalised };
enum class AttributePrediction : std::uint8_t { kMean, kParallelogram, kPositions };
enum class SmoothingWeight : std::uint8_t { kAngle, kArea, kEqual };
enum class Diagonals : std::uint8_t { kNone, kFlagged, kLikely };

// F.2.2 attribute_header( )
struct AttributeHeader {
  String name;  // UTF-8 without control characters, 1 to kMaxAttributeNameBytes bytes
  AttributeDomain domain = AttributeDomain::kVertex;
  ValueKind kind = ValueKind::kIntegers;
  std::uint32_t num_components = 1;  // coded components: unit vectors 2, smoothing 0
  std::uint32_t value_bits = 32;     // bits per component
  ValueScale scale = ValueScale::kNone;
  std::int32_t log2_step = 0;                                  // kGrid only
  std::array<std::int32_t, kMaxAttributeComponents> origin{};  // kGrid only
  AttributePrediction prediction = AttributePrediction::kMean;
  SmoothingWeight weight = SmoothingWeight::kAngle;
  Diagonals diagonals = Diagonals::kNone;

  // Returns whether normals follow from positions, perhaps with residuals (F.8).
  bool has_faces() const {
    return kind == ValueKind::kSmoothing ||
           (kind == ValueKind::kUnitVectors && prediction == AttributePrediction::kPositions);
  }
  bool predicts_texture_coordinates() const {
    return kind == ValueKind::kIntegers && prediction == AttributePrediction::kPositions;
  }
  // Returns whether decoding needs the first frame.
  bool uses_positions() const {
    return prediction == AttributePrediction::kPositions || diagonals == Diagonals::kLikely;
  }
  // Returns the largest value of a component.
  std::int64_t max_value() const { return (std::int64_t{1} << value_bits) - 1; }
  bool operator==(const AttributeHeader&) const = default;
};

// Decoded set. Vertices are in output order; triangles and their corners are in the decoder's
// order. The components of value i begin at values[i * num_components].
struct AttributeSet {
  AttributeHeader header;
  // [3 * triangle + corner] index of the value (the sector); empty unless the domain is
  // kCorner. In smoothing, corners with the same index share a normal.
  Vector<std::uint32_t> value_of_corner;
  // [triangle] number of the face (F.8.1); empty unless header.has_faces().
  Vector<std::uint32_t> face_of_triangle;
  // Unsigned integers, points of an octahedron (F.8.4) or bits of floats: one value per vertex,
  // sector or triangle; none for smoothing.
  Vector<std::uint32_t> values;
  // [vertex][3] positions of the first frame if unit vectors have faces, which turn with the
  // surface in other frames (F.8.5). Set by the decoder.
  Vector<std::int32_t> first_positions{};

  std::size_t num_values() const {
    return header.num_components == 0 ? 0 : values.size() / header.num_components;
  }
};

// Set as coded in the stream: seams and residuals.
struct CodedAttributeSet {
  AttributeHeader header;
  Vector<bool> seams;           // [edge], F.1; domain kCorner only
  Vector<bool> diagonal_flags;  // [edge]; without diagonals: empty
  // [sector][component], modulo 2^32; domain kTriangle: values.
  Vector<std::uint32_t> residuals;
};

// Contents of an attribute unit.
struct CodedAttributes {
  std::uint32_t first_frame_crc = 0;  // set if a set uses positions
  Vector<CodedAttributeSet> sets;

  bool uses_positions() const {
    for (const CodedAttributeSet& set : sets) {
      if (set.header.uses_positions()) return true;
    }
    return false;
  }
};

}  // namespace rlpc
