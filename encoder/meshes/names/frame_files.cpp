#include "encoder/meshes/names/frame_files.h"

#include <cmath>
#include <cstdio>

#include "encoder/meshes/names/frame_steps.h"

namespace rlpc {

namespace {

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

FrameFiles in_order(const std::vector<std::string>& paths,
                    const std::vector<std::size_t>& order) {
  FrameFiles files;
  for (const std::size_t i : order) files.paths.push_back(paths[i]);
  return files;
}

FrameFiles with_notes(const std::vector<std::string>& paths, const Reading& reading) {
  FrameFiles files = in_order(paths, reading.order);
  const FrameSteps steps = steps_of(reading);
  constexpr double kStep = 1.1;  // largest step from one frame to the next
  std::vector<std::size_t> gaps = steps.gaps;
  if (steps.regularity == Regularity::kEqualSteps) {
    if (steps.step <= kStep || reading.has_fractions) return files;
    if (paths.size() > 2) {
      files.notes.push_back("the numbers of the frames go up in steps of " +
                            number_text(steps.step) + "; each file is one frame, without gaps");
      return files;
    }
    gaps = {0};
  }
  const std::string place = files.paths[gaps[0]] + " and " + files.paths[gaps[0] + 1];
  files.notes.push_back(
      gaps.size() == 1 ? "there is no frame between " + place + "; the gap is closed"
                       : "the numbers of the frames have " + std::to_string(gaps.size()) +
                             " gaps, the first between " + place + "; the gaps are closed");
  return files;
}

}  // namespace rlpc
