// Options and help page of rlpcenc, for CLI11.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "encoder/programs/rlpcenc/encode_options.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of a library
class App;
}

namespace rlpc {

// The options, and values that have not been converted to options yet.
struct EncodeCommandLine {
  explicit EncodeCommandLine(EncodeOptions& to) : options(to) {}

  EncodeOptions& options;
  std::vector<std::string> inputs;  // INPUT
  std::string fps;
  std::string axes;
  std::optional<std::string> gof;  // none: chosen by the profile
  std::string frame_pattern;
  std::optional<PartitionMethod> partition;
  std::vector<float> box;
  std::string metadata_path;
  std::string up_axis;                    // for the metadata: y, z; empty: not noted
  std::optional<double> metres_per_unit;  // for the metadata; none: not noted
  std::vector<std::string> clips;         // NAME:A-B
  std::optional<double> kg;
  std::optional<double> normals;
  std::optional<double> bpvf;
  std::optional<double> max_error;
  std::optional<int> lossless;  // 0: without a number of bits
};

// Adds the options. `line` must outlive the parsing of the command line.
void add_encode_options(CLI::App& app, EncodeCommandLine& line);

}  // namespace rlpc
