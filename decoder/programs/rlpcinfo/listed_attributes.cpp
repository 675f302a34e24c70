#include "decoder/programs/rlpcinfo/listed_attributes.h"

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/files/messages.h"
#include "decoder/describe_error.h"
#include "decoder/programs/borrowed_source.h"

namespace rlpc {
namespace {

constexpr std::array<const char*, 3> kDomains{"vertices", "corners", "triangles"};
constexpr std::array<const char*, 4> kKinds{"integers", "unit vectors", "floats", "smoothing"};

const char* domain_of(const AttributeSet& set) {
  return kDomains.at(static_cast<std::size_t>(set.header.domain));
}

const char* kind_of(const AttributeSet& set) {
  return kKinds.at(static_cast<std::size_t>(set.header.kind));
}

std::string line_of(const AttributeSet& set) {
  std::string line = printable(set.header.name) + ": " + domain_of(set) + ", ";
  if (set.header.kind == ValueKind::kSmoothing) return line + kind_of(set);
  line += std::to_string(set.header.num_components) + " x " +
          std::to_string(set.header.value_bits) + " bits, " + kind_of(set) + ", " +
          std::to_string(set.num_values());
  return line + (set.num_values() == 1 ? " value" : " values");
}

}  // namespace

ListedAttributes ListedAttributes::of(ByteSource& source, std::uint64_t max_memory_bytes) {
  ListedAttributes listed;
  DecoderOptions options;
  options.limits.max_memory_bytes = max_memory_bytes;
  auto decoder = Decoder::open(std::make_unique<BorrowedSource>(source), options);
  if (!decoder) {
    listed.problem = describe_error(decoder.error());
    return listed;
  }
  if (const auto asset = decoder->asset()) {
    listed.asset_bytes = asset->size();
  } else {
    listed.problem = describe_error(asset.error());
  }
  if (auto sets = decoder->attributes()) {
    listed.sets = std::move(*sets);
  } else {
    listed.problem = describe_error(sets.error());
  }
  return listed;
}

std::vector<std::string> ListedAttributes::lines() const {
  std::vector<std::string> lines;
  for (const AttributeSet& set : sets) lines.push_back(line_of(set));
  if (asset_bytes > 0) {
    lines.push_back("materials and textures: " + std::to_string(asset_bytes) +
                    " bytes of glTF");
  }
  if (!problem.empty()) lines.push_back("cannot be decoded: " + problem);
  return lines;
}

void ListedAttributes::add_to(nlohmann::ordered_json& json) const {
  for (const AttributeSet& set : sets) {
    json["attributes"].push_back({{"name", set.header.name},
                                  {"domain", domain_of(set)},
                                  {"kind", kind_of(set)},
                                  {"num_components", set.header.num_components},
                                  {"value_bits", set.header.value_bits},
                                  {"num_values", set.num_values()}});
  }
  if (asset_bytes > 0) json["asset_bytes"] = asset_bytes;
  if (!problem.empty()) json["attribute_error"] = problem;
}

}  // namespace rlpc
