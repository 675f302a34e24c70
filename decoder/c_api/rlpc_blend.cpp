// Blends of two frames (decoder/c_api/rlpc_pose.h).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "decoder/c_api/convert_frame.h"
#include "decoder/c_api/decoder_handle.h"
#include "decoder/c_api/frame_output.h"
#include "decoder/c_api/rlpc_pose.h"
#include "decoder/surface/attribute_values.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kSetWeight =
    RLPC_NORMAL_WEIGHT_ANGLE + 1;  // normals of the set `normal`

rlpc_status check_blend(rlpc_decoder& handle, const rlpc_blend& blend,
                        const rlpc_frame_output& output) {
  for (const std::uint32_t frame : {blend.first_frame, blend.second_frame}) {
    if (const auto status = check_frame(handle, frame); status != RLPC_OK) return status;
  }
  if (!(blend.weight >= 0 && blend.weight <= 1)) {
    return bad_output(handle, "weight: expected a number from 0 to 1");
  }
  if (output.positions.data != nullptr && output.positions.format == RLPC_FORMAT_INT32) {
    return bad_output(handle, "positions: blends have no integers (RLPC_FORMAT_INT32)");
  }
  return check_output(handle, output);
}

// Decodes a frame, unless `place` has it.
rlpc_status take_frame(rlpc_decoder& handle, BlendFrame& place, std::uint32_t frame) {
  if (place.frame == frame) return RLPC_OK;
  place.frame.reset();
  place.normals.clear();
  place.positions.resize(3 * std::size_t{handle.decoder->num_vertices()});
  const auto decoded = handle.decoder->frame(frame, place.positions);
  if (!decoded) return fail(handle, decoded.error());
  place.frame = frame;
  return RLPC_OK;
}

// Decodes the frames of a blend, which may be equal. Reuses those of the last blend.
rlpc_status take_frames(rlpc_decoder& handle, const rlpc_blend& blend) {
  auto& [first, second] = handle.blend.frames;
  const bool needs_first = blend.weight < 1;
  const bool needs_second = blend.weight > 0 && blend.second_frame != blend.first_frame;
  const bool are_swapped = (needs_first && second.frame == blend.first_frame) ||
                           (needs_second && first.frame == blend.second_frame);
  if (are_swapped) std::swap(first, second);
  if (needs_first) {
    if (const auto status = take_frame(handle, first, blend.first_frame); status != RLPC_OK)
      return status;
  }
  return needs_second ? take_frame(handle, second, blend.second_frame) : RLPC_OK;
}

void find_normals(rlpc_decoder& handle, BlendFrame& frame, std::uint32_t normals_of) {
  if (!frame.normals.empty() && frame.normals_of == normals_of) return;
  std::span<const double> sums;
  if (normals_of == kSetWeight) {
    sums = handle.drawn->normals().sums(std::span<const std::int32_t>(frame.positions));
  } else {
    sum_normals(frame.positions, handle.decoder->triangles(),
                normals_of == RLPC_NORMAL_WEIGHT_ANGLE, handle.normal_sums);
    sums = handle.normal_sums;
  }
  frame.normals.resize(sums.size());
  for (std::size_t i = 0; i < sums.size(); i += 3) {
    const auto unit = unit_normal(&sums[i]);
    std::copy(unit.begin(), unit.end(), &frame.normals[i]);
  }
  frame.normals_of = normals_of;
}

void write_blend(rlpc_decoder& handle, const rlpc_frame_output& output, BlendFrame& first,
                 BlendFrame& second) {
  const SequenceHeader& header = handle.decoder->header();
  const double weight = handle.blend.weight;
  std::span<const std::uint32_t> vertices;
  if (output.split != 0) vertices = handle.drawn->vertices().stream_vertex;
  if (output.positions.data != nullptr) {
    write_mixed_positions(
        Mix<std::int32_t>{{first.positions, vertices}, {second.positions, vertices}, weight},
        header.grid, scale_of(output, header), output.positions);
  }
  if (output.normals.data == nullptr) return;
  const bool has_set = output.split != 0 && handle.drawn->has_normals();
  const std::uint32_t normals_of = has_set ? kSetWeight : output.normal_weight;
  find_normals(handle, first, normals_of);
  find_normals(handle, second, normals_of);
  if (has_set) vertices = handle.drawn->normal_of_vertex();
  write_mixed_normals(
      Mix<double>{{first.normals, vertices}, {second.normals, vertices}, weight},
      output.normals);
}

// Returns the indices of the frames with a weight; equal if there is only one.
std::pair<std::size_t, std::size_t> shown_frames(const rlpc_blend& blend) {
  if (blend.weight == 0 || blend.first_frame == blend.second_frame) return {0, 0};
  return {blend.weight < 1 ? 0 : 1, 1};
}

}  // namespace

void give_bounds(const rlpc_decoder& handle, float* min, float* max) {
  const Blend& blend = handle.blend;
  const auto& first = blend.frames[blend.shown[0]].positions;
  const auto& second = blend.frames[blend.shown[1]].positions;
  const Mix<std::int32_t> mix{{first, {}}, {second, {}}, blend.weight};
  for (std::size_t c = 0; c < 3; ++c) {
    double low = mix.at(0, c);
    double high = low;
    for (std::size_t v = 1; v < first.size() / 3; ++v) {
      low = std::min(low, mix.at(v, c));
      high = std::max(high, mix.at(v, c));
    }
    const Grid& grid = handle.decoder->header().grid;
    min[c] = float_position(grid, c, low);
    max[c] = float_position(grid, c, high);
  }
}

}  // namespace rlpc

void rlpc_blend_init(rlpc_blend* blend, size_t struct_size) {
  rlpc::give_struct(rlpc_blend{}, blend, struct_size);
}

rlpc_status rlpc_decoder_blend(rlpc_decoder* decoder, const rlpc_blend* blend,
                               const rlpc_frame_output* output) {
  return rlpc::guarded(decoder, [&] {
    rlpc_blend ours{};
    if (blend == nullptr || !rlpc::take_struct(blend, ours)) {
      return rlpc::bad_output(*decoder, "blend is not initialised (rlpc_blend_init)");
    }
    rlpc_frame_output wanted{};
    if (output == nullptr || !rlpc::take_struct(output, wanted)) {
      return rlpc::bad_output(*decoder, "output is not initialised (rlpc_frame_output_init)");
    }
    if (const auto status = rlpc::check_blend(*decoder, ours, wanted); status != RLPC_OK) {
      return status;
    }
    decoder->has_frame = false;
    if (const auto status = rlpc::take_frames(*decoder, ours); status != RLPC_OK) {
      return status;
    }
    decoder->error.clear();
    const auto [first, second] = rlpc::shown_frames(ours);
    decoder->blend.shown = {first, second};
    decoder->blend.weight = first == second ? 0 : ours.weight;
    decoder->blend.is_shown = true;
    decoder->has_frame = true;
    rlpc::write_blend(*decoder, wanted, decoder->blend.frames[first],
                      decoder->blend.frames[second]);
    return RLPC_OK;
  });
}
