// One GOF, encoded at varying steps, whatever its kind.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/syntax/stream_format.h"
#include "encoder/gof/gof_frames.h"

namespace rlpc {

// At the operating point, a bit is worth this many squared steps of error: the slope of the
// rate of a uniform quantiser, 1 / (2 ln 2 D) bits with D = step^2 / 12.
inline constexpr double kErrorPerBit = 0.1155;

// Sets the decoded positions of frame f of a GOF, as a decoder has them; [num_vertices][3].
using DecodeFrame = std::function<void(std::uint32_t f, std::span<std::int32_t> positions)>;

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

// Squared error, with bits at their worth for a step.
inline double lagrangian_cost(const EncodedGof& encoded, const GofFrames& frames, double step) {
  double bits = 0.0;
  for (const auto& unit : encoded.units) bits += 8.0 * static_cast<double>(unit.payload.size());
  return squared_error(frames, encoded.frame) + kErrorPerBit * step * step * bits;
}

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
