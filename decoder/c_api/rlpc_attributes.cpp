#include "decoder/c_api/rlpc_attributes.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "decoder/c_api/convert_frame.h"
#include "decoder/c_api/decoder_handle.h"
#include "decoder/surface/attribute_values.h"
#include "decoder/surface/drawn_mesh.h"

namespace rlpc {
namespace {

rlpc_status bad(rlpc_decoder& handle, const std::string& what) {
  return handle.error.set(RLPC_BAD_ARGUMENT, what);
}

// Returns a set; null, and the error of the handle, if it does not exist.
const AttributeSet* set_at(rlpc_decoder& handle, std::uint32_t set) {
  const auto& sets = handle.attributes;
  if (sets && set < sets->size()) return &(*sets)[set];
  bad(handle, sets ? "expected a set below " + std::to_string(sets->size()) + ", got " +
                         std::to_string(set)
                   : "call rlpc_decoder_attributes first");
  return nullptr;
}

DrawnMesh* drawn_of(rlpc_decoder& handle) {
  if (!handle.drawn) bad(handle, "call rlpc_decoder_split first");
  return handle.drawn ? &*handle.drawn : nullptr;
}

template <class Value>
rlpc_status give(rlpc_decoder& handle, const Vector<Value>& values, Value* out,
                 std::size_t count) {
  if (!check_buffer(handle, out, count, values.size())) return RLPC_BAD_ARGUMENT;
  std::copy(values.begin(), values.end(), out);
  return RLPC_OK;
}

rlpc_status decode_attributes(rlpc_decoder& handle) {
  if (handle.attributes) return RLPC_OK;
  auto sets = handle.decoder->attributes();
  if (!sets) return fail(handle, sets.error());
  handle.attributes = std::move(*sets);
  return RLPC_OK;
}

rlpc_attribute describe(const AttributeSet& set) {
  rlpc_attribute described{};
  described.name = set.header.name.c_str();
  described.domain = static_cast<std::uint32_t>(set.header.domain);
  described.kind = static_cast<std::uint32_t>(set.header.kind);
  described.num_components = number_components(set.header);
  described.num_values = static_cast<std::uint32_t>(set.num_values());
  return described;
}

// Returns the index of a set in the sets of drawn vertices; none if it is not one of them.
std::optional<std::size_t> place_of(const DrawnMesh& drawn, const AttributeSet* set) {
  const auto sets = drawn.sets();
  const auto found = std::find(sets.begin(), sets.end(), set);
  if (found == sets.end() || number_components(set->header) == 0) return std::nullopt;
  return static_cast<std::size_t>(found - sets.begin());
}

}  // namespace
}  // namespace rlpc

rlpc_status rlpc_decoder_attributes(rlpc_decoder* decoder, uint32_t* num_sets) {
  return rlpc::guarded(decoder, [&] {
    if (num_sets == nullptr) return rlpc::bad(*decoder, "num_sets is null");
    *num_sets = 0;
    if (const auto ok = rlpc::decode_attributes(*decoder); ok != RLPC_OK) return ok;
    *num_sets = static_cast<std::uint32_t>(decoder->attributes->size());
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_attribute(rlpc_decoder* decoder, uint32_t set,
                                   rlpc_attribute* attribute, size_t struct_size) {
  return rlpc::guarded(decoder, [&] {
    if (attribute == nullptr || struct_size < sizeof(std::size_t)) {
      return rlpc::bad(*decoder, "attribute is null, or struct_size too small");
    }
    const rlpc::AttributeSet* const found = rlpc::set_at(*decoder, set);
    if (found == nullptr) return RLPC_BAD_ARGUMENT;
    rlpc::give_struct(rlpc::describe(*found), attribute, struct_size);
    return RLPC_OK;
  });
}

uint32_t rlpc_decoder_find_attribute(const rlpc_decoder* decoder, const char* name) {
  if (decoder == nullptr || name == nullptr || !decoder->attributes) return RLPC_ALL;
  const auto& sets = *decoder->attributes;
  const auto found = std::find_if(sets.begin(), sets.end(),
                                  [&](const auto& set) { return set.header.name == name; });
  return found == sets.end() ? RLPC_ALL : static_cast<std::uint32_t>(found - sets.begin());
}

rlpc_status rlpc_decoder_attribute_floats(rlpc_decoder* decoder, uint32_t set, float* values,
                                          size_t num_floats) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::AttributeSet* const found = rlpc::set_at(*decoder, set);
    if (found == nullptr) return RLPC_BAD_ARGUMENT;
    return rlpc::give(*decoder, rlpc::attribute_numbers(*found), values, num_floats);
  });
}

