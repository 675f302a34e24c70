// The functions called from JavaScript (stream_decoder.js): a StreamPlayer behind a pointer.
// Memory returned by a function belongs to the player and is valid until the next call of that
// function.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/bitstream/crc32.h"
#include "decoder/describe_error.h"
#include "decoder/player/stream_player.h"
#include "decoder/tools/exit_code.h"

#define RLPC_EXPORT(name) extern "C" [[clang::export_name(#name)]]

// Copies bytes of a stream from the page.
extern "C" [[clang::import_module("player"), clang::import_name("read_stream")]] void
read_stream(std::uint32_t stream, double offset, std::uint8_t* out, std::uint32_t num_bytes);

namespace rlpc {
namespace {

class PageSource final : public ByteSource {
 public:
  PageSource(std::uint32_t stream, std::uint64_t num_bytes)
      : stream_(stream), num_bytes_(num_bytes) {}
  std::uint64_t size() const override { return num_bytes_; }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > num_bytes_ || out.size() > num_bytes_ - offset) return false;
    read_stream(stream_, static_cast<double>(offset), out.data(),
                static_cast<std::uint32_t>(out.size()));
    return true;
  }

 private:
  std::uint32_t stream_;
  std::uint64_t num_bytes_;
};

std::unique_ptr<ByteSource> page_source(std::uint32_t stream, std::uint64_t num_bytes) {
  return std::make_unique<PageSource>(stream, num_bytes);
}

// A player, and the last results computed for the page.
struct Page {
  StreamPlayer player;
  std::string text;
  std::vector<PackedNormal> normals;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<float> distances;
  Box box;
  Deviation deviation;
};

// The header as JSON, with the names of the syntax elements.
std::string describe(const SequenceHeader& h) {
  const auto member = [](const char* name, std::int64_t value) {
    return "\"" + std::string(name) + "\":" + std::to_string(value) + ",";
  };
  return "{" + member("profile_idc", h.profile_idc) + member("level_idc", h.level_idc) +
         member("num_vertices", h.num_vertices) + member("num_triangles", h.num_triangles) +
         member("num_frames", h.num_frames) + member("position_bits", h.position_bits) +
         member("frame_rate_numerator", h.frame_rate.numerator) +
         member("frame_rate_denominator", h.frame_rate.denominator) +
         "\"grid_log2_step\":" + std::to_string(h.grid.log2_step) + "}";
}

}  // namespace
}  // namespace rlpc

using rlpc::Page;

RLPC_EXPORT(player_new) Page* player_new(std::uint32_t stream, double num_bytes) {
  return new Page{
      rlpc::StreamPlayer(rlpc::page_source, stream, static_cast<std::uint64_t>(num_bytes)),
      {},
      {},
      {},
      {},
      {},
      {}};
}

RLPC_EXPORT(player_open) bool player_open(Page* page) { return page->player.open(); }

RLPC_EXPORT(player_describe) const char* player_describe(Page* page) {
  rlpc::SequenceHeader header = page->player.decoder().header();
  header.num_frames = page->player.decoder().num_frames().value_or(1);
  page->text = rlpc::describe(header);
  return page->text.c_str();
}

// Uses the drawing coordinates of another stream.
RLPC_EXPORT(player_place_in) void player_place_in(Page* page, const Page* other) {
  page->player.set_placement(
      rlpc::placement_in(page->player.decoder().header(), other->player.decoder().header()));
}

RLPC_EXPORT(player_decode) bool player_decode(Page* page, std::uint32_t frame) {
  return page->player.decode(frame);
}

RLPC_EXPORT(player_finish) bool player_finish(Page* page) { return page->player.finish(); }

RLPC_EXPORT(player_hash_differs) bool player_hash_differs(const Page* page) {
  return page->player.hash_differs();
}

RLPC_EXPORT(player_compared_frames) std::uint32_t player_compared_frames(const Page* page) {
  return page->player.compared_frames();
}

RLPC_EXPORT(player_error_text) const char* player_error_text(Page* page) {
  page->text = rlpc::describe_error(page->player.error());
  return page->text.c_str();
}

RLPC_EXPORT(player_error_rule) const char* player_error_rule(const Page* page) {
  return page->player.error().rule;
}

RLPC_EXPORT(player_error_code) std::int32_t player_error_code(const Page* page) {
  return rlpc::exit_code(page->player.error().code);
}

RLPC_EXPORT(player_triangles) const std::uint32_t* player_triangles(const Page* page) {
  const auto triangles = page->player.decoder().triangles();
  return triangles.empty() ? nullptr : triangles.front().data();
}

RLPC_EXPORT(player_positions) const std::int32_t* player_positions(const Page* page) {
  return page->player.positions().data();
}

RLPC_EXPORT(player_coordinates) const float* player_coordinates(const Page* page) {
  return page->player.coordinates().data();
}

// Three doubles: the origin of the coordinates and of the box.
RLPC_EXPORT(player_centre) const double* player_centre(const Page* page) {
  return page->player.centre().data();
}

// The hash of 9.7.2 of the frame in output order.
RLPC_EXPORT(player_frame_crc) std::uint32_t player_frame_crc(const Page* page) {
  return rlpc::crc32_of_positions(page->player.positions());
}

RLPC_EXPORT(player_box) const float* player_box(Page* page) {
  page->box = rlpc::box_of(page->player.coordinates());
  return page->box.least.data();
}

RLPC_EXPORT(player_normals) const rlpc::PackedNormal* player_normals(Page* page) {
  rlpc::vertex_normals(page->player.coordinates(), page->player.decoder().triangles(),
                       page->normals);
  return page->normals.data();
}

RLPC_EXPORT(player_num_edges) std::uint32_t player_num_edges(Page* page) {
  page->edges = rlpc::drawn_edges(page->player.decoder().triangles());
  return static_cast<std::uint32_t>(page->edges.size());
}

// To be called after player_num_edges.
RLPC_EXPORT(player_edges) const std::uint32_t* player_edges(const Page* page) {
  return page->edges.empty() ? nullptr : page->edges.front().data();
}

RLPC_EXPORT(player_distances)
const float* player_distances(Page* page, const Page* reference) {
  const rlpc::Vec3d& centre = page->player.centre();
  const rlpc::Vec3d& other = reference->player.centre();
  page->deviation = rlpc::vertex_distances(
      page->player.coordinates(), reference->player.coordinates(),
      {centre[0] - other[0], centre[1] - other[1], centre[2] - other[2]}, page->distances);
  return page->distances.data();
}

// To be called after player_distances.
RLPC_EXPORT(player_largest_distance) float player_largest_distance(const Page* page) {
  return page->deviation.largest;
}

RLPC_EXPORT(player_rms_distance) float player_rms_distance(const Page* page) {
  return page->deviation.root_mean_square;
}
