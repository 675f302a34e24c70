// Tests that attributes survive writer and parser, and encoder and decoder (Annex F).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "common/codec/attributes/recon/attribute_recon.h"
#include "common/codec/attributes/sectors.h"
#include "common/codec/bits/bit_reader.h"
#include "common/codec/bits/crc32.h"
#include "common/codec/mesh/corners.h"
#include "common/testing/triangle_mesh.h"
#include "decoder/codec/parse/attributes/parse_attributes.h"
#include "encoder/codec/attributes/corner_map.h"
#include "encoder/codec/attributes/encode_attributes.h"
#include "encoder/codec/attributes/quantise_attribute.h"
#include "encoder/codec/write/write_attributes.h"
#include "encoder/codec/write/write_connectivity.h"

namespace rlpc {
namespace {

constexpr MemoryLimit kNoLimit{std::uint64_t{1} << 40, 0};

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  bool chance(std::uint32_t percent) { return below(100) < percent; }
  // Returns a residual of any magnitude below 2^bits.
  std::int32_t residual(std::uint32_t bits) {
    const auto magnitude =
        static_cast<std::int32_t>(engine_() >> (32 - below(bits + 1) - 1)) >> 1;
    return chance(50) ? -magnitude : magnitude;
  }
  std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }

 private:
  std::mt19937 engine_;
};

// Returns a grid, perhaps closed to a torus, with some triangles turned, left out or without
// area, and some of random vertices.
TriangleMesh random_mesh(Draw& draw) {
  const std::uint32_t columns = 2 + draw.below(6);
  const std::uint32_t rows = 1 + draw.below(6);
  const std::uint32_t wrap = draw.below(2);
  TriangleMesh mesh;
  const std::uint32_t across = columns + 1 - wrap;
  const auto vertex = [&](std::uint32_t x, std::uint32_t y) { return y * across + x % across; };
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = vertex(x, y);
      const std::uint32_t b = vertex(x + 1, y);
      const std::uint32_t c = vertex(x, y + 1);
      const std::uint32_t d = vertex(x + 1, y + 1);
      mesh.triangles.push_back({a, b, c});
      if (!draw.chance(5)) mesh.triangles.push_back({b, d, c});
    }
  }
  mesh.num_vertices = across * (rows + 1) + draw.below(3);
  for (std::uint32_t i = draw.below(4); i > 0; --i) {
    const auto any = [&] { return draw.below(mesh.num_vertices); };
    mesh.triangles.push_back({any(), any(), any()});
  }
  return mesh;
}

AttributeHeader random_header(Draw& draw, std::uint32_t s) {
  AttributeHeader h;
  h.name = std::string(1 + draw.below(5), 'a') + std::to_string(s);
  h.domain = static_cast<AttributeDomain>(draw.below(3));
  const bool is_triangle = h.domain == AttributeDomain::kTriangle;
  h.kind = static_cast<ValueKind>(draw.below(is_triangle ? 3 : 4));
  h.num_components = h.kind == ValueKind::kSmoothing     ? 0
                     : h.kind == ValueKind::kUnitVectors ? 2
                                                         : 1 + draw.below(4);
  if (h.kind == ValueKind::kIntegers) h.value_bits = 1 + draw.below(16);
  if (h.kind == ValueKind::kUnitVectors) h.value_bits = 2 + draw.below(15);
  if (h.kind == ValueKind::kIntegers) h.scale = static_cast<ValueScale>(draw.below(3));
  if (h.scale == ValueScale::kGrid) {
    h.log2_step = static_cast<std::int32_t>(draw.below(254)) - 126;
    for (std::uint32_t c = 0; c < h.num_components; ++c) h.origin[c] = draw.residual(24);
  }
  if (is_triangle) return h;
  const bool can_use_positions = h.kind == ValueKind::kUnitVectors ||
                                 (h.kind == ValueKind::kIntegers && h.num_components == 2);
  if (h.kind != ValueKind::kSmoothing) {
    h.prediction = static_cast<AttributePrediction>(draw.below(can_use_positions ? 3 : 2));
  }
  if (h.has_faces()) {
    h.weight = static_cast<SmoothingWeight>(draw.below(3));
    h.diagonals = static_cast<Diagonals>(draw.below(3));
  }
  return h;
}

