// peer_codec: encodes and decodes with other codecs, for scripts/compare.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/cli/command_line.h"
#include "common/files/messages.h"
#include "conformance/studies/peers/byte_stream.h"
#include "conformance/studies/peers/peer_codecs.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/open/open_source.h"
#include "encoder/programs/setting_options.h"

namespace rlpc::peers {
namespace {

struct Options {
  std::string codec;
  std::string mesh;
  std::string points;
  std::string input;
  std::string output;
  std::string order_map;
  std::string frame_rate;
  InputOptions source;  // convert only
  int bits = 12;
};

const std::vector<std::string> kCodecs = {
    "lorenzo",
#ifdef RLPC_MESHOPTIMIZER
    "meshopt",
#endif
#ifdef RLPC_ZFP
    "zfp",
#endif
#ifdef RLPC_DRACO
    "draco",
#endif
};

Animation read_animation(const InputOptions& input) {
  auto source = open_frame_source(input);
  if (!source) throw std::runtime_error(source.error().message);
  Animation out{(*source)->num_vertices(), (*source)->triangles(), {}};
  out.frames.resize((*source)->num_frames());
  for (std::uint32_t f = 0; f < out.frames.size(); ++f) {
    out.frames[f].resize(3 * std::size_t{out.num_vertices});
    if (auto error = (*source)->read_frame(f, out.frames[f])) {
      throw std::runtime_error(error->message);
    }
  }
  return out;
}

Bytes read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in) throw std::runtime_error(path + ": cannot be read");
  return std::move(bytes).str();
}

