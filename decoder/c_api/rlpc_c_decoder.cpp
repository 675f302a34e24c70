#include "decoder/c_api/rlpc_c_decoder.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/c_api/c_handle.h"
#include "common/files/clip_time.h"
#include "decoder/c_api/decoder_handle.h"
#include "decoder/describe_error.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

class CallersMemory final : public ByteSource {
 public:
  CallersMemory(const void* bytes, std::size_t size)
      : bytes_(static_cast<const std::uint8_t*>(bytes)), size_(size) {}
  std::uint64_t size() const override { return size_; }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > size_ || out.size() > size_ - offset) return false;
    if (!out.empty()) std::memcpy(out.data(), bytes_ + offset, out.size());
    return true;
  }

 private:
  const std::uint8_t* bytes_;
  std::size_t size_;
};

class CallersSource final : public ByteSource {
 public:
  explicit CallersSource(const rlpc_source& source) : source_(source) {}
  std::uint64_t size() const override { return source_.size; }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > source_.size || out.size() > source_.size - offset) return false;
    return out.empty() || source_.read(source_.user, offset, out.data(), out.size()) == 0;
  }

 private:
  rlpc_source source_;
};

#ifdef RLPC_OWNED_MEMORY
constexpr bool kHasNoOwners = false;
#else
constexpr bool kHasNoOwners = true;
#endif
constexpr std::uint64_t kUsualCachedBytes = std::uint64_t{64} << 20;

rlpc_decode_options default_options() {
  const DecoderOptions usual;
  rlpc_decode_options options{};
  options.struct_size = sizeof options;
  options.max_vertices = usual.limits.max_vertices;
  options.max_triangles = usual.limits.max_triangles;
  options.max_frames = usual.limits.max_frames;
  options.verify_hashes = usual.verify_hashes ? 1 : 0;
  options.max_memory_bytes = usual.limits.max_memory_bytes;
  options.threads = usual.threads;
  options.max_components = SliceCut::kAll;
  options.max_layers = SliceCut::kAll;
  options.max_temporal_layers = SliceCut::kAll;
  options.coarse_layers = SliceCut::kAll;
  options.max_cached_bytes = kUsualCachedBytes;
  return options;
}

DecoderOptions decoder_options(const rlpc_decode_options& given) {
  DecoderOptions options;
  options.limits = {given.max_vertices, given.max_triangles, given.max_frames,
                    given.max_memory_bytes};
  options.verify_hashes = given.verify_hashes != 0;
  options.threads = given.threads;
  options.cut = {given.max_components, given.max_layers, given.max_temporal_layers};
  options.coarse_layers = given.coarse_layers;
  options.max_cached_bytes = given.max_cached_bytes;
  options.skip_damaged_units = given.skip_damaged_units != 0;
  return options;
}

// Opens a stream. make_source(limits) returns a Result<std::unique_ptr<ByteSource>>.
template <class MakeSource>
rlpc_status open(const rlpc_decode_options* given, rlpc_decoder** decoder,
                 const MakeSource& make_source) {
  rlpc_decode_options options = default_options();
  if (!take_struct(given, options)) return RLPC_BAD_ARGUMENT;
  const rlpc_allocator& from = options.allocator;
  if ((from.allocate == nullptr) != (from.release == nullptr)) return RLPC_BAD_ARGUMENT;
  const bool allocates = from.allocate != nullptr && options.place == nullptr;
  if (allocates) {
    options.place_bytes = sizeof(rlpc_decoder);
    options.place = from.allocate(from.user, sizeof(rlpc_decoder), alignof(std::max_align_t));
    if (options.place == nullptr) return RLPC_OUT_OF_MEMORY;
  }
  auto* handle = make_handle<rlpc_decoder>(options.place, options.place_bytes);
  if (handle == nullptr) {
    return options.place != nullptr ? RLPC_BAD_ARGUMENT : RLPC_OUT_OF_MEMORY;
  }
  handle->is_allocated = allocates;
  handle->owner = {from.user, from.allocate, from.release};
  *decoder = handle;
  return guarded(handle, [&] {
    if (options.threads < 1 || options.threads > kMaxThreads) {
      return handle->error.break_handle(
          RLPC_BAD_ARGUMENT, "threads: " + std::to_string(options.threads) +
                                 " is not in the range of 1 to " + std::to_string(kMaxThreads));
    }
    for (const auto& [name, value] : {std::pair{"coarse_layers", options.coarse_layers},
                                      {"max_temporal_layers", options.max_temporal_layers}}) {
      if (value > 0) continue;
      return handle->error.break_handle(
          RLPC_BAD_ARGUMENT, std::string(name) + ": 0 is not in the range of 1 to RLPC_ALL");
    }
    if (kHasNoOwners && handle->owner.allocate != nullptr) {
      return handle->error.break_handle(
          RLPC_UNSUPPORTED, "allocator: librlpc has none; use librlpcdec, the decoder alone");
    }
    const DecoderOptions ours = decoder_options(options);
    Result<std::unique_ptr<ByteSource>> source = make_source(ours.limits);
    if (!source) {
      const rlpc_status status = status_of(source.error().code);
      return handle->error.break_handle(status, describe_error(source.error()));
    }
    auto opened = Decoder::open(std::move(*source), ours);
    if (!opened) {
      const rlpc_status status = status_of(opened.error().code);
      return handle->error.break_handle(status, describe_error(opened.error()));
    }
    handle->decoder = std::move(*opened);
    return RLPC_OK;
  });
}

