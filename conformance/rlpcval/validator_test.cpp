// Tests findings after the first error, and checks that decoders need not make.
#include "conformance/rlpcval/validator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "conformance/testing/rig_animation.h"
#include "conformance/testing/validator_streams.h"
#include "decoder/rlpc_decoder.h"
#include "encoder/codec/write/write_cluster_gof.h"
#include "encoder/codec/write/write_connectivity.h"
#include "encoder/codec/write/write_stream.h"

namespace rlpc {
namespace {

TEST(Validator, FindsNothingInGoodStreams) {
  for (const StreamBytes& stream : {rich_stream(), indexed_stream(), sliced_stream(),
                                    mixed_stream(), rig_stream(), indexed_rig_stream()}) {
    const ValidationReport report = validate(stream);
    EXPECT_EQ(ids(report), Ids{});
    EXPECT_TRUE(report.complete);
    EXPECT_EQ(report.frames, report.header->num_frames);
    EXPECT_EQ(report.hashed_frames, report.frames);
    EXPECT_EQ(report.units, units_of(stream).size());
  }
}

// 2^32 - 1, which no element may have.
void too_large(BitWriter& w) {
  w.u(32, 0);
  w.flag(true);
  w.u(32, 0);
}

TEST(Validator, ReportsAllValuesOfASequenceHeader) {
  BitWriter w;
  w.u(8, 0);
  w.u(8, 1);
  w.ue(1U << 14);
  w.ue((1U << 15) + 1);
  w.ue(1U << 24);
  too_large(w);
  too_large(w);
  w.se(-151);
  w.se((1 << 26) + 1);
  w.se(-(1 << 26) - 1);
  w.se(1 << 26);
  w.u(5, 25);
  w.u(6, 1);  // up to the next byte
  Bytes payload = w.take();
  payload.push_back(0);
  const StreamBytes stream = with_payload_of(rich_stream(), UnitType::kSequenceHeader, payload);
  Ids found = ids(stream);
  ASSERT_GE(found.size(), 11U);
  found.resize(11);
  EXPECT_EQ(found, (Ids{"R-LVL-01", "R-LVL-02", "R-LVL-03", "R-HDR-03", "R-HDR-03", "R-HDR-04",
                        "R-HDR-05", "R-HDR-05", "R-HDR-06", "R-BIT-02", "R-BIT-03"}));
}

TEST(Validator, ReportsAllValuesOfAGofHeader) {
  const StreamBytes stream = rich_stream();
  BitWriter w;
  w.ue(1);     // first_frame
  w.ue(5);     // num_gof_frames_minus1: 1 + 6 > 6
  w.ue(256);   // num_clusters_minus1, level 1
  w.u(5, 25);  // fraction_bits
  w.ue(1U << 16);
  w.u(3, 5);
  w.u(1, 0);
  w.u(5, 1);  // up to the next byte
  const ValidationReport report = validate(with_payload_of(stream, UnitType::kGof, w.take()));
  Ids found = ids(report);
  ASSERT_GE(found.size(), 7U);
  found.resize(7);
  EXPECT_EQ(found, (Ids{"R-GOF-01", "R-GOF-02", "R-LVL-06", "R-GOF-03", "R-GOF-04", "R-GOF-05",
                        "R-BIT-02"}));
  EXPECT_EQ(report.gofs, 1U);  // the other one is read
  EXPECT_EQ(report.hashed_frames, 3U);
}

TEST(Validator, ContinuesAfterABrokenGof) {
  StreamBytes stream = indexed_stream();
  const auto gofs = units_of_type(stream, UnitType::kGof);
  for (const std::size_t g : {std::size_t{2}, std::size_t{9}}) {
    stream[gofs[g].payload() + gofs[g].size / 2] ^= 0x10;
  }
  const ValidationReport report = validate(stream);
  Ids found = ids(report);
  EXPECT_EQ(std::count(found.begin(), found.end(), "R-UNT-03"), 2);
  for (const Finding& f : report.findings) {
    ASSERT_TRUE(f.unit) << f.id;
    EXPECT_EQ(f.consequence, f.id != std::string_view("R-UNT-03")) << f.id;
    EXPECT_TRUE(f.unit->offset == gofs[2].offset || f.unit->offset == gofs[9].offset ||
                f.unit->offset == gofs[2].end() || f.unit->offset == gofs[9].end());
  }
  EXPECT_GE(report.hashed_frames, 14U);
  EXPECT_EQ(report.first_failure()->unit->offset, gofs[2].offset);
}

TEST(Validator, MarksWhatMayBeAConsequence) {
  const StreamBytes good = indexed_stream();
  const auto gofs = units_of_type(good, UnitType::kGof);
  const StreamBytes stream =
      with_payload(good, gofs[3], std::span(good).subspan(gofs[9].payload(), gofs[9].size));
  std::vector<bool> consequences;
  for (const Finding& f : validate(stream).findings) {
    if (f.id == std::string_view("R-GOF-01")) consequences.push_back(f.consequence);
  }
  EXPECT_EQ(consequences, (std::vector<bool>{false, true}));
}

TEST(Validator, ReadsPayloadsWhoseCrcIsWrong) {
  StreamBytes stream = rich_stream();
  const UnitPlace unit = units_of_type(stream, UnitType::kMetadata).at(0);
  stream[unit.payload()] = 1;  // metadata_size of 16 MB
  const ValidationReport report = validate(stream);
  EXPECT_EQ(ids(report), (Ids{"R-UNT-03", "R-MET-01"}));
  EXPECT_TRUE(report.findings[1].consequence);
}

TEST(Validator, FindsUnitsAgainAfterAWrongSize) {
  const StreamBytes good = indexed_stream();
  const auto gofs = units_of_type(good, UnitType::kGof);
  for (std::size_t byte = 1; byte <= 4; ++byte) {
    StreamBytes stream = good;
    stream[gofs[5].offset + byte] ^= 0x05;
    const ValidationReport report = validate(stream);
    const Finding* first = report.first_failure();
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(report.hashed_frames, 15U) << "byte " << byte;
    EXPECT_FALSE(report.complete);
    // The bytes in between are not interpreted.
    for (const Finding& f : report.findings) {
      EXPECT_TRUE(f.bit_pos == first->bit_pos || f.consequence) << f.id << " at " << f.bit_pos;
      EXPECT_TRUE(!f.unit || f.unit->offset == gofs[5].offset) << f.id;
    }
  }
}

TEST(Validator, SaysWhatIsMissingOrTooMuch) {
  const StreamBytes good = rich_stream();
  const auto gofs = units_of_type(good, UnitType::kGof);
  const auto hashes = units_of_type(good, UnitType::kGofHash);
  StreamBytes stream = good;
  erase(stream, units_of_type(good, UnitType::kEndOfSequence).at(0));
  EXPECT_EQ(ids(stream), Ids{"R-UNT-01"});

  stream = good;
  stream.insert(stream.end(), {1, 2, 3});
  EXPECT_EQ(ids(stream), Ids{"R-END-02"});
  EXPECT_EQ(validate(stream).findings[0].detail, "3 bytes follow");

  stream = good;
  erase(stream, hashes[0]);
  erase(stream, gofs[0]);
  EXPECT_EQ(ids(stream), Ids{"R-GOF-01"});
  EXPECT_EQ(validate(stream).hashed_frames, 3U);

  stream = good;
  erase(stream, hashes[1]);
  erase(stream, gofs[1]);
  EXPECT_EQ(ids(stream), Ids{"R-END-01"});

  stream = good;
  insert(stream, hashes[1].end(), unit_bytes(good, gofs[0]));
  EXPECT_EQ(ids(stream), (Ids{"R-END-01", "W-HSH-01"}));

  stream = good;
  erase(stream, units_of_type(good, UnitType::kConnectivity).at(0));
  const Ids found = ids(stream);  // the vertex order, and the first of the GOFs
  EXPECT_EQ(found, (Ids{"R-UNT-05", "R-UNT-05"}));
}

// Writes the elements of the GOF unit of a skinned GOF up to its layers, and those of the
// layers.
void put_bones(BitWriter& w, std::uint32_t num_bones_minus1, std::uint32_t rest_step_minus1,
               std::uint32_t num_component_groups, std::uint32_t prediction_idc) {
  w.ue(0);       // first_frame
  w.ue(1);       // num_gof_frames_minus1
  w.flag(true);  // bones_flag
  w.ue(num_bones_minus1);
  w.u(5, 3);  // fraction_bits
  w.u(3, 4);  // weight_bits
  w.ue(rest_step_minus1);
  w.ue(num_component_groups);
  w.u(2, prediction_idc);
}
void put_layers(BitWriter& w, const std::vector<std::uint32_t>& layer_group_layers_minus1) {
  w.u(12, 0);  // damping_log2, outer_weight, outer_scale
  w.ue(static_cast<std::uint32_t>(layer_group_layers_minus1.size()));
  for (const std::uint32_t layers : layer_group_layers_minus1) w.ue(layers);
}
ValidationReport validate_first_gof(const Bytes& payload) {
  return validate(with_payload_of(sliced_stream(), UnitType::kGof, payload));
}

TEST(Validator, ReportsAllValuesOfASkinnedGofHeader) {
  BitWriter w;
  put_bones(w, 256, 1U << 16, 256, 0);
  w.byte_alignment();
  const ValidationReport report = validate_first_gof(w.take());
  Ids found = ids(report);
  ASSERT_GE(found.size(), 3U);
  found.resize(3);
  EXPECT_EQ(found, (Ids{"R-LVL-06", "R-BON-01", "R-BON-02"}));
  EXPECT_EQ(report.gofs, 1U);  // the other one is read
  EXPECT_EQ(report.hashed_frames, 2U);
  EXPECT_FALSE(report.complete);
}

TEST(Validator, ReportsLayerGroupsWithoutLayers) {
  const auto first_id = [](const std::vector<std::uint32_t>& layer_group_layers_minus1) {
    BitWriter w;
    put_bones(w, 2, 19, 2, 3);
    put_layers(w, layer_group_layers_minus1);
    w.u(32, 0);  // enough for layer steps and the section
    w.u(32, 0);
    w.u(32, 0);
    w.byte_alignment();
    return ids(validate_first_gof(w.take())).at(0);
  };
  EXPECT_NE(first_id({0}), "R-BON-03");
  EXPECT_EQ(first_id({250}), "R-BON-03");
  EXPECT_EQ(first_id(std::vector<std::uint32_t>(250, 0)), "R-BON-03");
}

TEST(Validator, ReportsSlicesOfNoGroupAndGoesOn) {
  const StreamBytes good = sliced_stream();
  const auto slices = units_of_type(good, UnitType::kSlice);
  BitWriter w;
  w.ue(3);
  w.ue(2);
  w.byte_alignment();
  const ValidationReport report = validate(with_payload(good, slices.at(5), w.take()));
  EXPECT_EQ(ids(report), (Ids{"R-SLI-01", "R-SLI-01"}));
  EXPECT_EQ(report.gofs, 1U);
  EXPECT_EQ(report.hashed_frames, 2U);
  EXPECT_FALSE(report.complete);
}

TEST(Validator, SaysWhichSlicesAreMissingOrMisplaced) {
  const StreamBytes good = sliced_stream();
  const auto slices = units_of_type(good, UnitType::kSlice);
  ASSERT_EQ(slices.size(), 8U);
  // Group 0, then groups 1 and 2, of two layer groups each; the second GOF has one of each.
  StreamBytes stream = good;
  erase(stream, slices[2]);
  EXPECT_EQ(ids(stream), Ids{"R-SLI-02"});
  stream = good;
  insert(stream, slices[2].offset, unit_bytes(good, slices[0]));
  EXPECT_EQ(ids(stream), Ids{"R-SLI-02"});
  // Leaving out the last slice, on which no other depends, is legal except for the hash.
  stream = good;
  erase(stream, slices[7]);
  EXPECT_EQ(ids(stream), Ids{"R-HSH-02"});
  // A slice after the hash, and one before any GOF.
  stream = good;
  insert(stream, units_of_type(good, UnitType::kGofHash).at(1).end(),
         unit_bytes(good, slices[7]));
  EXPECT_EQ(ids(stream), Ids{"R-UNT-05"});
  stream = good;
  insert(stream, units_of_type(good, UnitType::kGof).at(0).offset, unit_bytes(good, slices[0]));
  EXPECT_EQ(ids(stream), Ids{"R-UNT-05"});
}

TEST(Validator, AcceptsNoSlicesAfterClusterGofs) {
  const StreamBytes good = mixed_stream();
  const auto gofs = units_of_type(good, UnitType::kGof);
  const Bytes slice = unit_bytes(good, units_of_type(good, UnitType::kSlice).at(0));
  for (const std::size_t g : {std::size_t{0}, std::size_t{2}}) {
    StreamBytes stream = good;
    insert(stream, gofs.at(g).end(), slice);
    EXPECT_EQ(ids(stream), Ids{"R-UNT-05"});
  }
  // If the GOF unit is damaged, its kind is unknown.
  for (const bool cut : {false, true}) {
    StreamBytes stream = good;
    stream[gofs.at(1).payload()] ^= 2;  // bones_flag
    if (cut) stream = with_payload(good, gofs.at(1), Bytes{});
    const Ids found = ids(stream);
    EXPECT_EQ(found.at(0), cut ? "R-BIT-01" : "R-UNT-03");
    EXPECT_EQ(std::count(found.begin(), found.end(), "R-UNT-05"), 0);
  }
}

TEST(Validator, AcceptsNoSlicesInStreamsOfVersion0) {
  const StreamBytes rich = rich_stream();
  const UnitPlace gof = units_of_type(rich, UnitType::kGof).at(0);
  StreamBytes stream = rich;
  insert(stream, gof.end(), write_unit(UnitType::kSlice, {}));
  const ValidationReport report = validate(stream);
  EXPECT_EQ(ids(report).at(0), "R-UNT-04");
  EXPECT_EQ(report.count(Severity::kUnsupported), 1U);
  EXPECT_EQ(report.count(Severity::kError), 0U);
}

TEST(Validator, WarnsOfIdleBonesAndStillTrajectories) {
  EXPECT_EQ(ids(SlicedAnimation().idle_stream()), (Ids{"W-BON-01", "W-SLI-01"}));
}

// 4.6: the decoding process checks none of these.
TEST(Validator, ChecksWhatDecodersNeedNotCheck) {
  const StreamBytes rich = rich_stream();
  const auto hashes = units_of_type(rich, UnitType::kGofHash);
  const auto first_gof = units_of_type(rich, UnitType::kGof).at(0);
  StreamBytes stream = rich;
  insert(stream, hashes[0].offset, write_unit(UnitType::kMetadata, write_metadata("{}")));
  EXPECT_EQ(ids(stream), (Ids{"R-HSH-03", "W-MET-01"}));
  stream = rich;
  insert(stream, hashes[0].end(), unit_bytes(rich, hashes[0]));
  EXPECT_EQ(ids(stream), Ids{"R-HSH-03"});
  stream = rich;
  insert(stream, first_gof.offset, unit_bytes(rich, hashes[0]));
  EXPECT_EQ(ids(stream), Ids{"R-HSH-03"});

  EXPECT_EQ(ids(with_payload_of(rich, UnitType::kMetadata, write_metadata("{'a':1}"))),
            Ids{"R-MET-03"});
  EXPECT_EQ(ids(with_payload_of(rich, UnitType::kEndOfSequence, write_end_of_sequence(20))),
            Ids{"R-END-03"});
}

TEST(Validator, ComparesTheIndexWithTheGofs) {
  const StreamBytes good = indexed_stream();
  const auto gofs = units_of_type(good, UnitType::kGof);
  const UnitPlace index = units_of_type(good, UnitType::kGofIndex).at(0);
  std::vector<GofEntry> entries;
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    const std::size_t next = g + 1 < gofs.size() ? gofs[g + 1].offset : index.offset;
    entries.push_back({1, next - gofs[g].offset});
  }
  // The size of the index changes, and with it index_distance.
  const auto with_index = [&](std::uint64_t first, const std::vector<GofEntry>& list) {
    const Bytes payload = write_gof_index({first, list, {}}, kProfileBaseline);
    const auto size = static_cast<std::uint32_t>(payload.size() + 9);
    return with_payload_of(with_payload(good, index, payload), UnitType::kEndOfSequence,
                           write_end_of_sequence(size));
  };
  EXPECT_EQ(ids(with_index(gofs[0].offset, entries)), Ids{});
  EXPECT_EQ(ids(with_index(gofs[0].offset + 1, entries)), Ids{"R-IDX-03"});
  auto list = entries;
  list[7].bytes -= 9;
  EXPECT_EQ(ids(with_index(gofs[0].offset, list)), Ids{"R-IDX-03"});
  list = entries;
  list.pop_back();
  EXPECT_EQ(ids(with_index(gofs[0].offset, list)), Ids{"R-IDX-01"});
  list.back().num_frames = 2;
  EXPECT_EQ(ids(with_index(gofs[0].offset, list)), Ids{"R-IDX-03"});
  list = entries;
  list.push_back(list.back());
  EXPECT_EQ(ids(with_index(gofs[0].offset, list)), Ids{"R-IDX-01"});
  list = entries;
  list.back().bytes += 1;
  EXPECT_EQ(ids(with_index(gofs[0].offset, list)), Ids{"R-IDX-03"});
  EXPECT_EQ(ids(with_payload_of(good, UnitType::kEndOfSequence, write_end_of_sequence(0))),
            Ids{"R-IDX-04"});
  BitWriter w;
  w.ue(15);
  too_large(w);
  w.u(6, 0);
  EXPECT_EQ(ids(with_payload(good, index, w.take())),
            (Ids{"R-IDX-02", "R-BIT-01", "R-END-03", "R-IDX-04"}));
}

TEST(Validator, WarnsOfWhatIsSurelyNotIntended) {
  SequenceHeader header;
  header.level_idc = 3;
  header.num_vertices = 4;
  header.num_frames = 16;
  header.frame_rate = {1, 1000};
  ClusterGof gof;
  gof.clusters.resize(2);
  gof.cluster_of_vertex.assign(4, 0);
  gof.clusters[0].components.resize(1);
  gof.clusters[0].components[0].temporal_residual.assign(1, 5);
  gof.clusters[0].components[0].spatial_residual.assign(12, 0);
  StreamBytes stream = write_stream_header(kProfileBaseline);
  const auto append = [&](UnitType type, const Bytes& payload) {
    insert(stream, stream.size(), write_unit(type, payload));
  };
  append(UnitType::kSequenceHeader, write_sequence_header(header));
  append(UnitType::kConnectivity, write_connectivity(4, {}).payload);
  append(static_cast<UnitType>(0xFF), {1, 2, 3});
  for (; gof.first_frame < 16; ++gof.first_frame) {
    append(UnitType::kGof, write_cluster_gof(gof, header, make_topology(4, {})));
  }
  append(UnitType::kMetadata, write_metadata("1"));
  append(UnitType::kMetadata, write_metadata("2"));
  append(UnitType::kEndOfSequence, write_end_of_sequence(0));
  const ValidationReport report = validate(stream);
  Ids found = ids(report);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (Ids{"W-GOF-01", "W-GOF-02", "W-HDR-01", "W-HSH-01", "W-IDX-01", "W-LVL-01",
                        "W-MET-01", "W-UNT-01"}));
  for (const Finding& f : report.findings) {
    EXPECT_EQ(f.severity, Severity::kWarning);
    EXPECT_EQ(
        f.count,
        f.id == std::string_view("W-GOF-01") || f.id == std::string_view("W-GOF-02") ? 16U : 1U)
        << f.id;
  }
  EXPECT_EQ(report.first_failure(), nullptr);
}

