// Predicts the values of sectors in their order (F.7).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/attributes/recon/corner_geometry.h"
#include "common/codec/attributes/recon/normals.h"
#include "common/codec/attributes/sectors.h"
#include "common/memory/owned.h"

namespace rlpc {

// Mesh along which a set is predicted. All members must outlive the predictor.
struct AttributeMesh {
  const AttributeHeader& header;
  std::span<const std::uint32_t> edge_mates;
  const Vector<bool>& seams;  // empty: none
  const Sectors& sectors;
  const SectorOrder& order;
  const CornerGeometry* geometry = nullptr;  // set if header.uses_positions()
  const FaceView* faces = nullptr;           // set if header.has_faces()
};

// Value of an attribute; only the first num_components are used.
using AttributeValue = std::array<std::int64_t, kMaxAttributeComponents>;

// Predicts floats as ordered_bits().
class AttributePredictor {
 public:
  explicit AttributePredictor(const AttributeMesh& mesh);

  // PredictAttribute( ) for sector x, the next one in the order.
  AttributeValue predict(std::uint32_t x);
  // Takes the value of that sector, from which weights are learned and later values predicted.
  void learn(std::uint32_t x, const AttributeValue& value);
  // Returns the value of a residual modulo 2^32, as in CodedAttributeSet.
  AttributeValue value_of(const AttributeValue& prediction,
                          std::span<const std::uint32_t> residual) const;

 private:
  using Point = std::array<std::int64_t, 2>;
  struct UvPrediction {
    std::size_t kind;  // 0 conformal, 1 unfolded, 2 parallelogram
    Point point;       // 4 fractional bits
  };

  const AttributeValue& value(std::uint32_t x) const { return values_[x]; }
  std::uint32_t sector_of(std::uint32_t c) const { return mesh_.sectors.sector_of_corner[c]; }
  std::optional<std::uint32_t> corner_across(std::uint32_t e) const;
  AttributeValue from_neighbours(std::uint32_t x) const;
  AttributeValue texture_coordinates(std::uint32_t x);
  void add_uv_predictions(std::uint32_t e);
  void add_uv_prediction(std::size_t kind, std::int64_t u, std::int64_t v);
  void learn_uv(std::uint32_t x, const AttributeValue& value);

  AttributeMesh mesh_;
  Vector<AttributeValue> values_;  // [sector]
  Vector<bool> is_known_;
  Vector<UvPrediction> uv_predictions_;        // predictions of the last sector
  std::array<std::int64_t, 3> squared_error_;  // SquaredError
  std::int64_t turn_ = 0;                      // Turn
};

// F.7.2 OrderedBits( ) and UnorderedBits( )
constexpr std::uint32_t ordered_bits(std::uint32_t bits) {
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}
constexpr std::uint32_t unordered_bits(std::uint32_t ordered) {
  return (ordered & 0x80000000U) != 0 ? ordered & 0x7FFFFFFFU : ~ordered;
}

}  // namespace rlpc
