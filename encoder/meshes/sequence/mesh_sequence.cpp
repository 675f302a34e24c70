#include "encoder/meshes/sequence/mesh_sequence.h"

#include <fnmatch.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <system_error>
#include <utility>

#include "common/codec/attributes/attribute_names.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/materials/material_files.h"
#include "encoder/meshes/mesh_reader.h"
#include "encoder/meshes/names/frame_pattern.h"
#include "encoder/meshes/sequence/sequence_files.h"
#include "encoder/meshes/sequence/sequence_normals.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

// Returns the names of the files in a folder.
InputResult<std::vector<std::string>> list_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ec;
  fs::directory_iterator it(folder.empty() ? fs::path(".") : folder, ec);
  while (!ec && it != fs::directory_iterator()) {
    std::error_code unknown;  // a dangling link is reported when it is read
    if (!it->is_directory(unknown)) names.push_back(it->path().filename().string());
    it.increment(ec);
  }
  if (ec) return InputError{folder.string() + ": cannot list the folder: " + ec.message()};
  // Sort names, to report the same of several problems: systems list files in any order.
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

// Returns the names in the folder that match.
template <class Predicate>
InputResult<std::vector<std::string>> list_matching(const fs::path& folder, Predicate matches,
                                                    const std::string& if_none) {
  const auto names = list_names(folder);
  if (!names) return names.error();
  std::vector<std::string> paths;
  for (const std::string& name : *names) {
    if (matches(name)) paths.push_back((folder / name).string());
  }
  if (paths.empty()) return InputError{if_none};
  return paths;
}

const SourceAttribute* find_attribute(const SourceAttributes& attributes,
                                      const std::string& name) {
  for (const SourceAttribute& set : attributes.sets) {
    if (set.name == name) return &set;
  }
  return nullptr;
}

// Whether two sets of the same triangles have the same values, except for rounding.
bool are_near(const SourceAttribute& a, const SourceAttribute& b,
              std::span<const Triangle> triangles) {
  if (a.num_components != b.num_components || a.max_value != b.max_value) return false;
  const float near = a.max_value == 0 ? 1e-4F : 0.5F;
  const auto value_of = [&](const SourceAttribute& set, std::size_t corner) {
    if (set.domain == AttributeDomain::kTriangle) return corner / 3;
    return std::size_t{set.value_of_corner.empty() ? triangles[corner / 3][corner % 3]
                                                   : set.value_of_corner[corner]};
  };
  const std::size_t n = a.num_components;
  for (std::size_t corner = 0; corner < 3 * triangles.size(); ++corner) {
    for (std::size_t c = 0; c < n; ++c) {
      const float x = a.values[n * value_of(a, corner) + c];
      const float y = b.values[n * value_of(b, corner) + c];
      if (std::abs(x - y) > near) return false;
    }
  }
  return true;
}

// Changes the numbers of a set of triangles, which mean `names`, to those of the same names in
// `others`. Numbers without a name mean nothing.
void renumber(const std::vector<std::string>& names, const std::vector<std::string>& others,
              SourceAttribute& set) {
  std::vector<float> number_of;
  for (const std::string& name : names) {
    const auto found = std::find(others.begin(), others.end(), name);
    const bool is_known = found != others.end();
    number_of.push_back(is_known ? static_cast<float>(found - others.begin()) : -1.0F);
  }
  for (float& value : set.values) {
    const auto number = static_cast<std::size_t>(value);
    value = number < names.size() ? number_of[number] : static_cast<float>(others.size());
  }
}

