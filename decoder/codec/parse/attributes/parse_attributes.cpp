#include "decoder/codec/parse/attributes/parse_attributes.h"

#include <array>
#include <utility>

#include "common/codec/attributes/attribute_contexts.h"
#include "common/codec/attributes/sectors.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/corners.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {
namespace {

// F.2.2 attribute_name( )
String parse_name(BitReader& r) {
  String name;
  const std::uint32_t size = r.u(8, "attribute_name_size_minus1") + 1;
  for (std::uint32_t i = 0; i < size && !r.error(); ++i) {
    name += static_cast<char>(r.u(8, "attribute_name_byte"));
  }
  return name;
}

// F.2.2 value_scale( )
void parse_scale(BitReader& r, AttributeHeader& header) {
  constexpr std::int64_t kMaxOrigin = 1 << 24;
  if (header.kind == ValueKind::kIntegers) {
    header.scale = static_cast<ValueScale>(r.u(2, "value_scale_idc", {0, 2}, "R-ATT-04"));
  }
  if (header.scale != ValueScale::kGrid) return;
  header.log2_step = r.se("value_log2_step", {-126, 127}, "R-ATT-04");
  for (std::uint32_t c = 0; c < header.num_components; ++c) {
    header.origin[c] = r.se("value_origin", {-kMaxOrigin, kMaxOrigin}, "R-ATT-04");
  }
}

// F.2.2 attribute_header( )
AttributeHeader parse_header(BitReader& r) {
  AttributeHeader header;
  header.name = parse_name(r);
  header.domain = static_cast<AttributeDomain>(r.u(2, "attribute_domain", {0, 2}, "R-ATT-03"));
  const bool is_triangle = header.domain == AttributeDomain::kTriangle;
  header.kind =
      static_cast<ValueKind>(r.u(2, "value_kind", {0, is_triangle ? 2 : 3}, "R-ATT-03"));
  const bool has_bits =
      header.kind == ValueKind::kIntegers || header.kind == ValueKind::kUnitVectors;
  header.num_components = header.kind == ValueKind::kSmoothing ? 0 : 2;
  if (header.kind == ValueKind::kIntegers || header.kind == ValueKind::kFloats) {
    header.num_components = r.u(2, "num_components_minus1") + 1;
  }
  if (has_bits) {
    const std::int64_t min_minus1 = header.kind == ValueKind::kUnitVectors ? 1 : 0;
    header.value_bits = r.u(4, "value_bits_minus1", {min_minus1, 15}, "R-ATT-04") + 1;
  }
  parse_scale(r, header);
  if (!is_triangle && header.kind != ValueKind::kSmoothing) {
    const bool can_use_positions =
        header.kind == ValueKind::kUnitVectors ||
        (header.kind == ValueKind::kIntegers && header.num_components == 2);
    header.prediction = static_cast<AttributePrediction>(
        r.u(2, "prediction_idc", {0, can_use_positions ? 2 : 1}, "R-ATT-05"));
  }
  if (header.has_faces()) {
    header.weight =
        static_cast<SmoothingWeight>(r.u(2, "smoothing_weight_idc", {0, 2}, "R-ATT-06"));
    header.diagonals = static_cast<Diagonals>(r.u(2, "diagonal_idc", {0, 2}, "R-ATT-06"));
  }
  return header;
}

class SetParser {
 public:
  SetParser(SectionReader& section, std::uint32_t num_vertices,
            std::span<const Triangle> triangles)
      : section_(section),
        num_vertices_(num_vertices),
        triangles_(triangles),
        edge_mates_(find_edge_mates(num_vertices, triangles)) {
    earlier_.changes.assign(3 * triangles.size(), false);
  }

  // F.2.3 attribute_set( )
  void parse(CodedAttributeSet& set);

 private:
  void parse_seams(CodedAttributeSet& set);
  void parse_diagonals(CodedAttributeSet& set);
  void parse_sector_values(const Sectors& sectors, CodedAttributeSet& set);
  void parse_triangle_values(CodedAttributeSet& set);
  std::uint32_t parse_triangle_component(const AttributeHeader& header, std::uint32_t c,
                                         std::uint32_t prediction, TriangleContexts& contexts);
  std::uint32_t parse_float_residual(std::array<BitModel, 64>& models);

