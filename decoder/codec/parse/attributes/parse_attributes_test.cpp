#include "decoder/codec/parse/attributes/parse_attributes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "common/testing/element_names.h"

namespace rlpc {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::vector<Triangle> kTetrahedron{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}};
constexpr MemoryLimit kPlenty{1U << 20, 0};

// uv0: corners, integers of 10 bits, parallelograms, seams on edges 1, 3, 2, 8 and 0, 9;
// m: triangles, of 4 bits; normal: smoothing of vertices, one diagonal; w: vertices, floats.
const Bytes kFourSets{0x20, 0x13, 0xAB, 0xB1, 0x82, 0x32, 0x85, 0x45, 0x0F, 0x40, 0x1B, 0x60,
                      0x30, 0x15, 0xB9, 0xBD, 0xC9, 0xB5, 0x85, 0xB0, 0xD4, 0x01, 0xDC, 0x80,
                      0x47, 0xE4, 0x8F, 0xCC, 0xB2, 0x8B, 0xAF, 0x4B, 0x46, 0x20, 0x25, 0x93,
                      0x01, 0xE4, 0xFC, 0x02, 0xA6, 0x13, 0xE5, 0x2E, 0xFA, 0x24, 0x83};

Result<CodedAttributes> parse(const Bytes& payload, const MemoryLimit& memory = kPlenty) {
  BitReader r(payload);
  return parse_attributes(r, 4, kTetrahedron, memory);
}

std::vector<std::int32_t> as_signed(const std::vector<std::uint32_t>& values) {
  return {values.begin(), values.end()};
}

TEST(ParseAttributes, GivesHeaders) {
  const auto coded = parse(kFourSets);
  ASSERT_TRUE(coded);
  ASSERT_EQ(coded->sets.size(), 4U);
  EXPECT_FALSE(coded->uses_positions());
  AttributeHeader uv;
  uv.name = "uv0";
  uv.domain = AttributeDomain::kCorner;
  uv.num_components = 2;
  uv.value_bits = 10;
  uv.scale = ValueScale::kGrid;
  uv.log2_step = -10;
  uv.origin = {5, -7, 0, 0};
  uv.prediction = AttributePrediction::kParallelogram;
  EXPECT_EQ(coded->sets[0].header, uv);
  AttributeHeader normal;
  normal.name = "normal";
  normal.kind = ValueKind::kSmoothing;
  normal.num_components = 0;
  normal.weight = SmoothingWeight::kArea;
  normal.diagonals = Diagonals::kFlagged;
  EXPECT_EQ(coded->sets[2].header, normal);
  EXPECT_EQ(coded->sets[3].header.kind, ValueKind::kFloats);
}

