#include "encoder/meshes/axes.h"

#include <array>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace rlpc {

namespace {

constexpr std::string_view kNames = "xyz";

void turn_over(std::vector<Triangle>& triangles) {
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
}

void turn_over(SourceAttributes& attributes) {
  const auto swap_corners = [](std::vector<std::uint32_t>& corners) {
    for (std::size_t i = 0; i < corners.size(); i += 3)
      std::swap(corners[i + 1], corners[i + 2]);
  };
  swap_corners(attributes.rest_of_corner);
  for (SourceAttribute& set : attributes.sets) swap_corners(set.value_of_corner);
}

void turn_normals(const Axes& axes, SourceAttributes& attributes) {
  turn(axes, attributes.rest_xyz);
  turn(axes, attributes.first_normals);
  for (PosedNormals& later : attributes.later_normals) turn(axes, later.normals);
  for (SourceAttribute& set : attributes.sets) {
    if (set.kind == SourceAttribute::Kind::kNormals) turn(axes, set.values);
  }
}

// Returns the map between turned coordinates: turns back, maps, and turns.
BoneMap turned(const Axes& axes, const BoneMap& map) {
  BoneMap result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& row = map[axes.from[i]];
    for (std::size_t j = 0; j < 3; ++j) {
      const bool negative = axes.negative[i] != axes.negative[j];
      result[i][j] = negative ? -row[axes.from[j]] : row[axes.from[j]];
    }
    result[i][3] = axes.negative[i] ? -row[3] : row[3];
  }
  return result;
}

SourceRig turned(const Axes& axes, SourceRig rig) {
  turn(axes, rig.rest);
  for (SourceRig::Bone& bone : rig.bones) turn(axes, bone.pivot);
  return rig;
}

class TurnedSource final : public FrameSource {
 public:
  TurnedSource(Shape shape, std::unique_ptr<FrameSource> source, const Axes& axes)
      : FrameSource(std::move(shape)), source_(std::move(source)), axes_(axes) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    if (auto error = source_->read_frame(frame, xyz)) return error;
    turn(axes_, xyz);
    return std::nullopt;
  }
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    if (auto error = source_->read_exact(frame, xyz)) return error;
    turn(axes_, xyz);
    return std::nullopt;
  }
  bool is_finer_than_floats() const override { return source_->is_finer_than_floats(); }
  void read_bones(std::uint32_t frame, std::span<BoneMap> maps) override {
    source_->read_bones(frame, maps);
    for (BoneMap& map : maps) map = turned(axes_, map);
  }

  std::string file_of(std::uint32_t frame) const override { return source_->file_of(frame); }

 private:
  std::unique_ptr<FrameSource> source_;
  Axes axes_;
};

class TurnedStream final : public FrameStream {
 public:
  TurnedStream(Shape shape, std::unique_ptr<FrameStream> stream, const Axes& axes)
      : FrameStream(std::move(shape)), stream_(std::move(stream)), axes_(axes) {}

  InputResult<bool> next_frame(std::span<float> xyz) override {
    auto read = stream_->next_frame(xyz);
    if (!read || !*read) return read;
    turn(axes_, xyz);
    const std::span<const double> exact = stream_->exact();
    exact_.assign(exact.begin(), exact.end());
    turn(axes_, exact_);
    return true;
  }
  std::span<const double> exact() const override { return exact_; }

 private:
  std::unique_ptr<FrameStream> stream_;
  Axes axes_;
  std::vector<double> exact_;
};

}  // namespace

namespace {

template <class T>
void turn_all(const Axes& axes, std::span<T> xyz) {
  assert(xyz.size() % 3 == 0);
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    const std::array<T, 3> old{xyz[i], xyz[i + 1], xyz[i + 2]};
    for (std::size_t a = 0; a < 3; ++a) {
      xyz[i + a] = axes.negative[a] ? -old[axes.from[a]] : old[axes.from[a]];
    }
  }
}

}  // namespace

void turn(const Axes& axes, std::span<float> xyz) { turn_all(axes, xyz); }
void turn(const Axes& axes, std::span<double> xyz) { turn_all(axes, xyz); }

bool is_mirror(const Axes& axes) {
  bool odd = false;
  for (std::size_t a = 0; a < 3; ++a) {
    if (axes.negative[a]) odd = !odd;
    for (std::size_t b = a + 1; b < 3; ++b) {
      if (axes.from[a] > axes.from[b]) odd = !odd;
    }
  }
  return odd;
}

InputResult<Axes> parse_axes(std::string_view text) {
  const InputError error{
      "\"" + std::string(text) +
      "\": expected the new x, y and z as axes of the input, such as x,z,-y"};
  Axes axes;
  std::array<bool, 3> used{};
  std::string_view rest = text;
  for (std::size_t a = 0; a < 3; ++a) {
    axes.negative[a] = rest.starts_with('-');
    if (axes.negative[a]) rest.remove_prefix(1);
    const std::size_t from = rest.empty() ? kNames.npos : kNames.find(rest.front());
    if (from == kNames.npos || std::exchange(used[from], true)) return error;
    axes.from[a] = static_cast<std::uint8_t>(from);
    rest.remove_prefix(1);
    if (a == 2) break;
    if (!rest.starts_with(',')) return error;
    rest.remove_prefix(1);
  }
  if (!rest.empty()) return error;
  return axes;
}

std::string axes_text(const Axes& axes) {
  std::string text;
  for (std::size_t a = 0; a < 3; ++a) {
    if (a > 0) text += ',';
    if (axes.negative[a]) text += '-';
    text += kNames[axes.from[a]];
  }
  return text;
}

std::unique_ptr<FrameSource> turn_source(std::unique_ptr<FrameSource> source,
                                         const Axes& axes) {
  FrameSource::Shape shape = source->shape();
  if (shape.rig) shape.rig = std::make_shared<SourceRig>(turned(axes, *shape.rig));
  const bool is_mesh_mirrored = shape.axes_of_mesh && is_mirror(*shape.axes_of_mesh);
  if (is_mirror(axes) != is_mesh_mirrored) {
    turn_over(shape.triangles);
    turn_over(shape.attributes);
  }
  // A mesh that already has these axes keeps its normals.
  if (shape.axes_of_mesh == axes) {
    shape.axes_of_mesh.reset();
  } else {
    turn_normals(axes, shape.attributes);
  }
  return std::make_unique<TurnedSource>(std::move(shape), std::move(source), axes);
}

std::unique_ptr<FrameStream> turn_stream(std::unique_ptr<FrameStream> stream,
                                         const Axes& axes) {
  FrameStream::Shape shape = stream->shape();
  if (is_mirror(axes)) turn_over(shape.triangles);
  return std::make_unique<TurnedStream>(std::move(shape), std::move(stream), axes);
}

}  // namespace rlpc
