#include "decoder/meshes/mesh_bytes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>

#include "common/codec/attributes/attribute_names.h"
#include "common/files/messages.h"
#include "decoder/meshes/obj_bytes.h"
#include "decoder/meshes/ply_bytes.h"
#include "decoder/meshes/stream_asset.h"

namespace rlpc {

namespace {

template <class Number>
void append_digits(std::string& text, Number value) {
  std::array<char, 64> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

// Returns a set of vertices or corners with least to most components; null if there is none.
const AttributeSet* find_values(const SinkOptions& options, const char* name, std::uint32_t min,
                                std::uint32_t max) {
  const AttributeSet* const set = find_set(options.attributes, name);
  if (set == nullptr || set->header.domain == AttributeDomain::kTriangle) return nullptr;
  if (set->header.domain == AttributeDomain::kCorner && options.triangles.empty()) {
    return nullptr;
  }
  const std::uint32_t n = number_components(set->header);
  return n >= min && n <= max ? set : nullptr;
}

const AttributeSet* find_indices(const SinkOptions& options, const char* name) {
  const AttributeSet* const set = find_set(options.attributes, name);
  if (set == nullptr) return nullptr;
  const AttributeHeader& header = set->header;
  const bool fits = header.domain == AttributeDomain::kTriangle &&
                    header.kind == ValueKind::kIntegers && header.num_components == 1;
  return fits ? set : nullptr;
}

float finite(float x) { return std::isfinite(x) ? x : 0.0F; }

// Converts by IEC 61966-2-1.
float srgb_of_linear(float x) {
  if (!(x > 0.0F)) return 0.0F;
  if (x >= 1.0F) return 1.0F;
  if (x <= 0.0031308F) return 12.92F * x;
  return static_cast<float>(1.055 * std::pow(double{x}, 1.0 / 2.4) - 0.055);
}

}  // namespace

void append_number(std::string& text, float value) { append_digits(text, value); }
void append_number(std::string& text, std::uint64_t value) { append_digits(text, value); }

void append_rounded(std::string& text, float value) {
  constexpr double kScale = 1e4;
  const double rounded = std::round(double{value} * kScale) / kScale;
  append_digits(text, rounded == 0.0 ? 0.0 : rounded);  // no "-0"
}

void append_flipped(std::string& text, float value) {
  const double flipped = 1.0 - double{value};
  constexpr int kMaxDigits = 9;
  for (int digits = 1; digits <= kMaxDigits; ++digits) {
    std::array<char, 64> number{};
    const auto result = std::to_chars(number.data(), number.data() + number.size(), flipped,
                                      std::chars_format::general, digits);
    float read = 0.0F;
    std::from_chars(number.data(), result.ptr, read);
    if (1.0F - read != value && digits < kMaxDigits) continue;
    text.append(number.data(), result.ptr);
    return;
  }
}

void append_precise(std::string& text, double value) {
  std::array<char, 64> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                    std::chars_format::general, 7);
  text.append(digits.data(), result.ptr);
}

std::string frame_rate_text(FrameRate frame_rate) {
  return std::to_string(frame_rate.numerator) + "/" + std::to_string(frame_rate.denominator);
}

const AttributeSet* find_uv(const SinkOptions& options, std::uint32_t set) {
  return find_values(options, uv_name(set).c_str(), 2, 2);
}

MeshAttributes::MeshAttributes(const SinkOptions& options)
    : uv(find_uv(options, 0)),
      normal(find_values(options, kNormalName, 0, 3)),
      colour(find_values(options, colour_name(0).c_str(), 3, 4)),
      material(find_indices(options, kMaterialName)),
      part(find_indices(options, kPartName)) {
  if (normal == nullptr || normal->header.kind == ValueKind::kSmoothing) return;
  if (number_components(normal->header) != 3) normal = nullptr;
}

std::vector<float> MeshAttributes::uv_numbers() const {
  std::vector<float> numbers = attribute_numbers(*uv);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = finite(i % 2 == 0 ? numbers[i] : 1.0F - numbers[i]);
  }
  return numbers;
}

std::vector<float> MeshAttributes::colour_numbers() const {
  std::vector<float> numbers = attribute_numbers(*colour);
  const std::uint32_t n = number_components(colour->header);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] =
        i % n < 3 ? srgb_of_linear(numbers[i]) : std::clamp(finite(numbers[i]), 0.0F, 1.0F);
  }
  return numbers;
}

bool MeshAttributes::has_exact_colours() const {
  return colour != nullptr && colour->header.kind == ValueKind::kFloats;
}

bool MeshAttributes::has_exact_normals() const {
  constexpr std::uint32_t kExactBits = 16;
  return normal != nullptr && normal->header.kind == ValueKind::kUnitVectors &&
         normal->header.value_bits == kExactBits;
}

MeshNormals::MeshNormals(const MeshAttributes& attributes, const SinkOptions& options) {
  if (attributes.normal == nullptr) return;
  normals_.emplace(*attributes.normal, options.triangles, options.num_vertices);
  numbers_.resize(3 * std::size_t{normals_->count()});
}

std::span<const float> MeshNormals::of(std::span<const float> xyz) {
  normals_->compute(xyz, numbers_);
  for (float& x : numbers_) x = finite(x);
  return numbers_;
}

std::unique_ptr<MeshBytes> make_mesh_bytes(SinkFormat format, const SinkOptions& options,
                                           const std::string& materials) {
  if (format == SinkFormat::kObj) return std::make_unique<ObjBytes>(options, materials);
  assert(format == SinkFormat::kPly);
  return std::make_unique<PlyBytes>(options);
}

std::vector<std::string> left_out_remark(SinkFormat format, const SinkOptions& options,
                                         const MeshBytes& mesh) {
  std::string names;
  for (const AttributeSet& set : options.attributes) {
    if (mesh.holds(set)) continue;
    names += names.empty() ? "" : ", ";
    names += printable({set.header.name.begin(), set.header.name.end()});
  }
  std::vector<std::string> remarks;
  if (format == SinkFormat::kObj) {
    const std::string problem = StreamAsset(options.asset).problem();
    if (!problem.empty()) remarks.push_back(problem);
  }
  if (names.empty()) return remarks;
  const char* const hold =
      format == SinkFormat::kObj
          ? "OBJ holds the UVs that textures use, vertex colours, normals, "
            "materials and parts"
          : "PLY holds uv0, colour0 and normals";
  remarks.push_back("left out: " + names + " (" + hold + ")");
  return remarks;
}

}  // namespace rlpc
