#include "encoder/codec/math/principal_components.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "encoder/testing/dot.h"

namespace rlpc {
namespace {

// Returns the sum of `rank` outer products of random vectors.
TrajectoryMatrix random_matrix(unsigned seed, std::size_t num_values, std::size_t num_frames,
                               std::size_t rank) {
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<double>(random() % 20001) / 1000.0 - 10.0; };
  TrajectoryMatrix m{num_values, num_frames, std::vector<double>(num_values * num_frames)};
  for (std::size_t l = 0; l < rank; ++l) {
    std::vector<double> spatial(num_values);
    std::vector<double> temporal(num_frames);
    for (double& x : spatial) x = next();
    for (double& x : temporal) x = next();
    for (std::size_t i = 0; i < num_values; ++i) {
      for (std::size_t f = 0; f < num_frames; ++f) m.row(i)[f] += spatial[i] * temporal[f];
    }
  }
  return m;
}

TrajectoryMatrix transposed(const TrajectoryMatrix& m) {
  TrajectoryMatrix t{m.num_frames, m.num_values, std::vector<double>(m.a.size())};
  for (std::size_t i = 0; i < m.num_values; ++i) {
    for (std::size_t f = 0; f < m.num_frames; ++f) t.row(f)[i] = m.row(i)[f];
  }
  return t;
}

double largest_error(const TrajectoryMatrix& m, const PrincipalComponents& pc) {
  double largest = 0.0;
  for (std::size_t i = 0; i < m.num_values; ++i) {
    for (std::size_t f = 0; f < m.num_frames; ++f) {
      double sum = 0.0;
      for (std::size_t l = 0; l < pc.spatial.size(); ++l) {
        sum += pc.spatial[l][i] * pc.temporal[l][f];
      }
      largest = std::max(largest, std::abs(sum - m.row(i)[f]));
    }
  }
  return largest;
}

struct Size {
  std::size_t num_values;
  std::size_t num_frames;
};
// More values than frames, fewer, and equal numbers: both kinds of Gram matrix.
const std::vector<Size> kSizes{{30, 8}, {9, 40}, {12, 12}, {12, 13}, {3, 1}, {3, 2}};

TEST(PrincipalComponents, ReproduceALowRankMatrixWithFewComponents) {
  for (const Size& size : kSizes) {
    constexpr unsigned kSeed = 1;
    SCOPED_TRACE(testing::Message()
                 << "seed " << kSeed << ", " << size.num_values << " x " << size.num_frames);
    const std::size_t rank =
        std::min<std::size_t>(3, std::min(size.num_values, size.num_frames));
    const TrajectoryMatrix m = random_matrix(kSeed, size.num_values, size.num_frames, rank);
    const PrincipalComponents pc = principal_components(m, 100, 1e-6);
    EXPECT_EQ(pc.spatial.size(), rank);
    EXPECT_EQ(pc.temporal.size(), rank);
    EXPECT_LT(largest_error(m, pc), 1e-9);
  }
}

TEST(PrincipalComponents, TemporalVectorsAreOrthonormalAndSpatialVectorsCarryTheEnergy) {
  for (const Size& size : kSizes) {
    constexpr unsigned kSeed = 2;
    SCOPED_TRACE(testing::Message()
                 << "seed " << kSeed << ", " << size.num_values << " x " << size.num_frames);
    const TrajectoryMatrix m = random_matrix(kSeed, size.num_values, size.num_frames, 40);
    const PrincipalComponents pc = principal_components(m, 100, 1e-6);
    ASSERT_EQ(pc.spatial.size(), std::min(size.num_values, size.num_frames));
    const double scale = pc.energy[0];
    for (std::size_t l = 0; l < pc.spatial.size(); ++l) {
      ASSERT_EQ(pc.temporal[l].size(), size.num_frames);
      ASSERT_EQ(pc.spatial[l].size(), size.num_values);
      for (std::size_t k = 0; k < pc.spatial.size(); ++k) {
        EXPECT_NEAR(dot(pc.temporal[l], pc.temporal[k]), l == k ? 1.0 : 0.0, 1e-9);
        EXPECT_NEAR(dot(pc.spatial[l], pc.spatial[k]), l == k ? pc.energy[l] : 0.0,
                    1e-10 * scale);
      }
    }
  }
}

TEST(PrincipalComponents, EnergiesDescendAndSumToThatOfTheMatrix) {
  for (const Size& size : kSizes) {
    constexpr unsigned kSeed = 3;
    SCOPED_TRACE(testing::Message()
                 << "seed " << kSeed << ", " << size.num_values << " x " << size.num_frames);
    const TrajectoryMatrix m = random_matrix(kSeed, size.num_values, size.num_frames, 40);
    const PrincipalComponents pc = principal_components(m, 1, 0.0);
    EXPECT_EQ(pc.spatial.size(), 1U);
    EXPECT_EQ(pc.energy.size(), std::min(size.num_values, size.num_frames));
    double sum = 0.0;
    for (std::size_t l = 0; l < pc.energy.size(); ++l) {
      EXPECT_GE(pc.energy[l], 0.0);
      if (l > 0) {
        EXPECT_LE(pc.energy[l], pc.energy[l - 1]);
      }
      sum += pc.energy[l];
    }
    EXPECT_NEAR(sum / pc.total_energy, 1.0, 1e-12);
    EXPECT_NEAR(dot(m.a, m.a) / pc.total_energy, 1.0, 1e-12);
  }
}

TEST(PrincipalComponents, AgreeForTheTransposedMatrix) {
  constexpr unsigned kSeed = 4;
  SCOPED_TRACE(kSeed);
  const TrajectoryMatrix tall = random_matrix(kSeed, 25, 9, 9);
  const PrincipalComponents a = principal_components(tall, 100, 1e-6);
  const PrincipalComponents b = principal_components(transposed(tall), 100, 1e-6);
  ASSERT_EQ(a.spatial.size(), b.spatial.size());
  for (std::size_t l = 0; l < a.spatial.size(); ++l) {
    EXPECT_NEAR(a.energy[l] / b.energy[l], 1.0, 1e-9);
    // Spatial and temporal vectors swap roles and norms; signs may differ.
    const double sigma = std::sqrt(a.energy[l]);
    EXPECT_NEAR(std::abs(dot(a.temporal[l], b.spatial[l])), sigma, 1e-7 * sigma);
    EXPECT_NEAR(std::abs(dot(a.spatial[l], b.temporal[l])), sigma, 1e-7 * sigma);
  }
}

TEST(PrincipalComponents, LeadingComponentsAreTheBestApproximation) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(kSeed);
  const TrajectoryMatrix m = random_matrix(kSeed, 20, 10, 10);
  for (std::size_t count = 0; count <= 10; ++count) {
    const PrincipalComponents pc = principal_components(m, count, 0.0);
    ASSERT_EQ(pc.spatial.size(), count);
    double error = 0.0;
    for (std::size_t i = 0; i < m.num_values; ++i) {
      for (std::size_t f = 0; f < m.num_frames; ++f) {
        double rest = m.row(i)[f];
        for (std::size_t l = 0; l < count; ++l) rest -= pc.spatial[l][i] * pc.temporal[l][f];
        error += rest * rest;
      }
    }
    double left = 0.0;
    for (std::size_t l = count; l < pc.energy.size(); ++l) left += pc.energy[l];
    EXPECT_NEAR(error, left, 1e-10 * pc.total_energy);
  }
}

