// One GOF, encoded at varying steps, whatever its kind.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/syntax/stream_format.h"

namespace rlpc {

// Sets the decoded positions of frame f of a GOF, as a decoder has them; [num_vertices][3].
using DecodeFrame = std::function<void(std::uint32_t f, std::span<std::int32_t> positions)>;

// An analysis serves steps up to this factor from the one that it is made for.
inline constexpr double kAnalysisServes = 1.44;  // tuned (off: 1): steps of an analysis
inline bool analysis_serves(double made_for, double step) {
  return step <= kAnalysisServes * made_for && made_for <= kAnalysisServes * step;
}
// Beyond, kinds, bones and tools are chosen again, but not for ever.
inline constexpr int kMostChoices = 3;  // tuned (off: 1): for one GOF

// One encoding of a GOF.
struct EncodedGof {
  struct Unit {
    UnitType type;
    std::vector<std::uint8_t> payload;
  };
  std::vector<Unit> units;  // the GOF unit, then its slices
  DecodeFrame frame;
  std::uint64_t num_factors = 0;      // NumFactors of the specification
  std::uint32_t clusters = 0;         // or bones
  std::uint32_t components = 0;       // or trajectories
  std::uint32_t most_components = 0;  // of a cluster; all trajectories
};

// Encodes one GOF. What is chosen for it stands as long as the coder does; the analysis of the
// last step, which is large, can be released, and is then made again when it is needed.
class GofCoder {
 public:
  virtual ~GofCoder() = default;
  // As encode() does first, where expected_error() tells more afterwards.
  virtual void analyse(double /*analysis_step*/) {}
  // Squared error of what encode() would give, by the last analysis; the real one is larger or
  // smaller by a factor that hardly depends on the step. None: nothing is known.
  virtual std::optional<double> expected_error(double /*step*/) const { return std::nullopt; }
  // Whether encode() looks at the frames; else they may be gone.
  virtual bool needs_frames(double step, double analysis_step) const = 0;
  // step: of the quantisers, in grid steps. analysis_step: that the analysis is made for, near
  // it; the last analysis is kept, and serves again for its step.
  virtual EncodedGof encode(double step, double analysis_step) = 0;
  virtual void release_analysis() = 0;
};

}  // namespace rlpc
