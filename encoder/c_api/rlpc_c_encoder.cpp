#include "encoder/c_api/rlpc_c_encoder.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/c_api/c_handle.h"
#include "encoder/codec/kind_choices.h"
#include "encoder/frame_encoder.h"

// NOLINTNEXTLINE(readability-identifier-naming): its name in C.
struct rlpc_encoder {
  std::optional<rlpc::FrameEncoder> encoder;
  std::vector<std::uint32_t> input_vertex;  // set by rlpc_encoder_finish
  std::size_t num_values = 0;               // per frame
  rlpc_write_function write = nullptr;
  void* user = nullptr;
  bool write_failed = false;
  bool low_delay = false;
  rlpc::HandleError error;
  bool is_placed = false;
};

namespace rlpc {
namespace {

static_assert(kKindChoices[RLPC_GOF_KIND_CLUSTER - 1] == GofKind::kCluster &&
              kKindChoices[RLPC_GOF_KIND_SKINNED - 1] == GofKind::kSkinned &&
              kKindChoices[RLPC_GOF_KIND_INTER - 1] == GofKind::kInter);

rlpc_encode_options default_options() {
  const EncoderSettings defaults;
  rlpc_encode_options options{};
  options.struct_size = sizeof options;
  options.profile = RLPC_PROFILE_MAIN;
  options.preset = RLPC_PRESET_MEDIUM;
  options.target = RLPC_TARGET_KG;
  options.target_value = defaults.target.value;
  options.hash_mode = RLPC_HASH_MODE_GOF;
  options.least_level = 1;
  options.max_memory_bytes = defaults.max_memory_bytes;
  options.threads = defaults.threads;
  options.temporal_layers = defaults.main.temporal_layers;
  return options;
}

rlpc_frame_format default_format() {
  rlpc_frame_format format{};
  format.struct_size = sizeof format;
  format.frame_rate_numerator = FrameRate{}.numerator;
  format.frame_rate_denominator = FrameRate{}.denominator;
  return format;
}

// Copies the clips. False: there are too many, or one has no name.
bool add_clips(const rlpc_encode_options& options, std::vector<Clip>& clips) {
  if (options.num_clips > RLPC_MAX_CLIPS) return false;
  if (options.num_clips > 0 && options.clips == nullptr) return false;
  for (const rlpc_clip& clip : std::span(options.clips, options.num_clips)) {
    if (clip.name == nullptr) return false;
    clips.push_back({clip.name, clip.first_frame, clip.num_frames});
  }
  return true;
}

// Converts the options; none if a value is outside its enumeration.
std::optional<EncoderSettings> settings_of(const rlpc_encode_options& options) {
  EncoderSettings settings;
  switch (options.profile) {
    case RLPC_PROFILE_BASELINE:
      settings.profile = Profile::kBaseline;
      break;
    case RLPC_PROFILE_MAIN:
      settings.profile = Profile::kMain;
      break;
    case RLPC_PROFILE_HIGH:
      settings.profile = Profile::kHigh;
      break;
    default:
      return std::nullopt;
  }
  switch (options.preset) {
    case RLPC_PRESET_FAST:
      settings.preset = Preset::kFast;
      break;
    case RLPC_PRESET_MEDIUM:
      settings.preset = Preset::kMedium;
      break;
    case RLPC_PRESET_SLOW:
      settings.preset = Preset::kSlow;
      break;
    default:
      return std::nullopt;
  }
  switch (options.target) {
    case RLPC_TARGET_KG:
      settings.target.kind = Target::kKg;
      break;
    case RLPC_TARGET_BPVF:
      settings.target.kind = Target::kBpvf;
      break;
    case RLPC_TARGET_MAX_ERROR:
      settings.target.kind = Target::kMaxError;
      break;
    case RLPC_TARGET_LOSSLESS:
      settings.target.kind = Target::kLossless;
      break;
    default:
      return std::nullopt;
  }
  switch (options.hash_mode) {
    case RLPC_HASH_MODE_NONE:
      settings.hash_mode = HashMode::kNone;
      break;
    case RLPC_HASH_MODE_GOF:
      settings.hash_mode = HashMode::kGof;
      break;
    case RLPC_HASH_MODE_FRAME:
      settings.hash_mode = HashMode::kFrame;
      break;
    default:
      return std::nullopt;
  }
  if (options.gof_kind > kNumKindChoices || options.low_delay > 1) return std::nullopt;
  if (options.gof_kind > 0) settings.gof_kind = kKindChoices[options.gof_kind - 1];
  settings.low_delay = options.low_delay != 0;
  settings.target.value = options.target_value;
  settings.target.max_normals = options.max_normals;
  settings.gof_frames = options.gof_frames;
  settings.components = options.components;
  settings.keep_order = options.keep_order != 0;
  if (options.metadata != nullptr) settings.metadata = options.metadata;
  if (!add_clips(options, settings.clips)) return std::nullopt;
  settings.max_memory_bytes = options.max_memory_bytes;
  settings.threads = options.threads;
  settings.main.temporal_layers = options.temporal_layers;
  return settings;
}

FrameFormat format_of(const rlpc_frame_format& given, const rlpc_encode_options& options) {
  FrameFormat format;
  format.num_vertices = given.num_vertices;
  format.num_frames = given.num_frames;
  format.frame_rate = {given.frame_rate_numerator, given.frame_rate_denominator};
  format.triangles.reserve(given.num_triangles);
  for (std::size_t i = 0; i < given.num_triangles; ++i) {
    const std::uint32_t* t = given.indices + 3 * i;
    format.triangles.push_back({t[0], t[1], t[2]});
  }
  std::copy_n(given.box_min, 3, format.box_min.begin());
  std::copy_n(given.box_max, 3, format.box_max.begin());
  format.least_level = options.least_level;
  format.max_held_frames = options.max_held_frames;
  return format;
}

ByteSink sink_of(rlpc_encoder& handle) {
  return [&handle](std::span<const std::uint8_t> bytes) {
    handle.write_failed = handle.write(handle.user, bytes.data(), bytes.size()) != 0;
    return !handle.write_failed;
  };
}

rlpc_status create(rlpc_encoder& handle, const rlpc_frame_format& format,
                   const rlpc_encode_options& options) {
  const auto settings = settings_of(options);
  if (!settings) {
    return handle.error.break_handle(RLPC_BAD_ARGUMENT, "an option has an unknown value");
  }
  if (options.threads < 1 || options.threads > kMaxEncoderThreads) {
    return handle.error.break_handle(RLPC_BAD_ARGUMENT,
                                     "threads: " + std::to_string(options.threads) +
                                         " is not in the range of 1 to " +
                                         std::to_string(kMaxEncoderThreads));
  }
  auto encoder = FrameEncoder::create(format_of(format, options), *settings, sink_of(handle));
  if (!encoder) {
    const InputError& error = encoder.error();
    return handle.error.break_handle(error.is_limit ? RLPC_LIMIT_EXCEEDED : RLPC_BAD_INPUT,
                                     error.message);
  }
  handle.encoder = std::move(*encoder);
  handle.num_values = 3 * std::size_t{format.num_vertices};
  handle.low_delay = settings->low_delay;
  return RLPC_OK;
}

rlpc_status fail(rlpc_encoder& handle, const InputError& error) {
  return handle.error.break_handle(handle.write_failed ? RLPC_IO_FAILED
                                   : error.is_fault    ? RLPC_INTERNAL_ERROR
                                                       : RLPC_BAD_INPUT,
                                   error.message);
}

void give_report(const EncodeReport& report, rlpc_encode_report* theirs,
                 std::size_t struct_size) {
  rlpc_encode_report ours{};
  ours.num_bytes = report.bytes;
  ours.bpvf = report.bpvf;
  ours.kg_error_percent = report.metrics.kg_error_percent;
  ours.rms_error = report.metrics.rms_error;
  ours.max_error = report.metrics.max_error;
  ours.num_gofs = report.num_gofs;
  ours.level = report.header.level_idc;
  ours.target_met = report.target_met ? 1 : 0;
  static_assert(RLPC_MAX_TEMPORAL_LAYERS == kMaxTrackLevels + 1);
  for (std::size_t i = 0; i < report.temporal_cuts.size(); ++i) {
    ours.temporal_cut_bytes[i] = report.temporal_cuts[i].bytes;
    ours.temporal_cut_kg_error_percent[i] = report.temporal_cuts[i].kg_error_percent;
  }
  give_struct(ours, theirs, struct_size);
}

}  // namespace
}  // namespace rlpc

