#include "encoder/programs/rlpcenc/normal_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

namespace rlpc {
namespace {

constexpr double kFarOff = 8.0;  // degrees on average: shading differs visibly

std::string degrees(double angle) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", angle);
  return text.data();
}

const NormalError& worst_of(const AttributeReport& normals) {
  return *std::ranges::max_element(normals.normal_errors, {}, &NormalError::mean);
}

std::string mean_in(const NormalError& error) {
  return degrees(error.mean) + " in frame " + std::to_string(error.frame);
}

}  // namespace

std::string normal_text(const AttributeReport& normals) {
  std::string text = normals.is_smoothing ? "smoothing" : "unit vectors";
  if (!normals.is_smoothing && normals.num_following > 0) {
    const double part = 100.0 * static_cast<double>(normals.num_following) /
                        static_cast<double>(normals.values);
    text += " (" + degrees(part) + " % follow the surface)";
  }
  text += ", largest error " + degrees(normals.largest_error) + " degrees";
  const std::vector<NormalError>& errors = normals.normal_errors;
  if (errors.empty()) return text;
  text += "; on average " + mean_in(errors.front());
  if (errors.size() == 1) return text;
  text += ", " + mean_in(errors[errors.size() / 2]) + ", at most " + mean_in(worst_of(normals));
  return text;
}

std::optional<std::string> normal_warning(const AttributeReport& normals) {
  if (normals.normal_errors.empty()) return std::nullopt;
  const NormalError& worst = worst_of(normals);
  if (worst.mean < kFarOff) return std::nullopt;
  return "normals are off by " + degrees(worst.mean) + " degrees on average in frame " +
         std::to_string(worst.frame) +
         ": shading may differ there. Normals of INPUT may not turn with its surface, or parts "
         "may be thinner than the position error (try a higher --quality)";
}

}  // namespace rlpc