TEST(PrincipalComponents, DropComponentsWithLittleEnergy) {
  constexpr unsigned kSeed = 6;
  SCOPED_TRACE(kSeed);
  const TrajectoryMatrix m = random_matrix(kSeed, 20, 10, 10);
  const PrincipalComponents all = principal_components(m, 100, 0.0);
  for (std::size_t l = 1; l < all.energy.size(); ++l) {
    constexpr double kMore = 1.0 + 1e-12;  // rounding depends on the number of components
    const double between = 0.5 * (all.energy[l - 1] + all.energy[l]);
    EXPECT_EQ(principal_components(m, 100, between).spatial.size(), l);
    EXPECT_EQ(principal_components(m, 100, kMore * all.energy[l]).spatial.size(), l);
    EXPECT_EQ(principal_components(m, 100, all.energy[l] / kMore).spatial.size(), l + 1);
  }
}

// The sign of an eigenvector does not depend on the library: its largest element is positive.
TEST(PrincipalComponents, LargestElementOfTheEigenvectorIsPositive) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    for (const Size& size : {Size{30, 8}, Size{8, 30}}) {
      const TrajectoryMatrix m = random_matrix(seed, size.num_values, size.num_frames, 8);
      const PrincipalComponents pc = principal_components(m, 100, 1e-6);
      for (std::size_t l = 0; l < pc.spatial.size(); ++l) {
        const auto& v = size.num_frames <= size.num_values ? pc.temporal[l] : pc.spatial[l];
        double largest = 0.0;
        for (const double x : v) largest = std::abs(x) > std::abs(largest) ? x : largest;
        EXPECT_GT(largest, 0.0);
      }
    }
  }
}

