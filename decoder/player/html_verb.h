// rlpcdec --html: a page that plays the stream.
#pragma once

#include <memory>
#include <string>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

struct HtmlRequest {
  std::string input;      // name of the stream
  std::string output;     // page to write
  std::string player;     // page of the player; empty: where it usually is
  std::string reference;  // another stream of the same mesh; empty: none
  DecoderOptions decoder;
  bool quiet = false;
};

// Looks at the first units of the streams, writes the page, and returns the exit code.
int write_html(const HtmlRequest& request, ByteSource& stream);

}  // namespace rlpc
