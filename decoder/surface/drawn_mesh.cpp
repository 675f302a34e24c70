#include "decoder/surface/drawn_mesh.h"

#include <algorithm>
#include <utility>

#include "common/codec/attributes/attribute_names.h"

namespace rlpc {

bool is_drawable(const AttributeHeader& header, std::span<const Triangle> triangles) {
  return header.domain == AttributeDomain::kVertex ||
         (header.domain == AttributeDomain::kCorner && !triangles.empty());
}

Vector<const AttributeSet*> drawable_sets(const Vector<AttributeSet>& sets,
                                          std::span<const Triangle> triangles) {
  Vector<const AttributeSet*> drawable;
  for (const AttributeSet& set : sets) {
    if (is_drawable(set.header, triangles)) drawable.push_back(&set);
  }
  return drawable;
}

bool is_normal_set(const AttributeHeader& header) {
  const bool is_direction =
      header.kind == ValueKind::kUnitVectors || header.kind == ValueKind::kSmoothing;
  return header.name == kNormalName && is_direction &&
         header.domain != AttributeDomain::kTriangle;
}

DrawnMesh::DrawnMesh(Vector<const AttributeSet*> sets, std::span<const Triangle> triangles,
                     std::uint32_t num_vertices)
    : sets_(std::move(sets)), vertices_(split_vertices(triangles, num_vertices, sets_)) {
  const auto normal = std::find_if(sets_.begin(), sets_.end(), [](const AttributeSet* set) {
    return is_normal_set(set->header);
  });
  if (normal == sets_.end() || triangles.empty()) return;
  normal_set_ = static_cast<std::size_t>(normal - sets_.begin());
  normals_.emplace(**normal, triangles, num_vertices);
}

Vector<float> DrawnMesh::numbers(std::size_t set) const {
  const std::size_t width = number_components(sets_[set]->header);
  const Vector<float> all = attribute_numbers(*sets_[set]);
  Vector<float> numbers;
  if (width == 0) return numbers;
  numbers.reserve(width * vertices_.num_vertices());
  for (const std::uint32_t i : vertices_.value_of_vertex[set]) {
    const auto value = std::span(all).subspan(i * width, width);
    numbers.insert(numbers.end(), value.begin(), value.end());
  }
  return numbers;
}

std::span<const std::uint32_t> DrawnMesh::normal_of_vertex() const {
  if (!normals_) return {};
  return vertices_.value_of_vertex[normal_set_];
}

}  // namespace rlpc