TEST(PrincipalComponents, HaveNoVectorsForEmptyAndZeroMatrices) {
  const PrincipalComponents nothing = principal_components({0, 5, {}}, 10, 0.0);
  EXPECT_TRUE(nothing.energy.empty());
  EXPECT_TRUE(nothing.spatial.empty());
  for (const Size& size : kSizes) {
    const TrajectoryMatrix zeros{size.num_values, size.num_frames,
                                 std::vector<double>(size.num_values * size.num_frames, 0.0)};
    const PrincipalComponents pc = principal_components(zeros, 10, 0.0);
    EXPECT_EQ(pc.total_energy, 0.0);
    EXPECT_TRUE(pc.spatial.empty());
    for (const double energy : pc.energy) EXPECT_EQ(energy, 0.0);
  }
}

// With repeated rows, all components but the first are rounding errors or zero.
TEST(PrincipalComponents, AreFiniteForRepeatedTrajectories) {
  for (const Size& size : kSizes) {
    for (const double value : {1.0, 0.1, 3e-5, 1e7}) {
      TrajectoryMatrix m{size.num_values, size.num_frames, {}};
      for (std::size_t i = 0; i < size.num_values * size.num_frames; ++i) {
        m.a.push_back(value * static_cast<double>(i % size.num_frames + 1));
      }
      const PrincipalComponents pc = principal_components(m, 100, 0.0);
      ASSERT_GE(pc.spatial.size(), 1U);
      for (std::size_t l = 0; l < pc.spatial.size(); ++l) {
        for (const double x : pc.spatial[l]) EXPECT_TRUE(std::isfinite(x)) << l;
        for (const double x : pc.temporal[l]) EXPECT_TRUE(std::isfinite(x)) << l;
      }
      EXPECT_LT(largest_error(m, pc), 1e-6 * value * 40);
    }
  }
}

TrajectoryRows rows_of(const TrajectoryMatrix& m) {
  return {m.num_values, m.num_frames, [&m](std::size_t first, auto some) {
            std::copy_n(m.a.data() + first * m.num_frames, some.size(), some.begin());
          }};
}

TEST(ComponentsByRow, AreThePrincipalComponents) {
  for (const Size size : {Size{20, 10}, Size{1300, 40}, Size{30, 90}, Size{0, 4}, Size{4, 0}}) {
    const TrajectoryMatrix m = random_matrix(8, size.num_values, size.num_frames, 6);
    const PrincipalComponents pc = principal_components(m, 4, 0.0);
    const ComponentsByRow same = components_by_row(rows_of(m), 4, 0.0);
    EXPECT_EQ(same.temporal, pc.temporal);
    EXPECT_EQ(same.energy, pc.energy);
    ASSERT_EQ(same.spatial.size(), size.num_values * pc.spatial.size());
    for (std::size_t i = 0; i < same.spatial.size(); ++i) {
      const std::size_t count = pc.spatial.size();
      EXPECT_EQ(same.spatial[i], static_cast<float>(pc.spatial[i % count][i / count]));
    }
  }
}

