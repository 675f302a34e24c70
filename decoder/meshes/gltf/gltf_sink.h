// Base class of the sinks of .glb files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/files/output_file.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/gltf/glb_document.h"
#include "decoder/meshes/gltf/gltf_look.h"
#include "decoder/meshes/gltf/gltf_morph.h"

namespace rlpc {

// Number of targets beyond which three.js shows none: graphics cards have 2,048 layers.
inline constexpr std::size_t kMaxTargetsShown = 2000;

class GltfSink : public FrameSink {
 public:
  GltfSink(SinkOptions options, OutputFile file);

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) final;
  std::vector<std::string> remarks() const final { return remarks_; }

 protected:
  // Adds a frame. xyz: [num_vertices][3].
  virtual std::optional<OutputError> add_frame(std::vector<float> xyz) = 0;

  // Returns the name of the file in messages.
  std::string name() const;
  void remark(const std::string& text) { remarks_.push_back(name() + ": " + text); }
  // Warns of more targets than viewers support.
  void warn_of_targets(std::size_t num_targets, const char* remedy);
  std::optional<OutputError> failure(const GlbDocument& document) const {
    return failure_of(document, file_.path(), options_.limit);
  }
  std::optional<OutputError> finish_morph(GlbDocument& document, GltfMorph& morph);
  std::optional<OutputError> write(GlbDocument& document);

  const SinkOptions& options() const { return options_; }
  const GltfLook& look() const { return look_; }
  const std::vector<Clip>& spans() const { return spans_; }

 private:
  SinkOptions options_;
  OutputFile file_;
  GltfLook look_;
  std::vector<Clip> spans_;
  std::vector<std::string> remarks_;
  std::uint32_t written_ = 0;
};

// Makes a sink that writes bones, or chooses the method (GltfMotion::kAuto).
std::unique_ptr<FrameSink> make_skin_sink(SinkOptions options, OutputFile file);

}  // namespace rlpc
