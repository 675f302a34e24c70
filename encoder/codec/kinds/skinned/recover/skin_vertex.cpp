#include "encoder/codec/kinds/skinned/recover/skin_vertex.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/recover/convex_weights.h"
#include "encoder/codec/math/matrix_products.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

std::vector<double> times(const std::vector<double>& gram, const std::vector<double>& x) {
  const std::size_t n = x.size();
  std::vector<double> result(n, 0.0);
  for (std::size_t s = 0; s < n; ++s) {
    if (x[s] == 0.0) continue;  // most are, of a vertex that follows few of many bones
    subtract_multiple(-x[s], std::span(gram).subspan(s * n, n), result);
  }
  return result;
}

NormalEquations normal_equations(const std::vector<double>& gram, const std::vector<double>& d,
                                 const std::vector<double>& products, std::size_t count) {
  const std::size_t size = products.size();
  // Columns have few rows that are not 0: a bone moves its own coordinates and its parent's.
  struct Entry {
    std::size_t row;
    double value;
  };
  std::vector<Entry> entries;         // column by column
  std::vector<std::size_t> first{0};  // entries of the columns before
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t s = 0; s < size; ++s) {
      const double value = d[s * count + p];
      if (value != 0.0) entries.push_back({s, value});
    }
    first.push_back(entries.size());
  }
  const auto column = [&](std::size_t p) {
    return std::span(entries).subspan(first[p], first[p + 1] - first[p]);
  };
  NormalEquations e{std::vector<double>(count * count, 0.0), std::vector<double>(count, 0.0)};
  std::vector<double> gd(size);
  for (std::size_t p = 0; p < count; ++p) {
    std::fill(gd.begin(), gd.end(), 0.0);
    for (const auto& [row, value] : column(p)) {
      e.b[p] += value * products[row];
      subtract_multiple(-value, std::span(gram).subspan(row * size, size), gd);
    }
    for (std::size_t q = 0; q <= p; ++q) {
      double sum = 0.0;
      for (const auto& [row, value] : column(q)) sum += value * gd[row];
      e.a[p * count + q] = e.a[q * count + p] = sum;
    }
  }
  return e;
}

void add_block(const Eigen::Matrix3d& m, std::size_t row, std::size_t column, std::size_t width,
               std::vector<double>& to) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      to[(row + r) * width + column + c] +=
          m(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
    }
  }
}

std::vector<double> point_derivatives(const PlacedBones& bones, const BoneSpace::Part& part,
                                      std::span<const RigWeight> weights, const Vec3d& rest,
                                      bool weights_vary) {
  const std::size_t size = part.size();
  const std::size_t others = weights_vary ? weights.size() - 1 : 0;
  const std::size_t count = 3 + others;
  std::vector<double> d(size * count, 0.0);
  std::vector<double> last(size, 0.0);
  bones.add_moved(part, weights.back().bone, rest, 1.0, last);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const RigWeight& w = weights[k];
    add_block(w.weight * bones.turn(w.bone), part.place(w.bone), 0, count, d);
    if (k >= others) continue;
    std::vector<double> one(size, 0.0);
    bones.add_moved(part, w.bone, rest, 1.0, one);
    for (std::size_t s = 0; s < size; ++s) d[s * count + 3 + k] = one[s] - last[s];
  }
  return d;
}

SkinVertex::SkinVertex(const PlacedBones& bones, std::span<const Vec3d> trajectory,
                       std::vector<std::uint32_t> candidates)
    : products_(bones.space().products(trajectory)), fit_{trajectory[0], {}, 0.0} {
  for (const Vec3d& x : trajectory) square_ += x.squaredNorm();
  if (candidates.empty()) {
    widen(bones);
  } else {
    take(bones.space(), std::move(candidates));
  }
  double min = std::numeric_limits<double>::infinity();
  for (const std::uint32_t b : part_.bones) {
    const Vec3d rest = bones.rest_of(b, trajectory[0]);
    const double error = error_of_one(bones, b, rest);
    if (!(error < min)) continue;
    min = error;
    fit_.rest = rest;
  }
}

// Returns the squared error if the vertex follows one bone, less the square of the trajectory.
double SkinVertex::error_of_one(const PlacedBones& bones, std::uint32_t bone,
                                const Vec3d& rest) const {
  std::vector<double> x(part_.size(), 0.0);
  bones.add_moved(part_, bone, rest, 1.0, x);
  return dot(x, times(part_.gram, x)) - 2.0 * dot(x, wanted_);
}

void SkinVertex::take(const BoneSpace& space, std::vector<std::uint32_t> bones) {
  part_ = space.part(std::move(bones));
  wanted_.clear();
  for (const std::size_t c : part_.coordinates) wanted_.push_back(products_[c]);
}

void SkinVertex::widen(const PlacedBones& bones) {
  constexpr std::size_t kCandidates = 12;  // fixed: time
  const BoneSpace& space = bones.space();
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t b = 0; b < space.num_bones(); ++b) {
    if (!space.has_place(b)) continue;
    take(space, {b});
    order.emplace_back(error_of_one(bones, b, fit_.rest), b);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> chosen;
  for (const RigWeight& w : fit_.weights) chosen.push_back(w.bone);
  for (const auto& [error, b] : order) {
    if (chosen.size() == kCandidates) break;
    if (std::find(chosen.begin(), chosen.end(), b) == chosen.end()) chosen.push_back(b);
  }
  std::sort(chosen.begin(), chosen.end());
  take(space, std::move(chosen));
}

