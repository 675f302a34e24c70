#include "common/codec/attributes/recon/attribute_recon.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/codec/attributes/recon/attribute_prediction.h"
#include "common/codec/attributes/sectors.h"
#include "common/codec/mesh/corners.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

// DecodeValues( )
Vector<std::uint32_t> recon_values(const AttributeMesh& mesh,
                                   std::span<const std::uint32_t> residuals) {
  const std::uint32_t n = mesh.header.num_components;
  Vector<std::uint32_t> values(std::size_t{n} * mesh.sectors.count());
  AttributePredictor predictor(mesh);
  for (const std::uint32_t x : mesh.order.order) {
    const AttributeValue prediction = predictor.predict(x);
    const std::size_t first = std::size_t{x} * n;
    const AttributeValue value = predictor.value_of(prediction, residuals.subspan(first, n));
    predictor.learn(x, value);
    for (std::size_t c = 0; c < n; ++c) {
      values[first + c] = static_cast<std::uint32_t>(value[c]);
    }
  }
  return values;
}

AttributeSet recon_set(const CodedAttributeSet& coded, std::uint32_t num_vertices,
                       std::span<const std::uint32_t> edge_mates,
                       const CornerGeometry& geometry) {
  AttributeSet set;
  set.header = coded.header;
  if (coded.header.domain == AttributeDomain::kTriangle) {
    set.values = coded.residuals;
  } else {
    const bool is_corner = coded.header.domain == AttributeDomain::kCorner;
    Sectors sectors = is_corner ? sectors_of_corners(edge_mates, coded.seams)
                                : sectors_of_vertices(num_vertices, geometry.triangles());
    std::optional<Faces> faces;
    if (coded.header.has_faces()) {
      faces.emplace(geometry, coded.header.diagonals, edge_mates, coded.seams,
                    coded.diagonal_flags, coded.header.kind != ValueKind::kSmoothing);
    }
    if (coded.header.kind != ValueKind::kSmoothing) {
      const SectorOrder order(sectors);
      const FaceView view = faces ? faces->view() : FaceView{};
      set.values = recon_values(
          {coded.header, edge_mates, coded.seams, sectors, order, &geometry, &view},
          coded.residuals);
    }
    if (faces) set.face_of_triangle = std::move(faces->face_of_triangle());
    if (is_corner) set.value_of_corner = std::move(sectors.sector_of_corner);
  }
  if (coded.header.kind == ValueKind::kFloats) {
    for (std::uint32_t& value : set.values) value = unordered_bits(value);
  }
  return set;
}

}  // namespace

Vector<AttributeSet> recon_attributes(const CodedAttributes& coded, std::uint32_t num_vertices,
                                      std::span<const Triangle> triangles,
                                      std::span<const std::int32_t> first_frame) {
  const Vector<std::uint32_t> edge_mates = find_edge_mates(num_vertices, triangles);
  const CornerGeometry geometry(triangles, first_frame);
  Vector<AttributeSet> sets;
  sets.reserve(coded.sets.size());
  for (const CodedAttributeSet& set : coded.sets) {
    sets.push_back(recon_set(set, num_vertices, edge_mates, geometry));
  }
  return sets;
}

}  // namespace rlpc
