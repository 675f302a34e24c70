// A walking elephant: a cage of boxes, one Catmull-Clark subdivision, smooth skinning.
#include <algorithm>
#include <map>
#include <utility>

#include "conformance/tools/make_inputs.h"

namespace rlpc::inputs {

namespace {

using Quad = std::array<std::uint32_t, 4>;

struct QuadMesh {
  std::vector<Vec3> vertices;
  std::vector<Quad> quads;
};

// The cage: cells of a grid with these planes; x forward, y up, z to the right.
constexpr std::array kPlaneX{-1.75, -1.42, -1.12, -0.58, -0.1, 0.38, 0.95, 1.5, 1.9};
constexpr std::array kPlaneY{0.0, 0.22, 0.55, 0.95, 1.75, 2.05};
constexpr std::array kPlaneZ{-0.95, -0.5, -0.17, 0.17, 0.5, 0.95};

using Cell = std::array<int, 3>;

std::vector<Cell> elephant_cells() {
  std::vector<Cell> cells;
  for (int x = 2; x <= 5; ++x) {
    for (int z = 1; z <= 3; ++z) cells.push_back({x, 3, z});  // body
  }
  for (const int x : {2, 5}) {
    for (const int z : {1, 3}) {
      for (int y = 0; y <= 2; ++y) cells.push_back({x, y, z});  // legs
    }
  }
  for (int z = 1; z <= 3; ++z) cells.push_back({6, 3, z});       // head
  for (int z = 0; z <= 4; ++z) cells.push_back({6, 4, z});       // its upper half, and ears
  for (int y = 1; y <= 3; ++y) cells.push_back({7, y, 2});       // trunk
  cells.insert(cells.end(), {{1, 3, 2}, {0, 3, 2}, {0, 2, 2}});  // tail
  return cells;
}

// Moves a corner of the cage to where it looks better.
Vec3 sculpt(const Cell& corner, Vec3 p) {
  const auto [i, j, k] = corner;
  const bool middle = k == 2 || k == 3;
  if (i < 2 || (i == 2 && middle && j == 2)) {  // thin tail
    p.z *= 0.4;
    if (i == 0 && j == 4) p.y -= 0.3;
    if (i == 1) p = p + Vec3{0.1, j == 3 ? 0.34 : -0.08, 0};
    if (i == 1 && j == 2) p = p + Vec3{-0.22, -0.34, 0};
    if (i == 0 && j == 3) p.y += 0.1;
  }
  if (i >= 2 && i <= 6 && j == 4 && middle) p.y += 0.26 - 0.035 * (i - 4) * (i - 4);  // back
  if (i >= 3 && i <= 5 && j == 3) p.y -= i == 4 ? 0.18 : 0.08;                        // belly
  if (i >= 3 && i <= 5 && (k == 1 || k == 4) && j >= 3) p.z *= 1.25;                  // flanks
  if (j <= 1 && i >= 2 && i <= 6) {                                                   // feet
    const double centre = i <= 3 ? -0.85 : 0.665;
    p.x = centre + 1.1 * (p.x - centre) + 0.04;
  }
  if (i >= 6 && j >= 4 && k >= 1 && k <= 4) p = p + Vec3{0.08, j == 5 ? 0.3 : 0.05, 0};
  if (i >= 6 && j == 5 && (k == 1 || k == 4)) p.z *= 0.7;  // round head
  if (i == 7 && (k == 1 || k == 4)) p = p + Vec3{-0.12, 0, -0.3 * p.z};
  if (k == 0 || k == 5) {  // thin, hanging ears
    p.x = (i == 6 ? 0.82 : 0.98) - (j == 4 ? 0.02 : 0.0);
    p.y += j == 4 ? -0.62 : 0.12;
    p.z *= j == 4 ? 0.98 : 1.05;
  }
  if (i == 8 || (i == 7 && j < 3)) {  // tapered trunk
    const double taper = 0.58 + 0.14 * j;
    p.z *= taper;
    p.x = 1.66 + taper * (p.x - 1.7) + (j < 3 ? 0.04 * (3 - j) : 0);
    if (j == 4) p.y += 0.05;
    if (j == 1) p.y -= 0.1;
  }
  return p;
}

// The outer faces of the cells.
QuadMesh make_cage() {
  const std::vector<Cell> cells = elephant_cells();
  const auto filled = [&](const Cell& c) {
    return std::find(cells.begin(), cells.end(), c) != cells.end();
  };
  QuadMesh mesh;
  std::map<Cell, std::uint32_t> index_of;
  const auto corner_index = [&](const Cell& c) {
    const auto [it, is_new] =
        index_of.try_emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.push_back(sculpt(
          c, {kPlaneX[static_cast<std::size_t>(c[0])], kPlaneY[static_cast<std::size_t>(c[1])],
              kPlaneZ[static_cast<std::size_t>(c[2])]}));
    }
    return it->second;
  };
  for (const Cell& cell : cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Cell neighbour = cell;
        neighbour[axis] += 2 * side - 1;
        if (filled(neighbour)) continue;
        // Corners around the face, anticlockwise as seen from outside.
        constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        Quad quad{};
        for (std::size_t n = 0; n < 4; ++n) {
          Cell corner = cell;
          corner[axis] += side;
          corner[(axis + 1) % 3] += kAround[n][0];
          corner[(axis + 2) % 3] += kAround[n][1];
          quad[side == 1 ? n : 3 - n] = corner_index(corner);
        }
        mesh.quads.push_back(quad);
      }
    }
  }
  return mesh;
}