rlpc_status rlpc_decoder_attribute_integers(rlpc_decoder* decoder, uint32_t set,
                                            uint32_t* values, size_t num_integers) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::AttributeSet* const found = rlpc::set_at(*decoder, set);
    if (found == nullptr) return RLPC_BAD_ARGUMENT;
    if (found->header.kind == rlpc::ValueKind::kUnitVectors) {
      return rlpc::bad(*decoder, "unit vectors are not integers; ask for floats");
    }
    return rlpc::give(*decoder, found->values, values, num_integers);
  });
}

rlpc_status rlpc_decoder_attribute_of_corners(rlpc_decoder* decoder, uint32_t set,
                                              uint32_t* indices, size_t num_corners) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::AttributeSet* const found = rlpc::set_at(*decoder, set);
    if (found == nullptr) return RLPC_BAD_ARGUMENT;
    const auto triangles = decoder->decoder->triangles();
    if (!rlpc::check_buffer(*decoder, indices, num_corners, 3 * triangles.size())) {
      return RLPC_BAD_ARGUMENT;
    }
    for (std::size_t c = 0; c < num_corners; ++c) {
      switch (found->header.domain) {
        case rlpc::AttributeDomain::kVertex:
          indices[c] = triangles[c / 3][c % 3];
          break;
        case rlpc::AttributeDomain::kCorner:
          indices[c] = found->value_of_corner[c];
          break;
        case rlpc::AttributeDomain::kTriangle:
          indices[c] = static_cast<std::uint32_t>(c / 3);
          break;
      }
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_split(rlpc_decoder* decoder, uint32_t* num_drawn) {
  return rlpc::guarded(decoder, [&] {
    if (num_drawn == nullptr) return rlpc::bad(*decoder, "num_drawn is null");
    *num_drawn = 0;
    if (!decoder->drawn) {
      if (const auto ok = rlpc::decode_attributes(*decoder); ok != RLPC_OK) return ok;
      const auto triangles = decoder->decoder->triangles();
      decoder->drawn.emplace(rlpc::drawable_sets(*decoder->attributes, triangles), triangles,
                             decoder->decoder->num_vertices());
    }
    *num_drawn = decoder->drawn->vertices().num_vertices();
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_split_vertices(rlpc_decoder* decoder, uint32_t* vertices,
                                        size_t num_values) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::DrawnMesh* const drawn = rlpc::drawn_of(*decoder);
    if (drawn == nullptr) return RLPC_BAD_ARGUMENT;
    return rlpc::give(*decoder, drawn->vertices().stream_vertex, vertices, num_values);
  });
}

rlpc_status rlpc_decoder_split_indices(rlpc_decoder* decoder, void* indices, size_t num_bytes,
                                       uint32_t index_bytes) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::DrawnMesh* const drawn = rlpc::drawn_of(*decoder);
    if (drawn == nullptr) return RLPC_BAD_ARGUMENT;
    return rlpc::give_indices(*decoder, drawn->vertices().triangles,
                              drawn->vertices().num_vertices(),
                              {indices, num_bytes, index_bytes});
  });
}

rlpc_status rlpc_decoder_split_floats(rlpc_decoder* decoder, uint32_t set, float* values,
                                      size_t num_floats) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::DrawnMesh* const drawn = rlpc::drawn_of(*decoder);
    if (drawn == nullptr) return RLPC_BAD_ARGUMENT;
    const rlpc::AttributeSet* const found = rlpc::set_at(*decoder, set);
    if (found == nullptr) return RLPC_BAD_ARGUMENT;
    const auto place = rlpc::place_of(*drawn, found);
    if (!place) {
      return rlpc::bad(*decoder, "the set " + std::string(found->header.name) +
                                     " has no values of vertices or corners");
    }
    return rlpc::give(*decoder, drawn->numbers(*place), values, num_floats);
  });
}

rlpc_status rlpc_decoder_asset(rlpc_decoder* decoder, const void** bytes, size_t* num_bytes) {
  return rlpc::guarded(decoder, [&] {
    if (bytes == nullptr || num_bytes == nullptr) {
      return rlpc::bad(*decoder, "bytes or num_bytes is null");
    }
    *bytes = nullptr;
    *num_bytes = 0;
    if (!decoder->asset) {
      auto asset = decoder->decoder->asset();
      if (!asset) return rlpc::fail(*decoder, asset.error());
      decoder->asset = std::move(*asset);
    }
    if (decoder->asset->empty()) return RLPC_OK;
    *bytes = decoder->asset->data();
    *num_bytes = decoder->asset->size();
    return RLPC_OK;
  });
}
