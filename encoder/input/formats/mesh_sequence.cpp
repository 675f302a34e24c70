#include "encoder/input/formats/mesh_sequence.h"

#include <fnmatch.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "common/io/numbered_name.h"
#include "encoder/input/formats/material_files.h"
#include "encoder/input/input_format.h"
#include "encoder/input/mesh_reader.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The run of digits that starts at `pos`, without its leading zeros; moves `pos` past it.
std::string_view take_number(std::string_view text, std::size_t& pos) {
  while (pos < text.size() && text[pos] == '0') ++pos;
  const std::size_t first = pos;
  while (pos < text.size() && is_digit(text[pos])) ++pos;
  return text.substr(first, pos - first);
}

// Names of the files in a folder.
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
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

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

// A file name, split at its last number.
struct NameParts {
  std::string_view before;
  std::optional<std::uint64_t> number;
  std::string_view after;
};

NameParts parts_of(std::string_view path) {
  const std::string_view name = path.substr(path.find_last_of('/') + 1);
  std::size_t end = name.size();
  while (end > 0 && !is_digit(name[end - 1])) --end;
  std::size_t first = end;
  while (first > 0 && is_digit(name[first - 1])) --first;
  std::uint64_t number = 0;
  const auto [rest, error] = std::from_chars(name.data() + first, name.data() + end, number);
  if (error != std::errc()) return {name, std::nullopt, ""};
  return {name.substr(0, first), number, name.substr(end)};
}

// Warnings about suspicious sequences.
std::vector<std::string> notes_on(const std::vector<std::string>& paths) {
  std::size_t gaps = 0;
  std::string first_gap;
  for (std::size_t i = 1; i < paths.size(); ++i) {
    const NameParts a = parts_of(paths[i - 1]);
    const NameParts b = parts_of(paths[i]);
    if (a.before != b.before || a.after != b.after || !a.number || !b.number) {
      return {paths[i - 1] + " and " + paths[i] + " are frames " + std::to_string(i - 1) +
              " and " + std::to_string(i) + ", though their names have different forms"};
    }
    if (*b.number == *a.number + 1) continue;
    if (gaps++ == 0) first_gap = paths[i - 1] + " and " + paths[i];
  }
  if (gaps == 0) return {};
  if (gaps == 1) {
    return {"there is no frame between " + first_gap + "; the gap is closed"};
  }
  return {"the numbers of the frames have " + std::to_string(gaps) +
          " gaps, the first between " + first_gap + "; the gaps are closed"};
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

class MeshSequence : public FrameSource {
 public:
  MeshSequence(Shape shape, std::vector<std::string> paths, std::uint64_t max_memory_bytes)
      : FrameSource(std::move(shape)),
        paths_(std::move(paths)),
        max_memory_bytes_(max_memory_bytes),
        has_compared_attributes_(paths_.size(), false) {
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

  std::string file_of(std::uint32_t frame) const override { return paths_[frame]; }

 private:
  InputResult<SingleMesh> read_file_of(std::uint32_t frame) {
    auto mesh = read_mesh(paths_[frame], max_memory_bytes_, !has_compared_attributes_[frame]);
    if (!mesh) return mesh;
    if (auto error = compare_with_first(frame, *mesh)) return *error;
    if (!has_compared_attributes_[frame]) compare_attributes(frame, mesh->attributes);
    return mesh;
  }

  std::optional<InputError> compare_with_first(std::uint32_t frame,
                                               const SingleMesh& mesh) const {
    const auto differs = [&](const std::string& here, const std::string& there) {
      return InputError{paths_[frame] + ": frame " + std::to_string(frame) + " (from 0) has " +
                        here + ", but " + paths_[0] + " has " + there +
                        "; every frame must have the vertices and faces of the first"};
    };
    if (mesh.xyz.size() / 3 != num_vertices()) {
      return differs(std::to_string(mesh.xyz.size() / 3) + " vertices",
                     std::to_string(num_vertices()));
    }
    if (mesh.triangles.size() != triangles().size()) {
      return differs(std::to_string(mesh.triangles.size()) + " triangles",
                     std::to_string(triangles().size()));
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.triangles[t] == triangles()[t]) continue;
      return differs("triangle " + std::to_string(t) + " = " + corners(mesh.triangles[t]),
                     corners(triangles()[t]));
    }
    return std::nullopt;
  }

  // Adds a note about the first file whose attributes are not those of the first one.
  void compare_attributes(std::uint32_t frame, const SourceAttributes& found) {
    has_compared_attributes_[frame] = true;
    for (const SourceAttribute& set : found.sets) {
      if (set.name == "normal") continue;  // moves with the frames
      const SourceAttribute* const first = find_attribute(attributes(), set.name);
      if (first != nullptr && are_near(*first, set, triangles())) continue;
      add_note(paths_[frame] + ": " + set.name +
               (first == nullptr
                    ? " is dropped, as " + paths_[0] + " has none"
                    : " differs from that of " + paths_[0] + ", which is kept for all frames"));
      has_compared_attributes_.assign(paths_.size(), true);
      return;
    }
  }

  // Counted from 1, as in OBJ files.
  static std::string corners(const Triangle& t) {
    std::string text;
    for (const std::uint32_t v : t) text += " " + std::to_string(std::uint64_t{v} + 1);
    return "f" + text;
  }

  std::vector<std::string> paths_;
  std::uint64_t max_memory_bytes_;
  std::vector<bool> has_compared_attributes_;  // [frame]
};

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view m = take_number(a, i);
      const std::string_view n = take_number(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      // As bytes: char is signed on some machines.
      if (a[i] != b[j])
        return static_cast<std::uint8_t>(a[i]) < static_cast<std::uint8_t>(b[j]);
      ++i;
      ++j;
    }
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a < b;  // equal except for leading zeros
}