CodedAttributeSet random_set(Draw& draw, std::uint32_t s, const TriangleMesh& mesh,
                             const std::vector<std::uint32_t>& mates) {
  CodedAttributeSet set;
  set.header = random_header(draw, s);
  const bool is_corner = set.header.domain == AttributeDomain::kCorner;
  const std::uint32_t percent = std::array{0U, 15U, 60U, 100U}[draw.below(4)];
  const auto flags = [&](bool skip_seams) {
    std::vector<bool> result(mates.size(), false);
    for (std::uint32_t c = 0; c < mates.size(); ++c) {
      const bool is_seam = skip_seams && !set.seams.empty() && set.seams[c];
      if (mates[c] < c && !is_seam && draw.chance(percent)) result[c] = result[mates[c]] = true;
    }
    return result;
  };
  if (is_corner) set.seams = flags(false);
  if (set.header.diagonals != Diagonals::kNone) set.diagonal_flags = flags(true);
  const bool is_triangle = set.header.domain == AttributeDomain::kTriangle;
  const std::size_t count = is_triangle ? mesh.triangles.size()
                            : is_corner ? sectors_of_corners(mates, set.seams).count()
                                        : std::size_t{mesh.num_vertices};
  const bool is_float = set.header.kind == ValueKind::kFloats;
  for (std::size_t i = 0; i < count * set.header.num_components; ++i) {
    if (is_triangle) {
      const auto max = static_cast<std::uint32_t>(set.header.max_value());
      set.residuals.push_back((draw.chance(40) ? draw.below(3) : draw.word()) & max);
    } else {
      set.residuals.push_back(is_float ? draw.word()
                                       : static_cast<std::uint32_t>(draw.residual(28)));
    }
  }
  return set;
}

TEST(AttributesRoundtrip, ParserReadsWhatTheWriterWrites) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const TriangleMesh mesh = random_mesh(draw);
    const auto mates = find_edge_mates(mesh.num_vertices, mesh.triangles);
    CodedAttributes coded;
    for (std::uint32_t s = 1 + draw.below(5); s > 0; --s) {
      coded.sets.push_back(random_set(draw, s, mesh, mates));
    }
    if (coded.uses_positions()) coded.first_frame_crc = draw.word();
    const auto payload = write_attributes(coded, mesh.num_vertices, mesh.triangles);
    BitReader r(payload);
    const auto parsed = parse_attributes(r, mesh.num_vertices, mesh.triangles, kNoLimit);
    ASSERT_TRUE(parsed) << "seed " << seed << ": " << parsed.error().rule;
    ASSERT_EQ(parsed->first_frame_crc, coded.first_frame_crc) << "seed " << seed;
    ASSERT_EQ(parsed->sets.size(), coded.sets.size()) << "seed " << seed;
    for (std::size_t s = 0; s < coded.sets.size(); ++s) {
      EXPECT_EQ(parsed->sets[s].header, coded.sets[s].header) << "seed " << seed;
      EXPECT_EQ(parsed->sets[s].seams, coded.sets[s].seams) << "seed " << seed;
      EXPECT_EQ(parsed->sets[s].diagonal_flags, coded.sets[s].diagonal_flags)
          << "seed " << seed;
      EXPECT_EQ(parsed->sets[s].residuals, coded.sets[s].residuals) << "seed " << seed;
    }
  }
}

TEST(AttributesRoundtrip, AnyResidualsGiveValuesWithinTheirBits) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    const TriangleMesh mesh = random_mesh(draw);
    const auto mates = find_edge_mates(mesh.num_vertices, mesh.triangles);
    CodedAttributes coded;
    coded.sets.push_back(random_set(draw, 0, mesh, mates));
    std::vector<std::int32_t> positions(3 * std::size_t{mesh.num_vertices});
    const std::uint32_t bits = draw.chance(30) ? 0 : draw.below(24);
    for (std::int32_t& x : positions) x = draw.residual(bits);
    for (const AttributeSet& set :
         recon_attributes(coded, mesh.num_vertices, mesh.triangles, positions)) {
      for (const std::uint32_t value : set.values) {
        ASSERT_LE(value, set.header.max_value()) << "seed " << seed;
      }
    }
  }
}

