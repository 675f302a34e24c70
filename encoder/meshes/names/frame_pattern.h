// Chooses the files of a sequence by a pattern such as walk_%04d.obj.
#pragma once

#include <string>
#include <vector>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/names/frame_files.h"

namespace rlpc {

// Returns the files among `names`, those in the folder of a pattern, that the pattern selects;
// their extension may be in upper or lower case. "%d" stands for whole numbers without padding,
// "%04d" or "####" for those padded to four characters (any width), with or without sign,
// without gaps; "%g" stands for every number, with or without sign, fraction and padding. A
// note lists files that are left out although they have another number in place of the
// pattern's. Errors: no such pattern; no file; a gap; two files of one frame.
InputResult<FrameFiles> select_frames(const std::string& pattern,
                                      const std::vector<std::string>& names);

}  // namespace rlpc
