// Fuzzes the parser and the reconstruction of cluster GOFs, without CRCs. Input: first frame, 4
// bytes; sizes of the payloads of sequence header and connectivity, 2 bytes each; both
// payloads; the payload of the GOF.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "common/codec/kinds/cluster/recon/cluster_recon.h"
#include "common/testing/fuzz_input.h"
#include "decoder/codec/kinds/cluster/parse/parse_cluster_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/codec/parse/sequence/parse_connectivity.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"
#include "decoder/fuzz/recon_fuzz.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size);

namespace {

constexpr std::size_t kPrefixBytes = 8;
// A GOF of this size takes well under a second, even with sanitizers.
constexpr std::uint32_t kMaxVertices = 1000;
constexpr std::uint32_t kMaxFrames = 100;
constexpr std::uint64_t kMaxMemoryBytes = 8 << 20;

void decode_gof(const rlpc::SequenceHeader& header, const rlpc::Topology& topology,
                std::uint32_t first_frame, std::span<const std::uint8_t> payload) {
  rlpc::BitReader r(payload);
  const rlpc::GofHeader gof_header = rlpc::parse_gof_header(r, header, first_frame);
  const auto gof = rlpc::parse_clusters(r, header, topology, gof_header, {kMaxMemoryBytes, 0});
  if (!gof) return;
  const rlpc::ClusterRecon recon(header, topology, *gof);
  rlpc::fuzz_check_frames(recon, header, first_frame);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::FuzzInput input(data, size);
  const std::uint32_t first_frame = input.number(4);
  const std::uint32_t header_bytes = input.number(2);
  const std::uint32_t connectivity_bytes = input.number(2);
  rlpc::BitReader header_bits(input.take(header_bytes));
  const auto header = rlpc::parse_sequence_header(header_bits, rlpc::kProfileBaseline);
  if (!header || header->num_vertices > kMaxVertices || header->num_frames > kMaxFrames ||
      first_frame >= header->num_frames) {
    return 0;
  }
  rlpc::BitReader connectivity_bits(input.take(connectivity_bytes));
  const auto triangles =
      rlpc::parse_connectivity(connectivity_bits, header->num_vertices, header->num_triangles);
  if (!triangles) return 0;
  decode_gof(*header, rlpc::make_topology(header->num_vertices, *triangles), first_frame,
             input.rest());
  return 0;
}

// Mutates the payload of the GOF, and occasionally the whole input: most changes before the GOF
// are rejected by the parsers of the other units, which have their own targets.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  std::minstd_rand random(seed);
  rlpc::FuzzInput input(data, size);
  input.take(kPrefixBytes - 4);
  const std::uint32_t header_bytes = input.number(2);
  const std::size_t before_gof = kPrefixBytes + header_bytes + input.number(2);
  if (before_gof >= std::min(size, max_size) || random() % 16 == 0) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  return before_gof +
         LLVMFuzzerMutate(data + before_gof, size - before_gof, max_size - before_gof);
}
