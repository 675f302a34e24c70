// Animations stored as one file per frame: OBJ, PLY, OFF.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/input/frame_source.h"

namespace rlpc {

// The files of a sequence in frame order. Errors: no file; a gap in a numbered pattern; several
// formats in a folder.
InputResult<std::vector<std::string>> list_mesh_folder(const std::string& folder);
InputResult<std::vector<std::string>> list_mesh_glob(const std::string& glob);
InputResult<std::vector<std::string>> list_mesh_pattern(const std::string& pattern);

// Compares names with runs of digits ordered by value: "frame2" before "frame10".
bool natural_less(std::string_view a, std::string_view b);

// One file per frame, at least one. The first is read now, the others on demand; their vertex
// counts and triangles must equal those of the first. Attributes are those of the first; a note
// is added if others than normals differ in a later file.
InputResult<std::unique_ptr<FrameSource>> open_mesh_sequence(std::vector<std::string> paths,
                                                             const InputOptions& options);

}  // namespace rlpc
