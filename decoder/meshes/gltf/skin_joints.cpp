#include "decoder/meshes/gltf/skin_joints.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace rlpc {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kAxisUnit = 1.0 / (std::int64_t{1} << 30);
constexpr double kOriginFractions = 16;

// Returns about the distance between the images of a point at distance 1 under two rotations.
double distance(const Quaterniond& a, const Quaterniond& b) {
  return 2 * std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}
double distance(const Vector3d& a, const Vector3d& b) { return (a - b).norm(); }

Quaterniond between(const Quaterniond& a, const Quaterniond& b, double t) {
  return a.slerp(t, b);
}
Vector3d between(const Vector3d& a, const Vector3d& b, double t) { return a + t * (b - a); }

std::size_t width_of(const Quaterniond&) { return 4; }
std::size_t width_of(const Vector3d&) { return 3; }

void append(std::vector<float>& values, const Quaterniond& q) {
  for (Eigen::Index c = 0; c < 4; ++c) values.push_back(static_cast<float>(q.coeffs()[c]));
}
void append(std::vector<float>& values, const Vector3d& p) {
  for (Eigen::Index c = 0; c < 3; ++c) values.push_back(static_cast<float>(p[c]));
}

void read(const float* values, Quaterniond& q) {
  q = Quaterniond(values[3], values[0], values[1], values[2]).normalized();
}
void read(const float* values, Vector3d& p) { p = {values[0], values[1], values[2]}; }

// Largest error of rotations as 16-bit integers.
constexpr double kShortUnit = 1.0 / 32767;
constexpr double kShortAngle = 2 * kShortUnit;

bool fits_shorts(const Quaterniond&, double tolerance) { return tolerance >= kShortAngle; }
bool fits_shorts(const Vector3d&, double) { return false; }

// JSON bytes of an accessor of times.
constexpr std::size_t kTimesJsonBytes = 130;

template <class T>
bool is_still(std::span<const T> series, const T& value, double tolerance) {
  return std::ranges::all_of(series,
                             [&](const T& x) { return distance(x, value) <= tolerance; });
}

// Returns the value that represents a nearly constant series: that of its middle.
template <class T>
JointTrack keys_of(std::span<const T> series, double tolerance) {
  JointTrack track;
  const T& middle = series[series.size() / 2];
  if (is_still(series, middle, tolerance / 2)) {
    track.keys = {0};
    append(track.values, middle);
    return track;
  }
  const auto num_frames = static_cast<std::uint32_t>(series.size());
  track.has_short_values = fits_shorts(middle, tolerance);
  track.keys = needed_keys(num_frames, [&](std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t f = a + 1; f < b; ++f) {
      const double t = static_cast<double>(f - a) / (b - a);
      if (distance(between(series[a], series[b], t), series[f]) > tolerance) return false;
    }
    return true;
  });
  const std::size_t bytes_of_key =
      track.has_short_values ? 8 : sizeof(float) * width_of(middle);
  track.keys = keys_to_write(std::move(track.keys), num_frames, bytes_of_key);
  for (const std::uint32_t key : track.keys) append(track.values, series[key]);
  if (track.has_short_values) {
    for (float& x : track.values) {
      x = static_cast<float>(std::round(x / kShortUnit) * kShortUnit);
    }
  }
  return track;
}

// Takes the tracks of all clips and the value of the node from a series over all frames.
// tracks: returns the track of a clip.
template <class T, class Tracks>
std::vector<float> add_tracks(std::span<const T> series, std::span<const Clip> spans,
                              double tolerance, const Tracks& tracks) {
  std::vector<float> node;
  const T& middle = series[series.size() / 2];
  if (is_still(series, middle, tolerance / 2)) {
    append(node, middle);
    return node;
  }
  append(node, series[0]);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    tracks(i) = keys_of(series.subspan(spans[i].first_frame, spans[i].num_frames), tolerance);
  }
  return node;
}

template <class T>
T value_at(const JointTrack& track, const float* node, std::size_t width, std::uint32_t f) {
  T a{};
  if (track.keys.empty()) {
    read(node, a);
    return a;
  }
  const auto next = std::ranges::upper_bound(track.keys, f);
  const auto i = static_cast<std::size_t>(std::distance(track.keys.begin(), next)) - 1;
  read(&track.values[i * width], a);
  if (i + 1 == track.keys.size()) return a;
  T b{};
  read(&track.values[(i + 1) * width], b);
  const double length = track.keys[i + 1] - track.keys[i];
  return between(a, b, (f - track.keys[i]) / length);
}

std::array<float, 16> columns_of(const JointPlace& place) {
  std::array<float, 16> values{};
  const Eigen::Matrix3d& m = place.axes;
  for (Eigen::Index column = 0; column < 3; ++column) {
    for (Eigen::Index row = 0; row < 3; ++row) {
      values[static_cast<std::size_t>(4 * column + row)] = static_cast<float>(m(row, column));
    }
    values[static_cast<std::size_t>(12 + column)] = static_cast<float>(place.origin[column]);
  }
  values[15] = 1;
  return values;
}

}  // namespace

JointPlace joint_place(const BonePlace& place, const Grid& grid) {
  Eigen::Matrix3d axes;
  JointPlace joint;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      axes(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) =
          static_cast<double>(place.axes[k][c]) * kAxisUnit;
    }
    joint.origin[static_cast<Eigen::Index>(k)] =
        std::ldexp(static_cast<double>(place.origin[k]) / kOriginFractions + grid.origin[k],
                   grid.log2_step);
  }
  joint.axes = axes;
  return joint;
}