InputResult<std::vector<std::string>> list_mesh_folder(const std::string& folder) {
  auto paths = list_matching(
      folder, [](const std::string& name) { return name[0] != '.' && is_mesh_extension(name); },
      folder + ": no " + extensions_text({InputFormat::Holds::kMesh}) +
          " file in this folder; expected one per frame");
  if (!paths) return paths;
  const std::string extension = lower_extension(paths->front());
  for (const std::string& path : *paths) {
    if (lower_extension(path) == extension) continue;
    return InputError{folder + ": has " + extension + " and " + lower_extension(path) +
                      " files; choose with a pattern, as in " +
                      (fs::path(folder) / ("*" + extension)).string()};
  }
  return paths;
}

InputResult<std::vector<std::string>> list_mesh_glob(const std::string& glob) {
  const fs::path path(glob);
  const std::string pattern = path.filename().string();
  return list_matching(
      path.parent_path(),
      [&](const std::string& name) {
        return fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0;
      },
      glob + ": no file matches; expected one file per frame");
}

InputResult<std::vector<std::string>> list_mesh_pattern(const std::string& pattern) {
  const fs::path path(pattern);
  const auto name = parse_pattern(path.filename().string());
  if (!name) {
    return InputError{pattern +
                      ": expected one %d or %04d (any width) in the file name, as in "
                      "walk_%04d.obj"};
  }
  const auto names = list_names(path.parent_path());
  if (!names) return names.error();
  std::vector<std::uint64_t> numbers;
  for (const std::string& candidate : *names) {
    if (const auto number = name->number_of(candidate)) numbers.push_back(*number);
  }
  if (numbers.empty()) {
    return InputError{pattern + ": no such file, for example " + name->with(0) + " or " +
                      name->with(1)};
  }
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != numbers[0] + i) {
      return InputError{(path.parent_path() / name->with(numbers[0] + i)).string() +
                        ": this frame is missing, though " + name->with(numbers[i]) +
                        " exists; number the files without gaps"};
    }
    paths.push_back((path.parent_path() / name->with(numbers[i])).string());
  }
  return paths;
}

InputResult<std::unique_ptr<FrameSource>> open_mesh_sequence(std::vector<std::string> paths,
                                                             const InputOptions& options) {
  assert(!paths.empty());
  auto first = read_mesh_and_materials(paths[0], options.textures, options.max_memory_bytes);
  if (!first) return first.error();
  auto shape =
      shape_of(std::move(*first), static_cast<std::uint32_t>(paths.size()), options.frame_rate);
  for (std::string& note : notes_on(paths)) shape.notes.push_back(std::move(note));
  shape.files.insert(shape.files.begin(), paths.begin(), paths.end());
  return std::unique_ptr<FrameSource>(std::make_unique<MeshSequence>(
      std::move(shape), std::move(paths), options.max_memory_bytes));
}

}  // namespace rlpc
