#include "encoder/meshes/materials/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "common/files/messages.h"
#include "encoder/meshes/mesh_text.h"

namespace rlpc {
namespace {

// Keywords whose parameters a stream cannot hold, and the values that mean the same as no such
// line.
struct Unkept {
  std::string_view keyword;
  std::optional<double> neutral;
};

constexpr std::array kUnkept{Unkept{"Ks", 0.0},
                             Unkept{"Ka", 0.0},
                             Unkept{"Tf", 1.0},
                             Unkept{"Ni", 1.0},
                             Unkept{"Ps", 0.0},
                             Unkept{"Pc", 0.0},
                             Unkept{"Pcr", 0.0},
                             Unkept{"aniso", 0.0},
                             Unkept{"anisor", 0.0},
                             Unkept{"sharpness", std::nullopt},
                             Unkept{"illum", std::nullopt}};

bool is_image(std::string_view keyword) {
  return keyword.starts_with("map_") || keyword == "norm" || keyword == "bump" ||
         keyword == "disp" || keyword == "decal" || keyword == "refl";
}

class MtlReader {
 public:
  explicit MtlReader(const SourceMaterials& materials)
      : used_(materials.names.begin(), materials.names.end()), text_(materials.mtl) {}

  MtlFile read() {
    Material* material = nullptr;
    bool is_unused = false;
    for (TextWords words(text_); !words.at_end(); words.next_line()) {
      const std::string_view keyword = words.next();
      if (keyword == "newmtl") {
        const std::string name = words.rest_of_words();
        is_unused = !used_.contains(name);
        material = is_unused ? nullptr : &all_[name];
        if (is_unused) unused_.insert(name);
      } else if (material != nullptr) {
        read_line(keyword, words, *material);
      } else if (!is_unused && !keyword.empty()) {
        drop(keyword);
      }
    }
    MtlFile file;
    for (auto& [name, found] : all_) {
      finish(found);
      file.materials.emplace(name, std::move(found.mtl));
    }
    file.dropped = dropped_text();
    return file;
  }

 private:
  struct Material {
    Mtl mtl;
    std::optional<double> shine_roughness;  // value of Ns
  };

  // Notes a dropped keyword. Keywords come from the file, so only so many are held.
  void drop(std::string_view keyword) {
    constexpr std::size_t kMaxNames = 100;
    const std::string name(keyword.substr(0, 40));
    if (known_.size() < kMaxNames && known_.insert(name).second) dropped_.push_back(name);
  }

  // Reads a number from 0 to 1.
  std::optional<double> factor_of(std::string_view keyword, TextWords& words) {
    const std::string_view word = words.next();
    const auto value = parse_number(word);
    if (!value) {
      if (!word.empty()) drop(keyword);
      return std::nullopt;
    }
    const double within = std::clamp(*value, 0.0, 1.0);
    if (within != *value) drop(std::string(keyword) + " outside 0 to 1");
    return within;
  }

  // Reads a colour; "Kd 0.8" means the same for all three.
  std::optional<MtlColour> colour_of(std::string_view keyword, TextWords& words) {
    const auto red = factor_of(keyword, words);
    if (!red) return std::nullopt;
    const auto green = factor_of(keyword, words);
    const auto blue = factor_of(keyword, words);
    return MtlColour{*red, green.value_or(*red), blue.value_or(*red)};
  }

  void read_line(std::string_view keyword, TextWords& words, Material& material) {
    Mtl& mtl = material.mtl;
    if (keyword == "Kd") {
      mtl.base = colour_of(keyword, words);
    } else if (keyword == "Ke") {
      mtl.emission = colour_of(keyword, words);
    } else if (keyword == "d") {
      mtl.opacity = factor_of(keyword, words);
    } else if (keyword == "Tr") {
      if (const auto clear = factor_of(keyword, words)) mtl.opacity = 1.0 - *clear;
    } else if (keyword == "Pr") {
      mtl.roughness = factor_of(keyword, words);
    } else if (keyword == "Pm") {
      mtl.metalness = factor_of(keyword, words);
    } else if (keyword == "Ns") {
      // Take the roughness of an equally wide Blinn-Phong highlight.
      const auto exponent = parse_number(words.next());
      if (exponent) {
        material.shine_roughness = std::sqrt(2.0 / (std::max(*exponent, 0.0) + 2.0));
      }
    } else if (keyword == "map_Kd") {
      mtl.base_image = read_mtl_map(words);
    } else if (keyword == "map_d") {
      mtl.alpha_image = read_mtl_map(words);
    } else if (keyword == "map_Ke") {
      mtl.emission_image = read_mtl_map(words);
    } else if (keyword == "norm") {
      mtl.normal_image = read_mtl_map(words);
    } else if (!keyword.empty() && !is_image(keyword)) {
      if (says_something(keyword, words)) drop(keyword);
    }
  }

  static bool says_something(std::string_view keyword, TextWords& words) {
    const auto* const found =
        std::find_if(kUnkept.begin(), kUnkept.end(),
                     [&](const Unkept& unkept) { return unkept.keyword == keyword; });
    if (found == kUnkept.end() || !found->neutral) return true;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (parse_number(word) != found->neutral) return true;
    }
    return false;
  }

  void finish(Material& material) {
    Mtl& mtl = material.mtl;
    if (material.shine_roughness && mtl.roughness) drop("Ns where Pr is given");
    if (!mtl.roughness) mtl.roughness = material.shine_roughness;
    const bool is_white = !mtl.base || *mtl.base == MtlColour{1.0, 1.0, 1.0};
    if (!is_white && !mtl.base_image.name.empty()) drop("Kd where map_Kd is given");
  }

  std::string dropped_text() const {
    std::string list;
    for (const std::string& keyword : dropped_) {
      list += (list.empty() ? "" : ", ") + printable(keyword);
    }
    if (!list.empty()) list = "parameters of materials (" + list + ")";
    if (const std::size_t count = unused_.size(); count > 0) {
      list += (list.empty() ? "" : ", ") + count_text(count, "material") +
              " that no face uses (" + rlpc::quoted(*unused_.begin()) +
              (count > 1 ? ", ...)" : ")");
    }
    return list.empty() ? list : "dropped: " + list;
  }

  std::set<std::string, std::less<>> used_;
  std::string_view text_;
  std::map<std::string, Material, std::less<>> all_;
  std::set<std::string> unused_;
  std::vector<std::string> dropped_;  // in the order of the file
  std::set<std::string> known_;
};

}  // namespace

MtlFile read_mtl(const SourceMaterials& materials) { return MtlReader(materials).read(); }

}  // namespace rlpc
