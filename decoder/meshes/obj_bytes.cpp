#include "decoder/meshes/obj_bytes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "common/files/float_position.h"

namespace rlpc {
namespace {

// Returns bits that identify a texture, also for numbers such as NaN.
std::array<std::uint64_t, 7> bits_of(const ObjTexture& texture) {
  std::array<std::uint64_t, 7> bits{texture.set};
  for (std::size_t i = 0; i < 6; ++i) {
    bits[1 + i] = std::bit_cast<std::uint64_t>(texture.rows[i / 3][i % 3]);
  }
  return bits;
}

}  // namespace

ObjBytes::ObjBytes(const SinkOptions& options, const std::string& materials)
    : options_(options), attributes_(options), normals_(attributes_, options) {
  header_ = "# frame_rate " + frame_rate_text(options.frame_rate) + "\n";
  if (!materials.empty()) header_ += "mtllib " + materials + "\n";
  const AttributeSet* const colour = attributes_.colour;
  // OBJ files have only colours of vertices.
  if (colour != nullptr && colour->header.domain == AttributeDomain::kVertex) {
    colours_ = attributes_.colour_numbers();
    colour_width_ = number_components(colour->header);
  }
  append_faces(ObjMaterials(options));
}

ObjBytes::UvList* ObjBytes::uv_of(const ObjMaterials& materials, std::size_t triangle) {
  const std::uint32_t material =
      attributes_.material == nullptr ? 0 : attributes_.material->values[triangle];
  const auto [place, is_new] = uv_list_of_material_.try_emplace(material);
  if (is_new) place->second = add_uv(materials.texture(material));
  return place->second ? &uv_lists_[*place->second] : nullptr;
}

std::optional<std::size_t> ObjBytes::add_uv(const ObjTexture& texture) {
  const AttributeSet* const set = find_uv(options_, texture.set);
  if (set == nullptr) return std::nullopt;
  const auto [known, is_new] = list_of_texture_.try_emplace(bits_of(texture), uv_lists_.size());
  if (!is_new) return known->second;
  UvList list{texture, set, std::nullopt, {}};
  const auto [values, is_first] = uv_of_set_.try_emplace(set);
  if (is_first) {
    values->second = attribute_numbers(*set);
    list.first = num_uv_ + 1;
    num_uv_ += values->second.size() / 2;
    for (std::uint32_t i = 0; i < values->second.size() / 2; ++i) append_uv(list, i);
  }
  uv_lists_.push_back(std::move(list));
  return known->second;
}

std::uint64_t ObjBytes::number_of(UvList& list, std::uint32_t value) {
  if (list.first) return *list.first + value;
  const auto [place, is_new] = list.numbers.try_emplace(value, num_uv_ + 1);
  if (is_new) {
    ++num_uv_;
    append_uv(list, value);
  }
  return place->second;
}

void ObjBytes::append_uv(const UvList& list, std::uint32_t value) {
  const float* const uv = &uv_of_set_.at(list.set)[2 * std::size_t{value}];
  std::array<float, 2> place{};
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& row = list.texture.rows[c];
    place[c] = static_cast<float>(row[0] * uv[0] + row[1] * uv[1] + row[2]);
    if (!std::isfinite(place[c])) place[c] = static_cast<float>(c);
  }
  header_ += "vt ";
  append_number(header_, place[0]);
  header_ += ' ';
  append_flipped(header_, place[1]);
  header_ += '\n';
}

std::vector<std::size_t> ObjBytes::triangles_by_part() const {
  std::vector<std::size_t> order(options_.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const AttributeSet* const set : {attributes_.material, attributes_.part}) {
    if (set == nullptr) continue;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return set->values[a] < set->values[b];
    });
  }
  return order;
}

void ObjBytes::append_faces(const ObjMaterials& materials) {
  if (materials.has_one()) faces_ += "usemtl " + materials.material_name(0) + "\n";
  std::optional<std::size_t> last;
  const auto changes = [&](const AttributeSet* set, std::size_t triangle) {
    return set != nullptr && (!last || set->values[triangle] != set->values[*last]);
  };
  for (const std::size_t t : triangles_by_part()) {
    if (changes(attributes_.part, t)) {
      faces_ += "g " + materials.part_name(attributes_.part->values[t]) + "\n";
    }
    if (changes(attributes_.material, t)) {
      faces_ += "usemtl " + materials.material_name(attributes_.material->values[t]) + "\n";
    }
    last = t;
    UvList* const uv = uv_of(materials, t);
    faces_ += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = options_.triangles[t][k];
      const std::size_t c = 3 * t + k;
      faces_ += ' ';
      append_number(faces_, std::uint64_t{v} + 1);
      if (uv != nullptr) {
        faces_ += '/';
        const auto& value_of_corner = uv->set->value_of_corner;
        append_number(faces_, number_of(*uv, value_of_corner.empty() ? v : value_of_corner[c]));
      }
      if (!normals_.exist()) continue;
      faces_ += uv != nullptr ? "/" : "//";
      append_number(faces_, std::uint64_t{normals_.normal_of_corner(c)} + 1);
    }
    faces_ += '\n';
  }
}

const std::string& ObjBytes::frame(std::span<const std::int32_t> positions) {
  bytes_ = header_;
  xyz_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    xyz_[i] = float_position(options_.grid, i % 3, positions[i]);
  }
  append_vertices();
  append_normals();
  return bytes_ += faces_;
}

bool ObjBytes::holds(const AttributeSet& set) const {
  if (&set == attributes_.colour) return colour_width_ > 0;
  return &set == attributes_.normal || &set == attributes_.material ||
         &set == attributes_.part ||
         std::any_of(uv_lists_.begin(), uv_lists_.end(),
                     [&](const UvList& list) { return list.set == &set; });
}

void ObjBytes::append_vertices() {
  for (std::size_t v = 0; v < xyz_.size() / 3; ++v) {
    bytes_ += 'v';
    for (std::size_t c = 0; c < 3; ++c) {
      bytes_ += ' ';
      append_number(bytes_, xyz_[3 * v + c]);
    }
    for (std::size_t c = 0; c < 3 && colour_width_ > 0; ++c) {
      bytes_ += ' ';
      const float colour = colours_[colour_width_ * v + c];
      if (attributes_.has_exact_colours()) {
        append_precise(bytes_, colour);
      } else {
        append_rounded(bytes_, colour);
      }
    }
    bytes_ += '\n';
  }
}

void ObjBytes::append_normals() {
  if (!normals_.exist()) return;
  const std::span<const float> normals = normals_.of(xyz_);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    bytes_ += i % 3 == 0 ? "vn " : " ";
    if (attributes_.has_exact_normals()) {
      append_number(bytes_, normals[i] == 0.0F ? 0.0F : normals[i]);  // no "-0"
    } else {
      append_rounded(bytes_, normals[i]);
    }
    if (i % 3 == 2) bytes_ += '\n';
  }
}

}  // namespace rlpc