  SectionReader& section_;
  std::uint32_t num_vertices_;
  std::span<const Triangle> triangles_;
  Vector<std::uint32_t> edge_mates_;
  EarlierSets earlier_;
};

void SetParser::parse(CodedAttributeSet& set) {
  if (set.header.domain == AttributeDomain::kTriangle) {
    parse_triangle_values(set);
    return;
  }
  const bool is_corner = set.header.domain == AttributeDomain::kCorner;
  if (is_corner) parse_seams(set);
  if (section_.failed()) return;
  if (set.header.diagonals != Diagonals::kNone) parse_diagonals(set);
  if (set.header.kind != ValueKind::kSmoothing && !section_.failed()) {
    const Sectors sectors = is_corner ? sectors_of_corners(edge_mates_, set.seams)
                                      : sectors_of_vertices(num_vertices_, triangles_);
    parse_sector_values(sectors, set);
  }
  if (is_corner) earlier_.seams = set.seams;
}

void SetParser::parse_seams(CodedAttributeSet& set) {
  set.seams.assign(edge_mates_.size(), false);
  SeamContexts contexts(num_vertices_, triangles_, earlier_);
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    const std::uint32_t mate = edge_mates_[c];
    if (mate < c && section_.bin(contexts.model(c), "seam_flag")) {
      set.seams[c] = set.seams[mate] = true;
      contexts.add_seam(c, mate);
    }
    if (c % 3 == 2) section_.check_overrun("seam_flag");
    if (section_.failed()) return;
  }
}

void SetParser::parse_diagonals(CodedAttributeSet& set) {
  set.diagonal_flags.assign(edge_mates_.size(), false);
  DiagonalContexts contexts(triangles_.size());
  for (std::uint32_t c = 0; c < edge_mates_.size(); ++c) {
    const std::uint32_t mate = edge_mates_[c];
    const bool is_seam = !set.seams.empty() && set.seams[c];
    if (mate < c && !is_seam && section_.bin(contexts.model(c, mate), "diagonal_flag")) {
      set.diagonal_flags[c] = set.diagonal_flags[mate] = true;
      contexts.add_flag(c, mate);
    }
    if (c % 3 == 2) section_.check_overrun("diagonal_flag");
    if (section_.failed()) return;
  }
}

// F.2.3 float_residual( ), modulo 2^32
std::uint32_t SetParser::parse_float_residual(std::array<BitModel, 64>& models) {
  const std::uint32_t size = section_.tree(models, "float_size");
  if (size > 32) section_.fail("R-ATT-07", "float_size");
  if (size == 0 || size > 32) return 0;
  const bool is_negative = section_.bypass(1, "float_sign") != 0;
  const std::uint32_t low = section_.bypass(static_cast<int>(size) - 1, "float_low_bits");
  const std::uint32_t magnitude = (std::uint32_t{1} << (size - 1)) + low;
  return is_negative ? 0 - magnitude : magnitude;
}

void SetParser::parse_sector_values(const Sectors& sectors, CodedAttributeSet& set) {
  const SectorOrder order(sectors);
  const std::uint32_t n = set.header.num_components;
  ValueContexts contexts(order, n);
  set.residuals.assign(std::size_t{n} * sectors.count(), 0);
  for (const std::uint32_t x : order.order) {
    for (std::uint32_t c = 0; c < n && !section_.failed(); ++c) {
      std::uint32_t& residual = set.residuals[std::size_t{x} * n + c];
      if (set.header.kind == ValueKind::kFloats) {
        residual = parse_float_residual(contexts.float_sizes(x));
        continue;
      }
      const std::int32_t value =
          section_.residual(contexts.models(x), contexts.expected(c, x), "value_residual");
      contexts.update(c, x, value);
      residual = static_cast<std::uint32_t>(value);
    }
    section_.check_overrun("value_residual");
    if (section_.failed()) return;
  }
}