TEST(Validator, ReadsNothingOfWhatItDoesNotSupport) {
  const StreamBytes good = rich_stream();
  for (const auto& [byte, value, rule] :
       std::vector<std::tuple<std::size_t, int, std::string>>{{8, 2, "R-STR-02"},
                                                              {9, 2, "R-STR-03"},
                                                              {9, 1, "R-STR-03"},
                                                              {15, 7, "R-HDR-01"},
                                                              {16, 9, "R-HDR-02"}}) {
    StreamBytes stream = good;
    stream[byte] = static_cast<std::uint8_t>(value);
    repair_crcs(stream);
    const ValidationReport report = validate(stream);
    EXPECT_EQ(ids(report), Ids{rule});
    EXPECT_EQ(report.count(Severity::kUnsupported), 1U);
    EXPECT_FALSE(report.complete);
  }
}

TEST(Validator, ReadsMetadataWithoutASequenceHeader) {
  StreamBytes stream = rich_stream();
  erase(stream, units_of_type(stream, UnitType::kSequenceHeader).at(0));
  const UnitPlace first = units_of(stream).at(0);
  insert(stream, first.offset, write_unit(UnitType::kMetadata, write_metadata("{'a':1}")));
  const ValidationReport report = validate(stream);
  EXPECT_FALSE(report.stopped);
  const Ids found = ids(report);
  EXPECT_EQ(std::count(found.begin(), found.end(), "R-MET-03"), 1);
}