// One Catmull-Clark step of a closed mesh.
QuadMesh subdivide(const QuadMesh& mesh) {
  struct Edge {
    std::uint32_t point = 0;
    Vec3 sum;  // sum of the adjacent face points
  };
  QuadMesh result;
  const auto num_vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto num_faces = static_cast<std::uint32_t>(mesh.quads.size());
  std::vector<Vec3> face_sum(num_vertices);
  std::vector<Vec3> edge_sum(num_vertices);
  std::vector<int> valence(num_vertices);
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
  std::vector<Vec3> face_points;
  for (const Quad& q : mesh.quads) {
    Vec3 centre;
    for (const std::uint32_t v : q) centre = centre + 0.25 * mesh.vertices[v];
    face_points.push_back(centre);
    for (std::size_t n = 0; n < 4; ++n) {
      const auto key = std::minmax(q[n], q[(n + 1) % 4]);
      edges[key].sum = edges[key].sum + centre;
      face_sum[q[n]] = face_sum[q[n]] + centre;
    }
  }
  std::uint32_t next = num_vertices + num_faces;
  std::vector<Vec3> edge_points;
  for (auto& [key, edge] : edges) {
    const Vec3 ends = mesh.vertices[key.first] + mesh.vertices[key.second];
    edge.point = next++;
    edge_points.push_back(0.25 * (ends + edge.sum));
    for (const std::uint32_t v : {key.first, key.second}) {
      edge_sum[v] = edge_sum[v] + 0.5 * ends;
      ++valence[v];
    }
  }
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    const double n = valence[v];
    result.vertices.push_back(
        (1 / n) * ((1 / n) * face_sum[v] + (2 / n) * edge_sum[v] + (n - 3) * mesh.vertices[v]));
  }
  result.vertices.insert(result.vertices.end(), face_points.begin(), face_points.end());
  result.vertices.insert(result.vertices.end(), edge_points.begin(), edge_points.end());
  for (std::uint32_t f = 0; f < num_faces; ++f) {
    const Quad& q = mesh.quads[f];
    for (std::size_t n = 0; n < 4; ++n) {
      result.quads.push_back({q[n], edges[std::minmax(q[n], q[(n + 1) % 4])].point,
                              num_vertices + f,
                              edges[std::minmax(q[(n + 3) % 4], q[n])].point});
    }
  }
  return result;
}

struct Bone {
  int parent = -1;
  Vec3 head;  // the joint
  Vec3 tail;
  double radius = 0.3;  // radius of influence
};

enum BoneIndex {
  kHips,
  kChest,
  kHead,
  kEars,
  kTrunk = kEars + 2,
  kTail = kTrunk + 4,
  kLegs = kTail + 3
};

std::vector<Bone> elephant_bones() {
  std::vector<Bone> bones{
      {-1, {-0.2, 1.35, 0}, {-1.0, 1.35, 0}, 0.45},
      {kHips, {-0.2, 1.35, 0}, {0.8, 1.35, 0}, 0.45},
      {kChest, {0.95, 1.5, 0}, {1.45, 1.6, 0}, 0.4},
      {kHead, {1.05, 1.95, -0.5}, {0.9, 1.5, -0.95}, 0.22},
      {kHead, {1.05, 1.95, 0.5}, {0.9, 1.5, 0.95}, 0.22},
  };
  const std::array<Vec3, 5> trunk{
      {{1.5, 1.4, 0}, {1.72, 1.2, 0}, {1.76, 0.85, 0}, {1.78, 0.5, 0}, {1.8, 0.2, 0}}};
  for (std::size_t n = 0; n < 4; ++n) {
    bones.push_back(
        {n == 0 ? kHead : kTrunk + static_cast<int>(n) - 1, trunk[n], trunk[n + 1], 0.22});
  }
  const std::array<Vec3, 4> tail{
      {{-1.1, 1.4, 0}, {-1.4, 1.35, 0}, {-1.62, 1.15, 0}, {-1.66, 0.6, 0}}};
  for (std::size_t n = 0; n < 3; ++n) {
    bones.push_back(
        {n == 0 ? kHips : kTail + static_cast<int>(n) - 1, tail[n], tail[n + 1], 0.15});
  }
  for (const double x : {-0.85, 0.67}) {
    for (const double z : {-0.34, 0.34}) {
      const int thigh = static_cast<int>(bones.size());
      bones.push_back({x < 0 ? kHips : kChest, {x, 1.2, z}, {x, 0.66, z}, 0.25});
      bones.push_back({thigh, {x, 0.62, z}, {x, 0.24, z}, 0.2});
      bones.push_back({thigh + 1, {x, 0.2, z}, {x + 0.05, 0.05, z}, 0.2});
    }
  }
  return bones;
}

