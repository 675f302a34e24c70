// rlpcinfo: what is in an .rlpc stream.

#include <CLI/CLI.hpp>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "decoder/describe_error.h"
#include "decoder/rlpc_decoder.h"

namespace {

constexpr const char* kExamples = R"(
Examples
  rlpcinfo walk.rlpc              what is in it, and what takes how many bits
  rlpcinfo walk.rlpc --json       the same for machines
  rlpcinfo walk.rlpc --trace      every syntax element: bit position, name, value

Exit code: 0 all of it was read; 1 not a conforming stream; 2 not supported; 4 not readable.)";

// Parts of a stream, in the order of the table.
struct Part {
  std::string_view name;
  std::vector<std::string_view> elements;
};
const std::array<Part, 11>& parts() {
  static const std::array<Part, 11> kParts{{
      {"unit headers and CRCs",
       {"version_major", "version_minor", "ancillary_flag", "unit_type", "unit_size",
        "unit_crc"}},
      {"sequence header", {"sequence_header"}},
      {"connectivity", {"connectivity"}},
      {"vertex order", {"vertex_order"}},
      {"GOF headers", {"gof"}},
      {"clusters", {"lcf_flag", "seed_vertex", "cluster_predicted_flag", "cluster_idx"}},
      {"seed tracks", {"seed_residual"}},
      {"component headers",
       {"num_components_delta", "scale_idx_delta", "spatial_bits_delta", "temporal_bits_delta",
        "temporal_predictor", "spatial_predictor"}},
      {"temporal factors", {"temporal_residual"}},
      {"spatial factors", {"spatial_residual"}},
      {"hashes, index, metadata", {"other"}},
  }};
  return kParts;
}

constexpr std::size_t kAncillaryPart = 10;

// Adds up the bits from each element to the next.
class BitCounter final : public rlpc::Trace {
 public:
  explicit BitCounter(bool print) : print_(print) {
    for (std::size_t p = 0; p < parts().size(); ++p) {
      for (const std::string_view name : parts()[p].elements) part_of_[name] = p;
    }
  }

  void begin(const char* structure, std::uint64_t bit_pos) override {
    close(bit_pos);
    if (print_) std::printf("%10" PRIu64 "  %s( )\n", bit_pos, structure);
    if (std::string_view(structure) == "unit") ++num_units_;
  }
  void element(const char* name, std::int64_t value, std::uint64_t bit_pos) override {
    close(bit_pos);
    if (print_) std::printf("%10" PRIu64 "    %s = %" PRId64 "\n", bit_pos, name, value);
    if (std::string_view(name) == "ancillary_flag") ancillary_ = value != 0;
    if (std::string_view(name) == "unit_type") {
      unit_part_ = ancillary_ ? kAncillaryPart : part_of_unit(value);
    }
    const auto part = part_of_.find(name);
    open_part_ = part == part_of_.end() ? unit_part_ : part->second;
  }
  void close(std::uint64_t bit_pos) {
    if (bit_pos > last_) bits_[open_part_] += bit_pos - last_;
    last_ = bit_pos;
  }

  std::uint64_t bits(std::size_t part) const { return bits_[part]; }
  std::uint64_t num_units() const { return num_units_; }

 private:
  static std::size_t part_of_unit(std::int64_t unit_type) {
    switch (unit_type) {
      case 1:
        return 1;
      case 2:
        return 2;
      case 3:
        return 3;
      case 4:
        return 4;
      default:
        return kAncillaryPart;
    }
  }

  bool print_;
  std::map<std::string_view, std::size_t> part_of_;
  std::array<std::uint64_t, 11> bits_{};
  std::size_t open_part_ = 0;
  bool ancillary_ = false;
  std::size_t unit_part_ = 0;
  std::uint64_t last_ = 0;
  std::uint64_t num_units_ = 0;
};

struct Options {
  std::string input;
  bool json = false;
  bool trace = false;
};

int complain(const Options& o, const rlpc::Error& error) {
  std::cerr << "rlpcinfo: " << o.input << ": " << rlpc::describe_error(error) << "\n";
  return rlpc::exit_code(error.code);
}

struct Summary {
  const rlpc::SequenceHeader& header;
  const BitCounter& counter;
  std::uint64_t bytes;
  std::uint32_t num_gofs;
  const std::string& metadata;
};

