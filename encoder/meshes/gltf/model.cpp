#include "encoder/meshes/gltf/model.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "encoder/meshes/glb_asset.h"
#include "encoder/meshes/gltf/asset.h"
#include "encoder/meshes/gltf/document/json.h"
#include "encoder/meshes/gltf/equal_uv.h"
#include "encoder/meshes/gltf/losses.h"

namespace rlpc {

namespace {

using std::to_string;

class ModelReader {
 public:
  // relief: from relief_of_materials().
  ModelReader(GltfDocument document, std::vector<std::optional<std::size_t>> relief,
              GltfFile& file, const GltfLimits& limits, GltfMemory& memory, GltfErrors& errors)
      : document_(std::move(document)),
        relief_(std::move(relief)),
        limits_(limits),
        memory_(memory),
        errors_(errors),
        buffers_(std::move(document_.buffers), file, errors),
        values_(document_.accessors, buffers_, limits.spare_values, memory, errors) {}

  GltfModel read(std::span<const std::string> animations) {
    model_.scene = read_gltf_scene(document_, errors_);
    if (errors_) return {};
    for (const std::string& extension : document_.extensions_left_out) {
      model_.notes.push_back(extension + " is ignored: the animation may show more or less");
    }
    const std::vector<std::uint32_t> chosen = choose_animations(document_, animations, errors_);
    if (errors_) return {};
    model_.dropped = document_.dropped;
    if (animations.empty() && document_.animations.size() > 1) {
      model_.notes.push_back("reading the first of " + to_string(document_.animations.size()) +
                             " animations (" + gltf_animation_names(document_) +
                             "); 'animations' chooses others");
    }
    for (const std::uint32_t number : chosen) {
      model_.clips.push_back(read_gltf_clip(document_, number, values_, errors_));
      drop_channels(document_.animations[number].pointers);
    }
    read_skins();
    if (errors_) return {};
    for (const std::uint32_t node : model_.scene.with_mesh) add_mesh(node);
    if (model_.instances.empty()) errors_.add("scenes", what_is_missing());
    note(num_without_triangles_, "point or line primitive");
    model_.equal_uv = drop_equal_uv(model_.geometries);
    if (!model_.equal_uv.empty()) model_.notes.push_back(equal_uv_note(model_.equal_uv));
    std::uint64_t num_clamped = 0;
    for (const GltfGeometry& geometry : model_.geometries) num_clamped += geometry.num_clamped;
    if (num_clamped > 0) {
      model_.notes.push_back("dropped: what " + to_string(num_clamped) +
                             " numbers of colours have outside 0 to 1, to which they are "
                             "clamped as glTF demands");
    }
    TangentCount tangents;
    for (const GltfGeometry& geometry : model_.geometries) tangents.add(geometry.tangents);
    if (std::string text = tangent_note(tangents); !text.empty())
      model_.notes.push_back(std::move(text));
    for (GltfMesh& mesh : document_.meshes) model_.weights.push_back(std::move(mesh.weights));
    model_.nodes = std::move(document_.nodes);
    model_.num_materials = document_.num_materials;
    model_.files = buffers_.files();
    return std::move(model_);
  }

 private:
  std::string what_is_missing() const {
    if (!document_.meshes.empty()) return "expected a mesh with triangles there";
    return document_.animations.empty()
               ? "the file has no mesh; expected one with triangles"
               : "the file has animations alone, and no mesh for them to move; export both in "
                 "one file";
  }

  void drop_channels(const std::vector<std::string>& pointers) {
    std::size_t without_target = 0;
    for (const std::string& pointer : pointers) {
      const std::string target = pointer_target(pointer);
      const std::string what = "animation of " + target;
      if (target.empty()) {
        ++without_target;
      } else if (std::find(model_.dropped.begin(), model_.dropped.end(), what) ==
                 model_.dropped.end()) {
        model_.dropped.push_back(what);
      }
    }
    if (without_target == 0) return;
    model_.dropped.push_back("channels of animations without target (" +
                             to_string(without_target) + ")");
  }

  void note(std::uint64_t count, const std::string& what) {
    if (count == 0) return;
    model_.notes.push_back("dropped " + to_string(count) + " " + what +
                           (count == 1 ? "" : "s"));
  }

