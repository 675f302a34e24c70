// Finds the frame number in the names of files, and sorts the files by it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/names/frame_files.h"

namespace rlpc {

// Sorts by the one number in which the names differ, compared by value: with signs
// (sim.-005.obj), fractions (f_1.25.obj, t=0.041667.obj), any padding, and whatever numbers
// come before and after it. Dates with times count as one number. paths: at least one, in any
// order. where: the folder or pattern, for messages. Errors, which say how to choose: names
// that do not fit the others; two files of one frame; names that can be read in two orders.
InputResult<FrameFiles> sort_frames(std::vector<std::string> paths, const std::string& where);

// Compares names with runs of digits ordered by value: "frame2" before "frame10".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace rlpc
