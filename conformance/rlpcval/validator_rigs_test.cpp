// Tests findings about shared rigs and the GOFs that use them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_findings.h"
#include "conformance/rlpcval/validator_headers.h"
#include "conformance/testing/rig_animation.h"
#include "conformance/testing/validator_streams.h"

namespace rlpc {
namespace {

bool is_in(const Ids& list, std::string_view id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}

TEST(ValidatorRigs, ReportsAllValuesOfARigHeader) {
  BitWriter w;
  w.u(3, 5);
  w.ue(256);   // num_bones_minus1, level 1
  w.u(5, 25);  // fraction_bits
  w.u(3, 4);
  w.ue(1U << 16);
  w.ue(256);
  w.u(2, 0);
  w.byte_alignment();
  const ValidationReport report =
      validate(with_payload_of(rig_stream(), UnitType::kRig, w.take()));
  Ids found = ids(report);
  ASSERT_GE(found.size(), 4U);
  found.resize(4);
  EXPECT_EQ(found, (Ids{"R-LVL-06", "R-GOF-03", "R-BON-01", "R-BON-02"}));
  EXPECT_FALSE(report.complete);
  // The GOFs that do not use it, and those of its successor, are read.
  EXPECT_EQ(report.gofs, 5U);
  EXPECT_EQ(report.hashed_frames, 10U);
}

// Returns the elements of a skinned GOF with a shared rig.
Bytes tracks(std::uint32_t gof_kind, std::uint32_t rig_idx, std::uint32_t num_local_groups) {
  BitWriter w;
  w.ue(0);
  w.ue(1);
  w.u(2, gof_kind);
  w.u(3, rig_idx);
  w.u(3, 0);  // track_levels
  w.ue(num_local_groups);
  w.byte_alignment();
  return w.take();
}

TEST(ValidatorRigs, ReportsGofsWithoutTheirRig) {
  const ValidationReport report =
      validate(with_payload_of(rig_stream(), UnitType::kGof, tracks(2, 4, 0)));
  EXPECT_EQ(ids(report), Ids{"R-MOD-01"});
  EXPECT_EQ(report.findings[0].severity, Severity::kUnsupported);
  EXPECT_EQ(report.gofs, 7U);
  EXPECT_FALSE(report.complete);
}

TEST(ValidatorRigs, ReportsTooManyLocalGroups) {
  const auto found = [](std::uint32_t groups) {
    return ids(with_payload_of(rig_stream(), UnitType::kGof, tracks(2, 0, groups)));
  };
  EXPECT_FALSE(is_in(found(253), "R-BON-02"));  // the rig has 2
  EXPECT_TRUE(is_in(found(254), "R-BON-02"));
}

TEST(ValidatorRigs, ReportsTooManyAdaptiveValues) {
  SequenceHeader header;
  header.profile_idc = kProfileHigh;
  header.num_vertices = 16384;
  for (const std::uint32_t adaptive : {128U, 129U, 513U}) {
    BitWriter w;
    w.u(3, 0);
    w.ue(0);
    w.u(5, 0);
    w.u(3, 0);
    w.ue(0);
    w.ue(0);
    w.u(2, 3);
    w.u(12, 0);
    w.ue(adaptive);
    w.ue(0);
    w.u(4, 15);
    w.flag(false);  // rest_order_flag
    w.byte_alignment();
    const Bytes payload = w.take();
    ValidationReport report;
    FindingList findings(report, 10);
    ElementReader r(UnitHeader{}, payload, findings);
    EXPECT_TRUE(is_known(check_rig_header(r, header, 1).units));
    EXPECT_EQ(ids(report), adaptive == 128   ? Ids{}
                           : adaptive == 129 ? Ids{"R-LVL-09"}
                                             : Ids{"R-BON-06"});
  }
}

TEST(ValidatorRigs, SaysWhatIsMissingOrMisplaced) {
  const StreamBytes good = rig_stream();
  const auto rigs = units_of_type(good, UnitType::kRig);
  const auto hashes = units_of_type(good, UnitType::kGofHash);
  const UnitPlace connectivity = units_of_type(good, UnitType::kConnectivity).at(0);
  const Bytes rig = unit_bytes(good, rigs.at(1));
  StreamBytes stream = good;
  insert(stream, connectivity.offset, rig);
  EXPECT_EQ(ids(stream).at(0), "R-UNT-05");
  // A rig between a GOF and its hash.
  stream = good;
  insert(stream, hashes.at(3).offset, rig);
  EXPECT_TRUE(is_in(ids(stream), "R-HSH-03"));
  // The rig is useless, but legal; without slices, all vertices follow its first bone.
  stream = good;
  insert(stream, hashes.at(7).end(), rig);
  EXPECT_EQ(ids(stream), (Ids{"W-BON-01", "W-MOD-01"}));
  EXPECT_TRUE(validate(stream).complete);
  // Only its slices remain.
  stream = good;
  erase(stream, rigs.at(1));
  EXPECT_EQ(ids(stream).at(0), "R-UNT-05");
  EXPECT_TRUE(is_in(ids(stream), "R-MOD-01"));
  // Without its slices, the tracks of its component group are out of place.
  stream = good;
  insert(stream, units_of_type(good, UnitType::kGof).at(1).offset, rig);
  EXPECT_TRUE(is_in(ids(stream), "R-SLI-02"));
}

TEST(ValidatorRigs, StreamsOfVersion1HaveNone) {
  const StreamBytes sliced = sliced_stream();
  StreamBytes stream = sliced;
  insert(stream, units_of_type(sliced, UnitType::kGof).at(0).offset,
         unit_bytes(rig_stream(), units_of_type(rig_stream(), UnitType::kRig).at(0)));
  const ValidationReport report = validate(stream);
  EXPECT_EQ(ids(report), Ids{"R-UNT-04"});
  EXPECT_EQ(report.count(Severity::kUnsupported), 1U);
}

TEST(ValidatorRigs, ContinuesAfterADamagedRig) {
  StreamBytes stream = rig_stream();
  const UnitPlace rig = units_of_type(stream, UnitType::kRig).at(1);
  stream[rig.payload() + 4] ^= 0x10;
  const ValidationReport report = validate(stream);
  EXPECT_EQ(report.first_failure()->id, std::string_view("R-UNT-03"));
  for (const Finding& f : report.findings) {
    EXPECT_EQ(f.consequence, &f != report.first_failure()) << f.id;
  }
  EXPECT_GE(report.hashed_frames, 14U);  // all but those of its GOF
}

TEST(ValidatorRigs, ReportsHashesThatFitAnotherRig) {
  // The second rig with index 0 instead of the first.
  const StreamBytes good = rig_stream();
  const auto rigs = units_of_type(good, UnitType::kRig);
  Bytes payload = unit_bytes(good, rigs.at(1));
  payload.assign(payload.begin() + 5, payload.end() - 4);
  payload[0] = static_cast<std::uint8_t>(payload[0] & 0x1F);  // rig_idx 0
  const Ids found = ids(with_payload(good, rigs.at(1), payload));
  EXPECT_TRUE(is_in(found, "R-MOD-01"));  // in the GOF that uses rig 5
  EXPECT_TRUE(is_in(found, "R-SLI-01") || is_in(found, "R-SLI-02") ||
              is_in(found, "R-HSH-02") || is_in(found, "R-RNG-01"));
}

TEST(ValidatorRigs, ComparesTheIndexWithTheUnits) {
  const StreamBytes good = indexed_rig_stream();
  const UnitPlace index = units_of_type(good, UnitType::kGofIndex).at(0);
  const auto gofs = units_of_type(good, UnitType::kGof);
  GofIndexEntries entries;
  entries.first_gof_offset = gofs[0].offset;
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    const std::size_t next = g + 1 < gofs.size() ? gofs[g + 1].offset : index.offset;
    entries.gofs.push_back({2, next - gofs[g].offset});
  }
  const std::vector<std::uint32_t> idx{0, 5, 0};
  const auto rigs = units_of_type(good, UnitType::kRig);
  for (std::size_t m = 0; m < 3; ++m) entries.rigs.push_back({idx[m], rigs[m].offset});
  // The size of the index changes, and with it index_distance.
  const auto with_index = [&](const std::vector<RigIndexEntry>& list) {
    GofIndexEntries changed = entries;
    changed.rigs = list;
    const Bytes payload = write_gof_index(changed, kProfileHigh);
    const auto size = static_cast<std::uint32_t>(payload.size() + 9);
    return ids(with_payload_of(with_payload(good, index, payload), UnitType::kEndOfSequence,
                               write_end_of_sequence(size)));
  };
  EXPECT_EQ(with_index(entries.rigs), Ids{});
  auto list = entries.rigs;
  list[1].rig_idx = 4;
  EXPECT_EQ(with_index(list), Ids{"R-IDX-06"});
  list = entries.rigs;
  list[2].offset += 1;
  EXPECT_EQ(with_index(list), Ids{"R-IDX-06"});
  list = entries.rigs;
  list.pop_back();
  EXPECT_EQ(with_index(list), Ids{"R-IDX-06"});
  list.clear();
  EXPECT_EQ(with_index(list), Ids{"R-IDX-06"});
  list.assign(16, entries.rigs[0]);
  EXPECT_EQ(with_index(list), Ids{"R-IDX-06"});
  list.assign(17, entries.rigs[0]);
  EXPECT_EQ(with_index(list), Ids{"R-IDX-05"});
}

TEST(ValidatorRigs, WarnsOfWhatNoGofUses) {
  const ValidationReport report = [] {
    const auto source = memory_source(RigAnimation().idle_stream());
    return validate(*source, {});
  }();
  Ids found = ids(report);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (Ids{"W-BON-01", "W-MOD-01", "W-SLI-01"}));
  for (const Finding& f : report.findings) {
    EXPECT_EQ(f.unit->type_byte, static_cast<std::uint8_t>(UnitType::kRig)) << f.id;
  }
}

TEST(ValidatorRigs, WarnsOfALevelThatIsTooHigh) {
  StreamBytes stream = rig_stream();
  stream[units_of(stream)[0].payload() + 1] = 2;  // level_idc
  repair_crcs(stream);
  EXPECT_EQ(ids(stream), Ids{"W-LVL-01"});
}

}  // namespace
}  // namespace rlpc
