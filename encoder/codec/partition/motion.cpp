#include "encoder/codec/partition/motion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/symmetric_system.h"
#include "encoder/codec/partition/point_tree.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kSampleFrames = 24;  // fixed: memory
// tuned (off: 0): The linear part of a motion is pulled to that of a translation, as flat parts
// do not determine it; relative to the spread of the part.
constexpr double kRidge = 1e-3;
constexpr std::uint32_t kSeedVertices = 32;  // tuned: Vertices that give a new part its motion.
constexpr int kRoundsWhileGrowing =
    2;                            // tuned (off: 0): Rounds each time the parts have doubled.
constexpr int kFinalRounds = 30;  // tuned (off: 0): Rounds of the final parts.
constexpr std::size_t kVerticesTogether = 1024;  // fixed: vertices of a pass

// Displacements from the first frame, x, y and z of all sample frames: translation + linear
// part * (position - centre).
struct AffineMotion {
  Point3 centre{};
  std::vector<double> linear;       // [3][values]
  std::vector<double> translation;  // [values]
};

class MotionParts {
 public:
  MotionParts(const SpanFrames& frames, const Graph& graph)
      : graph_(graph), partition_(frames.num_vertices), error_(frames.num_vertices) {
    const std::uint32_t moved = frames.num_frames - 1;
    const std::uint32_t sampled = std::min(moved, kSampleFrames);
    values_ = 3 * std::size_t{sampled};
    displacement_.resize(values_ * frames.num_vertices);
    for (std::size_t i = 0; i < sampled; ++i) {
      const auto frame = static_cast<std::uint32_t>((i + 1) * moved / sampled);
      for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
        for (std::size_t c = 0; c < 3; ++c) {
          displacement_[values_ * v + 3 * i + c] = frames.at(frame, v)[c] - frames.at(0, v)[c];
        }
      }
    }
    for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
      const double* const p = frames.at(0, v);
      rest_.push_back({p[0], p[1], p[2]});
    }
  }

  Partition run(std::uint32_t count) {
    fit_all(1);
    for (std::uint32_t v = 0; v < rest_.size(); ++v) error_[v] = error(motions_[0], v);
    std::size_t settled = 1;
    while (motions_.size() < count && add_part()) {
      if (motions_.size() < 2 * settled) continue;
      settled = motions_.size();
      settle(kRoundsWhileGrowing);
    }
    settle(kFinalRounds);
    return std::move(partition_);
  }

 private:
  AffineMotion fit(const std::vector<std::uint32_t>& vertices) const;
  double error(const AffineMotion& motion, std::uint32_t v) const;
  std::vector<std::uint32_t> around(std::uint32_t v) const;
  bool add_part();
  void fit_all(std::size_t count);
  bool assign();
  void settle(int rounds) {
    for (int i = 0; i < rounds; ++i) {
      fit_all(motions_.size());
      if (!assign()) break;
    }
  }

  const Graph& graph_;
  std::size_t values_ = 0;            // values of a displacement
  std::vector<Point3> rest_;          // positions in the first frame
  std::vector<double> displacement_;  // [num_vertices][values]
  std::vector<AffineMotion> motions_;
  Partition partition_;
  std::vector<double> error_;  // [vertex], in its part
};

AffineMotion MotionParts::fit(const std::vector<std::uint32_t>& vertices) const {
  AffineMotion motion;
  motion.translation.assign(values_, 0.0);
  const auto n = static_cast<double>(vertices.size());
  for (const std::uint32_t v : vertices) {
    for (std::size_t c = 0; c < 3; ++c) motion.centre[c] += rest_[v][c];
    for (std::size_t i = 0; i < values_; ++i) {
      motion.translation[i] += displacement_[values_ * v + i];
    }
  }
  for (double& c : motion.centre) c /= n;
  for (double& t : motion.translation) t /= n;
  std::vector<double> products(9);
  motion.linear.assign(3 * values_, 0.0);
  for (const std::uint32_t v : vertices) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = rest_[v][a] - motion.centre[a];
      for (std::size_t b = 0; b < 3; ++b) {
        products[3 * a + b] += x * (rest_[v][b] - motion.centre[b]);
      }
      double* const row = &motion.linear[a * values_];
      const double* const moved = &displacement_[values_ * v];
      for (std::size_t i = 0; i < values_; ++i) row[i] += x * moved[i];
    }
  }
  const double ridge = kRidge * (products[0] + products[4] + products[8]);
  for (std::size_t a = 0; a < 3; ++a) products[4 * a] += ridge;
  SymmetricSystem(std::move(products), 3).solve(motion.linear, values_);
  return motion;
}

