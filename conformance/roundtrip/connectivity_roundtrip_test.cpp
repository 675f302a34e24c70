// Tests writer and parser of the connectivity unit against each other (clauses 6.4 and 8.7).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/mesh/connectivity_models.h"
#include "common/testing/triangle_mesh.h"
#include "decoder/codec/parse/sequence/parse_connectivity.h"
#include "encoder/codec/write/write_connectivity.h"

namespace rlpc {
namespace {

using Triangles = std::vector<Triangle>;

// Returns the rotation of a triangle that starts with its smallest index.
Triangle canonical(Triangle t) {
  const Triangle turned_once{t[1], t[2], t[0]};
  const Triangle turned_twice{t[2], t[0], t[1]};
  return std::min({t, turned_once, turned_twice});
}

Triangles canonical_multiset(Triangles triangles) {
  for (Triangle& t : triangles) t = canonical(t);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Result<Triangles> parse(const std::vector<std::uint8_t>& payload, const TriangleMesh& mesh) {
  BitReader r(payload);
  return parse_connectivity(r, mesh.num_vertices,
                            static_cast<std::uint32_t>(mesh.triangles.size()));
}

ConnectivityCode expect_connectivity_round_trip(const TriangleMesh& mesh) {
  ConnectivityCode code = write_connectivity(mesh.num_vertices, mesh.triangles);
  const auto decoded = parse(code.payload, mesh);
  EXPECT_TRUE(decoded) << (decoded ? "" : decoded.error().rule);
  if (!decoded) return code;
  EXPECT_EQ(*decoded, code.triangles);

  std::vector<std::uint32_t> vertices = code.input_vertex;
  std::sort(vertices.begin(), vertices.end());
  std::vector<std::uint32_t> all(mesh.num_vertices);
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(vertices, all);

  Triangles mapped = *decoded;
  for (Triangle& t : mapped) {
    for (std::uint32_t& v : t) v = code.input_vertex.at(v);
  }
  EXPECT_EQ(canonical_multiset(mapped), canonical_multiset(mesh.triangles));
  return code;
}

TriangleMesh disjoint_union(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh sum = a;
  for (Triangle t : b.triangles) {
    for (std::uint32_t& v : t) v += a.num_vertices;
    sum.triangles.push_back(t);
  }
  sum.num_vertices += b.num_vertices;
  return sum;
}

// Merges vertex `from` into vertex `to`; `from` stays as an isolated vertex.
void merge_vertices(TriangleMesh& mesh, std::uint32_t from, std::uint32_t to) {
  for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), from, to);
}

TriangleMesh tetrahedron() { return {4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}}; }

TriangleMesh cube() {
  return {8,
          {{0, 2, 1},
           {0, 3, 2},
           {4, 5, 6},
           {4, 6, 7},
           {0, 1, 5},
           {0, 5, 4},
           {1, 2, 6},
           {1, 6, 5},
           {2, 3, 7},
           {2, 7, 6},
           {3, 0, 4},
           {3, 4, 7}}};
}

