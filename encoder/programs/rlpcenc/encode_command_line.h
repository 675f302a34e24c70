// The options of rlpcenc and its help page, as CLI11 takes them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "encoder/programs/rlpcenc/encode_options.h"

namespace CLI {  // NOLINT(readability-identifier-naming): of a library
class App;
}

namespace rlpc {

// Values that are not converted yet are beside the options.
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
  std::string up_axis;                    // of the metadata: y, z; empty: not noted
  std::optional<double> metres_per_unit;  // likewise
  std::vector<std::string> clips;         // NAME:A-B
  std::optional<double> kg;
  std::optional<double> bpvf;
  std::optional<double> max_error;
  std::optional<int> lossless;  // 0: without a number of bits
};

// `line` must outlive the parsing of the command line.
void add_encode_options(CLI::App& app, EncodeCommandLine& line);

}  // namespace rlpc
