// Reads materials from .mtl files.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "encoder/meshes/materials/mtl_map.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

using MtlColour = std::array<double, 3>;

// The properties of a material that are kept. Factors are 0 to 1.
struct Mtl {
  std::optional<MtlColour> base;  // Kd, taken as linear
  std::optional<MtlColour> emission;
  std::optional<double> opacity;
  std::optional<double> roughness;
  std::optional<double> metalness;
  MtlMap base_image;
  MtlMap alpha_image;
  MtlMap emission_image;
  MtlMap normal_image;
};

struct MtlFile {
  std::map<std::string, Mtl, std::less<>> materials;  // only used ones, [name]
  // A line for the user that names the keywords whose values are not kept, and the materials
  // that no face uses; empty: none.
  std::string dropped;
};

// Reads the materials that faces use, in time linear in the text and n * log n in the names.
MtlFile read_mtl(const SourceMaterials& materials);

}  // namespace rlpc
