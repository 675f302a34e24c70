#include "encoder/meshes/gltf/document/values.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/files/binary_numbers.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::uint64_t kValuesPerByte = 16;
constexpr std::size_t kBlockBytes = 1 << 16;

std::uint32_t load_unsigned(GltfComponent component, const char* bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes_of(component); i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

// Loads a number (glTF 2.0, 3.6.2.2): a normalised integer is a fraction of the largest of its
// type.
float load_float(const GltfAccessor& accessor, const char* bytes) {
  const auto scaled = [&](int value, int largest) {
    if (!accessor.normalized) return static_cast<float>(value);
    return static_cast<float>(std::max(static_cast<double>(value) / largest, -1.0));
  };
  switch (accessor.component) {
    case GltfComponent::kI8:
      return scaled(static_cast<std::int8_t>(load_unsigned(accessor.component, bytes)), 127);
    case GltfComponent::kU8:
      return scaled(static_cast<int>(load_unsigned(accessor.component, bytes)), 255);
    case GltfComponent::kI16:
      return scaled(static_cast<std::int16_t>(load_unsigned(accessor.component, bytes)), 32767);
    case GltfComponent::kU16:
      return scaled(static_cast<int>(load_unsigned(accessor.component, bytes)), 65535);
    default:
      return load_f32({bytes, 4}, 0);
  }
}

}  // namespace

std::string gltf_accessor_path(std::uint32_t accessor) {
  return "accessors[" + to_string(accessor) + "]";
}

GltfValues::GltfValues(const std::vector<GltfAccessor>& accessors, GltfBuffers& buffers,
                       std::uint64_t spare_values, GltfMemory& memory, GltfErrors& errors)
    : accessors_(accessors),
      buffers_(buffers),
      spare_values_(spare_values),
      memory_(memory),
      errors_(errors) {}

bool GltfValues::has_type(std::uint32_t accessor, std::string_view type) const {
  if (errors_) return false;
  const GltfAccessor& a = accessors_[accessor];
  if (a.type == type) return true;
  errors_.expected(gltf_accessor_path(accessor) + ".type", a.type, std::string(type));
  return false;
}

bool GltfValues::has_float_type(std::uint32_t accessor, std::string_view type,
                                Integers integers) const {
  if (!has_type(accessor, type)) return false;
  const GltfComponent component = accessors_[accessor].component;
  const bool small = component <= GltfComponent::kU16;
  if (component == GltfComponent::kF32 || (small && integers == Integers::kToo)) return true;
  errors_.expected(gltf_accessor_path(accessor) + ".componentType",
                   to_string(static_cast<int>(component)),
                   integers == Integers::kToo ? "5126, or 5120 to 5123" : "5126");
  return false;
}

bool GltfValues::take(std::uint32_t accessor, std::uint64_t elements) {
  const GltfAccessor& a = accessors_[accessor];
  // Check this first, as it determines the number of bytes.
  const auto missing = [&](const GltfRange& range) {
    return !buffers_.available(range.buffer);
  };
  if (a.base && missing(*a.base)) return false;
  if (a.sparse && (missing(a.sparse->indices) || missing(a.sparse->values))) return false;
  const std::uint64_t limit = spare_values_ + kValuesPerByte * buffers_.bytes_at_hand();
  const std::uint64_t left = limit - std::min(limit, values_);
  values_ += elements * a.width;
  if (elements * a.width <= left) {
    return memory_.take(gltf_accessor_path(accessor), elements * a.width * sizeof(float));
  }
  errors_.expected(gltf_accessor_path(accessor) + ".count", to_string(elements),
                   "at most " + to_string(left / a.width) + ", as all there is has " +
                       to_string(buffers_.bytes_at_hand()) + " bytes");
  return false;
}

template <class Visit>
void GltfValues::each_element(const GltfRange& range, std::uint64_t count, std::size_t size,
                              const Visit& visit) {
  const std::uint64_t block = kBlockBytes / range.stride;
  std::vector<char> bytes(kBlockBytes);
  for (std::uint64_t first = 0; first < count && !errors_; first += block) {
    const auto n = static_cast<std::size_t>(std::min(block, count - first));
    const auto stride = static_cast<std::size_t>(range.stride);
    buffers_.read(range.buffer, range.offset + first * range.stride,
                  std::span(bytes).first((n - 1) * stride + size));
    for (std::size_t i = 0; i < n && !errors_; ++i) visit(first + i, bytes.data() + i * stride);
  }
}

