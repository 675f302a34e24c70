// rlpccmp: error of a decoded animation against the original, and its rate.

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/cli/command_line.h"
#include "common/files/interrupts.h"
#include "common/files/messages.h"
#include "common/files/output_file.h"
#include "common/files/progress_bar.h"
#include "common/files/standard_output.h"
#include "common/json/json.h"
#include "conformance/rlpccmp/comparison_input.h"
#include "conformance/rlpccmp/comparison_page.h"
#include "conformance/rlpccmp/vertex_matching.h"
#include "decoder/report/mesh_view.h"
#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/metrics/surface_metrics.h"
#include "encoder/meshes/axes.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/open/open_source.h"
#include "encoder/programs/rlpcenc/report_json.h"
#include "encoder/programs/setting_options.h"

namespace {

enum ExitCode : int { kCompared = 0, kExceeded = 1, kFailed = 2, kUsage = 64 };

constexpr const char* kExamples = R"(Examples
  rlpcenc cow.obj --points cow.pc2 -o cow.rlpc --order-map cow.order
  rlpccmp cow.obj cow.rlpc --points cow.pc2 --order-map cow.order
  rlpccmp cow.obj cow.rlpc --html cow.html         if encoded with --keep-order
  rlpccmp frames/ walk.rlpc --csv errors.csv
  rlpccmp old.rlpc new.rlpc --max-kg 0.01 --quiet  a test for scripts)";

constexpr const char* kInputs = R"(A is the original, B the decoded animation. Either is one of
  clip.rlpc                       a stream: decoded, its hashes verified, its
                                  bits counted
  clip.rlpd                       decoded positions
  mesh.obj with --points-a/-b     triangles from the mesh, frames from the point
                                  cache
  clip.pc2                        the same, with the triangles of the mesh of
                                  that name next to it
  walk.glb, walk.gltf             a glTF 2.0 scene; for the original, repeat the
                                  --animation, --fps and --no-weld of rlpcenc
  folder/, f_%04d.obj, 'f_*.obj'  one mesh per frame, in numeric order
  mesh.obj                        one frame; if the other side has several and
                                  a point cache of that name is next to it, that
                                  cache is read as well, and the report mentions
                                  it
)";

// After the list of formats.
constexpr const char* kDetails = R"(
The vertices of a stream are in the order of the input only if it was encoded
with --keep-order. Otherwise pass the file that rlpcenc --order-map wrote.

Measures
  KG error  100 * ||A - B|| / ||A - E(A)||, per cent, in two norms. E(A) is the
            mean vertex of each frame of A in the KG error of rlpcenc and of
            --max-kg, or one mean of all vertices of all frames in most
            published figures, which gives the smaller number. The ratio of the
            two is a constant of A
  RMS       root mean square distance of vertices, in units of A
  PSNR      20 log10(diagonal / RMS), the diagonal of the bounding box of all
            frames of A
  PSNR of Ramanathan, Kassim and Tan 2008, 3.2
            -10 log10 of the squared error over the vertices that moved,
            relative to the largest displacement; mean over the frames
  STED      spatio-temporal edge difference of Vasa and Skala 2011, as in their
            program: with ed = (l - l') / l of an edge, the deviation of
            ed, weighted by l, from its mean over the edges that meet in a
            vertex or in its neighbours; mean over vertices and frames (spatial
            part). With s = sqrt(step^2 + dt^2) of each step of a vertex from
            frame to frame, in diagonals of A's first frame: |s - s'| relative
            to the mean of s over the steps f - 5 to f + 4; mean over vertices
            and steps (temporal part). sqrt(spatial^2 + (c * temporal)^2),
            dt = 0.0003, c = 0.00009144
  ring      edge difference in one ring, which rlpccmp up to 1.1.6 called STED:
            with ed = |l - l'| / l, over the edges that meet in a vertex; and
            the same over two virtual edges, from a vertex to itself a frame
            earlier and later, sqrt(distance^2 + (0.01 d)^2), d the diagonal of
            A's first frame. Root of the sum of squares of both
  normals   of vertices, which smooth surfaces are shaded by: sums of those of
            their triangles, weighted by area. RMS angle between A and B, and
            RMS change of that error, as a vector, from frame to frame, weighted
            by area in A. Of triangles: mean angle weighted by area, and the
            largest

Exit code: 0 compared; 1 compared, and beyond --max-kg or --max-error; 2 input
or output failed, or A and B cannot be compared; 64 wrong usage.)";