void write_file(const std::string& path, std::string_view bytes) {
  std::ofstream out(path, std::ios::binary);
  out << bytes << std::flush;
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

// Writes a point cache, and the triangles in an OBJ file next to it.
void write_animation(const std::string& path, const Animation& animation) {
  std::ostringstream obj;
  obj.precision(9);
  for (std::size_t i = 0; i < animation.frames[0].size(); ++i) {
    obj << (i % 3 == 0 ? "v " : " ") << animation.frames[0][i] << (i % 3 == 2 ? "\n" : "");
  }
  for (const Triangle& t : animation.triangles) {
    obj << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  write_file(std::filesystem::path(path).replace_extension(".obj").string(), obj.str());
  ByteWriter cache;
  cache.raw(std::string_view("POINTCACHE2\0", 12));
  cache.u32(1);
  cache.u32(animation.num_vertices);
  cache.f32(0.0F);
  cache.f32(1.0F);
  cache.u32(static_cast<std::uint32_t>(animation.frames.size()));
  for (const auto& frame : animation.frames) {
    for (const float value : frame) cache.f32(value);
  }
  write_file(path, cache.take());
}

// Moves each vertex of `decoded` to index order[decoded vertex].
Animation reordered(const Animation& decoded, const std::vector<std::uint32_t>& order) {
  Animation out = decoded;
  out.num_vertices = 1 + *std::max_element(order.begin(), order.end());
  for (std::size_t f = 0; f < out.frames.size(); ++f) {
    out.frames[f].assign(3 * std::size_t{out.num_vertices}, 0.0F);
    for (std::size_t i = 0; i < decoded.frames[f].size(); ++i) {
      out.frames[f][3 * std::size_t{order.at(i / 3)} + i % 3] = decoded.frames[f][i];
    }
  }
  for (Triangle& t : out.triangles) {
    for (std::uint32_t& v : t) v = order.at(v);
  }
  return out;
}

std::vector<std::uint32_t> read_order(const std::string& path) {
  std::istringstream in(read_file(path));
  return {std::istream_iterator<std::uint32_t>(in), {}};
}

Animation read_animation(const Options& o) {
  return read_animation(InputOptions{o.mesh, o.points, std::nullopt});
}

// Nine digits in OUT.obj and floats in OUT.pc2 keep every coordinate exactly.
void convert(const Options& o) {
  InputOptions input = o.source;
  if (!o.frame_rate.empty()) {
    const auto rate = parse_frame_rate(o.frame_rate);
    if (!rate) throw std::runtime_error("--fps: " + rate.error().message);
    input.frame_rate = *rate;
  }
  if (auto error = check_gltf_options(input)) throw std::runtime_error(error->message);
  write_animation(o.output, read_animation(input));
}

void encode(const Options& o) {
  const Animation animation = read_animation(o);
#ifdef RLPC_DRACO
  if (o.codec == "draco") return write_file(o.output, write_draco(animation, o.bits));
#endif
#ifdef RLPC_ZFP
  if (o.codec == "zfp") return write_file(o.output, write_zfp(animation, o.bits));
#endif
  const QuantisedAnimation quantised = quantise(animation, o.bits);
#ifdef RLPC_MESHOPTIMIZER
  if (o.codec == "meshopt") return write_file(o.output, write_meshopt(quantised));
#endif
  write_file(o.output, write_lorenzo(quantised));
}

Animation decode_file(const Options& o) {
  const Bytes bytes = read_file(o.input);
#ifdef RLPC_DRACO
  if (o.codec == "draco") return read_draco(bytes);
#endif
#ifdef RLPC_ZFP
  if (o.codec == "zfp") return read_zfp(bytes);
#endif
#ifdef RLPC_MESHOPTIMIZER
  if (o.codec == "meshopt") return dequantise(read_meshopt(bytes));
#endif
  return dequantise(read_lorenzo(bytes));
}

void decode(const Options& o) {
  const Animation decoded = decode_file(o);
  write_animation(o.output,
                  o.order_map.empty() ? decoded : reordered(decoded, read_order(o.order_map)));
}

// Writes the vertex order that the decoder of `codec` outputs.
void write_order(const Options& o) {
  const Animation animation = read_animation(o);
  std::vector<std::uint32_t> order(animation.num_vertices);
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
#ifdef RLPC_DRACO
  if (o.codec == "draco") order = draco_order(animation);
#endif
  std::string text;
  for (const std::uint32_t v : order) text += std::to_string(v) + "\n";
  write_file(o.output, text);
}

constexpr const char* kMain = "Options";

void add_output(CLI::App& app, Options& o, const char* what) {
  app.add_option("-o,--output", o.output, what)->required()->option_text("FILE")->group(kMain);
}

void add_codec(CLI::App& app, Options& o) {
  app.add_option("CODEC", o.codec, CLI::detail::join(kCodecs, ", "))
      ->required()
      ->check(CLI::IsMember(kCodecs).description(""));
}

void add_animation(CLI::App& app, Options& o) {
  app.add_option("MESH", o.mesh, "Triangles, as OBJ")->required();
  app.add_option("POINTS", o.points, "Positions, as PC2")->required();
}

void add_encode(CLI::App& app, Options& o) {
  add_codec(app, o);
  add_animation(app, o);
  app.add_option("--bits", o.bits, "Bits of a coordinate, 2 to 16 (default: 12)")
      ->check(CLI::Range(2, 16))
      ->option_text("N")
      ->group(kMain);
  add_output(app, o, "Encoded file to write");
}

void add_decode(CLI::App& app, Options& o) {
  add_codec(app, o);
  app.add_option("INPUT", o.input, "Encoded file")->required();
  app.add_option("--order-map", o.order_map, "Restore the order of the input by this file")
      ->option_text("FILE")
      ->group(kMain);
  add_output(app, o, "Point cache (.pc2) to write, with an OBJ file next to it");
}

void add_order(CLI::App& app, Options& o) {
  add_codec(app, o);
  add_animation(app, o);
  add_output(app, o, "Text to write");
}

void add_convert(CLI::App& app, Options& o) {
  app.add_option("INPUT", o.source.path, "Any input of rlpcenc")->required();
  app.add_option("--points", o.source.points, "Point cache with the frames")
      ->option_text("FILE")
      ->group(kMain);
  app.add_option("--animation", o.source.animations,
                 "If the input is glTF: name, index or `all`; may be repeated")
      ->option_text("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(kMain);
  app.add_option("--fps", o.frame_rate, "Frame rate of glTF files")
      ->option_text("RATE")
      ->group(kMain);
  app.add_flag_callback(
         "--no-weld", [&o] { o.source.weld = false; },
         "If the input is glTF: keep coincident vertices apart")
      ->group(kMain);
  add_output(app, o, "Point cache (.pc2) to write, with an OBJ file next to it");
}

void list(const Options& /*o*/) {
  for (const std::string& codec : kCodecs) std::cout << codec << "\n";
}

struct Verb {
  const char* name;
  const char* usage;
  const char* what;
  void (*add)(CLI::App& app, Options& o);
  void (*run)(const Options& o);
};
constexpr std::array<Verb, 5> kVerbs{{
    {"list", "", "Lists the codecs.", [](CLI::App&, Options&) {}, list},
    {"encode", "CODEC MESH POINTS -o FILE [OPTIONS]", "Encodes an animation.", add_encode,
     encode},
    {"decode", "CODEC INPUT -o OUT.pc2 [OPTIONS]", "Writes OUT.pc2 and OUT.obj.", add_decode,
     decode},
    {"order", "CODEC MESH POINTS -o FILE",
     "Writes, per decoded vertex, its index in the input.", add_order, write_order},
    {"convert", "INPUT -o OUT.pc2 [OPTIONS]",
     "Writes any input of rlpcenc as OUT.pc2 and OUT.obj.", add_convert, convert},
}};

std::string verb_list() {
  std::string text = "Verbs (peer_codec VERB --help)";
  for (const Verb& verb : kVerbs) {
    text += "\n  " + (verb.name + std::string(24, ' ')).substr(0, 24) + verb.what;
  }
  return text;
}

constexpr const char* kDetails = "Exit code: 0 done; 2 input or output failed; 64 wrong usage.";

int run(int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "";
  const auto verb =
      std::find_if(kVerbs.begin(), kVerbs.end(), [&](const Verb& v) { return v.name == word; });
  if (verb == kVerbs.end()) {
    CLI::App app(
        "Other codecs, for comparisons; those whose libraries were found at build time.",
        "peer_codec");
    std::vector<std::string> words;
    app.add_option("VERB", words, "What to do")->required();
    add_help(app, {"VERB ...", {}, verb_list(), kDetails}, RLPC_VERSION);
    if (const auto code = parse_command_line(app, argc, argv)) return *code;
    print_message("peer_codec", "unknown verb " + words[0] + "; --help lists them");
    return 64;
  }
  Options o;
  CLI::App app(verb->what, "peer_codec " + std::string(verb->name));
  verb->add(app, o);
  add_help(app, {verb->usage, {kMain}, verb_list(), kDetails}, RLPC_VERSION);
  if (const auto code = parse_command_line(app, argc - 1, argv + 1)) return *code;
  verb->run(o);
  return 0;
}

}  // namespace
}  // namespace rlpc::peers

int main(int argc, char** argv) try {
  return rlpc::peers::run(argc, argv);
} catch (const std::exception& error) {
  const std::string message = rlpc::with_encoder_options(error.what());
  std::fprintf(stderr, "peer_codec: %s\n", message.c_str());
  return 2;
}
