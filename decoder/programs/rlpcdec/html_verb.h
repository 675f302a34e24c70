// Implements rlpcdec --html, which writes a page that plays the stream.
#pragma once

#include <memory>
#include <string>

#include "common/files/output_file.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

struct HtmlRequest {
  std::string input;      // name of the stream; "-": standard input
  std::string output;     // page to write
  std::string player;     // page of the player; empty: the default location
  std::string reference;  // stream of the same mesh with the same vertex order; empty: none
  DecoderOptions decoder;
  std::shared_ptr<OutputLimit> limit;  // limit of the size of the page; null: none
  bool quiet = false;
};

// Checks the first units of the streams and writes the page. Returns the exit code of decoding
// the whole stream.
int write_html(const HtmlRequest& request, ByteSource& stream);

}  // namespace rlpc
