#include "encoder/codec/kinds/skinned/quantise/mean_motion.h"

#include <algorithm>
#include <numeric>

#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {

std::vector<MeanMotion> motions_of(const BoneMotion& bone, std::size_t first,
                                   std::size_t count) {
  const double axis_unit = exact_exp2(-kQuaternionFractionBits);
  std::vector<MeanMotion> motions(count);
  for (std::size_t f = 0; f < count; ++f) {
    const BonePose& pose = bone.poses[first + f];
    for (std::size_t c = 0; c < 3; ++c) {
      double moved = static_cast<double>(pose.origin[c]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = static_cast<double>(pose.axes[k][c]) * axis_unit;
        motions[f].turn[k][c] = a;
        moved -= a * static_cast<double>(bone.pivot[k]);
      }
      motions[f].shift[c] = moved / kPointScale;
    }
  }
  return motions;
}

std::vector<MeanMotion> motions_of(const Vec3i& pivot, std::span<const WantedPose> poses,
                                   std::span<const AxisImages> axes) {
  std::vector<MeanMotion> motions(poses.size());
  for (std::size_t f = 0; f < poses.size(); ++f) {
    const Eigen::Matrix3d turn =
        axes.empty() ? rotation_matrix(poses[f].rotation) : matrix_of(axes[f]);
    for (std::size_t c = 0; c < 3; ++c) {
      double moved = poses[f].origin[c];
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = turn(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k));
        motions[f].turn[k][c] = a;
        moved -= a * pivot[k];
      }
      motions[f].shift[c] = moved / kPointScale;
    }
  }
  return motions;
}

std::span<const MeanMotion> MeanMotions::of(const Influences& influences, int weight_bits) {
  if (std::ranges::equal(influences, mean_of_) && !mean_.empty()) return mean_;
  mean_of_ = influences;
  const double unit = exact_exp2(-weight_bits);
  mean_.assign(motions_.front().size(), {});
  for (const Influence& influence : influences) {
    const double weight = influence.weight * unit;
    const std::vector<MeanMotion>& motions = motions_[influence.bone];
    for (std::size_t f = 0; f < mean_.size(); ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) {
          mean_[f].turn[k][c] += weight * motions[f].turn[k][c];
        }
        mean_[f].shift[c] += weight * motions[f].shift[c];
      }
    }
  }
  return mean_;
}

void write_displacement(const SpanFrames& frames, std::span<const std::uint32_t> chosen,
                        std::uint32_t v, std::span<const MeanMotion> motion, const Point& rest,
                        double* row) {
  const std::size_t num_frames = chosen.size();
  for (std::size_t f = 0; f < num_frames; ++f) {
    const double* x = frames.at(chosen[f], v);
    for (std::size_t c = 0; c < 3; ++c) {
      double residual = x[c] - motion[f].shift[c];
      for (std::size_t k = 0; k < 3; ++k) residual -= motion[f].turn[k][c] * rest[k];
      row[c * num_frames + f] = residual;
    }
  }
}

std::vector<std::uint32_t> numbers_from(std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

}  // namespace rlpc
