// The ways to encode frames that arrive one by one.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "encoder/codec/report.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// The members are those of FrameEncoder.
class FrameBackend {
 public:
  FrameBackend() = default;
  FrameBackend(const FrameBackend&) = delete;
  FrameBackend& operator=(const FrameBackend&) = delete;
  virtual ~FrameBackend() = default;

  // Prepares for the first frame; the format and the settings have been checked.
  virtual std::optional<InputError> prepare() = 0;
  virtual std::optional<InputError> add_frame(std::span<const float> xyz,
                                              std::span<const double> exact) = 0;
  virtual InputResult<EncodeReport> finish() = 0;
  virtual std::uint32_t num_added() const = 0;
};

}  // namespace rlpc
