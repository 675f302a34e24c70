// The parts of a glTF document that determine positions, validated but without buffer contents:
// indices are in range, and accessors within their buffers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/document/accessor.h"
#include "encoder/meshes/gltf/document/affine.h"
#include "encoder/meshes/gltf/document/buffers.h"
#include "encoder/meshes/gltf/document/json.h"

namespace rlpc {

enum class GltfMode : std::uint8_t {
  kPoints,
  kLines,
  kLineLoop,
  kLineStrip,
  kTriangles,
  kTriangleStrip,
  kTriangleFan
};

// An attribute that does not move vertices, such as TEXCOORD_0.
struct GltfAttribute {
  std::string semantic;
  std::uint32_t accessor = 0;
};

struct GltfPrimitive {
  std::string path;  // "meshes[0].primitives[1]"
  GltfMode mode = GltfMode::kTriangles;
  std::optional<std::uint32_t> indices;  // accessors, here and below
  std::uint32_t positions = 0;
  bool is_compressed = false;  // compressed by an extension; may be unreadable without it
  // None: the target does not move positions, or does not turn normals.
  std::vector<std::optional<std::uint32_t>> targets;
  std::vector<std::optional<std::uint32_t>> normal_targets;
  std::vector<std::uint32_t> joints;  // same size as weights
  std::vector<std::uint32_t> weights;
  std::vector<GltfAttribute> attributes;  // texture coordinates, normals, colours
  std::optional<std::uint32_t> tangents;
  std::optional<std::uint32_t> material;

  bool has_triangles() const { return mode >= GltfMode::kTriangles; }
};

struct GltfMesh {
  std::vector<GltfPrimitive> primitives;  // only those with positions
  std::size_t num_targets = 0;            // per primitive
  std::vector<double> weights;            // [num_targets]
};

struct GltfNode {
  std::optional<std::uint32_t> mesh;
  std::optional<std::uint32_t> skin;
  std::vector<std::uint32_t> children;
  std::optional<Affine> matrix;  // replaces the next three members
  GltfVec3 translation{0, 0, 0};
  GltfQuaternion rotation{0, 0, 0, 1};  // unit length
  GltfVec3 scale{1, 1, 1};
  std::optional<std::vector<double>> weights;  // replace the weights of the mesh
};

struct GltfSkin {
  std::vector<std::uint32_t> joints;  // nodes
  std::optional<std::uint32_t> inverse_bind;
};

enum class GltfPath : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
enum class GltfInterpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

struct GltfAnimation {
  struct Sampler {
    std::uint32_t input = 0;
    std::uint32_t output = 0;
    GltfInterpolation interpolation = GltfInterpolation::kLinear;
  };
  struct Channel {
    std::uint32_t sampler = 0;
    std::uint32_t node = 0;
    GltfPath path = GltfPath::kTranslation;
  };

  std::string name;
  std::vector<Sampler> samplers;
  std::vector<Channel> channels;
  // JSON pointer of KHR_animation_pointer, or empty, of each channel whose target is not a
  // node.
  std::vector<std::string> pointers;
};

struct GltfDocument {
  std::vector<GltfBuffer> buffers;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<GltfSkin> skins;
  std::vector<GltfAnimation> animations;
  std::size_t num_materials = 0;
  std::optional<std::vector<std::uint32_t>>
      scene;  // its nodes; none: all nodes without a parent
  // Unsupported extensions that would change shapes or motions.
  std::vector<std::string> extensions_left_out;
  // Contents that are not read: "cameras".
  std::vector<std::string> dropped;
};

// Reads the document; complete only if there are no errors.
GltfDocument read_gltf_document(const GltfValue& root, GltfErrors& errors);

}  // namespace rlpc
