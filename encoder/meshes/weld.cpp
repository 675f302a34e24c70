#include "encoder/meshes/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace rlpc {

namespace {

using Position = std::array<float, 3>;

Position position(std::span<const float> xyz, std::uint32_t vertex) {
  const std::size_t first = 3 * std::size_t{vertex};
  return {xyz[first], xyz[first + 1], xyz[first + 2]};
}

// The vertices of a group that share a position in the current frame.
struct Part {
  std::uint32_t leader = 0;
  Position place{};
  bool operator==(const Part&) const = default;
};

struct PartHash {
  std::size_t operator()(const Part& part) const {
    std::uint64_t hash = part.leader;
    for (const float x : part.place) {
      const float zero_is_zero = x + 0.0F;  // -0 equals 0
      hash = (hash ^ std::bit_cast<std::uint32_t>(zero_is_zero)) * 0x9E3779B97F4A7C15;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

// Splits groups whose vertices differ in a frame. leader[v] is the first vertex of the group of
// v.
void split(std::span<const float> xyz, std::vector<std::uint32_t>& leader) {
  std::unordered_map<Part, std::uint32_t, PartHash> leader_of;
  for (std::uint32_t v = 0; v < leader.size(); ++v) {
    const Position place = position(xyz, v);
    if (place == position(xyz, leader[v])) continue;
    // The first vertex with a different position leads a new group of all that share it.
    leader[v] = leader_of.try_emplace({leader[v], place}, v).first->second;
  }
}

class WeldedSource : public FrameSource {
 public:
  WeldedSource(Shape shape, std::unique_ptr<FrameSource> source,
               std::vector<std::uint32_t> vertices)
      : FrameSource(std::move(shape)),
        source_(std::move(source)),
        vertices_(std::move(vertices)),
        all_(3 * std::size_t{source_->num_vertices()}) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    if (auto error = source_->read_frame(frame, all_)) return error;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      const Position place = position(all_, vertices_[v]);
      for (std::size_t c = 0; c < 3; ++c) xyz[3 * v + c] = place[c];
    }
    return std::nullopt;
  }

  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    exact_.resize(all_.size());
    if (auto error = source_->read_exact(frame, exact_)) return error;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        xyz[3 * v + c] = exact_[3 * std::size_t{vertices_[v]} + c];
      }
    }
    return std::nullopt;
  }
  bool is_finer_than_floats() const override { return source_->is_finer_than_floats(); }
  void read_bones(std::uint32_t frame, std::span<BoneMap> maps) override {
    source_->read_bones(frame, maps);
  }

  std::string file_of(std::uint32_t frame) const override { return source_->file_of(frame); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::vector<std::uint32_t> vertices_;  // [welded vertex], index in the source
  std::vector<float> all_;
  std::vector<double> exact_;
};

// Removes triangles and their attributes.
void keep_triangles(const std::vector<bool>& is_kept, FrameSource::Shape& shape) {
  const auto keep = [&](auto& items, std::size_t per_triangle) {
    std::size_t end = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (is_kept[i / per_triangle]) items[end++] = items[i];
    }
    items.resize(end);
  };
  keep(shape.triangles, 1);
  keep(shape.attributes.rest_of_corner, 3);
  for (SourceAttribute& set : shape.attributes.sets) {
    if (set.domain == AttributeDomain::kCorner) keep(set.value_of_corner, 3);
    if (set.domain == AttributeDomain::kTriangle) keep(set.values, set.num_components);
  }
}

}  // namespace

void drop_degenerate(FrameSource::Shape& shape) {
  std::vector<bool> is_kept;
  for (const Triangle& t : shape.triangles) {
    is_kept.push_back(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  }
  const auto dropped =
      static_cast<std::size_t>(std::count(is_kept.begin(), is_kept.end(), false));
  keep_triangles(is_kept, shape);
  if (dropped == 0) return;
  shape.notes.push_back("dropped " + std::to_string(dropped) + " degenerate triangle" +
                        (dropped == 1 ? "" : "s"));
}

InputResult<std::unique_ptr<FrameSource>> weld(std::unique_ptr<FrameSource> source) {
  std::vector<std::uint32_t> leader(source->num_vertices());  // one group
  std::vector<float> xyz(3 * leader.size());
  for (std::uint32_t f = 0; f < source->num_frames(); ++f) {
    if (auto error = source->read_frame(f, xyz)) return *error;
    split(xyz, leader);
  }
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> welded(leader.size());
  for (std::uint32_t v = 0; v < leader.size(); ++v) {
    if (leader[v] == v) vertices.push_back(v);
    welded[v] =
        leader[v] == v ? static_cast<std::uint32_t>(vertices.size() - 1) : welded[leader[v]];
  }
  FrameSource::Shape shape;
  shape.num_vertices = static_cast<std::uint32_t>(vertices.size());
  shape.num_frames = source->num_frames();
  shape.frame_rate = source->frame_rate();
  shape.triangles = source->triangles();
  for (Triangle& t : shape.triangles) {
    for (std::uint32_t& v : t) v = welded[v];
  }
  shape.notes = source->notes();
  shape.files = source->files();
  shape.clips = source->clips();
  shape.attributes = source->attributes();
  shape.asset = source->asset();
  shape.materials = source->materials();
  shape.memory_bytes = source->memory_bytes();
  if (source->rig()) {
    shape.rig = std::make_shared<SourceRig>(rig_of_vertices(*source->rig(), vertices));
    shape.memory_bytes += shape.rig->memory_bytes();
  }
  if (vertices.size() < welded.size()) {
    const std::size_t merged = welded.size() - vertices.size();
    shape.notes.push_back("merged " + std::to_string(merged) + " duplicate " +
                          (merged == 1 ? "vertex" : "vertices") + " (" +
                          std::to_string(vertices.size()) +
                          " left); 'weld = false' keeps them apart");
  }
  drop_degenerate(shape);
  return std::unique_ptr<FrameSource>(
      std::make_unique<WeldedSource>(std::move(shape), std::move(source), std::move(vertices)));
}

}  // namespace rlpc
