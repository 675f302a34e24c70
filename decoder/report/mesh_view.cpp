#include "decoder/report/mesh_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/json/json.h"
#include "decoder/meshes/base64.h"
#include "decoder/report/assets.h"

namespace rlpc {
namespace {

constexpr std::size_t kBytesPerVertex = 6 + 6 + 1;

std::string data_html(const char* id, std::span<const std::uint8_t> bytes) {
  return std::string("<script type=\"text/plain\" id=\"") + id + "\">" + base64(bytes) +
         "</script>\n";
}

// Returns the 99th percentile.
float upper_value(std::vector<float> values) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

MeshView::MeshView(std::uint32_t num_vertices, std::uint32_t num_frames,
                   std::span<const Triangle> triangles, FrameRate frame_rate,
                   std::size_t max_bytes)
    : num_vertices_(num_vertices),
      num_frames_(num_frames),
      triangles_(triangles.begin(), triangles.end()),
      frame_rate_(frame_rate) {
  const std::size_t overhead_bytes = kBytesPerVertex * num_vertices;
  const std::size_t mesh_bytes = 12 * triangles.size();
  if (mesh_bytes + overhead_bytes > max_bytes) return;
  const std::size_t max_frames = (max_bytes - mesh_bytes) / overhead_bytes;
  stride_ = static_cast<std::uint32_t>((num_frames + max_frames - 1) / max_frames);
}

void MeshView::add_frame(std::span<const float> original, std::span<const float> decoded) {
  assert(original.size() == 3 * std::size_t{num_vertices_} &&
         decoded.size() == original.size());
  original_.insert(original_.end(), original.begin(), original.end());
  decoded_.insert(decoded_.end(), decoded.begin(), decoded.end());
  for (std::size_t i = 0; i < original.size(); i += 3) {
    double squared = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const double d = static_cast<double>(original[c]) - static_cast<double>(decoded[c]);
      squared += d * d;
    }
    errors_.push_back(static_cast<float>(std::sqrt(squared)));
  }
}

std::string MeshView::note() const {
  const std::string limit = std::to_string(kMaxBytes >> 20) + " MiB";
  if (stride_ == 0) return "The mesh is too large for a page of " + limit + ".";
  if (stride_ == 1) return "";
  return "Shows one of every " + std::to_string(stride_) +
         " frames, as the page is limited to " + limit +
         ". Figures and charts cover all frames.";
}

std::string MeshView::frames_html(const std::vector<float>& values, const char* id,
                                  const float (&low)[3], const double (&step)[3]) const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double above = static_cast<double>(values[i]) - static_cast<double>(low[i % 3]);
    const long level = step[i % 3] > 0 ? std::lround(above / step[i % 3]) : 0;  // to 65535
    bytes.push_back(static_cast<std::uint8_t>(level & 255));
    bytes.push_back(static_cast<std::uint8_t>(level >> 8));
  }
  return data_html(id, bytes);
}

// Errors are quantised as square roots, so that small errors remain distinguishable.
std::string MeshView::errors_html(float largest) const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(errors_.size());
  for (const float error : errors_) {
    const float share = largest > 0 ? std::sqrt(error / largest) : 0;
    bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * share)));
  }
  return data_html("mesh-errors", bytes);
}

std::string MeshView::html(double diagonal) const {
  if (errors_.empty()) return "";
  float low[3] = {};
  float high[3] = {};
  double step[3] = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = high[axis] = original_[axis];
    for (const std::vector<float>* values : {&original_, &decoded_}) {
      for (std::size_t i = axis; i < values->size(); i += 3) {
        low[axis] = std::min(low[axis], (*values)[i]);
        high[axis] = std::max(high[axis], (*values)[i]);
      }
    }
    step[axis] = (static_cast<double>(high[axis]) - static_cast<double>(low[axis])) / 65535;
  }
  std::vector<std::uint8_t> corners;
  corners.reserve(12 * triangles_.size());
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t v : t) {
      for (int shift = 0; shift < 32; shift += 8) {
        corners.push_back(static_cast<std::uint8_t>(v >> shift & 255));
      }
    }
  }
  const float largest = *std::max_element(errors_.begin(), errors_.end());
  const nlohmann::ordered_json info = {
      {"vertices", num_vertices_},
      {"frames", errors_.size() / num_vertices_},
      {"stride", stride_},
      {"all_frames", num_frames_},
      {"frame_rate", static_cast<double>(frame_rate_.numerator) / frame_rate_.denominator},
      {"low", low},
      {"step", step},
      {"largest", largest},
      {"upper", upper_value(errors_)},
      {"diagonal", diagonal}};
  std::string html(kMeshViewHtml);
  html +=
      "<script type=\"application/json\" id=\"mesh-info\">" + json_text(info) + "</script>\n";
  html += data_html("mesh-triangles", corners);
  html += frames_html(original_, "mesh-original", low, step);
  html += frames_html(decoded_, "mesh-decoded", low, step);
  return html + errors_html(largest);
}

}  // namespace rlpc
