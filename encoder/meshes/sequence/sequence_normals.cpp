#include "encoder/meshes/sequence/sequence_normals.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/codec/attributes/attribute_names.h"

namespace rlpc {
namespace {

using Normal = std::array<float, 3>;

SourceAttribute* find_normals(SourceAttributes& attributes) {
  const auto found = std::ranges::find(attributes.sets, kNormalName, &SourceAttribute::name);
  return found == attributes.sets.end() ? nullptr : &*found;
}

Normal normal_at(std::span<const float> values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void put(const Normal& normal, std::size_t i, std::vector<float>& values) {
  std::ranges::copy(normal, values.begin() + 3 * static_cast<std::ptrdiff_t>(i));
}

// Returns the number of later frames to read: fewer for large meshes, or with too little
// memory.
std::size_t max_frames(std::size_t num_corners, std::uint64_t max_memory_bytes) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 27;    // fixed: memory
  constexpr std::uint64_t kPart = 64;                            // fixed: divides the limit
  constexpr std::uint64_t kMaxCorners = std::uint64_t{1} << 20;  // fixed: time, of all frames
  constexpr std::uint64_t kMin = 15;   // fixed: as many as for glTF, if memory allows
  constexpr std::uint64_t kMax = 255;  // fixed: time
  const std::uint64_t bytes = std::min(kMaxBytes, max_memory_bytes / kPart);
  const std::uint64_t fit = bytes / (sizeof(Normal) * num_corners);
  return std::min(fit, std::clamp<std::uint64_t>(kMaxCorners / num_corners, kMin, kMax));
}

// Returns frames 1 to num_frames - 1, or `max` of them at equal distances, the last included.
std::vector<std::uint32_t> spread_out(std::size_t num_frames, std::size_t max) {
  const std::size_t later = num_frames - 1;
  const std::size_t count = std::min(later, max);
  std::vector<std::uint32_t> frames;
  for (std::size_t i = 1; i <= count; ++i) {
    frames.push_back(static_cast<std::uint32_t>(later * i / count));
  }
  return frames;
}

// Collects the normals of later frames by the values of the first.
class NormalFollower {
 public:
  NormalFollower(std::size_t num_corners, SourceAttributes& attributes, SourceAttribute& first)
      : num_corners_(num_corners), later_(attributes.later_normals), first_(first) {}

  void add(std::uint32_t frame, const SourceAttribute& set) {
    const bool is_of_vertices = first_.value_of_corner.empty();
    if (is_of_vertices != set.value_of_corner.empty()) return;
    if (is_of_vertices) {
      if (set.values.size() == first_.values.size()) later_.push_back({frame, set.values});
      return;
    }
    std::vector<float> normals(first_.values.size());
    std::vector<bool> is_known(first_.num_values(), false);
    std::map<std::pair<std::uint32_t, Normal>, std::uint32_t> splits;
    for (std::size_t c = 0; c < num_corners_; ++c) {
      const std::uint32_t value = first_.value_of_corner[c];
      const Normal moved = normal_at(set.values, set.value_of_corner[c]);
      if (!is_known[value]) {
        is_known[value] = true;
        put(moved, value, normals);
      } else if (normal_at(normals, value) != moved) {
        const auto next = static_cast<std::uint32_t>(first_.num_values());
        const auto [place, is_new] = splits.try_emplace({value, moved}, next);
        if (is_new) {
          split(value);
          normals.insert(normals.end(), moved.begin(), moved.end());
          is_known.push_back(true);
        }
        first_.value_of_corner[c] = place->second;
      }
    }
    later_.push_back({frame, std::move(normals)});
  }

 private:
  // Appends a copy of a value.
  void split(std::uint32_t value) {
    const auto append = [&](std::vector<float>& values) {
      const Normal copied = normal_at(values, value);
      values.insert(values.end(), copied.begin(), copied.end());
    };
    append(first_.values);
    for (PosedNormals& before : later_) append(before.normals);
  }

  std::size_t num_corners_;
  std::vector<PosedNormals>& later_;
  SourceAttribute& first_;
};

}  // namespace

void add_later_normals(const SequenceFiles& files, SourceAttributes& attributes) {
  SourceAttribute* const first = find_normals(attributes);
  if (first == nullptr || files.count() < 2 || files.triangles().empty()) return;
  const std::size_t num_corners = 3 * files.triangles().size();
  NormalFollower follower(num_corners, attributes, *first);
  for (const std::uint32_t frame :
       spread_out(files.count(), max_frames(num_corners, files.max_memory_bytes()))) {
    auto mesh = files.read(frame, true);
    if (!mesh) return;
    if (const SourceAttribute* const set = find_normals(mesh->attributes)) {
      follower.add(frame, *set);
    }
  }
}

}  // namespace rlpc