void SkinVertex::fit(const PlacedBones& bones, int rounds) {
  for (int i = 0; i < rounds; ++i) {
    fit_weights(bones);
    fit_rest(bones);
  }
  fit_weights(bones);
  polish(bones);
}

void SkinVertex::fit_weights(const PlacedBones& bones) {
  const std::size_t count = part_.bones.size();
  const std::size_t size = part_.size();
  std::vector<std::vector<double>> x(count, std::vector<double>(size, 0.0));  // [candidate]
  std::vector<double> along(count);
  for (std::size_t i = 0; i < count; ++i) {
    bones.add_moved(part_, part_.bones[i], fit_.rest, 1.0, x[i]);
    along[i] = dot(x[i], wanted_);
  }
  std::vector<double> gram(count * count);  // of the errors of a vertex that follows one bone
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double> gx = times(part_.gram, x[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      const double both = dot(x[j], gx);
      gram[i * count + j] = gram[j * count + i] = both - along[i] - along[j] + square_;
    }
    double& own = gram[i * count + i];
    own = std::max(own, 0.0);  // negative only by rounding
  }
  const std::vector<double> w = convex_weights(gram, count, kMaxExtraBones);
  fit_.weights.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if (w[i] > 0.0) fit_.weights.push_back({part_.bones[i], w[i]});
  }
}

// Returns the coordinates of the vertex as its bones move it.
std::vector<double> SkinVertex::moved(const PlacedBones& bones) const {
  std::vector<double> x(part_.size(), 0.0);
  for (const RigWeight& w : fit_.weights)
    bones.add_moved(part_, w.bone, fit_.rest, w.weight, x);
  return x;
}

double SkinVertex::error(const PlacedBones& bones) const {
  const std::vector<double> x = moved(bones);
  const double error = dot(x, times(part_.gram, x)) - 2.0 * dot(x, wanted_) + square_;
  return std::max(error, 0.0);  // negative only by rounding
}

void SkinVertex::fit_rest(const PlacedBones& bones) {
  constexpr double kPull = 1e-8;  // fixed: directions that frames leave open
  std::vector<double> turns(part_.size() * 3, 0.0);
  for (const RigWeight& w : fit_.weights) {
    add_block(w.weight * bones.turn(w.bone), part_.place(w.bone), 0, 3, turns);
  }
  std::vector<double> left = wanted_;
  const std::vector<double> gx = times(part_.gram, moved(bones));
  for (std::size_t i = 0; i < left.size(); ++i) left[i] -= gx[i];
  NormalEquations e = normal_equations(part_.gram, turns, left, 3);
  const double trace = e.a[0] + e.a[4] + e.a[8];
  for (std::size_t i = 0; i < 3; ++i) e.a[4 * i] += kPull * trace;
  SymmetricSystem(std::move(e.a), 3).solve(e.b);
  fit_.rest += Vec3d(e.b[0], e.b[1], e.b[2]);
}

// Moves rest position and weights by Gauss-Newton steps, as long as the error falls.
void SkinVertex::polish(const PlacedBones& bones) {
  constexpr int kSteps = 5;          // fixed: two or three converge
  constexpr double kRegular = 1e-9;  // fixed: directions that frames leave open
  const std::size_t size = part_.size();
  fit_.squared_error = error(bones);
  for (int i = 0; i < kSteps; ++i) {
    const std::vector<RigWeight> weights = fit_.weights;
    const Vec3d rest = fit_.rest;
    const std::size_t others = weights.size() - 1;  // the last weight follows from the others
    const std::size_t unknowns = 3 + others;
    const std::vector<double> d = point_derivatives(bones, part_, weights, rest, true);
    std::vector<double> left = wanted_;
    const std::vector<double> gx = times(part_.gram, moved(bones));
    for (std::size_t s = 0; s < size; ++s) left[s] -= gx[s];
    NormalEquations e = normal_equations(part_.gram, d, left, unknowns);
    for (std::size_t p = 0; p < unknowns; ++p) e.a[p * unknowns + p] *= 1.0 + kRegular;
    SymmetricSystem(std::move(e.a), unknowns).solve(e.b);
    fit_.rest += Vec3d(e.b[0], e.b[1], e.b[2]);
    double taken = 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double more = k < others ? e.b[3 + k] : -taken;
      taken += more;
      fit_.weights[k].weight = std::max(weights[k].weight + more, 0.0);
      sum += fit_.weights[k].weight;
    }
    std::erase_if(fit_.weights, [](const RigWeight& w) { return w.weight == 0.0; });
    for (RigWeight& w : fit_.weights) w.weight /= sum;
    const double after = error(bones);
    if (!(after < fit_.squared_error)) {
      fit_.rest = rest;
      fit_.weights = weights;
      break;
    }
    fit_.squared_error = after;
  }
}

}  // namespace rlpc