// A grid of nx * ny quads; wrapped in x or y if asked for; quads for which keep() is false are
// left out.
template <class Keep>
TriangleMesh grid(std::uint32_t nx, std::uint32_t ny, bool wrap_x, bool wrap_y, Keep keep) {
  const std::uint32_t row = wrap_x ? nx : nx + 1;
  const std::uint32_t rows = wrap_y ? ny : ny + 1;
  TriangleMesh mesh{row * rows, {}};
  for (std::uint32_t y = 0; y < ny; ++y) {
    for (std::uint32_t x = 0; x < nx; ++x) {
      if (!keep(x, y)) continue;
      const std::uint32_t x1 = (x + 1) % row;
      const std::uint32_t y1 = (y + 1) % rows;
      const std::uint32_t a = y * row + x;
      const std::uint32_t b = y * row + x1;
      const std::uint32_t c = y1 * row + x1;
      const std::uint32_t d = y1 * row + x;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

TriangleMesh grid(std::uint32_t nx, std::uint32_t ny, bool wrap_x = false,
                  bool wrap_y = false) {
  return grid(nx, ny, wrap_x, wrap_y, [](std::uint32_t, std::uint32_t) { return true; });
}

// Closed surface of the given genus: the surface of a bar of cubes with `genus` holes in a row.
TriangleMesh surface_of_genus(std::uint32_t genus) {
  const std::uint32_t nx = 2 * genus + 1;
  const auto solid = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= 3 || z >= 1) return false;
    return !(y == 1 && x % 2 == 1);
  };
  std::map<std::array<std::int64_t, 3>, std::uint32_t> index;
  TriangleMesh mesh;
  const auto vertex = [&](std::array<std::int64_t, 3> p) {
    return index.emplace(p, static_cast<std::uint32_t>(index.size())).first->second;
  };
  for (std::int64_t x = 0; x < nx; ++x) {
    for (std::int64_t y = 0; y < 3; ++y) {
      if (!solid(x, y, 0)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::int64_t side : {0, 1}) {
          std::array<std::int64_t, 3> beyond{x, y, 0};
          beyond[axis] += side == 1 ? 1 : -1;
          if (solid(beyond[0], beyond[1], beyond[2])) continue;
          std::array<std::int64_t, 3> a{x, y, 0};
          a[axis] += side;
          auto b = a;
          auto c = a;
          auto d = a;
          ++b[(axis + 1) % 3];
          ++c[(axis + 1) % 3];
          ++c[(axis + 2) % 3];
          ++d[(axis + 2) % 3];
          if (side == 0) std::swap(b, d);
          mesh.triangles.push_back({vertex(a), vertex(b), vertex(c)});
          mesh.triangles.push_back({vertex(a), vertex(c), vertex(d)});
        }
      }
    }
  }
  mesh.num_vertices = static_cast<std::uint32_t>(index.size());
  return mesh;
}

TriangleMesh moebius_strip(std::uint32_t n) {
  TriangleMesh mesh{2 * n, {}};
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i;
    const std::uint32_t b = 2 * i + 1;
    const std::uint32_t c = i + 1 < n ? 2 * i + 2 : 1;
    const std::uint32_t d = i + 1 < n ? 2 * i + 3 : 0;
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({c, b, d});
  }
  return mesh;
}

// Returns a number from 0 to n - 1.
std::uint32_t draw(std::mt19937& rng, std::uint32_t n) {
  return static_cast<std::uint32_t>(rng()) % n;
}

void shuffle(TriangleMesh& mesh, std::mt19937& rng, bool flip) {
  std::vector<std::uint32_t> order(mesh.num_vertices);
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), rng);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), rng);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = order[v];
    std::rotate(t.begin(), t.begin() + draw(rng, 3), t.end());
    if (flip && draw(rng, 8) == 0) std::swap(t[0], t[1]);
  }
}

TriangleMesh random_soup(std::mt19937& rng) {
  TriangleMesh mesh;
  mesh.num_vertices = 1 + draw(rng, 12);
  mesh.triangles.resize(draw(rng, 60));
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = draw(rng, mesh.num_vertices);
  }
  return mesh;
}

std::vector<TriangleMesh> small_meshes() {
  TriangleMesh shared_vertex = disjoint_union(cube(), cube());
  merge_vertices(shared_vertex, 8, 0);
  TriangleMesh shared_edge = shared_vertex;
  merge_vertices(shared_edge, 9, 1);
  return {{0, {}},
          {5, {}},
          {3, {{0, 1, 2}}},
          {3, {{0, 1, 2}, {0, 2, 1}}},
          {3, {{0, 1, 2}, {1, 2, 0}}},
          {3, {{0, 1, 2}, {2, 0, 1}, {1, 0, 2}, {0, 1, 2}, {0, 2, 1}}},
          {5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}},
          {9, {{7, 1, 3}, {3, 1, 8}}},
          {4, {{0, 0, 1}, {2, 2, 2}, {1, 3, 1}}},
          {1, {{0, 0, 0}}},
          {7, {{5, 5, 6}, {0, 1, 2}, {2, 1, 3}, {6, 0, 6}}},
          tetrahedron(),
          cube(),
          shared_vertex,
          shared_edge,
          grid(4, 3),
          grid(3, 3, true, true),
          grid(2, 2, true, true),
          grid(1, 1, true, true),
          grid(5, 1, true, false),
          surface_of_genus(1),
          surface_of_genus(2),
          moebius_strip(5),
          disjoint_union(grid(2, 2), disjoint_union(tetrahedron(), grid(3, 4, true, true)))};
}

