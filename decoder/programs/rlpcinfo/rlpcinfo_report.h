// Reports of rlpcinfo on a stream: as text, as JSON, and as a page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/coarse_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "decoder/codec/units/stream_summary.h"
#include "decoder/programs/rlpcinfo/listed_attributes.h"
#include "decoder/report/bit_counter.h"
#include "decoder/report/gof_pictures.h"

namespace rlpc {

struct StreamInfo {
  const std::string& input;  // name on the command line
  const SequenceHeader& header;
  const BitCounter& counter;
  std::uint64_t bytes = 0;
  const StreamSummary& summary;
  const std::string& metadata;
  const std::vector<Clip>& clips;
  ListedAttributes attributes;
  const CoarseMeshes* coarse = nullptr;     // coarse meshes to list; null: not requested
  const PicturedFrame* pictured = nullptr;  // frame to draw on a page
  std::uint64_t max_json_bytes = 0;         // memory for the metadata as JSON
};

// Print to standard output.
void print_table(const StreamInfo& s, bool with_gofs);
void print_json(const StreamInfo& s);
// Returns a page in HTML; `pictured` must be set.
std::string page_text(const StreamInfo& s);

}  // namespace rlpc
