// Findings of rlpccmp as one page for a browser.
#pragma once

#include <optional>
#include <string>

#include "conformance/rlpccmp/comparison_input.h"
#include "decoder/report/mesh_view.h"
#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/metrics/surface_metrics.h"

namespace rlpc {

struct Distortion {
  Metrics metrics;
  SurfaceMetrics surface;
  // Whether every decoded number is the float nearest to A's: the only error is rounding.
  bool is_rounding = false;
};

struct ComparisonPage {
  const ComparisonPair& pair;
  const Distortion& distortion;
  const MeshView& view;  // includes the frames
  std::string stream;    // the file that B was decoded from; empty: unknown
};

InputResult<std::string> comparison_page_text(const ComparisonPage& comparison);

// Returns the KG error of one frame; Metrics::kg_error_percent is that of all frames.
double kg_error_percent(const FrameMetrics& frame);

}  // namespace rlpc
