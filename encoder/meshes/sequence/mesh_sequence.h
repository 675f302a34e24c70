// Animations stored as one file per frame: OBJ, PLY, OFF.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/names/frame_names.h"

namespace rlpc {

// List the files of a sequence in frame order, as sort_frames() and select_frames() find it.
// Errors: theirs; no file; several formats in a folder or list.
InputResult<FrameFiles> list_mesh_folder(const std::string& folder);
InputResult<FrameFiles> list_mesh_glob(const std::string& glob);
InputResult<FrameFiles> list_mesh_pattern(const std::string& pattern);
// Does the same for files that are given one by one.
InputResult<FrameFiles> list_mesh_files(const std::vector<std::string>& paths);

// Opens one file per frame, at least one. The first is read now, the others on demand; they
// must have the vertices of the first in its order, and its faces in any order. Polygons are
// split into triangles at the positions of the first. Attributes are those of the first; notes
// report other attributes, except normals, in later files.
InputResult<std::unique_ptr<FrameSource>> open_mesh_sequence(FrameFiles files,
                                                             const InputOptions& options);

}  // namespace rlpc
