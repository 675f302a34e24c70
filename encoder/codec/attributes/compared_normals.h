// Compares normals of decoded frames with those of the input: the error of each way to code
// them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/attributes/sectors.h"
#include "common/codec/mesh/mesh.h"
#include "encoder/codec/attributes/normal_error.h"
#include "encoder/codec/attributes/shape_normals.h"
#include "encoder/codec/attributes/smoothing_search.h"

namespace rlpc {

// Data that all frames share.
struct ComparedMesh {
  std::span<const Triangle> triangles;
  std::uint32_t num_vertices = 0;
  std::span<const std::uint32_t> edge_mates;
  const std::vector<bool>& seams;
  const Sectors& sectors;
  const Smoothing& smoothing;
  bool turns = true;  // unit vectors turn with the surface (F.8.5); false: they stay
};

// Decoded positions of a frame, and the normals of the input.
struct ComparedFrame {
  std::uint32_t frame = 0;
  std::span<const std::int32_t> positions;
  std::vector<Vec3d> normals;  // [sector], of length 1, or zero: none
};

class ComparedNormals {
 public:
  // frames: the first frame of the sequence, then others. They and what the mesh refers to must
  // outlive the object. Computes the normals of these frames twice, on several threads.
  ComparedNormals(const ComparedMesh& mesh, std::span<const ComparedFrame> frames);

  // Returns the unit vector of a sector in the first frame that comes nearest to the input in
  // all frames; zero if there is none.
  Vec3d fitted(std::uint32_t x) const;
  // Returns the unit vector of the first frame with the smallest vector_error(), out of those
  // that are right in one frame and the least-squares one. None: the sector is never seen.
  // Frames in which the surface turns differently from the normal do not count.
  std::optional<Vec3d> best_vector(std::uint32_t x) const;
  // Mean errors over the frames, in degrees: of smoothing; of a unit vector of the first frame.
  double smoothing_error(std::uint32_t x) const;
  double vector_error(std::uint32_t x, const Vec3d& stored) const;
  // Returns the sum of the weights of a sector in all frames.
  double weight(std::uint32_t x) const;
  // Whether unit vectors of a sector can turn: there is a surface around it in the first frame.
  bool can_turn(std::uint32_t x) const { return can_turn_[x]; }
  // Whether a sector can be seen in the first frame.
  bool is_in_first(std::uint32_t x) const { return frames_[0].weights[x] > 0.0F; }

  // Returns the error of each frame if the sectors have these normals. is_smooth: [sector];
  // stored: unit vectors of the others.
  std::vector<NormalError> errors(const std::vector<bool>& is_smooth,
                                  std::span<const Vec3d> stored) const;

 private:
  struct Frame {
    std::vector<float> weights;    // [sector]
    std::vector<float> smoothing;  // [sector], differences in degrees
    std::vector<Vec3d> turned;     // [sector], normals of the input turned to the first frame
  };

  void measure_areas();
  void find_surface();
  void measure(std::size_t f);

  ComparedMesh mesh_;
  std::span<const ComparedFrame> compared_;
  std::vector<Frame> frames_;
  Sectors vertices_;
  std::vector<bool> can_turn_;  // [sector]
};

}  // namespace rlpc
