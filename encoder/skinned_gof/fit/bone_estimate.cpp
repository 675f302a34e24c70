#include "encoder/skinned_gof/fit/bone_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "encoder/gof/component_cost.h"
#include "encoder/gof/sample_size.h"
#include "encoder/math/det_math.h"
#include "encoder/math/principal_components.h"

namespace rlpc {
namespace {

// Mean squared spatial prediction residual of each component: the difference between a
// vertex and the mean of its neighbours.
std::vector<double> differences(const BoneSample& sample, const PrincipalComponents& pc) {
  const std::size_t count = pc.spatial.size();
  std::vector<double> sum(count, 0.0);
  for (const auto& ring : sample.rings) {
    const auto around = static_cast<double>(ring.size() - 1);
    for (std::size_t l = 0; l < count; ++l) {
      double d = pc.spatial[l][ring[0]];
      for (std::size_t i = 1; i < ring.size(); ++i) d -= pc.spatial[l][ring[i]] / around;
      sum[l] += d * d;
    }
  }
  for (double& s : sum) s /= static_cast<double>(sample.rings.size());
  return sum;
}

}  // namespace

double expected_cost(const BoneSample& sample, std::vector<double> residuals,
                     std::uint32_t num_vertices, std::uint32_t num_frames, double step) {
  TrajectoryMatrix matrix;
  matrix.num_values = sample.num_vertices();
  matrix.num_frames = 3 * sample.num_frames;
  matrix.a = std::move(residuals);
  const PrincipalComponents pc = principal_components(matrix, matrix.num_frames, 0.0);
  const std::vector<double> difference = differences(sample, pc);
  const double vertices = num_vertices;
  const double values = 3.0 * num_frames;
  const double frame_scale = num_frames / static_cast<double>(sample.num_frames);
  const double scale = frame_scale * vertices / static_cast<double>(sample.num_vertices());
  double cost = 0.0;
  for (std::size_t l = 0; l < pc.energy.size(); ++l) {
    const double energy = scale * pc.energy[l];
    if (l >= difference.size()) {
      cost += energy;
      continue;
    }
    cost +=
        expected_component_cost(energy, vertices, values, frame_scale * difference[l], step);
  }
  return cost;
}

std::vector<double> unsteadiness(const GofFrames& frames) {
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
// takes half a bit per doubling of the square of what prediction leaves, relative to the error
// of its quantiser, step^2 / 12.
double expected_bone_bits(const std::vector<double>& unsteady, const GofFrames& frames,
                          std::size_t num_bones, double step) {
  constexpr double kValuesPerPose = 6.0;  // fixed: of a rotation and an origin
  if (unsteady.empty()) return 0.0;
  const double followers = frames.num_vertices / static_cast<double>(num_bones);
  const double scale = std::sqrt(12.0 * followers) / step;
  double sum = 0.0;
  for (const double d : unsteady) sum += det_log2(1.0 + scale * d);
  const double mean = sum / static_cast<double>(unsteady.size());
  return 0.5 * kValuesPerPose * mean * (frames.num_frames - 1);
}

}  // namespace rlpc
