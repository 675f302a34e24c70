#include "encoder/codec/sequence/memory_need.h"

#include <algorithm>
#include <string>

#include "common/files/messages.h"
#include "encoder/codec/kinds/inter/pattern_search.h"
#include "encoder/codec/sequence/choices/gof_kinds.h"
#include "encoder/codec/spans/sample_size.h"

namespace rlpc {

namespace {

// Bytes per position of the span being coded. Measured with random motion, which needs all
// components: 110 (Baseline) to 185 (Main). Real motion needs 40.
constexpr std::uint64_t kBytesOfPosition = 190;  // fixed: memory
// Bytes per position of a shared rig that later spans may use: factors of two or four bytes, of
// at most three trajectories for each frame.
constexpr std::uint64_t kFactorsOfRig = 12;  // fixed: memory

// Returns the number of frames that can be coded at once.
std::uint64_t frames_in_memory(const EncoderSettings& settings, std::uint32_t num_vertices,
                               std::uint64_t bytes_of_position) {
  constexpr std::uint64_t kMaxPositions = std::uint64_t{1} << 26;  // fixed: memory
  constexpr std::uint64_t kPart = 2;  // fixed: they take at most half of the limit
  const std::uint64_t positions =
      std::min(kMaxPositions, settings.max_memory_bytes / (kPart * bytes_of_position));
  return std::min<std::uint64_t>(positions / num_vertices, kMaxFrames);
}

// Returns the bytes per vertex of the encodings of an inter GOF that are compared: positions,
// as doubles, as floats and decoded, and the filters of each encoding.
std::uint64_t bytes_of_frames(const EncoderSettings& settings, const SequenceHeader& header,
                              std::uint32_t num_frames) {
  constexpr std::uint64_t kFrameBytes = 36;     // fixed: memory; without decoded positions
  constexpr std::uint64_t kDecoded = 12;        // fixed: memory
  constexpr std::uint64_t kFilterBytes = 2100;  // fixed: memory
  if (settings.profile != Profile::kHigh || !settings.may_use(GofKind::kInter)) return 0;
  std::size_t choices = 1;
  if (!settings.low_delay) {
    const auto patterns = patterns_of(settings, header.open_end_flag, num_frames);
    const auto patches = patches_of(settings, header.open_end_flag, num_frames);
    choices = std::max(patterns.size(), choices_of_patches(patterns, patches).size());
  }
  return kFrameBytes * num_frames +
         choices * (kDecoded * num_frames + kFilterBytes * settings.inter.temporal_layers);
}

// Returns the bytes of what is fitted to a sample of the vertices. Solvers of bones are kept
// for each number of bones and of influences, before and after rest positions were refined; a
// rig that is recovered from the frames takes less. Measured with random motion.
std::uint64_t bytes_of_bones(const EncoderSettings& settings, std::uint32_t num_vertices) {
  constexpr std::uint64_t kSolverBytes = 750;  // fixed: memory; of a vertex
  constexpr std::uint64_t kSumsBytes = 2400;   // fixed: memory; of a vertex and 36 bones
  constexpr std::uint64_t kFewSolvers = 7;     // fixed: memory; preset fast
  constexpr std::uint64_t kUsualSolvers = 17;  // fixed: memory; preset medium
  constexpr std::uint64_t kManySolvers = 48;   // fixed: memory; preset slow
  if (settings.profile == Profile::kBaseline || !settings.may_use(GofKind::kSkinned)) return 0;
  const std::uint64_t solvers = settings.preset == Preset::kFast   ? kFewSolvers
                                : settings.preset == Preset::kSlow ? kManySolvers
                                                                   : kUsualSolvers;
  return std::min(num_vertices, kSampleVertices) * (solvers * kSolverBytes + kSumsBytes);
}

struct MemoryNeed {
  std::uint64_t with_one_thread = 0;
  std::uint64_t thread_bytes = 0;  // bytes of each further thread
};

MemoryNeed memory_need(const EncoderSettings& settings, const SequenceHeader& header,
                       std::uint32_t span_frames, std::uint32_t kept_frames,
                       const SourceMemory& source) {
  // Measured with random motion: 70 bytes per position of a kept analysis. Real motion
  // needs 10.
  constexpr std::uint64_t kFixed = std::uint64_t{16} << 20;  // fixed: memory
  constexpr std::uint64_t kVertexBytes = 700;                // fixed: memory
  constexpr std::uint64_t kTriangleBytes = 250;              // fixed: memory
  constexpr std::uint64_t kKept = 70;                        // fixed: memory
  // What each span keeps for the vertices: its choices, and the errors of a trial.
  constexpr std::uint64_t kSpanBytes = 100;  // fixed: memory
  const std::uint64_t num_spans =
      std::max<std::uint64_t>(1, (source.encoded_frames + span_frames - 1) / span_frames);
  // The rest of a shared rig: rest position, influences, two sets of weights of prediction.
  constexpr std::uint64_t kRigBytes = 400;  // fixed: memory
  const bool has_rigs = settings.profile == Profile::kHigh && span_frames < header.num_frames;
  const std::uint64_t rig_bytes =
      has_rigs ? header.num_vertices * (kRigBytes + kFactorsOfRig * span_frames) : 0;
  // Normals and areas of the original and the decoded vertex, which the verifier compares, and
  // the search as well if they are bounded.
  constexpr std::uint64_t kNormalBytes = 64;  // fixed: memory
  // Each thread has a span of its own, or a candidate for one, encoded by all kinds of GOFs;
  // another rig is in force.
  const std::uint64_t thread_bytes =
      header.num_vertices * (kBytesOfPosition * span_frames + kNormalBytes +
                             bytes_of_frames(settings, header, span_frames)) +
      bytes_of_bones(settings, header.num_vertices) + rig_bytes;
  const std::uint64_t vertex_bytes = kVertexBytes + kSpanBytes * num_spans +
                                     kKept * kept_frames +
                                     source.bytes_of_position * span_frames;
  const std::uint64_t shared = kFixed + source.bytes + header.num_vertices * vertex_bytes +
                               header.num_triangles * kTriangleBytes + rig_bytes;
  return {shared + thread_bytes, thread_bytes};
}

}  // namespace

std::uint32_t longest_gof(const EncoderSettings& settings, std::uint32_t num_vertices) {
  if (settings.gof_frames > 0) return settings.gof_frames;
  if (settings.profile == Profile::kHigh) return kDefaultTrackFrames;
  return settings.clips.size() < 2 ? kDefaultGofFrames
                                   : longest_gof_of_all(settings, num_vertices);
}

std::uint32_t longest_gof_of_all(const EncoderSettings& settings, std::uint32_t num_vertices) {
  if (settings.gof_frames > 0) return settings.gof_frames;
  if (settings.profile == Profile::kHigh) return kDefaultTrackFrames;
  if (settings.profile == Profile::kBaseline) return kDefaultGofFrames;
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(frames_in_memory(settings, num_vertices, kBytesOfPosition),
                                kDefaultGofFrames, kClipFrames));
}

