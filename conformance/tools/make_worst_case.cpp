// make_worst_case LEVEL KIND OUT [OPTION NUMBER | --beyond LIMIT]...: writes a stream of one
// GOF that takes a decoder about as much time and memory as a GOF of the level can, and prints
// its size as JSON.
//
//   KIND            clusters, bones, tracks or frames
//   --frames N      at most so many frames: faster, with as many factors
//   --components N  at most so many components
//   --beyond LIMIT  with more vertices, frames, values, clusters, factors or adaptive than the
//                   level allows, and little of everything else
#include "conformance/tools/make_worst_case.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iostream>
#include <string>

namespace rlpc::worst_case {
namespace {

constexpr std::array<const char*, 4> kKindNames{"cluster", "skinned", "shared-rig", "inter"};

struct Request {
  std::uint32_t level = 0;
  Kind kind = Kind::kCluster;
  std::string path;
  Size size;
};

bool write_file(const Request& request) {
  const Size& size = request.size;
  const std::uint32_t max = kLevels[request.level - 1].max_triangles;
  const Plan plan{request.level, request.kind, size, make_mesh(size.vertices, max)};
  std::ofstream file(request.path, std::ios::binary);
  write_stream(plan, [&](const Bytes& bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  });
  std::cout << "{\"vertices\": " << size.vertices
            << ", \"triangles\": " << plan.triangles.size() << ", \"frames\": " << size.frames
            << ", \"components\": " << size.components
            << ", \"factors\": " << num_factors(request.kind, size)
            << ", \"adaptive_values\": " << std::uint64_t{size.adaptive_factors} * size.vertices
            << "}\n";
  return static_cast<bool>(file.flush());
}

bool parse(const std::string& text, std::uint32_t& value) {
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  return ec == std::errc() && end == text.data() + text.size() && value > 0;
}

// Options of the command line, after LEVEL KIND OUT.
struct Options {
  SizeLimits limits;
  std::string beyond;

  bool set(const std::string& name, const std::string& value) {
    if (name == "--frames") return parse(value, limits.frames);
    if (name == "--components") return parse(value, limits.components);
    beyond = value;
    return name == "--beyond";
  }
};

std::optional<Request> request_of(const std::vector<std::string>& words) {
  Request request;
  if (words.size() < 3 || words.size() % 2 == 0 || !parse(words[0], request.level) ||
      request.level > kMaxLevelIdc) {
    return std::nullopt;
  }
  const auto* const kind = std::find(kKindNames.begin(), kKindNames.end(), words[1]);
  if (kind == kKindNames.end()) return std::nullopt;
  request.kind = static_cast<Kind>(kind - kKindNames.begin());
  request.path = words[2];
  Options options;
  for (std::size_t i = 3; i < words.size(); i += 2) {
    if (!options.set(words[i], words[i + 1])) return std::nullopt;
  }
  const Level& level = kLevels[request.level - 1];
  request.size = hardest_size(request.kind, level, options.limits);
  if (options.beyond.empty()) return request;
  const auto beyond = size_beyond(options.beyond, level, request.size);
  if (!beyond) return std::nullopt;
  request.size = *beyond;
  return request;
}

int run(const std::vector<std::string>& words) {
  const auto request = request_of(words);
  if (!request) {
    std::cerr << "usage: make_worst_case LEVEL clusters|bones|tracks|frames OUT "
                 "[--frames N] [--components N] [--beyond LIMIT]\n";
    return 64;
  }
  if (write_file(*request)) return 0;
  std::cerr << request->path << ": cannot be written\n";
  return 1;
}

}  // namespace
}  // namespace rlpc::worst_case

int main(int argc, char** argv) { return rlpc::worst_case::run({argv + 1, argv + argc}); }