double bpvf(const Summary& s, double bits) {
  return bits / (static_cast<double>(s.header.num_vertices) * s.header.num_frames);
}

void print_json(const Summary& s) {
  const rlpc::SequenceHeader& h = s.header;
  nlohmann::ordered_json bits = nlohmann::ordered_json::object();
  for (std::size_t p = 0; p < parts().size(); ++p) bits[parts()[p].name] = s.counter.bits(p);
  nlohmann::ordered_json json = {
      {"profile_idc", h.profile_idc},
      {"level_idc", h.level_idc},
      {"num_vertices", h.num_vertices},
      {"num_triangles", h.num_triangles},
      {"num_frames", h.num_frames},
      {"frame_rate", {h.frame_rate.numerator, h.frame_rate.denominator}},
      {"grid_log2_step", h.grid.log2_step},
      {"grid_origin", h.grid.origin},
      {"position_bits", h.position_bits},
      {"num_gofs", s.num_gofs},
      {"num_units", s.counter.num_units()},
      {"bytes", s.bytes},
      {"bpvf", bpvf(s, 8.0 * static_cast<double>(s.bytes))},
      {"bits", bits}};
  if (!s.metadata.empty()) json["metadata"] = nlohmann::json::parse(s.metadata, nullptr, false);
  std::cout << json.dump(2) << "\n";
}

void print_table(const Options& o, const Summary& s) {
  const rlpc::SequenceHeader& h = s.header;
  const double total = 8.0 * static_cast<double>(s.bytes);
  std::printf("%s: Baseline profile, level %u\n", o.input.c_str(), h.level_idc);
  std::printf("  %u vertices, %u triangles, %u frames at %u/%u per second, %u GOFs\n",
              h.num_vertices, h.num_triangles, h.num_frames, h.frame_rate.numerator,
              h.frame_rate.denominator, s.num_gofs);
  std::printf("  grid step 2^%d, positions of %d bits\n\n", h.grid.log2_step, h.position_bits);
  std::printf("  %-26s %12s %8s %10s\n", "part", "bits", "share", "bpvf");
  for (std::size_t p = 0; p < parts().size(); ++p) {
    const auto bits = static_cast<double>(s.counter.bits(p));
    if (bits == 0.0) continue;
    std::printf("  %-26s %12.0f %6.2f %% %10.4f\n", parts()[p].name.data(), bits,
                100.0 * bits / total, bpvf(s, bits));
  }
  std::printf("  %-26s %12.0f %8s %10.4f\n", "all", total, "", bpvf(s, total));
  if (!s.metadata.empty()) std::printf("\n  metadata: %s\n", s.metadata.c_str());
}

int inform(const Options& o) {
  BitCounter counter(o.trace);
  auto source = rlpc::file_source(o.input);
  if (!source) return complain(o, source.error());
  const std::uint64_t bytes = (*source)->size();
  rlpc::DecoderOptions options;
  options.trace = &counter;
  auto decoder = rlpc::Decoder::open(std::move(*source), options);
  if (!decoder) return complain(o, decoder.error());
  const auto num_gofs = decoder->parse_rest();
  if (!num_gofs) return complain(o, num_gofs.error());
  counter.close(8 * bytes);
  const Summary summary{decoder->header(), counter, bytes, *num_gofs, decoder->metadata()};
  if (o.trace) return rlpc::kExitDone;
  if (o.json) {
    print_json(summary);
  } else {
    print_table(o, summary);
  }
  return rlpc::kExitDone;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Tells what is in an .rlpc stream.", "rlpcinfo");
  app.set_version_flag("--version", "rlpcinfo " RLPC_VERSION);
  Options options;
  app.add_option("input", options.input, "Stream to look at")->required();
  auto* json = app.add_flag("--json", options.json, "JSON on standard output");
  app.add_flag("--trace", options.trace, "Print every syntax element")->excludes(json);
  app.footer(kExamples);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? rlpc::kExitDone : rlpc::kExitUsage;
  }
  return inform(options);
} catch (const std::exception& error) {
  std::fprintf(stderr, "rlpcinfo: %s\n", error.what());  // out of memory, most likely
  return rlpc::kExitLimit;
}