TEST(Validator, KeepsToItsLimits) {
  const StreamBytes good = rich_stream();
  ValidationOptions options;
  options.limits.max_memory_bytes = 3000;
  EXPECT_TRUE(validate(good, options).stopped);
  options = {};
  options.limits.max_vertices = 29;
  const ValidationReport report = validate(good, options);
  ASSERT_TRUE(report.stopped);
  EXPECT_EQ(report.stopped->code, Errc::kLimitExceeded);
  EXPECT_STREQ(report.stopped->element, "num_vertices_minus1");
  DecoderOptions same;
  same.limits = options.limits;
  const auto decoder = Decoder::open(memory_source(StreamBytes(good)), same);
  ASSERT_FALSE(decoder);
  EXPECT_EQ(report.stopped->bit_pos, decoder.error().bit_pos);
  EXPECT_EQ(ids(report), Ids{});
  EXPECT_FALSE(report.complete);
  options = {};
  options.max_findings = 1;
  StreamBytes stream = good;
  for (const UnitPlace& unit : units_of(good)) stream[unit.crc()] ^= 1;
  const ValidationReport few = validate(stream, options);
  EXPECT_EQ(few.findings.size(), 1U);
  EXPECT_EQ(few.count(Severity::kError), units_of(good).size());
}

}  // namespace
}  // namespace rlpc
