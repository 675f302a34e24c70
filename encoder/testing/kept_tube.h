// A tube that bends, and the shared rig of an earlier span of it.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/testing/tube.h"
#include "encoder/codec/kinds/skinned/quantise/kept_rig.h"
#include "encoder/codec/kinds/skinned/skinned_span_coder.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {

inline constexpr double kTubeStep = 16.0;  // quantiser step, grid units

// Moves a point in frame f.
using Move = std::function<Point(const Point&, double f)>;

// Bends the second half relative to the first, and swells the whole.
inline Point bent(const Point& p, double f) {
  const double bend = 0.5 * std::sin(0.4 * f) * std::tanh((p[0] - 12000.0) / 3000.0);
  const double x = p[0] - 12000.0;
  const double swell = 1.0 + 0.05 * std::sin(0.9 * f + p[0] / 4000.0);
  return {std::cos(bend) * x - std::sin(bend) * p[1] + 90.0 * f,
          std::sin(bend) * x + std::cos(bend) * p[1], p[2] * swell};
}

class KeptTube {
 public:
  static constexpr std::uint32_t kRings = 40;
  static constexpr std::uint32_t kSides = 10;
  static constexpr std::uint32_t kVertices = kRings * kSides;
  static constexpr std::uint32_t kFrames = 32;  // frames of the earlier span

  KeptTube()
      : triangles_(tube_triangles(kRings, kSides)),
        topology_(make_topology(kVertices, triangles_)),
        context{header_, settings, triangles_, OrderedMeshes(topology_, triangles_, true)} {
    settings.profile = Profile::kHigh;
    settings.preset = Preset::kFast;
    header_.profile_idc = kProfileHigh;
    header_.num_vertices = kVertices;
    header_.position_bits = 20;
    const SpanFrames earlier = frames(bent, 0, kFrames, 1, true);
    kept = SkinnedSpanCoder(context, earlier).encode(kTubeStep, kTubeStep).rig;
  }
  KeptTube(const KeptTube&) = delete;
  KeptTube& operator=(const KeptTube&) = delete;

  static SpanFrames frames(const Move& move, std::uint32_t first, std::uint32_t count,
                           std::uint32_t num_gofs = 1, bool has_followers = false) {
    SpanFrames list{kVertices, count, {}, first, num_gofs, has_followers};
    for (std::uint32_t f = first; f < first + count; ++f) {
      for (std::uint32_t v = 0; v < kVertices; ++v) {
        const double angle = 6.283185307 * (v % kSides) / kSides;
        const double radius = 2500.0 + 300.0 * std::sin(1.7 * v);
        const std::uint32_t ring = v / kSides;
        const Point p =
            move({600.0 * ring, radius * std::cos(angle), radius * std::sin(angle)}, f);
        list.xyz.insert(list.xyz.end(), p.begin(), p.end());
      }
    }
    return list;
  }
  // Encodes a span with a rig of its own.
  EncodedSpan encode_alone(const SpanFrames& of) const {
    return SkinnedSpanCoder(context, of).encode(kTubeStep, kTubeStep);
  }

  EncoderSettings settings;

 private:
  SequenceHeader header_;
  std::vector<Triangle> triangles_;
  Topology topology_;

 public:
  SkinnedContext context;
  std::shared_ptr<const KeptRig> kept;
};

}  // namespace rlpc
