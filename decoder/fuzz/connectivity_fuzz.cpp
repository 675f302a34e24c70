// Fuzzes the connectivity parser. Input: num_vertices - 1 and num_triangles, 2 bytes each;
// the payload.

#include <cstddef>
#include <cstdint>

#include "common/codec/mesh/topology.h"
#include "common/testing/fuzz_input.h"
#include "decoder/codec/parse/sequence/parse_connectivity.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::FuzzInput input(data, size);
  const std::uint32_t num_vertices = input.number(2) + 1;
  const std::uint32_t num_triangles = input.number(2);
  rlpc::BitReader r(input.rest());
  const auto triangles = rlpc::parse_connectivity(r, num_vertices, num_triangles);
  if (!triangles) return 0;
  rlpc::fuzz_check(triangles->size() == num_triangles);
  for (const rlpc::Triangle& t : *triangles) {
    for (const std::uint32_t v : t) rlpc::fuzz_check(v < num_vertices);
  }
  const rlpc::Topology topology = rlpc::make_topology(num_vertices, *triangles);
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    for (const std::uint32_t u : topology.earlier_neighbours[v]) rlpc::fuzz_check(u < v);
    for (const rlpc::Parallelogram& p : topology.parallelograms[v]) {
      rlpc::fuzz_check(p.a < v && p.b < v && p.c < v);
    }
  }
  return 0;
}
