// Conversion between the axes of different programs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/frame_stream.h"

namespace rlpc {

// Writes the coordinates of the new axes over those of the old ones; xyz[3 * vertex + axis].
void turn(const Axes& axes, std::span<float> xyz);
void turn(const Axes& axes, std::span<double> xyz);

// Whether the axes mirror: a left hand becomes a right one.
bool is_mirror(const Axes& axes);

// Parses "x,z,-y": the new x, y and z as signed old axes, each old one once. No spaces.
InputResult<Axes> parse_axes(std::string_view text);
std::string axes_text(const Axes& axes);

// Return the same frames with other axes. If these mirror, triangles are reversed so that they
// keep facing the same side; but not if positions are taken to the axes of the mesh that the
// triangles come from.
std::unique_ptr<FrameSource> turn_source(std::unique_ptr<FrameSource> source, const Axes& axes);
std::unique_ptr<FrameStream> turn_stream(std::unique_ptr<FrameStream> stream, const Axes& axes);

}  // namespace rlpc