  void read_skins() {
    for (std::size_t s = 0; s < document_.skins.size() && !errors_; ++s) {
      GltfSkin& skin = document_.skins[s];
      GltfModel::Skin read;
      read.joints = std::move(skin.joints);
      if (skin.inverse_bind) {
        read.inverse_bind = values_.matrices(*skin.inverse_bind);
        if (!errors_ && read.inverse_bind.size() < read.joints.size()) {
          errors_.expected(gltf_accessor_path(*skin.inverse_bind) + ".count",
                           to_string(read.inverse_bind.size()),
                           to_string(read.joints.size()) + ", one for each joint of skins[" +
                               to_string(s) + "]");
        }
      }
      read.inverse_bind.resize(read.joints.size());
      model_.skins.push_back(std::move(read));
    }
  }

  // Adds the mesh of a node of the scene.
  void add_mesh(std::uint32_t node) {
    const std::uint32_t mesh = *document_.nodes[node].mesh;
    const std::optional<std::uint32_t> skin = document_.nodes[node].skin;
    for (std::size_t p = 0; p < document_.meshes[mesh].primitives.size() && !errors_; ++p) {
      const GltfPrimitive& primitive = document_.meshes[mesh].primitives[p];
      if (!primitive.has_triangles()) {
        ++num_without_triangles_;
        continue;
      }
      const GltfAccessor& positions = values_.accessor(primitive.positions);
      if (primitive.is_compressed && !positions.base && !positions.sparse) {
        errors_.expected(gltf_accessor_path(primitive.positions), "no bufferView",
                         "positions; export the file again without compression of meshes");
        return;
      }
      const std::uint64_t count = positions.count;
      if (count > limits_.max_vertices - model_.num_vertices) {
        errors_.expected(primitive.path, to_string(count) + " vertices more",
                         "at most " + to_string(limits_.max_vertices) + " in the whole scene");
        return;
      }
      const std::size_t geometry = geometry_of(primitive, skin);
      if (errors_) return;
      num_triangles_ += model_.geometries[geometry].triangles.size();
      if (num_triangles_ > limits_.max_triangles) {
        errors_.expected(primitive.path, "more triangles",
                         "at most " + to_string(limits_.max_triangles) + " in the whole scene");
        return;
      }
      if (!takes_instance(primitive, count, geometry)) return;
      model_.instances.push_back(
          {node, skin, geometry, model_.num_vertices, primitive.material});
      model_.num_vertices += count;
    }
  }

  // Counts an instance, with the memory that the source and welding need per vertex and
  // triangle.
  bool takes_instance(const GltfPrimitive& primitive, std::uint64_t num_vertices,
                      std::size_t geometry) {
    constexpr std::uint64_t kVertexBytes = 128;
    constexpr std::uint64_t kTriangleBytes = 60;
    const std::uint64_t num_triangles = model_.geometries[geometry].triangles.size();
    return memory_.take(primitive.path, 3 * sizeof(GltfModel::Instance) +
                                            kVertexBytes * num_vertices +
                                            kTriangleBytes * num_triangles);
  }

  // Returns the geometry, which nodes with the same mesh and skin share.
  std::size_t geometry_of(const GltfPrimitive& primitive, std::optional<std::uint32_t> skin) {
    const auto [known, is_new] =
        geometries_.try_emplace({&primitive, skin}, model_.geometries.size());
    if (is_new) {
      const std::size_t num_joints = skin ? model_.skins[*skin].joints.size() : 0;
      const auto relief_uv = primitive.material ? relief_[*primitive.material] : std::nullopt;
      model_.geometries.push_back(
          read_gltf_geometry(primitive, num_joints, relief_uv, values_, errors_));
    }
    return known->second;
  }

