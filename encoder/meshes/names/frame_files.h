// Files of frames, in frame order.
#pragma once

#include <string>
#include <vector>

#include "encoder/meshes/names/frame_reading.h"

namespace rlpc {

// The files of a sequence in frame order, and notes about gaps and about files left out.
struct FrameFiles {
  std::vector<std::string> paths;
  std::vector<std::string> notes{};
};

// Returns the files in the order of `order`.
FrameFiles in_order(const std::vector<std::string>& paths,
                    const std::vector<std::size_t>& order);

// Puts files in the order of a reading of their names; adds notes about gaps between numbers.
FrameFiles with_notes(const std::vector<std::string>& paths, const Reading& reading);

}  // namespace rlpc