rlpc_status next(rlpc_decoder& handle, std::span<std::int32_t> positions) {
  const auto more = handle.decoder->next_frame(positions);
  if (!more) return fail(handle, more.error());
  handle.error.clear();
  return *more ? RLPC_OK : RLPC_END;
}

// Returns the known frames of a clip in the stream; all frames for a null clip. None, and the
// error of the handle, if it has none.
std::optional<Clip> frames_of(rlpc_decoder& handle, const rlpc_clip* clip) {
  const std::uint32_t num_frames =
      handle.decoder->num_frames().value_or(handle.decoder->header().num_frames);
  if (clip == nullptr) return Clip{"", 0, num_frames};
  if (clip->num_frames == 0 || clip->first_frame >= num_frames) {
    handle.error.set(RLPC_BAD_ARGUMENT, clip->num_frames == 0
                                            ? "the clip has no frames"
                                            : "the clip begins after the last frame");
    return std::nullopt;
  }
  return Clip{"", clip->first_frame,
              std::min(clip->num_frames, num_frames - clip->first_frame)};
}

}  // namespace
}  // namespace rlpc

void rlpc_decode_options_init(rlpc_decode_options* options, size_t struct_size) {
  rlpc::give_struct(rlpc::default_options(), options, struct_size);
}

size_t rlpc_decoder_bytes() { return sizeof(rlpc_decoder); }

rlpc_status rlpc_decoder_open_memory(const void* bytes, size_t num_bytes,
                                     const rlpc_decode_options* options,
                                     rlpc_decoder** decoder) {
  if (decoder == nullptr) return RLPC_BAD_ARGUMENT;
  *decoder = nullptr;
  if (bytes == nullptr && num_bytes > 0) return RLPC_BAD_ARGUMENT;
  return rlpc::open(
      options, decoder,
      [&](const rlpc::DecodeLimits&) -> rlpc::Result<std::unique_ptr<rlpc::ByteSource>> {
        return {std::make_unique<rlpc::CallersMemory>(bytes, num_bytes)};
      });
}

rlpc_status rlpc_decoder_open_file(const char* path, const rlpc_decode_options* options,
                                   rlpc_decoder** decoder) {
  if (decoder == nullptr) return RLPC_BAD_ARGUMENT;
  *decoder = nullptr;
  if (path == nullptr) return RLPC_BAD_ARGUMENT;
  return rlpc::open(options, decoder, [&](const rlpc::DecodeLimits& limits) {
    return rlpc::file_source(path, limits.max_memory_bytes);
  });
}

rlpc_status rlpc_decoder_open_source(const rlpc_source* source,
                                     const rlpc_decode_options* options,
                                     rlpc_decoder** decoder) {
  if (decoder == nullptr) return RLPC_BAD_ARGUMENT;
  *decoder = nullptr;
  if (source == nullptr || source->read == nullptr) return RLPC_BAD_ARGUMENT;
  return rlpc::open(
      options, decoder,
      [&](const rlpc::DecodeLimits&) -> rlpc::Result<std::unique_ptr<rlpc::ByteSource>> {
        return {std::make_unique<rlpc::CallersSource>(*source)};
      });
}