struct Options {
  rlpc::InputOptions a;
  rlpc::InputOptions b;
  std::string fps;
  std::string axes;
  std::string stream;
  std::string order_map;
  std::string csv;
  std::string html;
  std::optional<double> max_kg;
  std::optional<double> max_error;
  bool json = false;
  bool quiet = false;
};

// CLI11's check accepts NaN, which nothing exceeds.
const CLI::Validator kBound(
    [](const std::string& word) {
      double value = 0.0;
      return CLI::detail::lexical_cast(word, value) && value >= 0.0
                 ? ""
                 : "expected a number, 0 or above, found `" + word + "`";
    },
    "NUMBER");

void add_options(CLI::App& app, Options& o) {
  const std::string input = "Input";
  const std::string output = "Output";
  const std::string more = "More input";
  app.add_option("A", o.a.path, "The original animation")->required();
  app.add_option("B", o.b.path, "The decoded animation, or its stream")->required();
  const auto add_file = [&](const char* name, std::string& value, const std::string& what) {
    return app.add_option(name, value, what)->option_text("FILE");
  };
  const std::string cache =
      "Point cache (" + rlpc::extensions_text({rlpc::InputFormat::Holds::kPoints}) + ") ";
  add_file("--points-a,--points", o.a.points, cache + "with the frames of A")->group(input);
  add_file("--points-b", o.b.points, cache + "with the frames of B")->group(input);
  add_file("--order-map", o.order_map,
           "Index in A of each vertex of B, from rlpcenc --order-map")
      ->group(input);
  add_file("--stream", o.stream, "The .rlpc file that B was decoded from, for the rate")
      ->check(CLI::ExistingFile)
      ->group(input);
  add_file("--csv", o.csv, "Write the errors of each frame; - for standard output")
      ->group(output);
  add_file("--html", o.html, "Write a page with charts, and the error in colour on the mesh")
      ->group(output);
  app.add_option("--max-kg", o.max_kg, "Exit code 1 if the KG error is larger")
      ->check(kBound)
      ->option_text("PERCENT")
      ->group(output);
  app.add_option("--max-error", o.max_error,
                 "Exit code 1 if the largest vertex error is larger, in units of A")
      ->check(kBound)
      ->option_text("DISTANCE")
      ->group(output);
  app.add_flag("--json", o.json, "Report as JSON on standard output")->group(output);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(output);

  app.add_option(
         "--animation-a,--animation", o.a.animations,
         "If A is a glTF file: name, index from 0, or `all`; may be repeated (default: first)")
      ->option_text("NAME")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(more);
  app.add_option("--animation-b", o.b.animations, "The same for B")
      ->option_text("NAME")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group(more);
  app.add_option("--axes-a,--axes", o.axes, "Axes of A, as for rlpcenc --axes")
      ->option_text("X,Y,Z")
      ->group(more);
  app.add_option("--fps", o.fps, "Frame rate of glTF files (default: as in rlpcenc)")
      ->option_text("RATE")
      ->group(more);
  app.add_flag_callback(
         "--no-weld-a,--no-weld", [&o] { o.a.weld = false; },
         "If A is a glTF file: keep vertices that coincide in every frame apart")
      ->group(more);
  app.add_flag_callback(
         "--no-weld-b", [&o] { o.b.weld = false; }, "The same for B")
      ->group(more);
  app.add_option(
         "--max-memory", o.a.max_memory_bytes,
         "Refuse input that needs more, for example 500MB (1 MB: 1000 * 1000 bytes; 1 MiB: "
         "1024 * 1024; default: 32GiB; streams: 4GiB)")
      ->transform(CLI::AsSizeValue(true))
      ->option_text("SIZE")
      ->group(more);
  rlpc::add_help(
      app,
      {"A B [OPTIONS]", {input, output}, kExamples, kInputs + rlpc::formats_text() + kDetails},
      RLPC_VERSION);
}

