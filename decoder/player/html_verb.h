// rlpcdec --html: a page that plays the stream.
#pragma once

#include <memory>
#include <string>

#include "common/io/output_file.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

struct HtmlRequest {
  std::string input;      // name of the stream; "-": it came from standard input
  std::string output;     // page to write
  std::string player;     // page of the player; empty: where it usually is
  std::string reference;  // of the same mesh, its vertices in the same order; empty: none
  DecoderOptions decoder;
  std::shared_ptr<OutputLimit> limit;  // of the page; null: none
  bool quiet = false;
};

// Looks at the first units of the streams, writes the page, and returns the exit code: that of
// decoding the stream whole.
int write_html(const HtmlRequest& request, ByteSource& stream);

}  // namespace rlpc
