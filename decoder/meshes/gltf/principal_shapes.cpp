// Principal components of the moves, in blocks: each is made from the residual of the previous
// blocks, including their rounding.
#include "decoder/meshes/gltf/principal_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;

// Numbers of frames and vertices from which a block is made: all, or as many at equal
// distances, different ones for each block.
constexpr Index kMaxSampledFrames = 256;
constexpr Index kMaxSampledVertices = 2048;
constexpr Index kTargetsOfBlock = 16;
constexpr Index kRows = 4096;  // rows multiplied at a time

// Part of the RMS that is aimed at: a target leaves out vertices that it would move by less, as
// sparse accessors take fewer bytes; but no more of them than make up the other part of its
// squares, so that each target reduces the residual. Other targets compensate for some. With
// half of the tolerance, 0.25 saves 15 to 25 % of files with many targets; 0.2 or 0.35 save 1
// to 5 % less or more, depending on the model; 0.5 may double the number of targets.
constexpr double kThinned = 0.25;
constexpr double kMaxThinned = 0.2;

// Returns index `i` of `count` out of `total`.
Index chosen(Index i, Index count, Index total, Index number) {
  return count == total ? i : (i * total + number % count) / count;
}

MatrixXf some_columns(const MatrixXf& moves, Index number) {
  const Index count = std::min(kMaxSampledFrames, moves.cols());
  MatrixXf some(moves.rows(), count);
  for (Index i = 0; i < count; ++i) {
    some.col(i) = moves.col(chosen(i, count, moves.cols(), number));
  }
  return some;
}

MatrixXf some_vertices(const MatrixXf& moves, Index number) {
  const Index total = moves.rows() / 3;
  const Index count = std::min(kMaxSampledVertices, total);
  MatrixXf some(3 * count, moves.cols());
  for (Index i = 0; i < count; ++i) {
    some.middleRows<3>(3 * i) = moves.middleRows<3>(3 * chosen(i, count, total, number));
  }
  return some;
}

// Returns a^T b, summed in double.
MatrixXd products_of(const MatrixXf& a, const MatrixXf& b) {
  MatrixXd products = MatrixXd::Zero(a.cols(), b.cols());
  for (Index first = 0; first < a.rows(); first += kRows) {
    const Index rows = std::min(kRows, a.rows() - first);
    products.noalias() += a.middleRows(first, rows).cast<double>().transpose() *
                          b.middleRows(first, rows).cast<double>();
  }
  return products;
}

// Returns columns that together contain most of the moves.
MatrixXf principal_columns(const MatrixXf& moves, Index number) {
  const MatrixXf some = some_columns(moves, number);
  const MatrixXf fewer = some_vertices(some, number);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(products_of(fewer, fewer));
  const Index count = std::min(kTargetsOfBlock, some.cols());
  return some * solver.eigenvectors().rightCols(count).rowwise().reverse().cast<float>();
}

// Returns the unit of targets that move a vertex at most this far with a weight of 1.
float unit_of(float farthest) { return farthest <= 1 ? 1.0F / 127 : 1.0F; }

// Rounds a column to bytes of a unit; the largest is 127. Returns false if all are zero.
bool round_to_bytes(Eigen::Ref<Eigen::VectorXf> column, float unit) {
  const float largest = column.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return false;
  column *= 127 / largest;
  for (float& x : column) x = std::round(x) * unit;
  return true;
}

double rms_of(const Eigen::Ref<const Eigen::RowVectorXd>& row) {
  return row.norm() / std::sqrt(static_cast<double>(row.size()));
}

// Sets vertices that a column moves least, by less than `length`, to 0.
void thin_out(Eigen::Ref<Eigen::VectorXf> column, double length) {
  std::vector<std::pair<double, Index>> order;
  for (Index i = 0; i < column.size(); i += 3) {
    const double square = column.segment<3>(i).squaredNorm();
    if (square < length * length) order.emplace_back(square, i);
  }
  std::ranges::sort(order);
  double room = kMaxThinned * column.squaredNorm();
  for (const auto& [square, i] : order) {
    room -= square;
    if (room < 0) break;
    column.segment<3>(i).setZero();
  }
}

// Size of a file with the targets so far.
class Budget {
 public:
  // price: null if only the number of targets counts.
  Budget(const TargetPrice* price, const MatrixXf& moves, bool has_short_weights)
      : price_(price),
        num_vertices_(static_cast<double>(moves.rows()) / 3),
        num_frames_(static_cast<double>(moves.cols())),
        weights_(num_frames_ * (has_short_weights ? 2 : 4)) {
    if (price_ == nullptr) return;
    bytes_ = price_->file_bytes;
    target_bytes_ = kVertexBytes * price_->written_vertices * num_vertices_ + weights_;
  }

  // Returns numbers to minimise, the first one first: the excess of squares over those of the
  // other errors; and the square of bytes times errors or, without a price, minus the number of
  // targets. count: number of further targets; left: squares of their residual.
  std::array<double, 2> loss(Index count, double left) const {
    if (price_ == nullptr) return {0, -static_cast<double>(count)};
    const double bytes = bytes_ + static_cast<double>(count) * target_bytes_;
    const double other = price_->other_rms * price_->other_rms;
    const double own = left / (num_vertices_ * num_frames_);
    return {std::max(0.0, own - other), bytes * bytes * (other + own)};
  }

