#include "encoder/codec/attributes/normal_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/codec/attributes/recon/corner_geometry.h"
#include "encoder/codec/attributes/compared_normals.h"
#include "encoder/codec/attributes/quantise_attribute.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

using Point = std::array<std::uint32_t, 2>;

constexpr std::uint32_t kSmoothingBits = 10;  // fixed: what smoothing is fitted to
// fixed: degrees by which a normal that follows from positions may be worse than a stored
// one; at a KG error of 0.1 %, normals of triangles are off by as much (README).
constexpr double kServes = 1.0;
// fixed: half of that; by how much (RMS) normals may be worse than the best way to code them.
// On q-character, robot, q-spider and cesium-man, normals take 19 to 31 % more bytes at half of
// it, and are off by 0.03 to 0.07 degrees less; 13 to 33 % fewer bytes at double, and by 0.12
// to 0.26 degrees more.
constexpr double kLost = kServes / 2;
// fixed: degrees; single normals that gain more than this are stored in any case
constexpr double kMuchBetter = 10.0;
// fixed: RMS degrees up to which smoothing takes the place of unit vectors that would keep
// their direction whatever the surface does
constexpr double kBetterThanStill = 20.0;

// Positions of the rest shape, as integers, and triangles with their indices.
struct RestShape {
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> positions;
};

std::optional<RestShape> rest_shape(const NormalTask& task) {
  const SourceAttributes& source = task.source;
  if (source.rest_xyz.empty()) return std::nullopt;
  double largest = 0.0;
  for (const float x : source.rest_xyz) largest = std::max<double>(largest, std::abs(x));
  const double scale = largest > 0.0 ? static_cast<double>(1 << 22) / largest : 0.0;
  RestShape shape;
  for (const float x : source.rest_xyz) {
    shape.positions.push_back(static_cast<std::int32_t>(round_to_int(x * scale)));
  }
  for (std::size_t t = 0; t < task.triangles.size(); ++t) {
    Triangle& triangle = shape.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = source.rest_of_corner[task.corner_map[3 * t + k]];
    }
  }
  return shape;
}

// Returns the normals of sectors from those of values; zero: none.
std::vector<Vec3d> sector_normals(const NormalTask& task, std::span<const float> values) {
  std::vector<Vec3d> normals;
  normals.reserve(task.value_of_sector.size());
  for (const std::uint32_t i : task.value_of_sector) {
    const float* const v = i == kNoSector ? nullptr : &values[3 * std::size_t{i}];
    normals.push_back(v == nullptr ? Vec3d{} : normalised({v[0], v[1], v[2]}));
  }
  return normals;
}

Smoothing smoothing_at_rest(const NormalTask& task, const std::vector<Vec3d>& at_rest) {
  std::vector<Point> wanted;
  wanted.reserve(at_rest.size());
  for (const Vec3d& n : at_rest) {
    wanted.push_back(octahedron_point(is_zero(n) ? Vec3d{0.0, 0.0, 1.0} : n, kSmoothingBits));
  }
  const std::optional<RestShape> rest = rest_shape(task);
  const CornerGeometry geometry = rest ? CornerGeometry(rest->triangles, rest->positions)
                                       : CornerGeometry(task.triangles, task.first_frame);
  return find_smoothing({geometry, task.edge_mates, task.seams, task.sectors}, wanted,
                        kSmoothingBits);
}

std::vector<ComparedFrame> compared_frames(const NormalTask& task,
                                           const std::vector<Vec3d>& at_rest) {
  std::vector<ComparedFrame> frames;
  const std::vector<float>& first = task.source.first_normals;
  frames.push_back(
      {0, task.first_frame, first.empty() ? at_rest : sector_normals(task, first)});
  for (const DecodedFrame& later : task.later_frames) {
    const auto found =
        std::ranges::find(task.source.later_normals, later.frame, &PosedNormals::frame);
    if (found == task.source.later_normals.end()) continue;
    frames.push_back({later.frame, later.positions, sector_normals(task, found->normals)});
  }
  return frames;
}

// RMS of differences.
class Total {
 public:
  void add(double rms, double weight) {
    squares_ += weight * rms * rms;
    weights_ += weight;
  }
  double rms() const { return weights_ > 0.0 ? std::sqrt(squares_ / weights_) : 0.0; }

 private:
  double squares_ = 0.0;
  double weights_ = 0.0;
};

class NormalPlanner {
 public:
  NormalPlanner(const NormalTask& task, const AttributeSettings& settings)
      : task_(task), settings_(settings), at_rest_(sector_normals(task, task.values)) {}