class MeshSequence : public FrameSource {
 public:
  // files: have the triangles of `shape`.
  MeshSequence(Shape shape, SequenceFiles files)
      : FrameSource(std::move(shape)),
        files_(std::move(files)),
        has_compared_attributes_(files_.count(), false) {
    has_compared_attributes_[0] = true;
  }

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    const auto mesh = read_file_of(frame);
    if (!mesh) return mesh.error();
    std::copy(mesh->xyz.begin(), mesh->xyz.end(), xyz.begin());
    return std::nullopt;
  }
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    const auto mesh = read_file_of(frame);
    if (!mesh) return mesh.error();
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = mesh->xyz[i];
      if (i < mesh->left.size()) xyz[i] += mesh->left[i];
    }
    return std::nullopt;
  }
  bool is_finer_than_floats() const override { return true; }

  std::string file_of(std::uint32_t frame) const override { return files_.path(frame); }

 private:
  InputResult<SingleMesh> read_file_of(std::uint32_t frame) {
    auto mesh = files_.read(frame, !has_compared_attributes_[frame]);
    if (!mesh) return mesh;
    if (!has_compared_attributes_[frame]) compare_attributes(frame, *mesh);
    return mesh;
  }

  // Notes sets that the first file does not have, or has with other values; each set once.
  void compare_attributes(std::uint32_t frame, SingleMesh& mesh) {
    has_compared_attributes_[frame] = true;
    for (SourceAttribute& set : mesh.attributes.sets) {
      if (set.name == kMaterialName && !mesh.materials.names.empty()) {
        renumber(mesh.materials.names, materials().names, set);
      } else if (set.name == kPartName && !mesh.materials.part_names.empty()) {
        renumber(mesh.materials.part_names, materials().part_names, set);
      }
      const SourceAttribute* const first = find_attribute(attributes(), set.name);
      // Normals move with the frames: normals of the stream are compared (add_later_normals).
      if (first != nullptr && set.name == kNormalName) continue;
      if (first != nullptr && are_near(*first, set, triangles())) continue;
      note_first(frame, set.name,
                 files_.path(frame) + ": " + set.name +
                     (first == nullptr ? " is dropped, as " + files_.path(0) + " has none"
                                       : " differs from that of " + files_.path(0) +
                                             ", which is kept for all frames"));
    }
    compare_materials(frame, mesh);
    for (const std::string& note : mesh.notes) compare_note(frame, note);
  }

  void compare_materials(std::uint32_t frame, SingleMesh& mesh) {
    const auto is_other = [&](std::vector<std::string> SourceMaterials::*what) {
      const std::vector<std::string>& known = materials().*what;
      const auto is_new = [&](const std::string& name) {
        return std::find(known.begin(), known.end(), name) == known.end();
      };
      const auto& found = mesh.materials.*what;
      return std::any_of(found.begin(), found.end(), is_new);
    };
    if (is_other(&SourceMaterials::names)) note_others(frame, "names of materials");
    if (is_other(&SourceMaterials::part_names)) note_others(frame, "names of parts");
    if (!mesh.material_library.empty() &&
        mesh.material_library != files_.first().material_library) {
      mesh.materials.textures.clear();
      read_material_text(files_.path(frame), files_.max_memory_bytes(), mesh);
      if (mesh.materials.mtl != materials().mtl) note_others(frame, "materials (.mtl)");
    }
    if (is_other(&SourceMaterials::textures)) note_others(frame, "textures");
  }

  // Passes on notes about data dropped from this file, unless an earlier file had them.
  void compare_note(std::uint32_t frame, const std::string& note) {
    // The same note with another number, or other names, is not new.
    const std::string kind = note.substr(0, note.find_first_of("(0123456789"));
    const auto is_known = [&](const std::string& known) { return known.starts_with(kind); };
    if (std::any_of(notes().begin(), notes().end(), is_known)) return;
    note_first(frame, kind, files_.path(frame) + ": " + note);
  }

  void note_others(std::uint32_t frame, const std::string& what) {
    note_first(frame, what,
               files_.path(frame) + ": " + what + " are dropped; those of " + files_.path(0) +
                   " are kept for all frames");
  }

  // Notes a kind of difference once, for the first of the frames that have it, in whatever
  // order they are read.
  void note_first(std::uint32_t frame, const std::string& kind, std::string note) {
    const auto [found, is_new] = noted_.try_emplace(kind, Noted{frame, notes().size()});
    Noted& noted = found->second;
    if (is_new) return add_note(std::move(note));
    if (frame >= noted.frame) return;
    noted.frame = frame;
    set_note(noted.index, std::move(note));
  }

  struct Noted {
    std::uint32_t frame = 0;
    std::size_t index = 0;  // in notes()
  };
  SequenceFiles files_;
  std::vector<bool> has_compared_attributes_;  // [frame]
  std::map<std::string, Noted> noted_;         // sets, materials and notes of later files
};

}  // namespace