// Values of a source, of some kind and domain; few different ones, so that sectors form.
SourceAttribute random_source(Draw& draw, SourceAttribute::Kind kind, AttributeDomain domain,
                              const TriangleMesh& mesh) {
  SourceAttribute source;
  source.name = kind == SourceAttribute::Kind::kNormals ? "normal" : "numbers";
  source.domain = domain;
  source.kind = kind;
  source.num_components = kind == SourceAttribute::Kind::kNormals ? 3 : 1 + draw.below(4);
  std::size_t count = domain == AttributeDomain::kVertex     ? mesh.num_vertices
                      : domain == AttributeDomain::kTriangle ? mesh.triangles.size()
                                                             : 1 + draw.below(12);
  for (; count > 0; --count) {
    std::array<float, 4> value{};
    float length = 0.0F;
    for (std::uint32_t c = 0; c < source.num_components; ++c) {
      value[c] = kind == SourceAttribute::Kind::kIntegers
                     ? static_cast<float>(draw.below(200))
                     : static_cast<float>(draw.residual(20)) / 1024.0F + 0.5F;
      length += value[c] * value[c];
    }
    const float scale =
        kind == SourceAttribute::Kind::kNormals ? 1.0F / std::sqrt(length) : 1.0F;
    for (std::uint32_t c = 0; c < source.num_components; ++c) {
      source.values.push_back(value[c] * scale);
    }
  }
  if (domain == AttributeDomain::kCorner) {
    const auto values = static_cast<std::uint32_t>(source.num_values());
    for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
      source.value_of_corner.push_back(draw.below(values));
    }
  }
  return source;
}

struct DecodedAttribute {
  TriangleMesh mesh;
  ConnectivityCode connectivity;
  std::vector<std::uint32_t> corner_map;
  AttributeSet decoded;
  std::vector<std::int32_t> positions{};  // decoded order

  // Whether the triangle of a decoded corner has an area. Normals of corners around which there
  // is no surface in the first frame are not stored.
  bool has_area(std::uint32_t corner) const {
    const Triangle& t = connectivity.triangles[corner / 3];
    std::array<std::array<double, 3>, 2> edge{};
    for (std::size_t e = 0; e < 2; ++e) {
      for (std::size_t c = 0; c < 3; ++c) {
        edge[e][c] = 1.0 * positions[3 * std::size_t{t[e + 1]} + c] -
                     positions[3 * std::size_t{t[0]} + c];
      }
    }
    const auto& [a, b] = edge;
    return a[1] * b[2] != a[2] * b[1] || a[2] * b[0] != a[0] * b[2] ||
           a[0] * b[1] != a[1] * b[0];
  }
};

DecodedAttribute decoded_attribute(Draw& draw, const TriangleMesh& mesh,
                                   const SourceAttributes& source,
                                   const AttributeSettings& settings) {
  DecodedAttribute result{mesh, write_connectivity(mesh.num_vertices, mesh.triangles), {}, {}};
  result.corner_map = map_corners(result.connectivity, mesh.triangles);
  std::vector<std::int32_t> positions(3 * std::size_t{mesh.num_vertices});
  for (std::int32_t& x : positions) x = draw.residual(12);
  const EncodedAttributes encoded =
      encode_attributes({source, result.connectivity, result.corner_map, positions}, settings);
  BitReader r(encoded.payload);
  const auto coded =
      parse_attributes(r, mesh.num_vertices, result.connectivity.triangles, kNoLimit);
  EXPECT_TRUE(coded);
  if (!coded) return result;
  if (coded->uses_positions()) {
    EXPECT_EQ(coded->first_frame_crc, crc32_of_positions(positions));
  }
  result.decoded =
      recon_attributes(*coded, mesh.num_vertices, result.connectivity.triangles, positions)
          .at(0);
  result.positions = std::move(positions);
  return result;
}

// Returns the indices of the values of a decoded corner in the source and in the decoded set,
// which has values of vertices if those of their corners are the same.
std::array<std::size_t, 2> values_of(const DecodedAttribute& coded,
                                     const SourceAttribute& source, std::uint32_t c) {
  const std::uint32_t input = coded.corner_map[c];
  const std::size_t from =
      source.domain == AttributeDomain::kVertex     ? coded.mesh.triangles[input / 3][input % 3]
      : source.domain == AttributeDomain::kTriangle ? input / 3
                                                    : source.value_of_corner[input];
  switch (coded.decoded.header.domain) {
    case AttributeDomain::kVertex:
      return {from, vertex_of_corner(coded.connectivity.triangles, c)};
    case AttributeDomain::kTriangle:
      return {from, c / 3};
    case AttributeDomain::kCorner:
      break;
  }
  return {from, coded.decoded.value_of_corner[c]};
}

