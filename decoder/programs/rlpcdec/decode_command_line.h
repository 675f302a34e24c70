// Command line of rlpcdec.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "decoder/meshes/frame_sink.h"
#include "decoder/programs/rlpcdec/html_verb.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

struct DecodeCommand {
  std::string input;
  std::string output;
  std::string frames;
  std::string clip;
  SinkFormat format = SinkFormat::kByName;
  bool ascii = false;
  GltfMotion motion = GltfMotion::kAuto;
  std::uint32_t max_targets = kUsualMaxTargets;
  bool no_attributes = false;
  bool verify_only = false;
  bool no_hashes = false;
  bool conceals = false;
  bool json = false;
  bool quiet = false;
  HtmlRequest html;
  DecoderOptions decoder;
  std::shared_ptr<OutputLimit> limit;

  bool is_part() const { return !frames.empty() || !clip.empty(); }
};

// Adds the options. `command` must outlive the parsing of the command line.
void add_decode_options(CLI::App& app, DecodeCommand& command);

// Returns what is wrong with the combination of options; empty if nothing is.
std::string find_usage_error(const CLI::App& app, const DecodeCommand& command);

}  // namespace rlpc