int complain(const std::string& message) {
  rlpc::print_message("rlpccmp", rlpc::with_encoder_options(message));
  return kFailed;
}

// Feeds frames in the vertex order of A, as the encoder does. `view`: receives the frames that
// it shows; null: none.
rlpc::InputResult<rlpc::Distortion> compare(const rlpc::ComparisonPair& pair,
                                            const std::vector<std::uint32_t>& map,
                                            rlpc::MeshView* view, bool progress) {
  rlpc::FrameSource& a = *pair.a.frames;
  rlpc::FrameSource& b = *pair.b.frames;
  const std::size_t values = 3 * std::size_t{a.num_vertices()};
  std::vector<double> exact(values);
  std::vector<double> exact_b(values);
  // Where A has floats, those of B are compared with them.
  const bool are_finer = a.is_finer_than_floats() && b.is_finer_than_floats();
  std::vector<float> original(values);
  std::vector<float> decoded(values);
  std::vector<float> in_order(values);
  rlpc::MetricsAccumulator metrics(a.num_vertices());
  rlpc::SurfaceAccumulator surface(a.num_vertices(), a.triangles());
  bool is_rounding = true;
  rlpc::ProgressBar bar("comparing", progress);
  for (std::uint32_t f = 0; f < a.num_frames(); ++f) {
    if (auto error = a.read_frame(f, original)) return *error;
    if (auto error = a.read_exact(f, exact)) return *error;
    if (auto error = b.read_frame(f, decoded)) return *error;
    if (are_finer) {
      if (auto error = b.read_exact(f, exact_b)) return *error;
    }
    for (std::size_t v = 0; v < map.size(); ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = 3 * std::size_t{map[v]} + c;
        in_order[at] = decoded[3 * v + c];
        is_rounding = is_rounding && in_order[at] == original[at];
        // Rounding of B's numbers to floats is no difference between A and B.
        if (are_finer) exact[at] -= exact_b[3 * v + c] - static_cast<double>(in_order[at]);
      }
    }
    metrics.add_frame(std::span<const double>(exact), in_order);
    surface.add_frame(original, in_order);
    if (view != nullptr && view->shows(f)) view->add_frame(original, in_order);
    bar.show((f + 1.0) / a.num_frames());
  }
  return rlpc::Distortion{metrics.result(), surface.result(), is_rounding};
}

// Returns the shortest text that reads back as the same value.
std::string digits(double value) {
  char text[64];
  const auto [end, ec] = std::to_chars(text, text + sizeof text, value);
  return {text, ec == std::errc() ? end : text};
}

std::optional<rlpc::OutputError> write_csv(const std::string& path, const rlpc::Distortion& d) {
  std::string text =
      "frame,kg_error_percent,rms_error,max_error,max_error_vertex,diagonal_psnr_db,"
      "ramanathan_psnr_db,sted_spatial,sted_temporal,ring_edge_difference_spatial,"
      "ring_edge_difference_temporal,mean_normal_angle_degrees,max_normal_angle_degrees,"
      "vertex_normal_rms_degrees,normal_flicker_rms_degrees\n";
  for (std::size_t f = 0; f < d.metrics.frames.size(); ++f) {
    const rlpc::FrameMetrics& frame = d.metrics.frames[f];
    const rlpc::FrameSurface& surface = d.surface.frames[f];
    text += std::to_string(f) + "," + digits(rlpc::kg_error_percent(frame)) + "," +
            digits(frame.rms_error) + "," + digits(frame.max_error) + "," +
            std::to_string(frame.max_error_vertex) + "," + digits(frame.diagonal_psnr_db) +
            "," + digits(frame.ramanathan_psnr_db) + "," + digits(surface.sted_spatial) + "," +
            digits(surface.sted_temporal) + "," + digits(surface.ring_spatial) + "," +
            digits(surface.ring_temporal) + "," + digits(surface.mean_normal_angle) + "," +
            digits(surface.max_normal_angle) + "," + digits(surface.vertex_normals) + "," +
            digits(surface.normal_flicker) + "\n";
  }
  auto file = rlpc::OutputFile::create(path);
  if (!file) return file.error();
  return rlpc::write_and_commit(*file, text);
}