  // Adds targets; further targets are assumed to be similar.
  void add(const MatrixXf& targets) {
    if (price_ == nullptr) return;
    const auto count = static_cast<double>(targets.cols());
    double bytes = count * weights_;
    for (Index k = 0; k < targets.cols(); ++k) {
      double moved = 0;
      for (Index i = 0; i < targets.rows(); i += 3) {
        if (!targets.col(k).segment<3>(i).isZero(0)) ++moved;
      }
      bytes += price_->written_vertices *
               std::min(kVertexBytes * num_vertices_, kSparseVertexBytes * moved);
    }
    bytes_ += bytes;
    target_bytes_ = bytes / count;
  }

 private:
  static constexpr double kVertexBytes = 4;        // three values and padding
  static constexpr double kSparseVertexBytes = 5;  // three values and an index of 16 bits

  const TargetPrice* price_;
  double num_vertices_;
  double num_frames_;
  double weights_;  // bytes of the weights of a target
  double bytes_ = 0;
  double target_bytes_ = 0;
};

// RMS of the residual to aim at, and RMS by which shapes are thinned out.
struct Aim {
  double rms;
  double thinned;
};

PrincipalShapes shapes_of(MatrixXf& moves, const Aim& aim, std::size_t max_targets, float unit,
                          const TargetPrice* price) {
  const double rms = aim.rms;
  const double places =
      static_cast<double>(moves.rows()) / 3 * static_cast<double>(moves.cols());
  const double wanted = rms * rms * places;
  PrincipalShapes shapes;
  shapes.targets.resize(moves.rows(), 0);
  shapes.weights.resize(0, moves.cols());
  shapes.unit = unit;
  shapes.has_short_weights = rms > 2 * 127 * unit * kWeightUnit;
  Budget budget(price, moves, shapes.has_short_weights);
  double left = moves.cast<double>().squaredNorm();
  const auto max = static_cast<Index>(max_targets);
  while (left > wanted && shapes.targets.cols() < max) {
    MatrixXf block = principal_columns(moves, 61 * shapes.targets.cols());
    Index room = 0;
    const Index columns = std::min(block.cols(), max - shapes.targets.cols());
    while (room < columns && round_to_bytes(block.col(room), unit)) ++room;
    // Keeps as few shapes of the block as suffice, or as many as are worth their price.
    block.conservativeResize(Eigen::NoChange, room);
    const MatrixXd squares = products_of(block, block);
    const MatrixXd products = products_of(block, moves);
    MatrixXd weights;
    Index count = 0;
    Index tried = 0;
    std::array<double, 2> min_loss = budget.loss(0, left);
    for (double rest = left; tried < room && rest > wanted;) {
      ++tried;
      const auto some = products.topRows(tried);
      const MatrixXd solution = squares.topLeftCorner(tried, tried).ldlt().solve(some);
      rest = left - solution.cwiseProduct(some).sum();
      const auto loss = budget.loss(tried, rest);
      if (!(loss < min_loss)) continue;
      min_loss = loss;
      count = tried;
      weights = solution;
    }
    if (count == 0) break;
    block.conservativeResize(Eigen::NoChange, count);
    for (Index k = 0; k < count; ++k) {
      thin_out(block.col(k), kThinned * aim.thinned / rms_of(weights.row(k)));
    }
    weights = products_of(block, block).ldlt().solve(products_of(block, moves));
    MatrixXf rounded = weights.cast<float>();
    shapes.has_short_weights = shapes.has_short_weights && rounded.cwiseAbs().maxCoeff() <= 1;
    if (shapes.has_short_weights) {
      rounded = (rounded / kWeightUnit).array().round() * kWeightUnit;
    }
    moves.noalias() -= block * rounded;
    const double before = left;
    left = moves.cast<double>().squaredNorm();
    if (!(left < before)) break;
    budget.add(block);
    const Index first = shapes.targets.cols();
    shapes.targets.conservativeResize(Eigen::NoChange, first + count);
    shapes.targets.rightCols(count) = block;
    shapes.weights.conservativeResize(first + count, Eigen::NoChange);
    shapes.weights.bottomRows(count) = rounded;
    if (count < tried) break;
  }
  return shapes;
}

}  // namespace

PrincipalShapes principal_shapes(MatrixXf moves, double rms, std::size_t max_targets) {
  const float farthest = moves.size() > 0 ? moves.cwiseAbs().maxCoeff() : 0;
  return shapes_of(moves, {rms, rms}, max_targets, unit_of(farthest), nullptr);
}

PrincipalShapes principal_shapes_of(MatrixXf& moves, double rms, double thinned,
                                    std::size_t max_targets, float unit) {
  return shapes_of(moves, {rms, thinned}, max_targets, unit, nullptr);
}

PrincipalShapes principal_shapes(MatrixXf moves, double rms, std::size_t max_targets,
                                 const TargetPrice& price) {
  const float farthest = moves.size() > 0 ? moves.cwiseAbs().maxCoeff() : 0;
  return shapes_of(moves, {rms, rms}, max_targets, unit_of(farthest), &price);
}

}  // namespace rlpc