void rlpc_decoder_close(rlpc_decoder* decoder) {
  if (decoder == nullptr) return;
  const rlpc::Owner owner = decoder->owner;
  const bool is_allocated = decoder->is_allocated;
  {
    const rlpc::OwnerScope scope(owner.allocate == nullptr ? nullptr : &owner);
    rlpc::close_handle(decoder);
  }
  if (is_allocated) {
    owner.release(owner.user, decoder, sizeof(rlpc_decoder), alignof(std::max_align_t));
  }
}

const char* rlpc_decoder_error_text(const rlpc_decoder* decoder) {
  return decoder == nullptr ? "there is no decoder" : decoder->error.text();
}

rlpc_status rlpc_decoder_info(rlpc_decoder* decoder, rlpc_stream_info* info,
                              size_t struct_size) {
  return rlpc::guarded(decoder, [&] {
    if (info == nullptr || struct_size < sizeof(std::size_t)) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, "info is null, or struct_size too small");
    }
    const rlpc::SequenceHeader& h = decoder->decoder->header();
    rlpc_stream_info ours{};
    ours.profile = h.profile_idc;
    ours.level = h.level_idc;
    ours.num_vertices = decoder->decoder->num_vertices();
    ours.num_triangles = static_cast<std::uint32_t>(decoder->decoder->triangles().size());
    ours.num_frames = decoder->decoder->num_frames().value_or(0);
    ours.frame_rate_numerator = h.frame_rate.numerator;
    ours.frame_rate_denominator = h.frame_rate.denominator;
    ours.grid_log2_step = h.grid.log2_step;
    for (std::size_t c = 0; c < 3; ++c) ours.grid_origin[c] = h.grid.origin[c];
    ours.position_bits = static_cast<std::uint32_t>(h.position_bits);
    ours.has_vertex_order = decoder->decoder->has_vertex_order() ? 1 : 0;
    ours.num_layers = decoder->decoder->num_layers();
    if (ours.num_frames > 0) {
      ours.duration_seconds = rlpc::clip_seconds(h.frame_rate, ours.num_frames);
    }
    const std::int32_t farthest = std::int32_t{1} << (h.position_bits - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      ours.range_min[c] = rlpc::float_position(h.grid, c, -farthest);
      ours.range_max[c] = rlpc::float_position(h.grid, c, farthest - 1);
    }
    rlpc::give_struct(ours, info, struct_size);
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_triangles(rlpc_decoder* decoder, uint32_t* indices,
                                   size_t num_values) {
  return rlpc::guarded(decoder, [&] {
    const auto triangles = decoder->decoder->triangles();
    if (!rlpc::check_buffer(*decoder, indices, num_values, 3 * triangles.size())) {
      return RLPC_BAD_ARGUMENT;
    }
    for (const rlpc::Triangle& t : triangles) {
      for (const std::uint32_t v : t) *indices++ = v;
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_coarse_vertices(rlpc_decoder* decoder, uint32_t* indices,
                                         size_t num_values) {
  return rlpc::guarded(decoder, [&] {
    const auto vertices = decoder->decoder->coarse_vertices();
    if (vertices.empty()) {
      return decoder->error.set(RLPC_BAD_ARGUMENT,
                                "the mesh is not a coarse one: coarse_layers is RLPC_ALL");
    }
    if (!rlpc::check_buffer(*decoder, indices, num_values, vertices.size())) {
      return RLPC_BAD_ARGUMENT;
    }
    std::copy(vertices.begin(), vertices.end(), indices);
    return RLPC_OK;
  });
}

const char* rlpc_decoder_metadata(const rlpc_decoder* decoder) {
  const bool open = decoder != nullptr && decoder->decoder;
  return open ? decoder->decoder->metadata().c_str() : "";
}

uint32_t rlpc_decoder_num_damaged_units(const rlpc_decoder* decoder) {
  const bool open = decoder != nullptr && decoder->decoder;
  return open ? static_cast<std::uint32_t>(decoder->decoder->damaged_units().size()) : 0;
}

uint32_t rlpc_decoder_num_clips(const rlpc_decoder* decoder) {
  const bool open = decoder != nullptr && decoder->decoder;
  return open ? static_cast<std::uint32_t>(decoder->decoder->clips().size()) : 0;
}

rlpc_status rlpc_decoder_clip(rlpc_decoder* decoder, uint32_t index, rlpc_clip* clip) {
  return rlpc::guarded(decoder, [&] {
    const auto& clips = decoder->decoder->clips();
    if (clip == nullptr || index >= clips.size()) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, clip == nullptr
                                                       ? "clip is null"
                                                       : "expected a clip below " +
                                                             std::to_string(clips.size()) +
                                                             ", got " + std::to_string(index));
    }
    const rlpc::Clip& found = clips[index];
    *clip = {found.name.c_str(), found.first_frame, found.num_frames};
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_find_clip(rlpc_decoder* decoder, const char* name, rlpc_clip* clip) {
  return rlpc::guarded(decoder, [&] {
    if (name == nullptr || clip == nullptr) {
      return decoder->error.set(RLPC_BAD_ARGUMENT,
                                name == nullptr ? "name is null" : "clip is null");
    }
    for (const rlpc::Clip& one : decoder->decoder->clips()) {
      if (std::strcmp(one.name.c_str(), name) != 0) continue;
      *clip = {one.name.c_str(), one.first_frame, one.num_frames};
      return RLPC_OK;
    }
    return decoder->error.set(RLPC_BAD_ARGUMENT, "no clip has this name");
  });
}

rlpc_status rlpc_decoder_duration(rlpc_decoder* decoder, const rlpc_clip* clip,
                                  double* seconds) {
  return rlpc::guarded(decoder, [&] {
    if (seconds == nullptr) return decoder->error.set(RLPC_BAD_ARGUMENT, "seconds is null");
    const auto span = rlpc::frames_of(*decoder, clip);
    if (!span) return RLPC_BAD_ARGUMENT;
    *seconds = rlpc::clip_seconds(decoder->decoder->header().frame_rate, span->num_frames);
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_frame_at(rlpc_decoder* decoder, const rlpc_clip* clip, double seconds,
                                  uint32_t repeats, uint32_t* frame, double* place) {
  return rlpc::guarded(decoder, [&] {
    if (frame == nullptr || seconds != seconds || repeats > 1) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, frame == nullptr ? "frame is null"
                                                   : repeats > 1 ? "repeats is neither 0 nor 1"
                                                                 : "seconds is not a number");
    }
    const auto span = rlpc::frames_of(*decoder, clip);
    if (!span) return RLPC_BAD_ARGUMENT;
    const double within = rlpc::clip_place(decoder->decoder->header().frame_rate,
                                           span->num_frames, seconds, repeats == 1);
    *frame = span->first_frame + rlpc::nearest_frame(within);
    if (place != nullptr) *place = span->first_frame + within;
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_next_positions(rlpc_decoder* decoder, int32_t* positions,
                                        size_t num_values) {
  return rlpc::guarded(decoder, [&] {
    const std::size_t wanted = 3 * std::size_t{decoder->decoder->num_vertices()};
    if (!rlpc::check_buffer(*decoder, positions, num_values, wanted)) return RLPC_BAD_ARGUMENT;
    return rlpc::next(*decoder, {positions, num_values});
  });
}

rlpc_status rlpc_decoder_next_floats(rlpc_decoder* decoder, float* xyz, size_t num_values) {
  return rlpc::guarded(decoder, [&] {
    const rlpc::SequenceHeader& header = decoder->decoder->header();
    const std::size_t wanted = 3 * std::size_t{decoder->decoder->num_vertices()};
    if (!rlpc::check_buffer(*decoder, xyz, num_values, wanted)) return RLPC_BAD_ARGUMENT;
    decoder->positions.resize(wanted);
    decoder->blend.is_shown = false;
    const rlpc_status status = rlpc::next(*decoder, decoder->positions);
    // The last frame stays at the end.
    if (status != RLPC_END) decoder->has_frame = status == RLPC_OK;
    if (status != RLPC_OK) return status;
    decoder->next_of_frame = decoder->decoder->position();
    for (std::size_t i = 0; i < wanted; ++i) {
      xyz[i] = rlpc::float_position(header.grid, i % 3, decoder->positions[i]);
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_seek(rlpc_decoder* decoder, uint32_t frame) {
  return rlpc::guarded(decoder, [&] {
    if (rlpc::check_frame(*decoder, frame) != RLPC_OK) return RLPC_BAD_ARGUMENT;
    if (const auto ok = decoder->decoder->seek(frame); !ok) {
      return rlpc::fail(*decoder, ok.error());
    }
    decoder->error.clear();
    return RLPC_OK;
  });
}

uint32_t rlpc_decoder_position(const rlpc_decoder* decoder) {
  const bool open = decoder != nullptr && decoder->decoder;
  return open ? decoder->decoder->position() : 0;
}