struct Rate {
  std::uint64_t bytes = 0;  // 0: unknown
  double bpvf = 0.0;
};

void print_json(const rlpc::ComparisonPair& pair, const Rate& rate, const rlpc::Distortion& d) {
  nlohmann::ordered_json json = {{"a", pair.a.name},
                                 {"b", pair.b.name},
                                 {"num_vertices", pair.a.frames->num_vertices()},
                                 {"num_frames", pair.a.frames->num_frames()}};
  if (rate.bytes > 0) {
    json["bytes"] = rate.bytes;
    json["bpvf"] = rate.bpvf;
  }
  json["metrics"] = rlpc::metrics_json(d.metrics);
  json["surface"] = rlpc::surface_json(d.surface);
  std::cout << rlpc::json_text(json, 2) << "\n";
}

void print_report(const rlpc::ComparisonPair& pair, const Rate& rate,
                  const rlpc::Distortion& d) {
  const rlpc::Metrics& m = d.metrics;
  const rlpc::FrameSource& a = *pair.a.frames;
  std::printf("A  %s\nB  %s\n   %s, %s\n", rlpc::printable(pair.a.name).c_str(),
              rlpc::printable(pair.b.name).c_str(),
              rlpc::count_text(a.num_vertices(), "vertex", "vertices").c_str(),
              rlpc::count_text(a.num_frames(), "frame").c_str());
  if (rate.bytes > 0) {
    std::printf("  rate      %.4f bits per vertex and frame (%llu bytes)\n", rate.bpvf,
                static_cast<unsigned long long>(rate.bytes));
  }
  std::printf("  KG error  %.4g %%, mean of each frame; %.4g %%, one mean of all frames\n",
              m.kg_error_percent, m.kg_sequence_error_percent);
  std::printf("  RMS       %.6g (%.4f %% of the diagonal)\n", m.rms_error, m.rms_error_percent);
  std::printf("  largest   %.6g (%.4f %% of the diagonal), frame %u, vertex %u\n", m.max_error,
              m.max_error_percent, m.max_error_frame, m.max_error_vertex);
  if (m.max_error > 0 && d.is_rounding) {
    std::printf(
        "  rounding  is the only error: each number of B is the float nearest to A's\n");
  }
  if (m.max_error > 0) {
    std::printf("  PSNR      %.2f dB of the diagonal; %.2f dB, Ramanathan's, mean of frames\n",
                m.diagonal_psnr_db, m.ramanathan_psnr_db);
  } else {
    std::printf("  PSNR      infinite: every frame is exact\n");
  }
  const rlpc::SurfaceMetrics& s = d.surface;
  if (s.has_sted) {
    std::printf("  STED      %.6g (spatial part %.6g, temporal part %.6g)\n", s.sted,
                s.sted_spatial, s.sted_temporal);
  } else {
    std::printf(
        "  STED      none: it divides by the size of the first frame, which is a point\n");
  }
  std::printf("  ring      %.6g, edge difference in one ring (spatial %.6g, temporal %.6g)\n",
              s.ring_difference, s.ring_spatial, s.ring_temporal);
  std::printf("  normals   of vertices: RMS deviation %.4g degrees, RMS flicker %.4g\n",
              s.vertex_normals, s.normal_flicker);
  std::printf(
      "            of triangles: mean deviation %.4g degrees, largest %.4g, frame %u, triangle "
      "%u\n",
      s.mean_normal_angle, s.max_normal_angle, s.max_normal_frame, s.max_normal_triangle);
}

int check_gates(const Options& o, const rlpc::Metrics& m) {
  int code = kCompared;
  const auto gate = [&](const char* name, double value, const std::optional<double>& limit) {
    if (!limit || value <= *limit) return;
    complain(name + digits(value) + " is above " + digits(*limit));
    code = kExceeded;
  };
  gate("KG error ", m.kg_error_percent, o.max_kg);
  gate("largest error ", m.max_error, o.max_error);
  return code;
}

constexpr const char* kWrittenOver =
    ": is also an input or the other output; choose another name";

std::optional<std::string> written_over(const Options& o,
                                        const std::vector<std::string>& read) {
  for (const std::string& written : {o.csv, o.html}) {
    for (const std::string& file : read) {
      if (rlpc::OutputFile::is_same_file(written, file)) return written + kWrittenOver;
    }
  }
  return std::nullopt;
}

