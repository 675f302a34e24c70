#include "common/surface/local_turn.h"

#include <cmath>
#include <cstddef>

namespace rlpc {
namespace {

using Vec3 = LocalTurn::Vec3;
using Vec4 = std::array<double, 4>;
using Matrix4 = std::array<Vec4, 4>;

// Limit relative to the value for a certain rotation.
constexpr double kUncertain = 1e-12;

double square_of(const Vec3& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

// Returns Horn's matrix of the products of vectors. Its trace is 0.
Matrix4 horn_matrix(const std::array<Vec3, 3>& s) {
  const double x = s[1][2] - s[2][1];
  const double y = s[2][0] - s[0][2];
  const double z = s[0][1] - s[1][0];
  const double xy = s[0][1] + s[1][0];
  const double yz = s[1][2] + s[2][1];
  const double zx = s[2][0] + s[0][2];
  return {{{s[0][0] + s[1][1] + s[2][2], x, y, z},
           {x, s[0][0] - s[1][1] - s[2][2], xy, zx},
           {y, xy, s[1][1] - s[0][0] - s[2][2], yz},
           {z, zx, yz, s[2][2] - s[0][0] - s[1][1]}}};
}

// Determinant and adjugate of a symmetric matrix, from the minors of its upper and lower rows.
class Cofactors {
 public:
  explicit Cofactors(const Matrix4& m) : m_(m) {
    upper_ = minors(m[0], m[1]);
    lower_ = minors(m[2], m[3]);
  }

  double determinant() const {
    const auto& [s0, s1, s2, s3, s4, s5] = upper_;
    const auto& [c0, c1, c2, c3, c4, c5] = lower_;
    return s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
  }

  Vec4 diagonal() const {
    const auto& [s0, s1, s2, s3, s4, s5] = upper_;
    const auto& [c0, c1, c2, c3, c4, c5] = lower_;
    return {m_[1][1] * c5 - m_[1][2] * c4 + m_[1][3] * c3,
            m_[0][0] * c5 - m_[0][2] * c2 + m_[0][3] * c1,
            m_[3][0] * s4 - m_[3][1] * s2 + m_[3][3] * s0,
            m_[2][0] * s3 - m_[2][1] * s1 + m_[2][2] * s0};
  }

  Matrix4 adjugate() const {
    const auto& [s0, s1, s2, s3, s4, s5] = upper_;
    const auto& [c0, c1, c2, c3, c4, c5] = lower_;
    Matrix4 a{};
    const Vec4 on = diagonal();
    for (std::size_t i = 0; i < 4; ++i) a[i][i] = on[i];
    a[0][1] = -m_[0][1] * c5 + m_[0][2] * c4 - m_[0][3] * c3;
    a[0][2] = m_[3][1] * s5 - m_[3][2] * s4 + m_[3][3] * s3;
    a[0][3] = -m_[2][1] * s5 + m_[2][2] * s4 - m_[2][3] * s3;
    a[1][2] = -m_[3][0] * s5 + m_[3][2] * s2 - m_[3][3] * s1;
    a[1][3] = m_[2][0] * s5 - m_[2][2] * s2 + m_[2][3] * s1;
    a[2][3] = -m_[2][0] * s4 + m_[2][1] * s2 - m_[2][3] * s0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) a[i][j] = a[j][i];
    }
    return a;
  }

 private:
  static std::array<double, 6> minors(const Vec4& a, const Vec4& b) {
    return {a[0] * b[1] - b[0] * a[1], a[0] * b[2] - b[0] * a[2], a[0] * b[3] - b[0] * a[3],
            a[1] * b[2] - b[1] * a[2], a[1] * b[3] - b[1] * a[3], a[2] * b[3] - b[2] * a[3]};
  }

  const Matrix4& m_;
  std::array<double, 6> upper_{};
  std::array<double, 6> lower_{};
};

// Returns the largest root of the characteristic polynomial x^4 + c2 x^2 + c1 x + c0, starting
// from an upper bound.
double largest_eigenvalue(const Matrix4& m, double bound) {
  constexpr int kSteps = 50;  // fixed: more than a double root takes
  constexpr double kSmallStep =
      1e-13;  // fixed: relative to the bound; smaller steps are rounding errors
  double c2 = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) c2 -= 0.5 * m[i][j] * m[i][j];
  }
  const Cofactors cofactors(m);
  double c1 = 0.0;
  for (const double x : cofactors.diagonal()) c1 -= x;
  const double c0 = cofactors.determinant();
  double x = bound;
  for (int i = 0; i < kSteps; ++i) {
    const double value = ((x * x + c2) * x + c1) * x + c0;
    const double slope = (4 * x * x + 2 * c2) * x + c1;
    if (!(slope > 0.0)) break;
    const double next = x - value / slope;
    const bool is_last = !(x - next > kSmallStep * bound);
    x = next;
    if (is_last) break;
  }
  return x;
}

}  // namespace

void LocalTurn::add_edge(const Vec3& before, const Vec3& after) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) products_[i][j] += before[i] * after[j];
  }
  squares_before_ += square_of(before);
  squares_after_ += square_of(after);
}

void LocalTurn::add_area(const Vec3& before, const Vec3& after) {
  for (std::size_t i = 0; i < 3; ++i) {
    area_before_[i] += before[i];
    area_after_[i] += after[i];
  }
}

bool LocalTurn::find() {
  const double root_before = std::sqrt(std::sqrt(square_of(area_before_)));
  const double root_after = std::sqrt(std::sqrt(square_of(area_after_)));
  if (root_before > 0.0 && root_after > 0.0) {
    for (double& x : area_before_) x /= root_before;
    for (double& x : area_after_) x /= root_after;
    add_edge(area_before_, area_after_);
  }
  // Cauchy-Schwarz bound; equality where vectors are only rotated and scaled.
  const double bound = std::sqrt(squares_before_ * squares_after_);
  if (!(bound > 0.0)) return false;
  for (Vec3& row : products_) {
    for (double& x : row) x /= bound;
  }
  Matrix4 m = horn_matrix(products_);
  const double largest = largest_eigenvalue(m, 1.0);
  for (std::size_t i = 0; i < 4; ++i) m[i][i] -= largest;
  // The cofactors are products of the parts of the quaternion, times their sum of squares.
  const Matrix4 a = Cofactors(m).adjugate();
  const double squares = a[0][0] + a[1][1] + a[2][2] + a[3][3];
  if (!(std::abs(squares) > kUncertain)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    rotation_[i][i] = (a[0][0] + a[i + 1][i + 1] - a[j + 1][j + 1] - a[k + 1][k + 1]) / squares;
    rotation_[i][j] = 2.0 * (a[i + 1][j + 1] - a[0][k + 1]) / squares;
    rotation_[j][i] = 2.0 * (a[i + 1][j + 1] + a[0][k + 1]) / squares;
  }
  return true;
}

LocalTurn::Vec3 LocalTurn::turned_back(const Vec3& vector) const {
  Vec3 sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum[j] += rotation_[i][j] * vector[i];
  }
  return sum;
}

LocalTurn::Vec3 LocalTurn::turned(const Vec3& vector) const {
  Vec3 sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum[i] += rotation_[i][j] * vector[j];
  }
  return sum;
}

}  // namespace rlpc