void rlpc_frame_format_init(rlpc_frame_format* format, size_t struct_size) {
  rlpc::give_struct(rlpc::default_format(), format, struct_size);
}

void rlpc_encode_options_init(rlpc_encode_options* options, size_t struct_size) {
  rlpc::give_struct(rlpc::default_options(), options, struct_size);
}

size_t rlpc_encoder_bytes() { return sizeof(rlpc_encoder); }

rlpc_status rlpc_encoder_create(const rlpc_frame_format* format,
                                const rlpc_encode_options* options, rlpc_write_function write,
                                void* user, rlpc_encoder** encoder) {
  if (encoder == nullptr) return RLPC_BAD_ARGUMENT;
  *encoder = nullptr;
  rlpc_frame_format our_format = rlpc::default_format();
  rlpc_encode_options our_options = rlpc::default_options();
  if (format == nullptr || write == nullptr || !rlpc::take_struct(format, our_format) ||
      !rlpc::take_struct(options, our_options) ||
      (our_format.indices == nullptr && our_format.num_triangles > 0)) {
    return RLPC_BAD_ARGUMENT;
  }
  auto* handle = rlpc::make_handle<rlpc_encoder>(our_options.place, our_options.place_bytes);
  if (handle == nullptr) {
    return our_options.place != nullptr ? RLPC_BAD_ARGUMENT : RLPC_OUT_OF_MEMORY;
  }
  handle->write = write;
  handle->user = user;
  *encoder = handle;
  return rlpc::guarded(handle, [&] { return rlpc::create(*handle, our_format, our_options); });
}