// Outputs that would overwrite a file that is used, or mix with another.
std::optional<std::string> check_places(const Options& o) {
  if (o.csv == "-" && o.json) return "--json and --csv cannot both go to standard output";
  if (o.html == "-" && (o.json || o.csv == "-")) {
    return "--html and another output cannot both go to standard output";
  }
  if (rlpc::OutputFile::is_same_file(o.csv, o.html)) return o.csv + kWrittenOver;
  return written_over(o, {o.a.path, o.a.points, o.b.path, o.b.points, o.stream, o.order_map});
}

int run(Options& o) {
  if (const auto wrong = check_places(o)) return complain(*wrong), kUsage;
  if (!o.axes.empty()) {
    const auto axes = rlpc::parse_axes(o.axes);
    if (!axes) return complain("--axes: " + axes.error().message), kUsage;
    o.a.axes = *axes;
  }
  if (!o.fps.empty()) {
    const auto rate = rlpc::parse_frame_rate(o.fps);
    if (!rate) return complain("--fps: " + rate.error().message), kUsage;
    o.a.frame_rate = o.b.frame_rate = *rate;
  }
  o.b.max_memory_bytes = o.a.max_memory_bytes;
  const auto pair = rlpc::open_comparison_pair(o.a, o.b);
  if (!pair) return complain(pair.error().message);
  for (const auto* side : {&pair->a, &pair->b}) {
    if (const auto wrong = written_over(o, side->frames->files()))
      return complain(*wrong), kUsage;
  }
  if (!o.fps.empty() && !rlpc::has_clips(o.a) && !rlpc::has_clips(o.b)) {
    return complain("--fps: neither A nor B is a glTF file"), kUsage;
  }
  const auto map = rlpc::match_vertices(*pair, o.order_map);
  if (!map) return complain(map.error().message);
  Rate rate{pair->b.stream_bytes, 0.0};
  if (!o.stream.empty()) {
    std::error_code ec;
    rate.bytes = std::filesystem::file_size(o.stream, ec);
    if (ec) return complain(o.stream + ": " + ec.message());
  }
  rate.bpvf = rlpc::bits_per_vertex_per_frame(rate.bytes, pair->a.frames->num_vertices(),
                                              pair->a.frames->num_frames());
  const rlpc::FrameSource& a = *pair->a.frames;
  std::optional<rlpc::OutputFile> page;
  std::optional<rlpc::MeshView> view;
  if (!o.html.empty()) {
    auto file = rlpc::OutputFile::create(o.html);
    if (!file) return complain(file.error().message);
    page.emplace(std::move(*file));
    view.emplace(a.num_vertices(), a.num_frames(), a.triangles(), a.frame_rate());
  }
  const auto distortion = compare(*pair, *map, view ? &*view : nullptr, !o.quiet);
  if (!distortion) return complain(distortion.error().message);
  if (!o.csv.empty()) {
    if (const auto error = write_csv(o.csv, *distortion)) return complain(error->message);
  }
  if (page) {
    const std::string stream =
        o.stream.empty() && pair->b.stream_bytes > 0 ? o.b.path : o.stream;
    const auto text = rlpc::comparison_page_text({*pair, *distortion, *view, stream});
    if (!text) return complain(text.error().message);
    if (const auto error = rlpc::write_and_commit(*page, *text))
      return complain(error->message);
  }
  if (o.json) {
    print_json(*pair, rate, *distortion);
  } else if (!o.quiet && o.csv != "-" && o.html != "-") {
    print_report(*pair, rate, *distortion);
  }
  return check_gates(o, distortion->metrics);
}

}  // namespace

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  CLI::App app("Compares a decoded animation with its original.", "rlpccmp");
  Options options;
  add_options(app, options);
  if (const auto code = rlpc::parse_command_line(app, argc, argv)) return *code;
  return rlpc::after_standard_output("rlpccmp", run(options), kFailed);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpccmp: out of memory\n");
  return kFailed;
} catch (const std::exception& error) {
  rlpc::print_message("rlpccmp", error.what());
  return kFailed;
}
