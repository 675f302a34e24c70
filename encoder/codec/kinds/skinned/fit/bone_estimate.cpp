#include "encoder/codec/kinds/skinned/fit/bone_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/principal_components.h"
#include "encoder/codec/spans/component_cost.h"
#include "encoder/codec/spans/sample_size.h"

namespace rlpc {
namespace {

// Returns the mean squared spatial prediction residual of each component: the difference
// between the centre vertex of a patch and the mean of the vertices around it.
std::vector<double> differences(const BoneSample& sample, const PrincipalComponents& pc) {
  const std::size_t count = pc.spatial.size();
  std::vector<double> sum(count, 0.0);
  for (const auto& patch : sample.patches) {
    const auto around = static_cast<double>(patch.size() - 1);
    for (std::size_t l = 0; l < count; ++l) {
      double d = pc.spatial[l][patch[0]];
      for (std::size_t i = 1; i < patch.size(); ++i) d -= pc.spatial[l][patch[i]] / around;
      sum[l] += d * d;
    }
  }
  for (double& s : sum) s /= static_cast<double>(sample.patches.size());
  return sum;
}

}  // namespace

ResidualSpectrum residual_spectrum(const BoneSample& sample, std::vector<double> residuals,
                                   std::uint32_t num_vertices, std::uint32_t num_frames) {
  TrajectoryMatrix matrix;
  matrix.num_values = sample.num_vertices();
  matrix.num_frames = 3 * sample.num_frames;
  matrix.a = std::move(residuals);
  const PrincipalComponents pc = principal_components(matrix, matrix.num_frames, 0.0);
  ResidualSpectrum spectrum{pc.energy, differences(sample, pc)};
  const double frame_scale = num_frames / static_cast<double>(sample.num_frames);
  const double scale = frame_scale * num_vertices / static_cast<double>(sample.num_vertices());
  for (double& x : spectrum.energy) x *= scale;
  for (double& x : spectrum.predicted) x *= frame_scale;
  return spectrum;
}

double expected_cost(const ResidualSpectrum& spectrum, std::uint32_t num_vertices,
                     std::uint32_t num_frames, double step) {
  double cost = 0.0;
  for (std::size_t l = 0; l < spectrum.energy.size(); ++l) {
    const double energy = spectrum.energy[l];
    cost += l < spectrum.predicted.size()
                ? expected_component_cost(energy, num_vertices, 3.0 * num_frames,
                                          spectrum.predicted[l], step)
                : energy;
  }
  return cost;
}

std::vector<double> unsteadiness(const SpanFrames& frames) {
  const std::uint32_t stride = (frames.num_vertices + kProbeVertices - 1) / kProbeVertices;
  std::vector<double> result;
  for (std::uint32_t f = 1; f < frames.num_frames; ++f) {
    for (std::uint32_t v = 0; v < frames.num_vertices; v += stride) {
      const double* now = frames.at(f, v);
      const double* before = frames.at(f - 1, v);
      const double* first = frames.at(f > 1 ? f - 2 : 0, v);
      double square = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = now[c] - 2.0 * before[c] + first[c];
        square += d * d;
      }
      result.push_back(std::sqrt(square));
    }
  }
  return result;
}

// The more vertices follow a bone, the finer its steps are. Each of the six values of a pose
// takes half a bit per doubling of the squared prediction residual, relative to the error of
// its quantiser, step^2 / 12.
double expected_bone_bits(const std::vector<double>& unsteady, const SpanFrames& frames,
                          std::size_t num_bones, double step) {
  constexpr double kValuesPerPose = 6.0;  // fixed: a rotation and an origin
  if (unsteady.empty()) return 0.0;
  const double followers = frames.num_vertices / static_cast<double>(num_bones);
  const double scale = std::sqrt(12.0 * followers) / step;
  double sum = 0.0;
  for (const double d : unsteady) sum += det_log2(1.0 + scale * d);
  const double mean = sum / static_cast<double>(unsteady.size());
  return 0.5 * kValuesPerPose * mean * (frames.num_frames - 1);
}

}  // namespace rlpc