TEST(PrincipalComponents, AreDeterministic) {
  const TrajectoryMatrix m = random_matrix(7, 200, 50, 50);
  const PrincipalComponents a = principal_components(m, 20, 0.0);
  const PrincipalComponents b = principal_components(m, 20, 0.0);
  EXPECT_EQ(a.energy, b.energy);
  EXPECT_EQ(a.spatial, b.spatial);
  EXPECT_EQ(a.temporal, b.temporal);
}

class WideMatrix : public testing::TestWithParam<std::size_t> {};

// Wide matrices of which few components are wanted are analysed through a sample of the
// columns, whether they have more rows or more columns.
TEST_P(WideMatrix, HasComponentsWithItsEnergy) {
  const std::size_t num_values = GetParam();
  constexpr std::size_t kColumns = 1560;  // the subspace is not improved
  constexpr std::size_t kRank = 6;
  const TrajectoryMatrix m = random_matrix(11, num_values, kColumns, kRank);
  int reads = 0;
  const TrajectoryRows rows{num_values, kColumns,
                            [&](std::size_t first, std::span<double> some) {
                              if (first == 0) ++reads;
                              for (std::size_t i = 0; i < some.size(); ++i) {
                                some[i] = m.a[first * kColumns + i];
                              }
                            }};
  const ComponentsByRow found = components_by_row(rows, 100, 1e-3);
  EXPECT_EQ(reads, 3) << "not by a sample";
  ASSERT_EQ(found.temporal.size(), kRank);
  ASSERT_EQ(found.spatial.size(), num_values * kRank);
  const PrincipalComponents exact = principal_components(m, 100, 1e-3);
  for (std::size_t l = 0; l < kRank; ++l) {
    EXPECT_NEAR(found.energy[l] / exact.energy[l], 1.0, 1e-6);
    EXPECT_NEAR(dot(found.temporal[l], found.temporal[l]), 1.0, 1e-9);
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < num_values; ++i) {
    for (std::size_t f = 0; f < kColumns; ++f) {
      double sum = 0.0;
      for (std::size_t l = 0; l < kRank; ++l) {
        sum += double{found.spatial[i * kRank + l]} * found.temporal[l][f];
      }
      largest = std::max(largest, std::abs(sum - m.row(i)[f]));
    }
  }
  EXPECT_LT(largest, 1e-2);
}

INSTANTIATE_TEST_SUITE_P(ComponentsByRow, WideMatrix, testing::Values(600U, 1600U));

// Motion in a few columns, one of which is in the sample, among noise.
TEST(ComponentsByRow, ASampleFindsWhatItHardlyShows) {
  constexpr std::size_t kValues = 500;
  constexpr std::size_t kColumns = 1000;
  TrajectoryMatrix m = random_matrix(5, kValues, kColumns, 3);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  std::vector<double> shape(kValues);
  for (double& x : shape) x = 8.0 * noise(random);
  for (std::size_t i = 0; i < kValues; ++i) {
    for (std::size_t f = 0; f < kColumns; ++f) {
      double& x = m.a[i * kColumns + f];
      x += noise(random);
      if (f >= 498 && f < 502) x += shape[i];
    }
  }
  constexpr double kMin = 16000.0;  // above the noise
  const TrajectoryRows rows{kValues, kColumns, [&](std::size_t first, std::span<double> some) {
                              for (std::size_t i = 0; i < some.size(); ++i) {
                                some[i] = m.a[first * kColumns + i];
                              }
                            }};
  const ComponentsByRow found = components_by_row(rows, 100, kMin);
  const PrincipalComponents exact = principal_components(m, 100, kMin);
  ASSERT_EQ(exact.temporal.size(), 4U);
  ASSERT_EQ(found.temporal.size(), 4U);
  for (std::size_t l = 0; l < 4; ++l) {
    const double along = dot(found.temporal[l], exact.temporal[l]);
    EXPECT_NEAR(along * along, 1.0, 1e-6) << l;
  }
}

}  // namespace
}  // namespace rlpc
