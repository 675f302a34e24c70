// make_tentacle VERTICES FRAMES OUT: writes OUT.obj and OUT.pc2, a bending tube of any size,
// for measurements of time and memory. One frame is held at a time.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "common/files/binary_numbers.h"
#include "conformance/tools/make_inputs.h"

namespace rlpc::inputs {
namespace {

constexpr double kLength = 10.0;

struct Size {
  std::uint32_t rings = 0;
  std::uint32_t around = 0;
  std::uint32_t frames = 0;
};

// Makes rings of vertices with square faces between them.
Size size_for(std::uint32_t num_vertices, std::uint32_t num_frames) {
  const auto around =
      std::max(6U, static_cast<std::uint32_t>(std::sqrt(num_vertices / kLength * 3.0)));
  return {std::max(2U, num_vertices / around), around, num_frames};
}

// Returns the curvature of the tube at `t`, 0 (its root) to 1, in turns per unit: waves that
// run along it.
double bend(double t, double seconds, double phase) {
  return 0.03 * sin_turns(0.31 * seconds - 0.7 * t + phase) +
         0.02 * sin_turns(0.83 * seconds - 1.9 * t + 2 * phase) +
         0.012 * t * sin_turns(1.7 * seconds - 3.1 * t + 3 * phase);
}

double radius(double t, double angle, double seconds) {
  const double muscle = sin_turns(0.6 * seconds - 2 * t) * cos_turns(2 * angle + 0.2 * seconds);
  return (0.6 - 0.45 * t) * (1 + 0.08 * muscle + 0.02 * sin_turns(14 * t + 3 * angle));
}

std::vector<Vec3> frame_of(const Size& size, std::uint32_t frame) {
  const double seconds = frame / 30.0;
  const double step = kLength / size.rings;
  std::vector<Vec3> out;
  out.reserve(std::size_t{size.rings} * size.around);
  Motion pose = translation({0, 0, 0});
  for (std::uint32_t r = 0; r < size.rings; ++r) {
    const double t = static_cast<double>(r) / size.rings;
    const Motion turn = rotation({0, 0, 0}, {1, 0, 0}, step * bend(t, seconds, 0.0)) *
                        rotation({0, 0, 0}, {0, 0, 1}, step * bend(t, seconds, 0.37));
    pose = pose * turn * translation({0, step, 0});
    for (std::uint32_t a = 0; a < size.around; ++a) {
      const double angle = static_cast<double>(a) / size.around;
      const double wide = radius(t, angle, seconds);
      out.push_back(pose({wide * cos_turns(angle), 0, wide * sin_turns(angle)}));
    }
  }
  return out;
}

bool write_obj(const std::string& path, const Size& size) {
  std::ofstream file(path);
  file.precision(9);
  for (const Vec3& p : frame_of(size, 0))
    file << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (std::uint32_t r = 0; r + 1 < size.rings; ++r) {
    for (std::uint32_t a = 0; a < size.around; ++a) {
      const std::uint32_t next = (a + 1) % size.around;
      const std::uint32_t low = r * size.around + 1;
      const std::uint32_t high = low + size.around;
      file << "f " << low + a << ' ' << high + a << ' ' << low + next << '\n'
           << "f " << low + next << ' ' << high + a << ' ' << high + next << '\n';
    }
  }
  return static_cast<bool>(file.flush());
}

bool write_pc2(const std::string& path, const Size& size) {
  std::ofstream file(path, std::ios::binary);
  std::string bytes("POINTCACHE2\0", 12);
  append_u32(bytes, 1);
  append_u32(bytes, size.rings * size.around);
  append_f32(bytes, 0.0F);
  append_f32(bytes, 1.0F);
  append_u32(bytes, size.frames);
  for (std::uint32_t f = 0; f < size.frames && file; ++f) {
    for (const Vec3& p : frame_of(size, f)) {
      for (const double value : {p.x, p.y, p.z}) {
        append_f32(bytes, static_cast<float>(value));
      }
    }
    file << bytes;
    bytes.clear();
  }
  return static_cast<bool>(file.flush());
}

bool parse(const std::string& text, std::uint32_t& value) {
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  return ec == std::errc() && end == text.data() + text.size() && value > 0 && value < 1U << 28;
}

int run(const std::vector<std::string>& words) {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_frames = 0;
  if (words.size() != 3 || !parse(words[0], num_vertices) || !parse(words[1], num_frames)) {
    std::cerr << "usage: make_tentacle VERTICES FRAMES OUT\n";
    return 64;
  }
  const Size size = size_for(num_vertices, num_frames);
  if (write_obj(words[2] + ".obj", size) && write_pc2(words[2] + ".pc2", size)) return 0;
  std::cerr << words[2] << ": cannot be written\n";
  return 1;
}

}  // namespace
}  // namespace rlpc::inputs

int main(int argc, char** argv) { return rlpc::inputs::run({argv + 1, argv + argc}); }
