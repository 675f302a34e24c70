#include "encoder/meshes/materials/material_files.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <system_error>
#include <utility>

#include "common/files/messages.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/materials/material_asset.h"
#include "encoder/meshes/materials/mtl_map.h"
#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

// Memory per byte of an .mtl file: the text, and lists of the images that it names.
constexpr std::uint64_t kMtlCost = 40;

// Returns the folder, never empty, so that no file in it is "-", which is standard input.
std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

// Returns the images that an .mtl file names and the asset has a use for.
std::set<std::string, std::less<>> kept_textures(std::string_view mtl) {
  std::set<std::string, std::less<>> kept;
  for (TextWords words(mtl); !words.at_end(); words.next_line()) {
    const std::string_view keyword = words.next();
    if (keyword != "map_Kd" && keyword != "map_Ke" && keyword != "norm") continue;
    kept.insert(read_mtl_map(words).name);
  }
  return kept;
}

// Returns the names in lines such as "mtllib a.mtl b.mtl", or with one name with blanks.
std::vector<std::string> library_names(const std::string& lines, const fs::path& folder) {
  std::vector<std::string> names;
  for (TextWords text(lines); !text.at_end(); text.next_line()) {
    TextWords whole = text;
    const std::string words = whole.rest_of_words();
    std::error_code unknown;
    if (fs::is_regular_file(folder / words, unknown)) {
      names.push_back(words);
      continue;
    }
    for (std::string_view name = text.next(); !name.empty(); name = text.next()) {
      names.emplace_back(name);
    }
  }
  return names;
}

// Adds notes about images that the asset has no use for.
void note_what_is_dropped(SingleMesh& mesh) {
  constexpr std::size_t kMaxNamed = 100;
  std::string dropped;
  std::size_t count = 0;
  const auto kept = kept_textures(mesh.materials.mtl);
  for (const std::string& texture : mesh.materials.textures) {
    if (kept.find(texture) != kept.end() || ++count > kMaxNamed) continue;
    dropped += (dropped.empty() ? "" : ", ") + printable(texture);
  }
  if (count > kMaxNamed) dropped += ", ...";
  if (count == 0) return;
  mesh.notes.push_back("dropped: " + std::to_string(count) +
                       (count == 1 ? " texture (" : " textures (") + dropped +
                       "); only those of map_Kd, map_Ke and norm are kept");
}

// Adds a note about a single name, which distinguishes nothing and is not worth an asset.
void note_only_names(SingleMesh& mesh) {
  if (!mesh.asset.empty()) return;
  std::string names;
  for (const auto* const list : {&mesh.materials.part_names, &mesh.materials.names}) {
    for (const std::string& name : *list) {
      names += (names.empty() ? "" : " and ") + rlpc::quoted(name);
    }
  }
  if (!names.empty()) mesh.notes.push_back("does not keep " + names + ", its only name");
}

// Returns an error if that takes more memory than is allowed.
std::optional<InputError> make_asset(const std::string& path, Images images,
                                     std::uint64_t max_memory_bytes, SingleMesh& mesh) {
  const std::uint64_t held = mesh.memory_bytes() + kMtlCost * mesh.materials.mtl.size() +
                             material_asset_bytes(mesh.materials);
  if (held > max_memory_bytes) {
    return InputError{path + ": materials and parts: " + memory_problem(max_memory_bytes)};
  }
  // Images are held up to four times while the asset is made.
  const std::uint64_t left = (max_memory_bytes - held) / 4;
  MaterialAsset made = make_material_asset(mesh.materials, folder_of(path), images, left);
  mesh.asset = std::move(made.glb);
  for (std::string& file : made.files) mesh.material_files.push_back(std::move(file));
  for (std::string& note : made.notes) mesh.notes.push_back(std::move(note));
  return std::nullopt;
}

}  // namespace

void read_material_text(const std::string& path, std::uint64_t max_memory_bytes,
                        SingleMesh& mesh) {
  if (mesh.material_library.empty()) return;
  if (path == "-") {
    mesh.notes.emplace_back("does not read .mtl files, which standard input has no folder for");
    return;
  }
  constexpr std::size_t kMaxTold = 5;
  std::size_t num_unread = 0;
  const auto note_unread = [&](const std::string& note) {
    if (++num_unread <= kMaxTold) mesh.notes.push_back(note);
  };
  const fs::path folder = folder_of(path);
  std::set<std::string, std::less<>> known;
  for (const std::string& name : library_names(mesh.material_library, folder)) {
    if (!known.insert(name).second) continue;
    if (!stays_below(folder, name)) {
      note_unread("does not read " + rlpc::quoted(name) +
                  ", which is not in the folder of the mesh");
      continue;
    }
    const std::string file = (folder / name).string();
    const std::uint64_t held = mesh.memory_bytes() + kMtlCost * mesh.materials.mtl.size();
    const std::uint64_t left = max_memory_bytes - std::min(held, max_memory_bytes);
    // Only part of the memory is for the text, but messages name the whole limit.
    std::error_code unknown;
    if (const auto size = fs::file_size(file, unknown); !unknown && size > left / kMtlCost) {
      note_unread("materials: " + file + ": " + memory_problem(max_memory_bytes));
      continue;
    }
    auto text = read_whole_file(file, left / kMtlCost);
    if (!text) {
      note_unread("materials: " + text.error().message);
      continue;
    }
    mesh.materials.mtl += *text;
    if (!text->ends_with('\n')) mesh.materials.mtl += '\n';
    mesh.material_files.push_back(file);
  }
  if (num_unread > kMaxTold) {
    mesh.notes.push_back("does not read " + std::to_string(num_unread - kMaxTold) +
                         " other .mtl files either");
  }
  for (std::string& texture : textures_of(mesh.materials.mtl)) {
    mesh.materials.textures.push_back(std::move(texture));
  }
}

std::vector<std::string> textures_of(std::string_view mtl) {
  std::vector<std::string> textures;
  std::set<std::string> known;
  for (TextWords words(mtl); !words.at_end(); words.next_line()) {
    const std::string_view keyword = words.next();
    const bool is_map = keyword.starts_with("map_") || keyword == "bump" || keyword == "disp" ||
                        keyword == "decal" || keyword == "refl" || keyword == "norm";
    if (!is_map) continue;
    const std::string name = read_mtl_map(words).name;
    if (!name.empty() && known.insert(name).second) textures.push_back(name);
  }
  return textures;
}

// Whether a name leads to a place in or below the folder, even if it is a link.
bool stays_below(const fs::path& folder, const fs::path& name) {
  if (!name.is_relative() || std::find(name.begin(), name.end(), "..") != name.end()) {
    return false;
  }
  std::error_code missing;
  const fs::path real = fs::canonical(folder / name, missing);
  if (missing) return true;
  const fs::path way = real.lexically_relative(fs::canonical(folder, missing));
  return !way.empty() && *way.begin() != "..";
}

InputResult<SingleMesh> read_mesh_and_materials(const std::string& path, Images images,
                                                std::uint64_t max_memory_bytes) {
  auto mesh = read_mesh(path, max_memory_bytes);
  if (!mesh) return mesh;
  read_material_text(path, max_memory_bytes, *mesh);
  if (const auto error = make_asset(path, images, max_memory_bytes, *mesh)) return *error;
  if (images != Images::kNone) note_what_is_dropped(*mesh);
  note_only_names(*mesh);
  return mesh;
}

}  // namespace rlpc
