// Finds the number of the frame in the names of files, and puts the files in its order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "encoder/input/frame_source.h"

namespace rlpc {

// The files of a sequence in frame order, and notes about gaps.
struct FrameFiles {
  std::vector<std::string> paths;
  std::vector<std::string> notes{};
};

// Sorts by the one number in which the names differ, compared by value: with signs
// (sim.-005.obj), fractions (f_1.25.obj), any padding, and whatever numbers come before and
// after it. Dates with times count as one number. paths: at least one, in any order. where: the
// folder or pattern, for messages. Errors: names that do not fit the others; two files of one
// frame; numbers that can be read in two ways. The messages say how to choose.
InputResult<FrameFiles> sort_frames(std::vector<std::string> paths, const std::string& where);

// The files among `names`, in `folder`, that a pattern selects. "%d" stands for whole numbers
// without padding, "%04d" for those padded to four characters (any width), both without gaps;
// "%g" stands for every number, with or without sign, fraction and padding. Errors: no such
// pattern; no file; a gap; two files of one frame.
InputResult<FrameFiles> select_frames(const std::string& pattern,
                                      const std::vector<std::string>& names);

// Compares names with runs of digits ordered by value: "frame2" before "frame10".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace rlpc
