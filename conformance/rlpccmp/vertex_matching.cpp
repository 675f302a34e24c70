#include "conformance/rlpccmp/vertex_matching.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>
#include <sstream>

#include "common/files/bounded_input.h"

namespace rlpc {
namespace {

// Reads one index per line, a permutation of 0 .. num_vertices - 1.
InputResult<std::vector<std::uint32_t>> read_order_map(const std::string& path,
                                                       std::uint32_t num_vertices) {
  constexpr std::size_t kMaxLineBytes = 32;
  const auto text = read_small_file(path, kMaxLineBytes * (std::size_t{num_vertices} + 1));
  if (!text) {
    return InputError{path + ": cannot be read, or is too long for " +
                      std::to_string(num_vertices) + " vertices"};
  }
  std::istringstream in(*text);
  std::vector<std::uint32_t> map;
  std::vector<bool> taken(num_vertices, false);
  for (std::string line; std::getline(in, line);) {
    const auto complain = [&](const std::string& what) {
      return InputError{path + ": line " + std::to_string(map.size() + 1) + ": " + what};
    };
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::uint32_t v = 0;
    const auto [end, ec] = std::from_chars(line.data(), line.data() + line.size(), v);
    if (ec != std::errc() || end != line.data() + line.size()) {
      return complain("expected the index of a vertex, got \"" + line.substr(0, 40) + "\"");
    }
    if (v >= num_vertices) {
      return complain("vertex " + line + ", but there are " + std::to_string(num_vertices) +
                      " (counted from 0)");
    }
    if (taken[v]) return complain("vertex " + line + " a second time");
    taken[v] = true;
    map.push_back(v);
  }
  if (map.size() != num_vertices) {
    return InputError{path + ": " + std::to_string(map.size()) + " lines for " +
                      std::to_string(num_vertices) + " vertices"};
  }
  return map;
}

// Oriented triangles without regard to their order and to the corner they start with.
std::vector<Triangle> as_set(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) {
    t = std::min({t, Triangle{t[1], t[2], t[0]}, Triangle{t[2], t[0], t[1]}});
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

InputResult<std::vector<std::uint32_t>> match_vertices(const ComparisonPair& pair,
                                                       const std::string& map_path) {
  const FrameSource& a = *pair.a.frames;
  const FrameSource& b = *pair.b.frames;
  std::vector<std::uint32_t> map(b.num_vertices());
  std::iota(map.begin(), map.end(), 0U);
  if (map_path.empty() && (pair.a.traversal_order || pair.b.traversal_order)) {
    if (a.triangles() == b.triangles()) return map;
    const std::string& stream = pair.b.traversal_order ? pair.b.name : pair.a.name;
    return InputError{stream +
                      ": its vertices are not in the order of the input; give the file of "
                      "`rlpcenc --order-map` with --order-map, or encode with --keep-order"};
  }
  std::vector<Triangle> triangles = b.triangles();
  if (!map_path.empty()) {
    auto read = read_order_map(map_path, b.num_vertices());
    if (!read) return read.error();
    map = std::move(*read);
    for (Triangle& t : triangles) {
      for (std::uint32_t& v : t) v = map[v];
    }
  }
  if (as_set(a.triangles()) == as_set(std::move(triangles))) return map;
  const std::string what = pair.b.name + ": its triangles are not those of " + pair.a.name;
  if (map_path.empty()) {
    return InputError{what + "; if its vertices are in decoded order, give --order-map"};
  }
  return InputError{what + " in the order of " + map_path +
                    "; that map belongs to another stream, or the vertices are in the order of "
                    "the input already"};
}

}  // namespace rlpc
