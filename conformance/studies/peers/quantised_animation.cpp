#include <algorithm>
#include <cmath>

#include "conformance/studies/peers/peer_codecs.h"

namespace rlpc::peers {

namespace {

struct Box {
  float low[3];
  float high[3];

  double side() const {
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      longest = std::max(longest, double{high[axis]} - double{low[axis]});
    }
    return longest;
  }
};

Box bounding_box(const Animation& animation) {
  const std::vector<float>& first = animation.frames.at(0);
  Box box{{first[0], first[1], first[2]}, {first[0], first[1], first[2]}};
  for (const auto& frame : animation.frames) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
      box.low[i % 3] = std::min(box.low[i % 3], frame[i]);
      box.high[i % 3] = std::max(box.high[i % 3], frame[i]);
    }
  }
  return box;
}

}  // namespace

double longest_side(const Animation& animation) { return bounding_box(animation).side(); }

QuantisedAnimation quantise(const Animation& animation, int bits) {
  QuantisedAnimation out{animation.num_vertices, animation.triangles, {}, 1.0F, {}};
  const Box box = bounding_box(animation);
  std::copy_n(box.low, 3, out.origin);
  const std::uint32_t levels = (1U << bits) - 1;
  if (box.side() > 0) out.step = static_cast<float>(box.side() / levels);
  for (const auto& frame : animation.frames) {
    auto& q = out.frames.emplace_back(frame.size());
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const double offset = double{frame[i]} - double{out.origin[i % 3]};
      q[i] = static_cast<std::uint16_t>(
          std::clamp(std::round(offset / double{out.step}), 0.0, static_cast<double>(levels)));
    }
  }
  return out;
}

Animation dequantise(const QuantisedAnimation& quantised) {
  Animation out{quantised.num_vertices, quantised.triangles, {}};
  for (const auto& q : quantised.frames) {
    auto& frame = out.frames.emplace_back(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      frame[i] =
          static_cast<float>(double{quantised.origin[i % 3]} + double{quantised.step} * q[i]);
    }
  }
  return out;
}

}  // namespace rlpc::peers
