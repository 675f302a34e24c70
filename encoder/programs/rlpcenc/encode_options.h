// The command line of rlpcenc.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "encoder/meshes/frame_source.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

struct EncodeOptions {
  InputOptions input;
  std::string output;                       // "-": standard output
  std::string order_map;                    // "-": standard output; empty: none
  std::string quality;                      // the word given; empty: none
  std::optional<std::array<float, 6>> box;  // --box: smallest x, y, z, then largest
  bool dry_run = false;
  bool json = false;
  bool verbose = false;
  bool quiet = false;
  EncoderSettings settings;

  // Whether frames are encoded as they arrive through standard input.
  bool is_live() const {
    return settings.low_delay && (input.path == "-" || input.points == "-");
  }
};

enum EncodeExitCode : int { kEncoded = 0, kFailed = 1, kTargetMissed = 2, kUsage = 64 };

// Reads the command line, and the metadata file that it names. Returns the exit code if the
// program should end: after --help, or after reporting an error.
std::optional<int> read_encode_options(int argc, char** argv, EncodeOptions& options);

// Prints the message on standard error; returns `code`.
int complain(const std::string& message, EncodeExitCode code = kFailed);

}  // namespace rlpc