JointPlace JointPlace::inverse() const {
  constexpr double kFlat = 1e-12;  // squared; rounding errors of axes are 1e-9
  Eigen::Matrix3d products = axes.transpose() * axes;
  products.diagonal().array() += kFlat;
  const Eigen::Matrix3d back = products.inverse() * axes.transpose();
  return {back, -(back * origin)};
}

TurnAndScale turn_and_scale(const Eigen::Matrix3d& map, const Quaterniond& before) {
  constexpr double kNothing = 1e-6;
  constexpr double kEqual = 1e-6;  // factors of 1 are rounded to 2^-28
  const Vector3d norms = map.colwise().norm();
  if ((norms.array() - 1.0).abs().maxCoeff() < kEqual) {
    return {Quaterniond(map).normalized(), Vector3d::Ones()};
  }
  Eigen::Matrix3d turn = map;
  int num_flat = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (norms[k] < kNothing) {
      ++num_flat;
    } else {
      turn.col(k) /= norms[k];
    }
  }
  if (num_flat > 1) return {before, norms};
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (norms[k] < kNothing) turn.col(k) = turn.col((k + 1) % 3).cross(turn.col((k + 2) % 3));
  }
  return {Quaterniond(turn).normalized(), norms};
}

JointMap map_of_place(const JointPlace& place) {
  JointMap map;
  map.leftCols<3>() = place.axes;
  map.col(3) = place.origin;
  return map;
}

std::vector<std::uint32_t> keys_to_write(std::vector<std::uint32_t> keys,
                                         std::uint32_t num_frames, std::size_t bytes_of_key) {
  const bool is_smaller =
      keys.size() <= 2 || keys.size() * (bytes_of_key + sizeof(float)) + kTimesJsonBytes <
                              num_frames * bytes_of_key;
  if (!is_smaller) {
    keys.resize(num_frames);
    std::iota(keys.begin(), keys.end(), 0U);
  }
  return keys;
}

JointMotion joint_motion(const Skeleton& skeleton, const Grid& grid,
                         std::span<const JointPlaces> places, std::span<const double> reach,
                         std::span<const Clip> spans, double tolerance) {
  JointMotion motion;
  const std::size_t num_joints = skeleton.bones.size();
  motion.nodes.resize(num_joints);
  motion.clips.assign(spans.size(), std::vector<JointMotion::OfClip>(num_joints));
  std::vector<Quaterniond> rotations(places.size());
  std::vector<Vector3d> origins(places.size());
  std::vector<Vector3d> scales(places.size());
  for (std::size_t j = 0; j < num_joints; ++j) {
    const std::int32_t parent = skeleton.bones[j].parent;
    for (std::size_t f = 0; f < places.size(); ++f) {
      JointPlace place = places[f][j];
      if (parent >= 0) {
        place = places[f][static_cast<std::size_t>(parent)].inverse().after(place);
      }
      const TurnAndScale local =
          turn_and_scale(place.axes, f > 0 ? rotations[f - 1] : Quaterniond::Identity());
      rotations[f] = local.turn;
      scales[f] = local.scale;
      if (f > 0 && rotations[f].dot(rotations[f - 1]) < 0) rotations[f].coeffs() *= -1;
      origins[f] = place.origin;
    }
    JointMotion::Node& node = motion.nodes[j];
    node.parent = parent;
    const double turn_tolerance = reach[j] > 0 ? tolerance / reach[j] : 1;
    const auto turn = add_tracks<Quaterniond>(
        rotations, spans, turn_tolerance,
        [&](std::size_t i) -> JointTrack& { return motion.clips[i][j].rotation; });
    std::ranges::copy(turn, node.rotation.begin());
    const auto scale = add_tracks<Vector3d>(
        scales, spans, turn_tolerance,
        [&](std::size_t i) -> JointTrack& { return motion.clips[i][j].scale; });
    std::ranges::copy(scale, node.scale.begin());
    const auto shift = add_tracks<Vector3d>(
        origins, spans, tolerance,
        [&](std::size_t i) -> JointTrack& { return motion.clips[i][j].translation; });
    std::ranges::copy(shift, node.translation.begin());
    motion.inverse_bind.push_back(
        columns_of(joint_place(skeleton.bones[j].bind, grid).inverse()));
  }
  return motion;
}

JointMaps joint_maps(const JointMotion& motion, std::size_t clip, std::uint32_t frame) {
  JointPlaces places;
  JointMaps maps;
  for (std::size_t j = 0; j < motion.nodes.size(); ++j) {
    const JointMotion::Node& node = motion.nodes[j];
    const JointMotion::OfClip& tracks = motion.clips[clip][j];
    const auto turn = value_at<Quaterniond>(tracks.rotation, node.rotation.data(), 4, frame);
    const auto scale = value_at<Vector3d>(tracks.scale, node.scale.data(), 3, frame);
    JointPlace place{turn.toRotationMatrix() * scale.asDiagonal(),
                     value_at<Vector3d>(tracks.translation, node.translation.data(), 3, frame)};
    if (node.parent >= 0) place = places[static_cast<std::size_t>(node.parent)].after(place);
    places.push_back(place);
    const auto& columns = motion.inverse_bind[j];
    const Eigen::Matrix4d bind =
        Eigen::Map<const Eigen::Matrix4f>(columns.data()).cast<double>();
    maps.push_back(map_of_place(place) * bind);
  }
  return maps;
}

}  // namespace rlpc
