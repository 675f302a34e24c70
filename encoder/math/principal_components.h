// Principal components of one cluster over one GOF (Amjoun and Strasser 2007, 3.3).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace rlpc {

// Trajectories of the coded coordinates of a cluster: [num_values][num_frames], grid units.
struct TrajectoryMatrix {
  std::size_t num_values = 0;  // 3 x coded vertices, planes x, y, z
  std::size_t num_frames = 0;
  std::vector<double> a;

  double* row(std::size_t i) { return &a[i * num_frames]; }
  const double* row(std::size_t i) const { return &a[i * num_frames]; }
};

// The matrix is sum over l of spatial[l] * temporal[l]^T; temporal vectors are orthonormal,
// spatial ones orthogonal with norm sigma, which falls with l.
struct PrincipalComponents {
  std::vector<double> energy;                 // sigma^2, descending; of all or the first
  double total_energy = 0.0;                  // squared norm of the matrix
  std::vector<std::vector<double>> temporal;  // [component][num_frames], for the leading ones
  std::vector<std::vector<double>> spatial;   // [component][num_values]
};

// Components with energy above min_energy, at most max_components, and the energies of these at
// least (eigenvectors.h).
PrincipalComponents principal_components(const TrajectoryMatrix& matrix,
                                         std::size_t max_components, double min_energy);

// Rows of a matrix that is never there as a whole, [num_values][num_frames].
struct TrajectoryRows {
  std::size_t num_values = 0;
  std::size_t num_frames = 0;
  // Writes some rows, from the first on; each is asked for twice.
  std::function<void(std::size_t first, std::span<double> rows)> write;
};

// The same of such rows, with little memory beside the result.
struct ComponentsByRow {
  double total_energy = 0.0;
  std::vector<double> energy;
  std::vector<std::vector<double>> temporal;  // [component][num_frames]
  std::vector<float> spatial;                 // [num_values][component]
};

ComponentsByRow components_by_row(const TrajectoryRows& rows, std::size_t max_components,
                                  double min_energy);

}  // namespace rlpc
