// Fuzzes the parser of attribute units and their reconstruction. Input: columns, rows and
// copies of a grid, 3 bytes; the payload.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/attributes/recon/attribute_recon.h"
#include "common/testing/fuzz_input.h"
#include "decoder/codec/parse/attributes/parse_attributes.h"

namespace {

using rlpc::fuzz_check;
using rlpc::Triangle;

// Makes copies of a grid. The second copy shares the vertices of the first, so that edges have
// more than two triangles; the third has every triangle with a repeated vertex.
std::vector<Triangle> mesh_of(std::uint32_t columns, std::uint32_t rows, std::uint32_t copies) {
  std::vector<Triangle> triangles;
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    for (std::uint32_t y = 0; y < rows; ++y) {
      for (std::uint32_t x = 0; x < columns; ++x) {
        const std::uint32_t a = y * (columns + 1) + x;
        const std::uint32_t c = a + columns + 1;
        triangles.push_back({a, copy == 2 ? a : a + 1, c});
        triangles.push_back({a + 1, c + 1, c});
      }
    }
  }
  return triangles;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::FuzzInput input(data, size);
  const std::uint32_t columns = 1 + input.number(1) % 12;
  const std::uint32_t rows = 1 + input.number(1) % 12;
  const std::vector<Triangle> triangles = mesh_of(columns, rows, 1 + input.number(1) % 3);
  const std::uint32_t num_vertices = (columns + 1) * (rows + 1);
  constexpr std::uint64_t kMemory = std::uint64_t{1} << 24;
  rlpc::BitReader r(input.rest());
  const auto coded = rlpc::parse_attributes(r, num_vertices, triangles, {kMemory, 0});
  if (!coded) return 0;
  std::vector<std::int32_t> positions(3 * std::size_t{num_vertices});
  std::uint32_t state = static_cast<std::uint32_t>(size);
  for (std::int32_t& x : positions) {
    state = state * 1664525 + 1013904223;
    x = static_cast<std::int32_t>(state >> 8) >> (state % 16);
  }
  const auto sets = rlpc::recon_attributes(*coded, num_vertices, triangles, positions);
  fuzz_check(sets.size() == coded->sets.size());
  for (const rlpc::AttributeSet& set : sets) {
    for (const std::uint32_t value : set.values) fuzz_check(value <= set.header.max_value());
    for (const std::uint32_t x : set.value_of_corner) {
      fuzz_check(set.header.num_components == 0 || x < set.num_values());
    }
    for (const std::uint32_t t : set.face_of_triangle) fuzz_check(t < triangles.size());
  }
  return 0;
}
