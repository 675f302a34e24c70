#include "encoder/codec/kinds/skinned/recover/trajectory_span.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "encoder/codec/math/eigenvectors.h"
#include "encoder/codec/math/matrix_products.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

// Returns M^T M - 1.
Eigen::Matrix3d strain(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d e = m.transpose() * m;
  e.diagonal().array() -= 1.0;
  return e;
}

double squared_strain(const Rotations& matrices) {
  double sum = 0.0;
  for (const Eigen::Matrix3d& m : matrices) sum += strain(m).squaredNorm();
  return sum;
}

Rotations nearest_rotations(const Rotations& matrices, const Rotations& start) {
  Rotations result(matrices.size());
  for (std::size_t f = 0; f < matrices.size(); ++f) {
    result[f] = closest_rotation(matrices[f], start[f]);
  }
  return result;
}

}  // namespace

RotationColumns orthonormal_columns(std::span<const Rotations* const> rotations) {
  if (rotations.empty()) return {};
  const std::size_t num_frames = rotations[0]->size();
  const std::size_t width = 3 * rotations.size();
  std::vector<double> all(3 * num_frames * width);
  for (std::size_t b = 0; b < rotations.size(); ++b) {
    for (std::size_t f = 0; f < num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t j = 0; j < 3; ++j) {
          all[(3 * f + c) * width + 3 * b + j] =
              (*rotations[b])[f](static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(j));
        }
      }
    }
  }
  constexpr double kSeparate = 1e-10;  // fixed: squared; as exact as rotations are found
  const EigenPairs pairs = leading_eigenvectors(gram_matrix(all, width), width, width,
                                                kSeparate * static_cast<double>(num_frames));
  RotationColumns columns;
  columns.count = pairs.vectors.size();
  std::vector<double> combination(width * columns.count);
  for (std::size_t k = 0; k < columns.count; ++k) {
    for (std::size_t i = 0; i < width; ++i) {
      combination[i * columns.count + k] = pairs.vectors[k][i] / std::sqrt(pairs.values[k]);
    }
  }
  columns.values = matrix_product(all, width, combination, columns.count);
  return columns;
}

TrajectorySpan::TrajectorySpan(const Trajectories& trajectories,
                               std::span<const std::uint32_t> vertices, double tolerance)
    : num_frames_(trajectories.num_frames()), num_vertices_(vertices.size()) {
  const std::size_t n = vertices.size();
  std::vector<double> rows(3 * num_frames_ * n);  // [3 * frame][vertex]
  for (std::size_t f = 0; f < num_frames_; ++f) {
    const Vec3d mean = trajectories.mean(f, vertices);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d p = trajectories.position(f, vertices[i]) - mean;
      for (std::size_t c = 0; c < 3; ++c) {
        rows[(3 * f + c) * n + i] = p(static_cast<Eigen::Index>(c));
      }
    }
  }
  const double values = 3.0 * static_cast<double>(num_frames_ * n);
  const EigenPairs pairs =
      leading_eigenvectors(gram_matrix(rows, n), n, n, tolerance * tolerance * values);
  rank_ = pairs.vectors.size();
  combination_.resize(n * rank_);
  for (std::size_t k = 0; k < rank_; ++k) {
    energy_.push_back(pairs.values[k]);
    const double scale = 1.0 / std::sqrt(pairs.values[k]);
    for (std::size_t i = 0; i < n; ++i)
      combination_[i * rank_ + k] = scale * pairs.vectors[k][i];
  }
  if (rank_ > 0) basis_ = matrix_product(rows, n, combination_, rank_);
}

// Returns the coordinates of the columns, [rank][3].
std::vector<double> TrajectorySpan::coordinates(const Rotations& rotation) const {
  std::vector<double> result(3 * rank_, 0.0);
  for (std::size_t f = 0; f < num_frames_; ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double* row = &basis_[(3 * f + c) * rank_];
      const auto at = static_cast<Eigen::Index>(c);
      const std::array<double, 3> values{rotation[f](at, 0), rotation[f](at, 1),
                                         rotation[f](at, 2)};
      for (std::size_t k = 0; k < rank_; ++k) {
        for (std::size_t j = 0; j < 3; ++j) result[3 * k + j] += row[k] * values[j];
      }
    }
  }
  return result;
}

Rotations TrajectorySpan::matrices(std::span<const double> coordinates) const {
  Rotations result(num_frames_);
  for (std::size_t f = 0; f < num_frames_; ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double* row = &basis_[(3 * f + c) * rank_];
      std::array<double, 3> sum{};
      for (std::size_t k = 0; k < rank_; ++k) {
        for (std::size_t j = 0; j < 3; ++j) sum[j] += row[k] * coordinates[3 * k + j];
      }
      for (std::size_t j = 0; j < 3; ++j) {
        result[f](static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(j)) = sum[j];
      }
    }
  }
  return result;
}