TEST(ConnectivityRoundTrip, SmallMeshes) {
  const std::vector<TriangleMesh> meshes = small_meshes();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    SCOPED_TRACE(i);
    expect_connectivity_round_trip(meshes[i]);
  }
}

TEST(ConnectivityRoundTrip, ShuffledAndFlippedMeshes) {
  const auto holes = [](std::uint32_t x, std::uint32_t y) { return (x * 7 + y * 5) % 6 != 0; };
  const std::vector<TriangleMesh> meshes{
      grid(20, 17, true, true), grid(30, 20, false, false, holes),
      grid(9, 30, true, false), surface_of_genus(3),
      surface_of_genus(60),     moebius_strip(40)};
  std::mt19937 rng(1);
  for (const TriangleMesh& original : meshes) {
    for (int variant = 0; variant < 40; ++variant) {
      SCOPED_TRACE(variant);
      TriangleMesh mesh = original;
      shuffle(mesh, rng, variant % 2 == 1);
      expect_connectivity_round_trip(mesh);
    }
  }
}

TEST(ConnectivityRoundTrip, RandomTriangleSoups) {
  for (std::uint32_t seed = 0; seed < 6000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 rng(seed);
    expect_connectivity_round_trip(random_soup(rng));
    if (HasFailure()) return;
  }
}

// Vertices merged at random: handles, pinched vertices and edges with many triangles.
TEST(ConnectivityRoundTrip, RandomlyPinchedSurfaces) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 rng(seed);
    TriangleMesh mesh =
        grid(3 + draw(rng, 9), 3 + draw(rng, 9), draw(rng, 2) == 0, draw(rng, 2) == 0);
    for (std::uint32_t i = draw(rng, 12); i > 0; --i) {
      merge_vertices(mesh, draw(rng, mesh.num_vertices), draw(rng, mesh.num_vertices));
    }
    shuffle(mesh, rng, draw(rng, 4) == 0);
    expect_connectivity_round_trip(mesh);
    if (HasFailure()) return;
  }
}

class FarJoins : public Trace {
 public:
  void begin(const char*, std::uint64_t) override {}
  void element(const char* name, std::int64_t value, std::uint64_t) override {
    if (std::string_view(name) == "far_join_flag") (value == 1 ? num_far : num_near) += 1;
  }
  int num_far = 0;
  int num_near = 0;
};

// Tests triangles across the open end of a long tube, and a small closed surface.
TEST(ConnectivityRoundTrip, JoinsAreNearOrFar) {
  TriangleMesh mesh = grid(6000, 2, true, false);
  mesh.triangles.push_back({0, 3000, 1500});
  mesh.triangles.push_back({1, 0, 1500});
  mesh = disjoint_union(mesh, surface_of_genus(3));
  const ConnectivityCode code = expect_connectivity_round_trip(mesh);
  FarJoins joins;
  BitReader r(code.payload, 0, &joins);
  EXPECT_TRUE(parse_connectivity(r, mesh.num_vertices,
                                 static_cast<std::uint32_t>(mesh.triangles.size())));
  EXPECT_GT(joins.num_far, 0);
  EXPECT_GT(joins.num_near, 0);
}

