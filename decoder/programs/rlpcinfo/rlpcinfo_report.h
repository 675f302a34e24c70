// What rlpcinfo reports of a stream: as text, as JSON, and as a page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/coarse_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "decoder/codec/units/gof_summary.h"
#include "decoder/programs/rlpcinfo/listed_attributes.h"
#include "decoder/report/bit_counter.h"
#include "decoder/report/gof_pictures.h"

namespace rlpc {

struct StreamInfo {
  const std::string& input;  // as given on the command line
  const SequenceHeader& header;
  const BitCounter& counter;
  std::uint64_t bytes = 0;
  const StreamSummary& summary;
  const std::string& metadata;
  const std::vector<Clip>& clips;
  ListedAttributes attributes;
  const CoarseMeshes* coarse = nullptr;     // to be listed; null: not asked for
  const PicturedFrame* pictured = nullptr;  // of a page
  std::uint64_t max_json_bytes = 0;         // of memory for the metadata as JSON
};

// Both on standard output.
void print_table(const StreamInfo& s, bool with_gofs);
void print_json(const StreamInfo& s);
// HTML; `pictured` is set.
std::string page_text(const StreamInfo& s);

}  // namespace rlpc
