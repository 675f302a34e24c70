// Implements rlpcinfo --extract, which writes a stream without some of its slices.
#pragma once

#include <optional>
#include <string>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

// Parses "components=K", "layers=L", "temporal=N", or several of them separated by commas: K is
// 0 or more, L and N are 1 or more. None if the text is none of these.
std::optional<SliceCut> parse_slice_cut(const std::string& text);

struct ExtractOptions {
  std::string input;
  std::string output;
  SliceCut cut;
  DecodeLimits limits;
  bool json = false;
};

// Writes the stream, and a report on standard output unless the stream goes there ("-").
// Reports errors on standard error. Returns the exit code.
int extract(const ExtractOptions& options);

}  // namespace rlpc