// Tests tubes, which close by a join: the widest that needs no far one, and the next.
TEST(ConnectivityRoundTrip, JoinsMayBeAsFarAsTheirLimit) {
  const auto is_near = [](std::uint32_t around) {
    const TriangleMesh mesh = grid(around, 2, true, false);
    const auto code = write_connectivity(mesh.num_vertices, mesh.triangles);
    FarJoins joins;
    BitReader r(code.payload, 0, &joins);
    (void)parse_connectivity(r, mesh.num_vertices,
                             static_cast<std::uint32_t>(mesh.triangles.size()));
    return joins.num_far == 0;
  };
  std::uint32_t near = 100;
  std::uint32_t far = 4 * kMaxJoinDistance;
  ASSERT_TRUE(is_near(near));
  ASSERT_FALSE(is_near(far));
  while (far - near > 1) (is_near((near + far) / 2) ? near : far) = (near + far) / 2;
  EXPECT_GE(near, kMaxJoinDistance / 2);
  expect_connectivity_round_trip(grid(near, 2, true, false));
  expect_connectivity_round_trip(grid(far, 2, true, false));
}

TEST(ConnectivityRoundTrip, EveryProperPrefixFails) {
  std::vector<TriangleMesh> meshes = small_meshes();
  meshes.push_back(surface_of_genus(4));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto code = write_connectivity(meshes[i].num_vertices, meshes[i].triangles);
    for (std::size_t n = 0; n < code.payload.size(); ++n) {
      const std::vector<std::uint8_t> prefix(code.payload.begin(),
                                             code.payload.begin() + static_cast<long>(n));
      EXPECT_FALSE(parse(prefix, meshes[i])) << "mesh " << i << ", " << n << " bytes";
    }
  }
}

TEST(ConnectivityRoundTrip, ChangedBytesNeverBreakTheParser) {
  for (const TriangleMesh& mesh : small_meshes()) {
    const auto code = write_connectivity(mesh.num_vertices, mesh.triangles);
    for (std::size_t i = 0; i < code.payload.size(); ++i) {
      std::vector<std::uint8_t> changed = code.payload;
      for (int value = 0; value < 256; ++value) {
        changed[i] = static_cast<std::uint8_t>(value);
        const auto decoded = parse(changed, mesh);
        if (!decoded) continue;
        EXPECT_EQ(decoded->size(), mesh.triangles.size());
        for (const Triangle& t : *decoded) {
          for (const std::uint32_t v : t) EXPECT_LT(v, mesh.num_vertices);
        }
      }
    }
  }
}

TEST(ConnectivityRoundTrip, RandomBytesNeverBreakTheParser) {
  std::mt19937 rng(7);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> bytes(draw(rng, 200));
    for (auto& b : bytes) b = static_cast<std::uint8_t>(rng());
    if (bytes.size() > 2 && i % 4 != 0) bytes[0] = 0x80 | (bytes[0] & 0x7F);
    const TriangleMesh claimed{i % 2 == 0 ? 40U : 1000000U, Triangles(draw(rng, 500))};
    const auto decoded = parse(bytes, claimed);
    if (!decoded) continue;
    for (const Triangle& t : *decoded) {
      for (const std::uint32_t v : t) EXPECT_LT(v, claimed.num_vertices);
    }
  }
}

// The triangles of an OBJ file, polygons not expected.
TriangleMesh read_obj(const std::filesystem::path& path) {
  TriangleMesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("v ")) ++mesh.num_vertices;
    if (!line.starts_with("f ")) continue;
    std::istringstream words(line.substr(2));
    Triangle t{};
    for (std::uint32_t& v : t) {
      std::string word;
      words >> word;
      v = static_cast<std::uint32_t>(std::stoul(word)) - 1;
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

TEST(ConnectivityRoundTrip, ClosedManifoldsNeedFewBits) {
  const std::filesystem::path folder = RLPC_SOURCE_DIR "/../shared/data/sequences";
  if (!std::filesystem::exists(folder / "cow.obj")) GTEST_SKIP() << "no test data";
  for (const char* name : {"cow.obj", "samba.obj"}) {
    const TriangleMesh mesh = read_obj(folder / name);
    const ConnectivityCode code = expect_connectivity_round_trip(mesh);
    EXPECT_LE(8.0 * static_cast<double>(code.payload.size()), 2.3 * mesh.num_vertices) << name;
  }
}

}  // namespace
}  // namespace rlpc