InputResult<FrameFiles> list_mesh_files(const std::vector<std::string>& paths) {
  const std::string where = "the " + std::to_string(paths.size()) + " files given";
  const std::string extension = lower_extension(paths.front());
  for (const std::string& path : paths) {
    std::error_code ec;
    if (fs::is_directory(path, ec) || !is_mesh_extension(path)) {
      return InputError{path + ": several inputs are the frames of one sequence, each a " +
                        extensions_text({InputFormat::Holds::kMesh}) +
                        " file; encode others one by one"};
    }
    if (lower_extension(path) == extension) continue;
    return InputError{path + ": is no " + extension + " file, as " + paths.front() +
                      " is; give the frames of one sequence"};
  }
  return sort_frames(paths, where);
}

InputResult<FrameFiles> list_mesh_folder(const std::string& folder) {
  auto paths = list_matching(
      folder, [](const std::string& name) { return name[0] != '.' && is_mesh_extension(name); },
      folder + ": no " + extensions_text({InputFormat::Holds::kMesh}) +
          " file in this folder; expected one per frame");
  if (!paths) return paths.error();
  const std::string extension = lower_extension(paths->front());
  for (const std::string& path : *paths) {
    if (lower_extension(path) == extension) continue;
    return InputError{folder + ": has " + extension + " and " + lower_extension(path) +
                      " files; choose with a pattern, as in " +
                      (fs::path(folder) / ("*" + extension)).string()};
  }
  return sort_frames(std::move(*paths), folder);
}

InputResult<FrameFiles> list_mesh_glob(const std::string& glob) {
  const fs::path path(glob);
  const std::string pattern = path.filename().string();
  auto paths = list_matching(
      path.parent_path(),
      [&](const std::string& name) {
        return fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0;
      },
      glob + ": no file matches; expected one file per frame");
  if (!paths) return paths.error();
  return sort_frames(std::move(*paths), glob);
}

InputResult<FrameFiles> list_mesh_pattern(const std::string& pattern) {
  const auto names = list_names(fs::path(pattern).parent_path());
  if (!names) return names.error();
  return select_frames(pattern, *names);
}

InputResult<std::unique_ptr<FrameSource>> open_mesh_sequence(FrameFiles files,
                                                             const InputOptions& options) {
  std::vector<std::string>& paths = files.paths;
  assert(!paths.empty());
  auto first = read_mesh_and_materials(paths[0], options.images, options.max_memory_bytes);
  if (!first) return first.error();
  FirstMesh faces{std::move(first->polygons), std::move(first->cuts), first->material_library};
  const std::uint64_t more =
      faces.polygons.size() * sizeof(MeshPolygon) + faces.cuts.memory_bytes();
  auto shape =
      shape_of(std::move(*first), static_cast<std::uint32_t>(paths.size()), options.frame_rate);
  shape.memory_bytes += more;
  for (std::string& note : files.notes) shape.notes.push_back(std::move(note));
  shape.files.insert(shape.files.begin(), paths.begin(), paths.end());
  SequenceFiles fitting(std::move(paths), std::move(faces), shape.triangles, shape.num_vertices,
                        options.max_memory_bytes);
  add_later_normals(fitting, shape.attributes);
  // Decoded positions of these frames are kept too.
  for (const PosedNormals& later : shape.attributes.later_normals)
    shape.memory_bytes += 4 * sizeof(float) * later.normals.size();
  return std::unique_ptr<FrameSource>(
      std::make_unique<MeshSequence>(std::move(shape), std::move(fitting)));
}

}  // namespace rlpc
