// Principal component analysis of vertex trajectories over one GOF (Amjoun and Strasser 2007,
// 3.3).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace rlpc {

// Values over time, a row for each spatial value: [num_values][num_frames], grid units.
struct TrajectoryMatrix {
  std::size_t num_values = 0;  // in clusters: 3 x coded vertices, planes x, y, z
  std::size_t num_frames = 0;
  std::vector<double> a;

  double* row(std::size_t i) { return &a[i * num_frames]; }
  const double* row(std::size_t i) const { return &a[i * num_frames]; }
};

// The matrix is the sum over all components l of spatial[l] * temporal[l]^T. Temporal vectors
// are orthonormal; spatial vectors are orthogonal with norm sigma, which falls with l.
struct PrincipalComponents {
  std::vector<double> energy;  // sigma^2, descending; of all components or at least those below
  double total_energy = 0.0;   // squared norm of the matrix
  std::vector<std::vector<double>>
      temporal;                              // [component][num_frames], leading components only
  std::vector<std::vector<double>> spatial;  // [component][num_values], the same ones
};

// Returns the components with energy above min_energy, at most max_components.
PrincipalComponents principal_components(const TrajectoryMatrix& matrix,
                                         std::size_t max_components, double min_energy);

// A matrix [num_values][num_frames] that is generated row by row and never stored as a whole.
struct TrajectoryRows {
  std::size_t num_values = 0;
  std::size_t num_frames = 0;
  // Fills `rows` with consecutive rows, starting with row `first`; called two to five times
  // for each row.
  std::function<void(std::size_t first, std::span<double> rows)> write;
};

// Principal components of such a matrix, computed with little memory besides the result. The
// time is quadratic in the number of frames, unless that is large and the components few: then
// it is linear, and the components are those of a subspace with nearly all of their energy.
struct ComponentsByRow {
  double total_energy = 0.0;
  std::vector<double> energy;
  std::vector<std::vector<double>> temporal;  // [component][num_frames]
  std::vector<float> spatial;                 // [num_values][component]
};

ComponentsByRow components_by_row(const TrajectoryRows& rows, std::size_t max_components,
                                  double min_energy);

}  // namespace rlpc
