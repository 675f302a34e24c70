// peer_codec: encodes and decodes with other codecs, for scripts/compare.

#include <CLI/CLI.hpp>
#include <algorithm>
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
#include <vector>

#include "conformance/peers/byte_stream.h"
#include "conformance/peers/peer_codecs.h"
#include "encoder/input/frame_source.h"

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
  InputOptions source;  // of convert
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

// A point cache, and the triangles in an OBJ file beside it.
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

// The vertex order that the decoder of `codec` gives.
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

CLI::App* add_verb(CLI::App& app, Options& o, const std::string& name,
                   const std::string& what) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->add_option("codec", o.codec)->required()->check(CLI::IsMember(kCodecs));
  if (name == "decode") {
    verb->add_option("input", o.input, "Encoded file")->required();
    verb->add_option("--order-map", o.order_map, "Restore the order of the input by this file");
  } else {
    verb->add_option("mesh", o.mesh, "Triangles, as OBJ")->required();
    verb->add_option("points", o.points, "Positions, as PC2")->required();
  }
  if (name == "encode") {
    verb->add_option("--bits", o.bits, "Bits of a coordinate")->check(CLI::Range(2, 16));
  }
  verb->add_option("-o,--output", o.output)->required();
  return verb;
}

CLI::App* add_convert(CLI::App& app, Options& o) {
  CLI::App* verb = app.add_subcommand(
      "convert", "Write any input of rlpcenc as OUT.pc2, with OUT.obj beside it");
  verb->add_option("input", o.source.path)->required();
  verb->add_option("--points", o.source.points, "Point cache with the frames");
  verb->add_option("--animation", o.source.animation,
                   "If the input is glTF: name, index or `all`");
  verb->add_option("--fps", o.frame_rate, "Frame rate of glTF files");
  verb->add_flag("!--no-weld", o.source.weld,
                 "If the input is glTF: keep coincident vertices apart");
  verb->add_option("-o,--output", o.output)->required();
  return verb;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Other codecs for comparisons, as far as their libraries were found at build time.",
      "peer_codec");
  Options o;
  const auto* list = app.add_subcommand("list", "List the codecs");
  const auto* encoding = add_verb(app, o, "encode", "Encode an animation");
  const auto* decoding = add_verb(app, o, "decode", "Write OUT.pc2, and OUT.obj beside it");
  const auto* converting = add_convert(app, o);
  add_verb(app, o, "order", "Write, per decoded vertex, its index in the input");
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 64;
  }
  if (list->parsed()) {
    for (const std::string& codec : kCodecs) std::cout << codec << "\n";
  } else if (encoding->parsed()) {
    encode(o);
  } else if (decoding->parsed()) {
    decode(o);
  } else if (converting->parsed()) {
    convert(o);
  } else {
    write_order(o);
  }
  return 0;
}

}  // namespace
}  // namespace rlpc::peers

int main(int argc, char** argv) try {
  return rlpc::peers::run(argc, argv);
} catch (const std::exception& error) {
  std::fprintf(stderr, "peer_codec: %s\n", error.what());
  return 2;
}
