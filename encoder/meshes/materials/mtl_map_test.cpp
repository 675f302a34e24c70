#include "encoder/meshes/materials/mtl_map.h"

#include <gtest/gtest.h>

#include <string>

namespace rlpc {
namespace {

using Pair = std::array<double, 2>;

MtlMap map_of(const std::string& line) {
  TextWords words(line);
  return read_mtl_map(words);
}

TEST(MtlMap, NamesMayHaveBlanks) {
  EXPECT_EQ(map_of("skin.png").name, "skin.png");
  EXPECT_EQ(map_of("tx/my skin tone.png").name, "tx/my skin tone.png");
  EXPECT_EQ(map_of("-bm 0.5 -clamp on my skin.png").name, "my skin.png");
  EXPECT_EQ(map_of("-mm 0 1 -skin.png").name, "-skin.png");
  EXPECT_EQ(map_of("").name, "");
  EXPECT_EQ(map_of("-bm").name, "");
}

TEST(MtlMap, ScaleAndOffsetHaveOneToThreeNumbers) {
  const MtlMap map = map_of("-s 2 3 1 -o 0.25 -0.5 skin.png");
  EXPECT_EQ(map.name, "skin.png");
  EXPECT_EQ(map.scale, (Pair{2.0, 3.0}));
  EXPECT_EQ(map.offset, (Pair{0.25, -0.5}));
  EXPECT_EQ(map_of("-s 2 skin.png").scale, (Pair{2.0, 1.0}));
  EXPECT_EQ(map_of("-o 1 2 7").name, "7");
  EXPECT_EQ(map_of("-t 1 2 3 -s 4 5 6 7.png").scale, (Pair{4.0, 5.0}));
  EXPECT_EQ(map_of("-s nan 2 1 skin.png").name, "nan 2 1 skin.png");
}

}  // namespace
}  // namespace rlpc