std::uint32_t longest_span(const EncoderSettings& settings, const SequenceHeader& header,
                           const SourceMemory& source) {
  const std::uint32_t longest = longest_gof(settings, header.num_vertices);
  if (settings.profile != Profile::kHigh) return longest;
  const auto frames = [&](std::uint64_t bytes_of_position) {
    return static_cast<std::uint32_t>(std::max<std::uint64_t>(
        longest, frames_in_memory(settings, header.num_vertices, bytes_of_position)));
  };
  std::uint32_t span = frames(kBytesOfPosition);
  // With several spans, there are also two shared rigs: one in force and a new one.
  if (header.num_frames > span) span = frames(kBytesOfPosition + 2 * kFactorsOfRig);
  // Memory that does not grow with the span may need more than the other half of the limit.
  const auto fits = [&] {
    return memory_need(settings, header, std::min(span, header.num_frames), 0, source)
               .with_one_thread <= settings.max_memory_bytes;
  };
  while (span > longest && !fits()) span = std::max(longest, span - (span + 3) / 4);
  return span;
}

InputResult<std::uint32_t> check_memory(const EncoderSettings& settings,
                                        const SequenceHeader& header, std::uint32_t span_frames,
                                        std::uint32_t kept_frames, const SourceMemory& source) {
  const MemoryNeed need = memory_need(settings, header, span_frames, kept_frames, source);
  if (need.with_one_thread <= settings.max_memory_bytes) {
    const std::uint64_t others =
        (settings.max_memory_bytes - need.with_one_thread) / need.thread_bytes;
    const std::uint32_t wanted = std::clamp(settings.threads, 1U, kMaxEncoderThreads);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, others + 1));
  }
  return InputError{"encoding may need " + std::to_string((need.with_one_thread >> 20) + 1) +
                        " MiB of memory; the limit is " + size_text(settings.max_memory_bytes) +
                        " ('max_memory_bytes'). A smaller 'gof_frames' needs less",
                    true};
}

}  // namespace rlpc
