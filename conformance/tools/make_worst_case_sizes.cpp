// Sizes of GOFs within the limits of a level, and the mesh.
#include <algorithm>

#include "conformance/tools/make_worst_case.h"

namespace rlpc::worst_case {
namespace {

std::uint64_t factors_without_components(Kind kind, const Size& size) {
  if (kind == Kind::kCluster) return 9 * std::uint64_t{size.frames};       // three seeds
  const std::uint64_t factors_of_bone = kind == Kind::kSharedRig ? 9 : 6;  // with stretches
  return factors_of_bone * size.bones * size.frames + 3 * std::uint64_t{size.vertices};
}

std::uint64_t factors_of_component(Kind kind, const Size& size) {
  if (kind == Kind::kCluster) return 3 * (std::uint64_t{size.vertices} - 3) + size.frames;
  return size.vertices + 3 * std::uint64_t{size.frames};
}

// Returns a size with as many vertices and components as its frames allow.
std::optional<Size> largest_size(Kind kind, const Level& level, std::uint32_t frames,
                                 std::uint32_t max_components) {
  Size size;
  size.frames = frames;
  size.bones = kind == Kind::kCluster ? 1 : level.max_clusters;
  const std::uint64_t max =
      std::min<std::uint64_t>(level.max_vertices, level.max_gof_values / frames);
  size.vertices = static_cast<std::uint32_t>(max / kAround * kAround);
  const std::uint64_t without = factors_without_components(kind, size);
  if (size.vertices < 3 * kAround || without > level.max_gof_factors) return std::nullopt;
  size.components = static_cast<std::uint32_t>(std::min<std::uint64_t>(
      max_components, (level.max_gof_factors - without) / factors_of_component(kind, size)));
  if (kind == Kind::kSharedRig) {
    size.adaptive_factors = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(size.components, level.max_adaptive_values / size.vertices));
  }
  return size;
}

// Adds a tube of six triangles in place of two.
void add_handle(std::vector<Triangle>& triangles, const Triangle& a, const Triangle& b) {
  const Triangle opposite{b[0], b[2], b[1]};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    triangles.push_back({a[k], a[next], opposite[next]});
    triangles.push_back({a[k], opposite[next], opposite[k]});
  }
}

// Returns the largest size with learned weights in so many temporal layers.
Size largest_frames(const Level& level, std::uint32_t frames, std::uint32_t temporal_layers) {
  Size size;
  size.frames = frames;
  size.components = temporal_layers;
  size.bones = level.max_clusters;
  const std::uint64_t max = std::min<std::uint64_t>(
      level.max_learning_vertices / temporal_layers, level.max_gof_values / frames);
  size.vertices = static_cast<std::uint32_t>(max / kAround * kAround);
  if (size.vertices < 3 * kAround) return {};
  size.repeats =
      static_cast<std::uint32_t>(level.max_gof_factors / (std::uint64_t{3} * size.vertices));
  return size;
}

// Returns the size with the most filters that adapt and, among these, the most vertices.
Size hardest_frames(const Level& level, const SizeLimits& limits) {
  Size best;
  std::uint64_t highest = 0;
  const std::uint32_t longest = std::min(limits.frames, level.max_gof_frames);
  for (std::uint32_t t = 1; t <= std::min(limits.components, kMaxPatternDepths); ++t) {
    for (std::uint32_t frames = 1; frames <= longest; ++frames) {
      const Size size = largest_frames(level, frames, t);
      if (size.values() * t <= highest) continue;
      highest = size.values() * t;
      best = size;
    }
  }
  return best;
}

}  // namespace

std::uint64_t num_factors(Kind kind, const Size& size) {
  if (kind == Kind::kInter) return 3 * std::uint64_t{size.vertices} * size.repeats;
  return factors_without_components(kind, size) +
         size.components * factors_of_component(kind, size);
}

Size hardest_size(Kind kind, const Level& level, const SizeLimits& limits) {
  if (kind == Kind::kInter) return hardest_frames(level, limits);
  Size best;
  double highest = 0.0;
  for (std::uint32_t frames = 1; frames <= std::min(limits.frames, level.max_gof_frames);
       ++frames) {
    const auto size =
        largest_size(kind, level, frames, std::min(limits.components, level.max_components));
    if (!size) continue;
    const double products = static_cast<double>(size->values()) * size->components;
    const double score = products * static_cast<double>(num_factors(kind, *size));
    if (score <= highest) continue;
    highest = score;
    best = *size;
  }
  return best;
}

std::optional<Size> size_beyond(std::string_view what, const Level& level, const Size& size) {
  if (what == "vertices") return Size{level.max_vertices + kAround, 1, 1, 1, 0};
  if (what == "frames") return Size{3 * kAround, level.max_gof_frames + 1, 1, 1, 0};
  if (what == "values") {
    const auto frames = static_cast<std::uint32_t>(level.max_gof_values / level.max_vertices);
    return Size{level.max_vertices, frames + 1, 1, 1, 0};
  }
  if (what == "clusters") return Size{3 * kAround, 1, 1, level.max_clusters + 1, 0};
  if (what == "factors") {
    Size more = size;
    ++more.components;
    return more;
  }
  if (what == "adaptive") {
    const std::uint32_t vertices = level.max_vertices / 2;
    const auto factors = static_cast<std::uint32_t>(level.max_adaptive_values / vertices);
    return Size{vertices, 1, 1, 1, factors + 1};
  }
  return std::nullopt;
}

std::vector<Triangle> make_mesh(std::uint32_t num_vertices, std::uint32_t max_triangles) {
  constexpr std::uint32_t kVerticesOfHandle = 20;
  const std::uint32_t rings = num_vertices / kAround;
  std::vector<Triangle> triangles;
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t s = 0; s < kAround; ++s) {
      const std::uint32_t a = r * kAround + s;
      const std::uint32_t b = r * kAround + (s + 1) % kAround;
      const std::uint32_t c = (r + 1) % rings * kAround + s;
      const std::uint32_t d = (r + 1) % rings * kAround + (s + 1) % kAround;
      triangles.push_back({a, b, d});
      triangles.push_back({a, d, c});
    }
  }
  const std::size_t left =
      max_triangles - std::min<std::size_t>(max_triangles, triangles.size());
  const std::size_t num_holes =
      2 * std::min<std::size_t>(num_vertices / kVerticesOfHandle, left / 4);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < num_holes; ++i) {
    std::swap(triangles[i], triangles[i + random() % (triangles.size() - i)]);
  }
  const std::vector<Triangle> holes(triangles.begin(),
                                    triangles.begin() + static_cast<std::ptrdiff_t>(num_holes));
  triangles.erase(triangles.begin(),
                  triangles.begin() + static_cast<std::ptrdiff_t>(num_holes));
  for (std::size_t i = 0; i < num_holes; i += 2) add_handle(triangles, holes[i], holes[i + 1]);
  return triangles;
}

}  // namespace rlpc::worst_case