void rlpc_encoder_close(rlpc_encoder* encoder) { rlpc::close_handle(encoder); }

const char* rlpc_encoder_error_text(const rlpc_encoder* encoder) {
  return encoder == nullptr ? "there is no encoder" : encoder->error.text();
}

rlpc_status rlpc_encoder_add_frame(rlpc_encoder* encoder, const float* xyz, size_t num_values) {
  return rlpc::guarded(encoder, [&] {
    if (xyz == nullptr || num_values != encoder->num_values) {
      return encoder->error.set(
          RLPC_BAD_ARGUMENT, xyz == nullptr
                                 ? "the frame is null"
                                 : "the frame has " + std::to_string(num_values) +
                                       " values, not " + std::to_string(encoder->num_values));
    }
    if (const auto error = encoder->encoder->add_frame({xyz, num_values})) {
      if (encoder->low_delay && !encoder->write_failed && !error->is_fault) {
        return encoder->error.set(RLPC_BAD_INPUT, error->message);  // the frame is left out
      }
      return rlpc::fail(*encoder, *error);
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_encoder_finish(rlpc_encoder* encoder, rlpc_encode_report* report,
                                size_t struct_size) {
  return rlpc::guarded(encoder, [&] {
    auto finished = encoder->encoder->finish();
    if (!finished) return rlpc::fail(*encoder, finished.error());
    rlpc::give_report(*finished, report, struct_size);
    encoder->input_vertex = std::move(finished->input_vertex);
    return RLPC_OK;
  });
}

rlpc_status rlpc_encoder_vertex_order(rlpc_encoder* encoder, uint32_t* input_vertex,
                                      size_t num_values) {
  return rlpc::guarded(encoder, [&] {
    if (encoder->input_vertex.empty()) {
      return encoder->error.set(RLPC_BAD_ARGUMENT, "the stream is not finished");
    }
    if (input_vertex == nullptr || num_values != encoder->input_vertex.size()) {
      return encoder->error.set(RLPC_BAD_ARGUMENT, "num_values must be the number of vertices");
    }
    std::copy(encoder->input_vertex.begin(), encoder->input_vertex.end(), input_vertex);
    return RLPC_OK;
  });
}
