// make_inputs FOLDER: writes the animations of streams/inputs.
#include "conformance/tools/make_inputs.h"

#include <charconv>
#include <fstream>
#include <iostream>
#include <utility>

#include "common/files/binary_numbers.h"

namespace rlpc::inputs {
namespace {

std::array<float, 3> to_floats(Vec3 p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

std::string obj_text(const MadeAnimation& animation) {
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

std::string pc2_bytes(const MadeAnimation& animation) {
  std::string bytes("POINTCACHE2\0", 12);
  append_u32(bytes, 1);
  append_u32(bytes, static_cast<std::uint32_t>(animation.frames[0].size()));
  append_f32(bytes, 0.0F);  // start
  append_f32(bytes, 1.0F);  // frames per sample
  append_u32(bytes, static_cast<std::uint32_t>(animation.frames.size()));
  for (const auto& frame : animation.frames) {
    for (const Vec3& p : frame) {
      for (const float value : to_floats(p)) append_f32(bytes, value);
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
  for (const MadeAnimation& animation : {make_elephant(), make_curtain(), make_robot()}) {
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