double distance_to_bone(Vec3 p, const Bone& bone) {
  const Vec3 d = bone.tail - bone.head;
  const double t = std::clamp(dot(p - bone.head, d) / dot(d, d), 0.0, 1.0);
  return length(p - (bone.head + t * d));
}

// weights[vertex][bone], sum 1; smooth in the position of the vertex.
std::vector<std::vector<double>> skin_weights(const std::vector<Vec3>& vertices,
                                              const std::vector<Bone>& bones) {
  std::vector<std::vector<double>> weights;
  for (const Vec3& p : vertices) {
    std::vector<double> row;
    double sum = 0;
    for (const Bone& bone : bones) {
      const double d = distance_to_bone(p, bone) / bone.radius;
      const double d2 = d * d + 0.05;
      row.push_back(1 / (d2 * d2 * d2));
      sum += row.back();
    }
    for (double& w : row) w /= sum;
    weights.push_back(std::move(row));
  }
  return weights;
}

// Rotation of each bone about its joint at `time` in walk cycles.
std::vector<Motion> pose(const std::vector<Bone>& bones, double time) {
  const Vec3 side{0, 0, 1};
  const Vec3 up{0, 1, 0};
  const Vec3 forward{1, 0, 0};
  std::vector<Motion> local(bones.size());
  const auto turn = [&](int bone, Vec3 axis, double turns) {
    const auto b = static_cast<std::size_t>(bone);
    local[b] = local[b] * rotation(bones[b].head, axis, turns);
  };
  turn(kHips, up, 0.012 * sin_turns(time));
  turn(kHips, forward, 0.01 * sin_turns(time + 0.1));
  turn(kChest, up, -0.02 * sin_turns(time));
  turn(kChest, side, 0.006 * sin_turns(2 * time));
  turn(kHead, side, 0.02 * sin_turns(2 * time + 0.3) + 0.015 * sin_turns(0.5 * time));
  turn(kHead, up, 0.03 * sin_turns(0.5 * time + 0.1));
  for (const int ear : {0, 1}) {
    const double sign = ear == 0 ? 1 : -1;
    turn(kEars + ear, up, sign * (0.05 + 0.07 * sin_turns(1.5 * time + 0.07 * ear)));
  }
  for (int n = 0; n < 4; ++n) {
    const double lift = smooth_step(0.7, 1.1, time) - smooth_step(1.5, 1.9, time);
    turn(kTrunk + n, side, 0.03 * sin_turns(time - 0.15 * n) + lift * (n == 0 ? 0.11 : 0.1));
    turn(kTrunk + n, forward, 0.035 * sin_turns(time + 0.25 - 0.12 * n));
  }
  for (int n = 0; n < 3; ++n) turn(kTail + n, up, 0.05 * sin_turns(2 * time - 0.15 * n));
  // Hind left, hind right, fore left, fore right: a walk in four beats.
  constexpr std::array<double, 4> kPhase{0, 0.5, 0.25, 0.75};
  for (int leg = 0; leg < 4; ++leg) {
    const double phase = time + kPhase[static_cast<std::size_t>(leg)];
    const double swing = 0.065 * sin_turns(phase);
    const double lift = std::max(0.0, cos_turns(phase));  // while the leg swings forward
    const double bend = (leg < 2 ? -0.13 : -0.11) * lift * lift;
    turn(kLegs + 3 * leg, side, swing - 0.4 * bend);
    turn(kLegs + 3 * leg + 1, side, bend);
    turn(kLegs + 3 * leg + 2, side, -0.5 * swing - 0.3 * bend);
  }
  // Pose bones from the root outwards: parents come before their children.
  const Vec3 path{1.3 * time, 0.025 * cos_turns(2 * time), 0.03 * sin_turns(time)};
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const Motion parent = bones[b].parent < 0
                              ? translation(path)
                              : local[static_cast<std::size_t>(bones[b].parent)];
    local[b] = parent * local[b];
  }
  return local;
}

}  // namespace

MadeAnimation make_elephant() {
  constexpr int kFrames = 60;
  constexpr double kCycleFrames = 30;
  const QuadMesh mesh = subdivide(make_cage());
  const std::vector<Bone> bones = elephant_bones();
  const auto weights = skin_weights(mesh.vertices, bones);
  MadeAnimation animation;
  animation.name = "elephant";
  for (const Quad& q : mesh.quads) {
    animation.triangles.push_back({q[0], q[1], q[2]});
    animation.triangles.push_back({q[0], q[2], q[3]});
  }
  for (int f = 0; f < kFrames; ++f) {
    const std::vector<Motion> motions = pose(bones, f / kCycleFrames);
    std::vector<Vec3> frame;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      Vec3 p;
      for (std::size_t b = 0; b < bones.size(); ++b) {
        p = p + weights[v][b] * motions[b](mesh.vertices[v]);
      }
      frame.push_back(p);
    }
    animation.frames.push_back(std::move(frame));
  }
  return animation;
}

}  // namespace rlpc::inputs