// Calls visit(element, bytes) in ascending order of elements.
template <class Visit>
void GltfValues::each_sparse(std::uint32_t accessor, const Visit& visit) {
  const GltfAccessor& a = accessors_[accessor];
  const GltfAccessor::Sparse& sparse = *a.sparse;
  std::vector<std::uint32_t> elements;
  each_element(sparse.indices, sparse.count, bytes_of(sparse.index_component),
               [&](std::uint64_t i, const char* bytes) {
                 const std::uint32_t element = load_unsigned(sparse.index_component, bytes);
                 if (element < a.count && (elements.empty() || elements.back() < element)) {
                   elements.push_back(element);
                   return;
                 }
                 errors_.expected(
                     gltf_accessor_path(accessor) + ".sparse.indices, number " + to_string(i),
                     to_string(element), "indices that ascend, below " + to_string(a.count));
               });
  each_element(sparse.values, elements.size(), std::size_t{a.width} * bytes_of(a.component),
               [&](std::uint64_t i, const char* bytes) {
                 visit(elements[static_cast<std::size_t>(i)], bytes);
               });
}

// Skips elements without a buffer. Visits sparse elements a second time, with their final
// values.
template <class Visit>
void GltfValues::each(std::uint32_t accessor, const Visit& visit) {
  const GltfAccessor& a = accessors_[accessor];
  if (a.base) {
    each_element(*a.base, a.count, std::size_t{a.width} * bytes_of(a.component), visit);
  }
  if (a.sparse) each_sparse(accessor, visit);
}

void GltfValues::store_floats(std::uint32_t accessor, std::uint64_t element, const char* bytes,
                              std::span<float> out) {
  const GltfAccessor& a = accessors_[accessor];
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = load_float(a, bytes + c * bytes_of(a.component));
    if (std::isfinite(out[c])) continue;
    errors_.expected(gltf_accessor_path(accessor) + ", element " + to_string(element),
                     std::isnan(out[c]) ? "NaN" : "infinity", "finite numbers");
  }
}

std::vector<float> GltfValues::floats(std::uint32_t accessor, std::string_view type,
                                      Integers integers) {
  if (!has_float_type(accessor, type, integers)) return {};
  const GltfAccessor& a = accessors_[accessor];
  if (!take(accessor, a.count)) return {};
  std::vector<float> values(static_cast<std::size_t>(a.count) * a.width);
  const auto store = [&](std::uint64_t element, const char* bytes) {
    const auto first = static_cast<std::size_t>(element) * a.width;
    store_floats(accessor, element, bytes, std::span(values).subspan(first, a.width));
  };
  each(accessor, store);
  if (errors_) return {};
  return values;
}

std::vector<std::uint32_t> GltfValues::integers(std::uint32_t accessor, std::string_view type) {
  if (!has_type(accessor, type)) return {};
  const GltfAccessor& a = accessors_[accessor];
  if (a.component != GltfComponent::kU8 && a.component != GltfComponent::kU16 &&
      a.component != GltfComponent::kU32) {
    errors_.expected(gltf_accessor_path(accessor) + ".componentType",
                     to_string(static_cast<int>(a.component)), "5121, 5123 or 5125");
    return {};
  }
  if (!take(accessor, a.count)) return {};
  std::vector<std::uint32_t> values(static_cast<std::size_t>(a.count) * a.width);
  const auto store = [&](std::uint64_t element, const char* bytes) {
    for (std::size_t c = 0; c < a.width; ++c) {
      values[static_cast<std::size_t>(element) * a.width + c] =
          load_unsigned(a.component, bytes + c * bytes_of(a.component));
    }
  };
  each(accessor, store);
  if (errors_) return {};
  return values;
}

std::vector<GltfDelta> GltfValues::deltas(std::uint32_t accessor) {
  if (!has_float_type(accessor, "VEC3", Integers::kToo)) return {};
  const GltfAccessor& a = accessors_[accessor];
  std::vector<GltfDelta> deltas;
  const auto add = [&](std::uint64_t vertex, std::span<const float> move) {
    if (move[0] == 0 && move[1] == 0 && move[2] == 0) return;
    deltas.push_back({static_cast<std::uint32_t>(vertex), {move[0], move[1], move[2]}});
  };
  if (a.base) {
    const std::vector<float> moves = floats(accessor, "VEC3", Integers::kToo);
    for (std::size_t v = 0; v < moves.size() / 3; ++v) {
      add(v, std::span(moves).subspan(3 * v, 3));
    }
  } else if (a.sparse && take(accessor, a.sparse->count)) {
    each_sparse(accessor, [&](std::uint64_t vertex, const char* bytes) {
      std::array<float, 3> move{};
      store_floats(accessor, vertex, bytes, move);
      add(vertex, move);
    });
  }
  return deltas;
}

std::vector<Affine> GltfValues::matrices(std::uint32_t accessor) {
  const std::vector<float> values = floats(accessor, "MAT4", Integers::kNo);
  std::vector<Affine> matrices(values.size() / 16);
  for (std::size_t m = 0; m < matrices.size(); ++m) {
    const auto columns = values.begin() + static_cast<std::ptrdiff_t>(16 * m);
    matrices[m] = affine_of_columns({columns, columns + 16});
  }
  return matrices;
}

}  // namespace rlpc
