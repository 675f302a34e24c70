#include "encoder/codec/write/write_attributes.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "common/codec/attributes/attribute_contexts.h"
#include "common/codec/attributes/sectors.h"
#include "common/codec/bits/bit_writer.h"
#include "common/codec/mesh/corners.h"
#include "encoder/codec/write/section_writer.h"

namespace rlpc {
namespace {

// F.2.2 attribute_header( )
void write_header(BitWriter& w, const AttributeHeader& header) {
  assert(!header.name.empty() && header.name.size() <= kMaxAttributeNameBytes);
  w.u(8, static_cast<std::uint32_t>(header.name.size() - 1));
  for (const char byte : header.name) w.u(8, static_cast<unsigned char>(byte));
  w.u(2, static_cast<std::uint32_t>(header.domain));
  w.u(2, static_cast<std::uint32_t>(header.kind));
  if (header.kind == ValueKind::kIntegers || header.kind == ValueKind::kFloats) {
    w.u(2, header.num_components - 1);
  }
  if (header.kind == ValueKind::kIntegers || header.kind == ValueKind::kUnitVectors) {
    w.u(4, header.value_bits - 1);
  }
  if (header.kind == ValueKind::kIntegers) {
    w.u(2, static_cast<std::uint32_t>(header.scale));
    if (header.scale == ValueScale::kGrid) {
      w.se(header.log2_step);
      for (std::uint32_t c = 0; c < header.num_components; ++c) w.se(header.origin[c]);
    }
  }
  if (header.domain != AttributeDomain::kTriangle && header.kind != ValueKind::kSmoothing) {
    w.u(2, static_cast<std::uint32_t>(header.prediction));
  }
  if (header.has_faces()) {
    w.u(2, static_cast<std::uint32_t>(header.weight));
    w.u(2, static_cast<std::uint32_t>(header.diagonals));
  }
}

class SetWriter {
 public:
  SetWriter(SectionWriter& section, std::uint32_t num_vertices,
            std::span<const Triangle> triangles)
      : section_(section),
        num_vertices_(num_vertices),
        triangles_(triangles),
        edge_mates_(find_edge_mates(num_vertices, triangles)) {
    earlier_.changes.assign(3 * triangles.size(), false);
  }

  // F.2.3 attribute_set( )
  void write(const CodedAttributeSet& set);

 private:
  void write_seams(const CodedAttributeSet& set);
  void write_diagonals(const CodedAttributeSet& set);
  void write_sector_values(const Sectors& sectors, const CodedAttributeSet& set);
  void write_triangle_values(const CodedAttributeSet& set);
  void write_float_residual(std::array<BitModel, 64>& models, std::uint32_t residual);

  SectionWriter& section_;
  std::uint32_t num_vertices_;
  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> edge_mates_;
  EarlierSets earlier_;
};

void SetWriter::write(const CodedAttributeSet& set) {
  if (set.header.domain == AttributeDomain::kTriangle) {
    write_triangle_values(set);
    return;
  }
  const bool is_corner = set.header.domain == AttributeDomain::kCorner;
  if (is_corner) write_seams(set);
  if (set.header.diagonals != Diagonals::kNone) write_diagonals(set);
  if (set.header.kind != ValueKind::kSmoothing) {
    write_sector_values(is_corner ? sectors_of_corners(edge_mates_, set.seams)
                                  : sectors_of_vertices(num_vertices_, triangles_),
                        set);
  }
  if (is_corner) earlier_.seams = set.seams;
}

void SetWriter::write_seams(const CodedAttributeSet& set) {
  SeamContexts contexts(num_vertices_, triangles_, earlier_);
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    const std::uint32_t mate = edge_mates_[c];
    if (mate >= c) continue;
    section_.bin(contexts.model(c), set.seams[c]);
    if (set.seams[c]) contexts.add_seam(c, mate);
  }
}

void SetWriter::write_diagonals(const CodedAttributeSet& set) {
  DiagonalContexts contexts(triangles_.size());
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    const std::uint32_t mate = edge_mates_[c];
    if (mate >= c || (!set.seams.empty() && set.seams[c])) continue;
    section_.bin(contexts.model(c, mate), set.diagonal_flags[c]);
    if (set.diagonal_flags[c]) contexts.add_flag(c, mate);
  }
}

// F.2.3 float_residual( )
void SetWriter::write_float_residual(std::array<BitModel, 64>& models, std::uint32_t residual) {
  // Both signs would do; the shorter one is written.
  const bool is_negative = residual > 0x80000000U;
  const std::uint32_t magnitude = is_negative ? 0 - residual : residual;
  const auto size = static_cast<std::uint32_t>(std::bit_width(magnitude));
  section_.tree(models, size);
  if (size == 0) return;
  section_.bypass(1, is_negative ? 1U : 0U);
  const int low_bits = static_cast<int>(size) - 1;
  section_.bypass(low_bits, magnitude - (std::uint32_t{1} << low_bits));
}

void SetWriter::write_sector_values(const Sectors& sectors, const CodedAttributeSet& set) {
  const SectorOrder order(sectors);
  const std::uint32_t n = set.header.num_components;
  ValueContexts contexts(order, n);
  for (const std::uint32_t x : order.order) {
    for (std::uint32_t c = 0; c < n; ++c) {
      const std::uint32_t residual = set.residuals[std::size_t{x} * n + c];
      if (set.header.kind == ValueKind::kFloats) {
        write_float_residual(contexts.float_sizes(x), residual);
      } else {
        const auto value = static_cast<std::int32_t>(residual);
        section_.residual(contexts.models(x), contexts.expected(c, x), value);
        contexts.update(c, x, value);
      }
    }
  }
}

// F.2.3 triangle_values( )
void SetWriter::write_triangle_values(const CodedAttributeSet& set) {
  const std::uint32_t n = set.header.num_components;
  TriangleContexts contexts(edge_mates_, n);
  const auto value_of = [&](std::uint32_t t) {
    return std::span(set.residuals).subspan(std::size_t{t} * n, n);
  };
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto candidates = contexts.find_candidates(t, set.residuals);
    bool is_found = false;
    for (std::size_t i = 0; i < candidates.size() && !is_found; ++i) {
      is_found = std::ranges::equal(value_of(candidates[i]), value_of(t));
      section_.bin(contexts.same_rig(i), is_found);
    }
    for (std::uint32_t c = 0; c < n && !is_found; ++c) {
      const std::uint32_t prediction = candidates.empty() ? 0 : value_of(candidates[0])[c];
      const std::uint32_t residual = value_of(t)[c] - prediction;
      if (set.header.kind == ValueKind::kFloats) {
        write_float_residual(contexts.float_sizes(), residual);
      } else {
        const auto value = static_cast<std::int32_t>(residual);
        section_.residual(contexts.models(), contexts.expected(c), value);
        contexts.update(c, value);
      }
    }
  }
  earlier_.add_triangle_values(edge_mates_, set.residuals, n);
}

}  // namespace

std::vector<std::uint8_t> write_attributes(const CodedAttributes& coded,
                                           std::uint32_t num_vertices,
                                           std::span<const Triangle> triangles) {
  BitWriter w;
  w.ue(static_cast<std::uint32_t>(coded.sets.size() - 1));
  for (const CodedAttributeSet& set : coded.sets) write_header(w, set.header);
  if (coded.uses_positions()) w.u(32, coded.first_frame_crc);
  w.byte_alignment();
  SectionWriter section;
  SetWriter writer(section, num_vertices, triangles);
  for (const CodedAttributeSet& set : coded.sets) writer.write(set);
  w.append(section.finish());
  return w.take();
}

}  // namespace rlpc
