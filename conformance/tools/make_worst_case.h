// Streams that reach the limits of a level (Annex B) in one GOF, so that a decoder takes about
// as much time and memory for it as a GOF of the level can demand.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/write_units.h"

namespace rlpc::worst_case {

// A cluster GOF (Baseline); a skinned GOF (Main); a shared rig and a skinned GOF that uses it
// (High); an inter GOF (High).
enum class Kind : std::uint8_t { kCluster, kSkinned, kSharedRig, kInter };

struct Size {
  std::uint32_t vertices = 0;
  std::uint32_t frames = 1;
  std::uint32_t components = 0;  // components of the cluster, trajectories, or temporal layers
  std::uint32_t bones = 0;       // bones, clusters, or patches of an inter GOF
  std::uint32_t adaptive_factors = 0;
  std::uint32_t repeats = 0;  // max_earlier_distance of an inter GOF

  std::uint64_t values() const { return std::uint64_t{vertices} * frames; }
};

struct SizeLimits {
  std::uint32_t frames = kMaxFrames;
  std::uint32_t components = 1U << 24;
};

// Returns the size with the most products. Vertices times frames come as close to their limit
// as the mesh allows; of such sizes, those with many factors are preferred.
Size hardest_size(Kind kind, const Level& level, const SizeLimits& limits);
// Returns the number of factors that R-LVL-05 limits.
std::uint64_t num_factors(Kind kind, const Size& size);
// Returns a size with one more of `what` than its limit, and little of everything else; none
// for an unknown word.
std::optional<Size> size_beyond(std::string_view what, const Level& level, const Size& size);

// A torus with handles. Handles raise the valence, and so the number of neighbours that predict
// a vertex, to 17 on average; without them it is 15. num_vertices: a multiple of kAround.
inline constexpr std::uint32_t kAround = 64;
std::vector<Triangle> make_mesh(std::uint32_t num_vertices, std::uint32_t max_triangles);

// Residuals that take the most bins: 14 in the prefix, and an escape. They stay just below 32
// bits, so that a unit with all factors of a GOF stays within MaxUnitBytes.
class Noise {
 public:
  std::int32_t residual() {
    const auto bits = static_cast<std::uint32_t>(random_());
    const auto magnitude = static_cast<std::int32_t>(kMin + (bits >> 9));
    return (bits & 1) != 0 ? -magnitude : magnitude;
  }
  std::vector<std::int32_t> residuals(std::size_t count);
  TrackResiduals track(std::uint32_t num_frames);
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

 private:
  static constexpr std::uint32_t kMin = 1U << 23;
  std::mt19937 random_{1};
};

// A stream with num_rounds rounds: shared rigs and a GOF that uses each, or a single GOF.
struct Plan {
  std::uint32_t level = 1;
  Kind kind = Kind::kCluster;
  Size size;
  std::vector<Triangle> triangles;
  std::uint32_t num_rigs = 1;
  std::uint32_t num_rounds = 1;
};
// Writes the stream, piece by piece.
void write_stream(const Plan& plan, const std::function<void(const Bytes&)>& write);

ClusterGof make_clusters(const Size& size, Noise& noise);
SkinnedGof make_bones(const Size& size, const OrderedMesh& mesh, Noise& noise);
SharedRig make_rig(const Size& size, const OrderedMesh& mesh, Noise& noise);
// Makes a GOF whose member `rig` is still null.
SkinnedGof make_tracks(const Size& size, const SharedRig& rig, Noise& noise);
InterSettings make_frames(const Size& size, const OrderedMesh& mesh);

}  // namespace rlpc::worst_case