double MotionParts::error(const AffineMotion& motion, std::uint32_t v) const {
  const double x = rest_[v][0] - motion.centre[0];
  const double y = rest_[v][1] - motion.centre[1];
  const double z = rest_[v][2] - motion.centre[2];
  const double* const moved = &displacement_[values_ * v];
  const double* const linear = motion.linear.data();
  double sum = 0.0;
  for (std::size_t i = 0; i < values_; ++i) {
    const double away = moved[i] - motion.translation[i] - x * linear[i] -
                        y * linear[values_ + i] - z * linear[2 * values_ + i];
    sum += away * away;
  }
  return sum;
}

// Returns the vertices of the graph that are nearest by edges.
std::vector<std::uint32_t> MotionParts::around(std::uint32_t v) const {
  std::vector<std::uint32_t> found{v};
  for (std::size_t i = 0; i < found.size() && found.size() < kSeedVertices; ++i) {
    for (const std::uint32_t u : graph_.neighbours(found[i])) {
      if (found.size() == kSeedVertices) break;
      if (std::find(found.begin(), found.end(), u) == found.end()) found.push_back(u);
    }
  }
  return found;
}

// Adds a part at the vertex with the largest error. Returns false if there is no error.
bool MotionParts::add_part() {
  const auto worst = std::max_element(error_.begin(), error_.end());
  if (*worst <= 0.0) return false;
  const auto seed = static_cast<std::uint32_t>(worst - error_.begin());
  const auto part = static_cast<std::uint16_t>(motions_.size());
  motions_.push_back(fit(around(seed)));
  for_ranges(rest_.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      const double other = error(motions_[part], static_cast<std::uint32_t>(v));
      if (other >= error_[v]) continue;
      error_[v] = other;
      partition_[v] = part;
    }
  });
  partition_[seed] = part;  // even if the motion of those around does not suit it
  error_[seed] = 0.0;       // not to be chosen again
  return true;
}

// Fits the motions of the first parts; a part without vertices keeps its motion.
void MotionParts::fit_all(std::size_t count) {
  motions_.resize(count);
  std::vector<std::vector<std::uint32_t>> vertices(count);
  for (std::uint32_t v = 0; v < partition_.size(); ++v) vertices[partition_[v]].push_back(v);
  for_each(count, [&](std::size_t i) {
    if (!vertices[i].empty()) motions_[i] = fit(vertices[i]);
  });
}

// Assigns vertices. Returns whether any moved to the part of a neighbour.
bool MotionParts::assign() {
  const Partition before = partition_;
  for_ranges(rest_.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const auto v = static_cast<std::uint32_t>(i);
      error_[v] = error(motions_[before[v]], v);
      std::uint16_t tried = before[v];
      for (const std::uint32_t u : graph_.neighbours(v)) {
        const std::uint16_t part = before[u];
        if (part == before[v] || part == tried || part == partition_[v]) continue;
        tried = part;
        const double other = error(motions_[part], v);
        if (other >= error_[v]) continue;
        error_[v] = other;
        partition_[v] = part;
      }
    }
  });
  return partition_ != before;
}

}  // namespace

Partition motion_partition(const SpanFrames& frames, const Graph& graph, std::uint32_t count) {
  return MotionParts(frames, graph).run(count);
}

}  // namespace rlpc