// Returns the normal equations for a change of the coordinates, column by column, that lowers
// the squared strain.
TrajectorySpan::StrainEquations TrajectorySpan::strain_equations(
    std::span<const double> coordinates) const {
  const Rotations now = matrices(coordinates);
  const std::size_t n = 3 * rank_;
  StrainEquations e{std::vector<double>(n * n), std::vector<double>(n, 0.0), 0.0};
  // Row f holds, for each column a, the products of the basis with that column in the frame.
  std::vector<double> along(num_frames_ * n, 0.0);
  for (std::size_t f = 0; f < num_frames_; ++f) {
    double* w = &along[f * n];
    for (std::size_t c = 0; c < 3; ++c) {
      const double* row = &basis_[(3 * f + c) * rank_];
      for (std::size_t a = 0; a < 3; ++a) {
        const double x = now[f](static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(a));
        for (std::size_t k = 0; k < rank_; ++k) w[a * rank_ + k] += row[k] * x;
      }
    }
    const Eigen::Matrix3d strained = strain(now[f]);
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double x =
            2.0 * strained(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        for (std::size_t k = 0; k < rank_; ++k) e.b[j * rank_ + k] += x * w[i * rank_ + k];
      }
    }
  }
  const std::vector<double> gram = gram_matrix(along, n);
  const auto product = [&](std::size_t a, std::size_t k, std::size_t b, std::size_t l) {
    const std::size_t row = a * rank_ + k;
    const std::size_t column = b * rank_ + l;
    return gram[std::max(row, column) * n + std::min(row, column)];
  };
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = j; i < 3; ++i) {
      for (std::size_t k = 0; k < rank_; ++k) {
        for (std::size_t l = 0; l < rank_; ++l) {
          double sum = 2.0 * product(i, k, j, l);
          if (i == j) {
            for (std::size_t a = 0; a < 3; ++a) sum += 2.0 * product(a, k, a, l);
          }
          e.a[(j * rank_ + k) * n + i * rank_ + l] = sum;
          if (i == j && k == l) e.mean += sum / static_cast<double>(n);
        }
      }
    }
  }
  return e;
}

// Takes a damped Gauss-Newton step towards coordinates of rotations. Returns the squared strain
// after it, or that before if no step lowers it.
double TrajectorySpan::step(std::vector<double>& coordinates, Damping& damping,
                            double before) const {
  const std::size_t n = 3 * rank_;
  const StrainEquations e = strain_equations(coordinates);
  for (; !damping.is_spent(); damping.tighten()) {
    std::vector<double> damped = e.a;
    for (std::size_t i = 0; i < n; ++i) damped[i * n + i] += damping.value() * e.mean;
    std::vector<double> x = e.b;
    SymmetricSystem(std::move(damped), n).solve(x);
    std::vector<double> moved = coordinates;
    for (std::size_t k = 0; k < rank_; ++k) {
      for (std::size_t j = 0; j < 3; ++j) moved[3 * k + j] -= x[j * rank_ + k];
    }
    const double after = squared_strain(matrices(moved));
    if (!(after < before)) continue;
    coordinates = std::move(moved);
    damping.relax();
    return after;
  }
  return before;
}

TrajectorySpan::Found TrajectorySpan::rotation_near(const Rotations& start) const {
  constexpr int kProjections = 12;        // fixed: brings most starts near enough for the steps
  constexpr int kSteps = 15;              // fixed: time; four are usual
  constexpr double kStalled = 1e-3;       // fixed: part of the strain that a step must remove
  constexpr double kNegligible = 1e-16;   // fixed: rounding, squared
  constexpr double kFirstDamping = 1e-3;  // fixed: the start is near
  constexpr std::size_t kStrains = 6;     // fixed: elements of a symmetric matrix
  Rotations near = start;
  std::vector<double> x;
  for (int i = 0; i < kProjections; ++i) {
    x = coordinates(near);
    near = nearest_rotations(matrices(x), near);
  }
  x = coordinates(near);
  double left = squared_strain(matrices(x));
  Damping damping(kFirstDamping);
  for (int i = 0; i < kSteps; ++i) {
    const double before = left;
    left = step(x, damping, before);
    if (left > (1.0 - kStalled) * before || left < kNegligible) break;
  }
  near = nearest_rotations(matrices(x), near);
  Found found;
  found.error = std::sqrt(left / static_cast<double>(kStrains * num_frames_));
  const Eigen::Matrix3d first = near.front().transpose();
  for (Eigen::Matrix3d& r : near) r *= first;
  found.rotation = std::move(near);
  for (std::size_t i = 0; i < num_vertices_; ++i) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t k = 0; k < rank_; ++k) {
      sum += combination_[i * rank_ + k] * Vec3d(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
    }
    found.combination.push_back(first.transpose() * sum);
  }
  return found;
}

double TrajectorySpan::distance(const Rotations& rotation) const {
  const std::vector<double> x = coordinates(rotation);
  Eigen::Matrix3d inside = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < rank_; ++k) {
    const Vec3d row(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
    inside += row * row.transpose();
  }
  // The columns of rotations are orthogonal, each with the squared norm num_frames, so the
  // eigenvalues are squared cosines.
  const Eigen::Matrix3d part = inside / static_cast<double>(num_frames_);
  const EigenPairs pairs =
      leading_eigenvectors({part(0, 0), part(0, 1), part(0, 2), part(1, 0), part(1, 1),
                            part(1, 2), part(2, 0), part(2, 1), part(2, 2)},
                           3, 3, 0.0);
  return std::sqrt(std::max(1.0 - pairs.values[1], 0.0));
}

double TrajectorySpan::unexplained(const RotationColumns& columns) const {
  const std::size_t count = columns.count;
  std::vector<double> inside(rank_ * count, 0.0);  // products of the basis and the columns
  for (std::size_t row = 0; row < 3 * num_frames_; ++row) {
    for (std::size_t k = 0; k < rank_; ++k) {
      subtract_multiple(-basis_[row * rank_ + k],
                        std::span(columns.values).subspan(row * count, count),
                        std::span(inside).subspan(k * count, count));
    }
  }
  double left = 0.0;
  for (std::size_t k = 0; k < rank_; ++k) {
    double square = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      square += inside[k * count + i] * inside[k * count + i];
    }
    left += energy_[k] * std::max(1.0 - square, 0.0);
  }
  return std::sqrt(left / (3.0 * static_cast<double>(num_frames_ * num_vertices_)));
}

}  // namespace rlpc