  NormalPlan plan() {
    NormalPlan plan;
    plan.smoothing = smoothing_at_rest(task_, at_rest_);
    const std::vector<ComparedFrame> frames = compared_frames(task_, at_rest_);
    const ComparedNormals compared(
        {task_.triangles, task_.num_vertices, task_.edge_mates, task_.seams, task_.sectors,
         plan.smoothing, settings_.from_positions},
        frames);
    is_exact_ = settings_.exact || settings_.normals == NormalChoice::kExact;
    for (std::uint32_t x = 0; x < task_.sectors.count(); ++x) {
      plan.points.push_back(
          octahedron_point(vector_of(compared, frames[0].normals[x], x), task_.value_bits));
      stored_.push_back(octahedron_vector(plan.points.back(), task_.value_bits));
      smooth_.push_back(compared.smoothing_error(x));
      vector_.push_back(compared.vector_error(x, stored_.back()));
    }
    plan.follows = followers(compared);
    if (settings_.from_positions) {
      for (std::uint32_t x = 0; x < count(); ++x) {
        if (!compared.can_turn(x)) plan.follows[x] = true;
      }
    }
    for (std::uint32_t x = 0; x < count(); ++x) {
      plan.must_turn.push_back(!plan.follows[x] && smooth_[x] - vector_[x] > kServes);
    }
    plan.is_smoothing = std::ranges::all_of(plan.follows, [](bool x) { return x; }) &&
                        settings_.normals != NormalChoice::kExact && !settings_.exact;
    if (settings_.normals == NormalChoice::kSmoothing) plan.is_smoothing = true;
    plan.errors = compared.errors(plan.follows, stored_);
    Total all;
    for (const NormalError& error : plan.errors) all.add(error.rms, 1.0);
    plan.rms_error = all.rms();
    return plan;
  }

 private:
  std::uint32_t count() const { return task_.sectors.count(); }

  // Returns the vector to store for a sector. in_first: the normal of the input in the first
  // frame.
  Vec3d vector_of(const ComparedNormals& compared, const Vec3d& in_first,
                  std::uint32_t x) const {
    if (is_exact_ && compared.is_in_first(x)) return in_first;
    if (const auto best = compared.best_vector(x)) return *best;
    if (!is_zero(in_first)) return in_first;
    return is_zero(at_rest_[x]) ? Vec3d{0.0, 0.0, 1.0} : at_rest_[x];
  }

  Total total(const ComparedNormals& compared, const std::vector<bool>& follows) const {
    Total total;
    for (std::uint32_t x = 0; x < count(); ++x) {
      total.add(follows[x] ? smooth_[x] : vector_[x], compared.weight(x));
    }
    return total;
  }

  // Stores the normals that gain most, until all others together lose at most kLost, and every
  // normal that gains much.
  std::vector<bool> follow_where_it_serves(const ComparedNormals& compared) const {
    std::vector<bool> follows(count(), true);
    std::vector<std::pair<double, std::uint32_t>> gains;  // squared, and the sector
    double weights = 0.0;
    double lost = 0.0;
    for (std::uint32_t x = 0; x < count(); ++x) {
      const double weight = compared.weight(x);
      weights += weight;
      const double gain = weight * (smooth_[x] * smooth_[x] - vector_[x] * vector_[x]);
      if (!(gain > 0.0)) continue;
      gains.emplace_back(-gain, x);
      lost += gain;
    }
    std::ranges::sort(gains);
    for (const auto& [minus_gain, x] : gains) {
      const bool is_enough = lost <= kLost * kLost * weights;
      if (is_enough && smooth_[x] - vector_[x] <= kMuchBetter) continue;
      follows[x] = false;
      lost += minus_gain;
    }
    return follows;
  }

  std::vector<bool> followers(const ComparedNormals& compared) const {
    std::vector<bool> all(count(), true);
    std::vector<bool> none(count(), false);
    if (settings_.normals == NormalChoice::kSmoothing) return all;
    if (!settings_.from_positions) {
      if (is_exact_) return none;
      const double smooth = total(compared, all).rms();
      const bool is_judged = !task_.is_animated || !task_.later_frames.empty();
      const double still = is_judged ? total(compared, none).rms() : kBetterThanStill;
      return smooth <= std::max(kServes, still) ? all : none;
    }
    if (is_exact_) {
      std::vector<bool> follows(count());  // set for sectors that are not in the first frame
      for (std::uint32_t x = 0; x < count(); ++x) {
        const bool must_be_exact = compared.is_in_first(x) || compared.weight(x) == 0.0;
        follows[x] = !must_be_exact && smooth_[x] <= vector_[x];
      }
      return follows;
    }
    return follow_where_it_serves(compared);
  }

  const NormalTask& task_;
  const AttributeSettings& settings_;
  std::vector<Vec3d> at_rest_;
  bool is_exact_ = false;
  // [sector]
  std::vector<Vec3d> stored_;
  std::vector<double> smooth_;  // errors
  std::vector<double> vector_;
};

}  // namespace

NormalPlan plan_normals(const NormalTask& task, const AttributeSettings& settings) {
  return NormalPlanner(task, settings).plan();
}

}  // namespace rlpc