TEST(ParseAttributes, GivesSeamsDiagonalsAndResiduals) {
  const auto coded = parse(kFourSets);
  ASSERT_TRUE(coded);
  EXPECT_EQ(coded->sets[0].seams, (std::vector<bool>{1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(as_signed(coded->sets[0].residuals),
            (std::vector<std::int32_t>{3, -2, -1, 4, 0, -4, 3, -7, -9, -4, -8, -5, -2, -7}));
  EXPECT_EQ(coded->sets[1].residuals, (std::vector<std::uint32_t>{5, 5, 3, 3}));
  EXPECT_EQ(coded->sets[2].diagonal_flags,
            (std::vector<bool>{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(coded->sets[2].residuals.empty());
  EXPECT_EQ(coded->sets[3].residuals,
            (std::vector<std::uint32_t>{2147483571U, 1U, 0U, 4294442909U}));
}

// The trace is that of the specification's pseudo-code.
TEST(ParseAttributes, ElementsAreTracedAsInTheSpecification) {
  ElementNames names;
  BitReader r(kFourSets, 0, &names);
  ASSERT_TRUE(parse_attributes(r, 4, kTetrahedron, kPlenty));
  EXPECT_TRUE(names.in_order);
  EXPECT_EQ(names.text,
            "num_attribute_sets_minus1 3\n"
            "attribute_name_size_minus1 2\nattribute_name_byte 117 118 48\n"
            "attribute_domain 1\nvalue_kind 0\nnum_components_minus1 1\n"
            "value_bits_minus1 9\nvalue_scale_idc 1\nvalue_log2_step -10\n"
            "value_origin 5 -7\nprediction_idc 1\n"
            "attribute_name_size_minus1 0\nattribute_name_byte 109\n"
            "attribute_domain 2\nvalue_kind 0\nnum_components_minus1 0\n"
            "value_bits_minus1 3\nvalue_scale_idc 0\n"
            "attribute_name_size_minus1 5\n"
            "attribute_name_byte 110 111 114 109 97 108\n"
            "attribute_domain 0\nvalue_kind 3\nsmoothing_weight_idc 1\ndiagonal_idc 1\n"
            "attribute_name_size_minus1 0\nattribute_name_byte 119\n"
            "attribute_domain 0\nvalue_kind 2\nnum_components_minus1 0\nprediction_idc 0\n"
            "seam_flag 1 0 1 1 0 0\n"
            "value_residual 3 -2 -1 4 0 -4 3 -7 -9 -4 -8 -5 -2 -7\n"
            "triangle_residual 5\nsame_value_flag 1 0\ntriangle_residual -2\n"
            "same_value_flag 0 0\ntriangle_residual -2\n"
            "diagonal_flag 0 1 0 0 0 0\n"
            "float_size 32\nfloat_sign 1\nfloat_low_bits 77\n"
            "float_size 1\nfloat_sign 0\nfloat_low_bits 0\n"
            "float_size 0 20\nfloat_sign 1\nfloat_low_bits 99");
}

TEST(ParseAttributes, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < kFourSets.size(); ++n) {
    const auto coded =
        parse(Bytes(kFourSets.begin(), kFourSets.begin() + static_cast<std::ptrdiff_t>(n)));
    ASSERT_FALSE(coded) << n;
    // Past the end of the section, zeros are read, which can break another rule first (4.6).
    const std::string rule = coded.error().rule;
    EXPECT_TRUE(rule == "R-BIT-01" || rule == "R-RNG-01" || rule == "R-ATT-07") << n << rule;
  }
}

TEST(ParseAttributes, NothingFollowsTheSection) {
  Bytes longer = kFourSets;
  longer.push_back(0);
  const auto coded = parse(longer);
  ASSERT_FALSE(coded);
  EXPECT_EQ(coded.error().rule, std::string("R-RNG-01"));
}

// Header of one set, up to the element that is out of range.
struct Header {
  std::uint32_t sets_minus1 = 0;
  std::uint32_t domain = 0;
  std::uint32_t kind = 0;
  std::uint32_t components_minus1 = 0;
  std::uint32_t bits_minus1 = 7;
  std::uint32_t scale = 0;
  std::int32_t log2_step = 0;
  std::int32_t origin = 0;
  std::uint32_t prediction = 0;
  std::uint32_t weight = 0;
  std::uint32_t diagonals = 0;
};

Bytes bytes_of(const Header& h) {
  BitWriter w;
  w.ue(h.sets_minus1);
  w.u(8, 0);
  w.u(8, 'a');
  w.u(2, h.domain);
  w.u(2, h.kind);
  if (h.kind == 0 || h.kind == 2) w.u(2, h.components_minus1);
  if (h.kind < 2) w.u(4, h.bits_minus1);
  if (h.kind == 0) w.u(2, h.scale);
  if (h.scale == 1) {
    w.se(h.log2_step);
    for (std::uint32_t c = 0; c <= h.components_minus1; ++c) w.se(h.origin);
  }
  if (h.domain < 2 && h.kind < 3) w.u(2, h.prediction);
  if (h.kind == 3 || (h.kind == 1 && h.prediction == 2)) {
    w.u(2, h.weight);
    w.u(2, h.diagonals);
  }
  w.u(32, 0);
  w.u(32, 0);
  w.byte_alignment();
  return w.take();
}

void expect_broken(const Header& header, const char* rule, const char* element) {
  const auto coded = parse(bytes_of(header));
  ASSERT_FALSE(coded) << element;
  EXPECT_EQ(coded.error().rule, std::string(rule)) << element;
  EXPECT_EQ(coded.error().element, std::string(element));
}

TEST(ParseAttributes, ElementsAreInRange) {
  expect_broken({.sets_minus1 = 64}, "R-ATT-02", "num_attribute_sets_minus1");
  expect_broken({.domain = 3}, "R-ATT-03", "attribute_domain");
  expect_broken({.domain = 2, .kind = 3}, "R-ATT-03", "value_kind");
  expect_broken({.kind = 1, .bits_minus1 = 0}, "R-ATT-04", "value_bits_minus1");
  expect_broken({.scale = 3}, "R-ATT-04", "value_scale_idc");
  expect_broken({.scale = 1, .log2_step = -127}, "R-ATT-04", "value_log2_step");
  expect_broken({.scale = 1, .log2_step = 128}, "R-ATT-04", "value_log2_step");
  expect_broken({.scale = 1, .origin = 16777217}, "R-ATT-04", "value_origin");
  expect_broken({.scale = 1, .origin = -16777217}, "R-ATT-04", "value_origin");
  expect_broken({.prediction = 2}, "R-ATT-05", "prediction_idc");
  expect_broken({.components_minus1 = 1, .prediction = 3}, "R-ATT-05", "prediction_idc");
  expect_broken({.kind = 2, .components_minus1 = 1, .prediction = 2}, "R-ATT-05",
                "prediction_idc");
  expect_broken({.kind = 3, .weight = 3}, "R-ATT-06", "smoothing_weight_idc");
  expect_broken({.kind = 1, .prediction = 2, .diagonals = 3}, "R-ATT-06", "diagonal_idc");
}

TEST(ParseAttributes, MemoryIsCheckedBeforeItIsTaken) {
  const auto coded = parse(kFourSets, {64, 0});
  ASSERT_FALSE(coded);
  EXPECT_EQ(coded.error().code, Errc::kLimitExceeded);
  const auto in_use = parse(kFourSets, {1U << 20, 1U << 20});
  ASSERT_FALSE(in_use);
  EXPECT_EQ(in_use.error().code, Errc::kLimitExceeded);
}

// A payload of some hundred bytes that declares 64 sets of a mesh of a million triangles.
TEST(ParseAttributes, SmallUnitsDoNotAskForMuchMemory) {
  constexpr std::uint32_t kVertices = 500000;
  std::vector<Triangle> triangles(1000000, Triangle{0, 1, 2});
  BitWriter w;
  w.ue(63);
  for (std::uint32_t s = 0; s < 64; ++s) {
    w.u(8, 0);
    w.u(8, 'A' + s % 26);
    w.u(2, 1);
    w.u(2, 2);
    w.u(2, 3);
    w.u(2, 0);
  }
  w.byte_alignment();
  w.u(32, 0);
  const Bytes payload = w.take();
  BitReader r(payload);
  const auto coded = parse_attributes(r, kVertices, triangles, {std::uint64_t{1} << 30, 0});
  ASSERT_FALSE(coded);
  EXPECT_EQ(coded.error().code, Errc::kLimitExceeded);
  EXPECT_EQ(coded.error().element, std::string("num_attribute_sets_minus1"));
}

}  // namespace
}  // namespace rlpc