// F.2.3 triangle_values( )
void SetParser::parse_triangle_values(CodedAttributeSet& set) {
  const std::uint32_t n = set.header.num_components;
  TriangleContexts contexts(edge_mates_, n);
  set.residuals.assign(n * triangles_.size(), 0);
  const auto values = std::span(set.residuals);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto candidates = contexts.find_candidates(t, set.residuals);
    std::size_t i = 0;
    while (i < candidates.size() && !section_.bin(contexts.same_rig(i), "same_value_flag")) {
      ++i;
    }
    for (std::uint32_t c = 0; c < n && !section_.failed(); ++c) {
      std::uint32_t& value = values[std::size_t{t} * n + c];
      if (i < candidates.size()) {
        value = values[std::size_t{candidates[i]} * n + c];
      } else {
        const std::uint32_t prediction =
            candidates.empty() ? 0 : values[std::size_t{candidates[0]} * n + c];
        value = parse_triangle_component(set.header, c, prediction, contexts);
      }
    }
    section_.check_overrun("same_value_flag");
    if (section_.failed()) return;
  }
  earlier_.add_triangle_values(edge_mates_, set.residuals, n);
}

std::uint32_t SetParser::parse_triangle_component(const AttributeHeader& header,
                                                  std::uint32_t c, std::uint32_t prediction,
                                                  TriangleContexts& contexts) {
  if (header.kind == ValueKind::kFloats) {
    return prediction + parse_float_residual(contexts.float_sizes());
  }
  const std::int32_t residual =
      section_.residual(contexts.models(), contexts.expected(c), "triangle_residual");
  contexts.update(c, residual);
  return static_cast<std::uint32_t>(
      clip3(0, header.max_value(), std::int64_t{prediction} + residual));
}

// Returns an upper bound of the memory of one set while it is parsed and reconstructed.
std::uint64_t memory_of_set(const AttributeHeader& header, std::uint32_t num_vertices,
                            std::uint64_t num_triangles) {
  constexpr std::uint64_t kPerCorner = 40;  // sectors, their order, predictors and rings
  constexpr std::uint64_t kPerValue = 64;   // per sector: order, prediction
  const std::uint64_t corners = 3 * num_triangles;
  const std::uint64_t components = header.num_components;
  switch (header.domain) {
    case AttributeDomain::kTriangle:
      return 4 * components * num_triangles;
    case AttributeDomain::kVertex:
      return kPerCorner * corners + (kPerValue + 8 * components) * num_vertices;
    case AttributeDomain::kCorner:
      break;
  }
  return (kPerCorner + kPerValue + 8 * components) * corners;
}

CodedAttributes parse_headers(BitReader& r) {
  CodedAttributes coded;
  const std::uint32_t count =
      r.ue("num_attribute_sets_minus1", {0, std::int64_t{kMaxAttributeSets} - 1}, "R-ATT-02") +
      1;
  for (std::uint32_t s = 0; s < count && !r.error(); ++s) {
    coded.sets.push_back({parse_header(r), {}, {}, {}});
  }
  return coded;
}

}  // namespace

bool attributes_use_positions(BitReader& r) {
  const CodedAttributes coded = parse_headers(r);
  return !r.error() && coded.uses_positions();
}

Result<CodedAttributes> parse_attributes(BitReader& r, std::uint32_t num_vertices,
                                         std::span<const Triangle> triangles,
                                         const MemoryLimit& memory) {
  CodedAttributes coded = parse_headers(r);
  if (coded.uses_positions()) coded.first_frame_crc = r.u(32, "first_frame_crc");
  r.byte_alignment();
  if (r.error()) return *r.error();
  SectionReader section(r, "attributes");
  std::uint64_t bytes = 32 * (num_vertices + triangles.size());
  for (const CodedAttributeSet& set : coded.sets) {
    bytes += memory_of_set(set.header, num_vertices, triangles.size());
  }
  section.check_memory(memory, bytes, "num_attribute_sets_minus1");
  if (r.error()) return *r.error();
  SetParser parser(section, num_vertices, triangles);
  for (CodedAttributeSet& set : coded.sets) {
    parser.parse(set);
    if (r.error()) return *r.error();
  }
  section.finish();
  if (r.error()) return *r.error();
  return coded;
}

}  // namespace rlpc
