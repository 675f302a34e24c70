// make_inputs FOLDER: writes the animations of streams/inputs.
#include "conformance/tools/make_inputs.h"

#include <bit>
#include <charconv>
#include <fstream>
#include <iostream>
#include <utility>

namespace rlpc::inputs {

double sin_turns(double turns) {
  constexpr double kTwoPi = 6.283185307179586;
  double t = turns - std::floor(turns);
  const double sign = t < 0.5 ? 1 : -1;
  if (t >= 0.5) t -= 0.5;
  if (t > 0.25) t = 0.5 - t;
  const double x = kTwoPi * t;  // 0 to pi / 2
  double sum = 0;
  for (int n = 19; n >= 1; n -= 2) sum = 1 - x * x / ((n + 1) * (n + 2)) * sum;
  return sign * x * sum;
}

double smooth_step(double from, double to, double x) {
  const double t = x <= from ? 0 : x >= to ? 1 : (x - from) / (to - from);
  return t * t * (3 - 2 * t);
}

Motion translation(Vec3 offset) {
  Motion m;
  m.offset = offset;
  return m;
}

Motion rotation(Vec3 centre, Vec3 axis, double turns) {
  const double s = sin_turns(turns);
  const double c = cos_turns(turns);
  const double d = 1 - c;
  const auto [x, y, z] = axis;
  Motion m;
  m.rows = {Vec3{c + d * x * x, d * x * y - s * z, d * x * z + s * y},
            Vec3{d * x * y + s * z, c + d * y * y, d * y * z - s * x},
            Vec3{d * x * z - s * y, d * y * z + s * x, c + d * z * z}};
  m.offset = centre - m(centre);
  return m;
}

Motion operator*(const Motion& second, const Motion& first) {
  Motion m;
  const Vec3 origin = second(first.offset);
  const auto column = [&](Vec3 unit) { return second(first(unit)) - origin; };
  const Vec3 x = column({1, 0, 0});
  const Vec3 y = column({0, 1, 0});
  const Vec3 z = column({0, 0, 1});
  m.rows = {Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}};
  m.offset = origin;
  return m;
}

namespace {

void append_u32(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
}

std::array<float, 3> to_floats(Vec3 p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

std::string obj_text(const Animation& animation) {
  std::string text =
      "# " + animation.name + ": first frame; all frames are in " + animation.name + ".pc2\n";
  text += "# frame_rate 30/1\n";
  for (const Vec3& p : animation.frames[0]) {
    text += 'v';
    for (const float value : to_floats(p)) {
      std::array<char, 32> digits{};
      text += ' ';
      text.append(digits.data(), std::to_chars(digits.begin(), digits.end(), value).ptr);
    }
    text += '\n';
  }
  for (const Triangle& t : animation.triangles) {
    text += 'f';
    for (const std::uint32_t v : t) text += ' ' + std::to_string(v + 1);
    text += '\n';
  }
  return text;
}

std::string pc2_bytes(const Animation& animation) {
  std::string bytes("POINTCACHE2\0", 12);
  append_u32(bytes, 1);
  append_u32(bytes, static_cast<std::uint32_t>(animation.frames[0].size()));
  append_u32(bytes, std::bit_cast<std::uint32_t>(0.0F));  // start
  append_u32(bytes, std::bit_cast<std::uint32_t>(1.0F));  // frames per sample
  append_u32(bytes, static_cast<std::uint32_t>(animation.frames.size()));
  for (const auto& frame : animation.frames) {
    for (const Vec3& p : frame) {
      for (const float value : to_floats(p))
        append_u32(bytes, std::bit_cast<std::uint32_t>(value));
    }
  }
  return bytes;
}

bool write_file(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes << std::flush;
  if (!file) std::cerr << path << ": cannot be written\n";
  return static_cast<bool>(file);
}

int run(const std::string& folder) {
  for (const Animation& animation : {make_elephant(), make_curtain(), make_robot()}) {
    const std::string path = folder + "/" + animation.name;
    if (!write_file(path + ".obj", obj_text(animation))) return 1;
    if (!write_file(path + ".pc2", pc2_bytes(animation))) return 1;
    std::cout << animation.name << ": " << animation.frames[0].size() << " vertices, "
              << animation.triangles.size() << " triangles, " << animation.frames.size()
              << " frames\n";
  }
  return 0;
}

}  // namespace
}  // namespace rlpc::inputs

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_inputs FOLDER\n";
    return 2;
  }
  return rlpc::inputs::run(argv[1]);
}