double number_of(const AttributeSet& set, std::uint32_t value, std::uint32_t c) {
  const AttributeHeader& h = set.header;
  if (h.kind == ValueKind::kFloats) return std::bit_cast<float>(value);
  if (h.scale != ValueScale::kGrid) return value;
  return std::ldexp(static_cast<double>(value) + h.origin[c], h.log2_step);
}

constexpr std::array kDomains{AttributeDomain::kVertex, AttributeDomain::kCorner,
                              AttributeDomain::kTriangle};

TEST(AttributesRoundtrip, ExactNumbersAndIntegersComeBack) {
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    Draw draw(seed);
    const TriangleMesh mesh = random_mesh(draw);
    const auto kind =
        seed % 2 == 0 ? SourceAttribute::Kind::kNumbers : SourceAttribute::Kind::kIntegers;
    SourceAttributes source;
    source.sets.push_back(random_source(draw, kind, kDomains[seed / 2 % 3], mesh));
    AttributeSettings settings;
    settings.exact = kind == SourceAttribute::Kind::kNumbers;
    const DecodedAttribute coded = decoded_attribute(draw, mesh, source, settings);
    const SourceAttribute& in = source.sets[0];
    ASSERT_EQ(coded.decoded.header.num_components, in.num_components) << "seed " << seed;
    for (std::uint32_t c = 0; c < coded.corner_map.size(); ++c) {
      const auto [from, to] = values_of(coded, in, c);
      for (std::uint32_t k = 0; k < in.num_components; ++k) {
        const std::uint32_t value = coded.decoded.values[to * in.num_components + k];
        ASSERT_EQ(number_of(coded.decoded, value, k), in.values[from * in.num_components + k])
            << "seed " << seed << ", corner " << c;
      }
    }
  }
}

TEST(AttributesRoundtrip, TextureCoordinatesAndNormalsComeNear) {
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    Draw draw(seed);
    const TriangleMesh mesh = random_mesh(draw);
    const bool is_normal = seed % 2 == 0;
    const AttributeDomain domain = kDomains[seed / 2 % 2];
    SourceAttributes source;
    source.sets.push_back(random_source(
        draw, is_normal ? SourceAttribute::Kind::kNormals : SourceAttribute::Kind::kNumbers,
        domain, mesh));
    SourceAttribute& in = source.sets[0];
    if (!is_normal) {
      in.name = "uv0";
      for (float& x : in.values) x = std::fmod(std::abs(x), 4.0F);
    }
    AttributeSettings settings;
    settings.normals = NormalChoice::kExact;
    settings.normal_bits = 12;
    const DecodedAttribute coded = decoded_attribute(draw, mesh, source, settings);
    if (is_normal) {
      settings = {};
      settings.exact = true;
      const AttributeHeader header =
          decoded_attribute(draw, mesh, source, settings).decoded.header;
      ASSERT_EQ(header.kind, ValueKind::kUnitVectors) << "seed " << seed;
      ASSERT_EQ(header.value_bits, 16U);
    }
    const std::uint32_t n = in.num_components;
    const bool is_smoothing = coded.decoded.header.kind == ValueKind::kSmoothing;
    std::map<std::size_t, std::size_t> source_of;  // [sector]
    for (std::uint32_t c = 0; c < coded.corner_map.size(); ++c) {
      const auto [from, to] = values_of(coded, in, c);
      if (is_smoothing) {
        // Normals are computed, but corners share one only where those of the source did.
        ASSERT_TRUE(is_normal);
        const std::size_t known = source_of.emplace(to, from).first->second;
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_EQ(in.values[3 * known + k], in.values[3 * from + k]) << "seed " << seed;
        }
        continue;
      }
      if (is_normal) {
        if (!coded.has_area(c)) continue;
        const auto v = octahedron_vector(
            {coded.decoded.values[2 * to], coded.decoded.values[2 * to + 1]}, 12);
        double cosine = 0.0;
        for (std::size_t k = 0; k < 3; ++k) cosine += v[k] * in.values[3 * from + k];
        ASSERT_GT(cosine, 0.999998) << "seed " << seed << ", corner " << c;
        continue;
      }
      for (std::uint32_t k = 0; k < n; ++k) {
        const double value = number_of(coded.decoded, coded.decoded.values[to * n + k], k);
        ASSERT_NEAR(value, in.values[from * n + k], 1.0 / 8192) << "seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