  GltfDocument document_;
  std::vector<std::optional<std::size_t>> relief_;  // [material]
  const GltfLimits& limits_;
  GltfMemory& memory_;
  GltfErrors& errors_;
  GltfBuffers buffers_;
  GltfValues values_;
  GltfModel model_;
  std::map<std::pair<const GltfPrimitive*, std::optional<std::uint32_t>>, std::size_t>
      geometries_;
  std::uint64_t num_triangles_ = 0;
  std::uint64_t num_without_triangles_ = 0;
};

// Returns the part of a material that needs tangents: its normal map; that of its clear coat;
// anisotropy, whose direction is relative to them, with or without a texture. Null: no part.
const nlohmann::json& relief_of(const nlohmann::json& material) {
  const auto& map = gltf_member(material, "normalTexture");
  if (!map.is_null()) return map;
  const auto& extensions = gltf_member(material, "extensions");
  const auto& coat = gltf_member(extensions, "KHR_materials_clearcoat");
  const auto& map_of_coat = gltf_member(coat, "clearcoatNormalTexture");
  if (!map_of_coat.is_null()) return map_of_coat;
  const auto& anisotropy = gltf_member(extensions, "KHR_materials_anisotropy");
  const auto& its_map = gltf_member(anisotropy, "anisotropyTexture");
  return its_map.is_null() ? anisotropy : its_map;
}

// Returns the number of the texture coordinates that tangents of each material belong to; none:
// it has no use for them. Materials may be anything here: their readers check them.
std::vector<std::optional<std::size_t>> relief_of_materials(const nlohmann::json& root,
                                                            std::size_t num_materials) {
  std::vector<std::optional<std::size_t>> relief(num_materials);
  for (std::size_t m = 0; m < num_materials; ++m) {
    const nlohmann::json& map = relief_of(root["materials"][m]);
    if (map.is_null()) continue;
    constexpr std::size_t kMaxSets = 256;
    relief[m] = index_of(map, "texCoord", kMaxSets).value_or(0);
    const auto& transform =
        gltf_member(gltf_member(map, "extensions"), "KHR_texture_transform");
    if (transform.is_null()) continue;
    const auto other = index_of(transform, "texCoord", kMaxSets);
    if (other) relief[m] = *other;
  }
  return relief;
}

// Returns the frame rate in extras, which may be anything: nothing in them is an error.
std::optional<FrameRate> frame_rate_of(const nlohmann::json& root) {
  const nlohmann::json* value = &root;
  for (const char* const key : {"asset", "extras", "frame_rate"}) {
    if (!value->is_object()) return std::nullopt;
    const auto member = value->find(key);
    if (member == value->end()) return std::nullopt;
    value = &*member;
  }
  if (!value->is_string()) return std::nullopt;
  const auto rate = parse_frame_rate(value->get_ref<const std::string&>());
  return rate ? std::optional(*rate) : std::nullopt;
}

}  // namespace

InputResult<GltfModel> read_gltf_model(const InputOptions& options, const GltfLimits& limits) {
  auto file = open_gltf_file(options.path, options.max_memory_bytes);
  if (!file) return file.error();
  GltfErrors errors(file->file.path());
  GltfMemory memory(options.max_memory_bytes - file->file.memory_bytes(), errors);
  memory.take("", file->document_bytes);
  GltfDocument document = read_gltf_document(GltfValue(*file->json, errors), errors);
  if (errors) return errors.first();
  const auto frame_rate = frame_rate_of(*file->json);
  auto relief = relief_of_materials(*file->json, document.num_materials);
  GltfModel model =
      ModelReader(std::move(document), std::move(relief), *file, limits, memory, errors)
          .read(options.animations);
  if (errors) return errors.first();
  for (std::string& loss : gltf_losses(*file->json, model)) {
    model.dropped.push_back(std::move(loss));
  }
  if (!model.dropped.empty()) {
    std::string list;
    for (const std::string& what : model.dropped) list += (list.empty() ? "" : ", ") + what;
    model.notes.insert(model.notes.begin(), "dropped: " + list);
  }
  const auto& generator = gltf_member(gltf_member(*file->json, "asset"), "generator");
  if (!generator.is_null() && generator != "rlpcdec") {
    model.notes.emplace_back(
        "the stream does not say which program wrote the file (asset.generator)");
  }
  // Count the asset, which is another tree, and its text.
  memory.take("materials", file->document_bytes);
  if (errors) return errors.first();
  GltfAsset asset = make_gltf_asset(*file->json, model, *file, options.images, memory);
  if (errors) return errors.first();
  model.asset = std::move(asset.glb);
  model.notes.insert(model.notes.end(), asset.notes.begin(), asset.notes.end());
  model.files.insert(model.files.end(), asset.files.begin(), asset.files.end());
  file->json.reset();
  memory.give_back(2 * file->document_bytes);
  model.memory_bytes = memory.taken() + file->file.memory_bytes();
  model.frame_rate = frame_rate;
  return model;
}

}  // namespace rlpc
