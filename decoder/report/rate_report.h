// Charts and tables of the bits of a stream by purpose, for a page.
#pragma once

#include <cstdint>
#include <string>

#include "decoder/codec/units/stream_summary.h"
#include "decoder/report/bit_counter.h"
#include "decoder/report/html_page.h"

namespace rlpc {

struct StreamRates {
  std::uint64_t num_vertices = 0;
  std::uint64_t num_frames = 0;
  std::uint64_t bytes = 0;
  const BitCounter* counter = nullptr;     // not owned; finished
  const StreamSummary* summary = nullptr;  // not owned

  double bpvf(double bits) const {
    return bits / (static_cast<double>(num_vertices) * static_cast<double>(num_frames));
  }
};

// Adds charts of the parts of the stream, and of the rate of each GOF over time.
void add_rate_section(HtmlPage& page, const StreamRates& rates);
// Adds a table with a row per GOF and shared rig, and the contents of their slices.
void add_gof_section(HtmlPage& page, const StreamRates& rates);

}  // namespace rlpc
