// Animations stored as one OBJ file per frame.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/frame_source.h"

namespace rlpc {

// Files of a sequence in frame order. None found, or a gap in a numbered sequence, is an error.
InputResult<std::vector<std::string>> list_obj_folder(const std::string& folder);
InputResult<std::vector<std::string>> list_obj_glob(const std::string& glob);
InputResult<std::vector<std::string>> list_obj_pattern(const std::string& pattern);

// Orders runs of digits by their value: "frame2" before "frame10".
bool natural_less(std::string_view a, std::string_view b);

// One file per frame, at least one. The first is read now, each other when its frame is asked
// for; its vertex count and triangles must then equal those of the first.
InputResult<std::unique_ptr<FrameSource>> open_obj_sequence(
    std::vector<std::string> paths, const std::optional<FrameRate>& frame_rate);

}  // namespace rlpc
