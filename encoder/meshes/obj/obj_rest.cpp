#include "encoder/meshes/obj/obj_rest.h"

#include <array>

#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace {

struct Keyword {
  std::string_view word;
  std::string_view kind;  // contents, in the words of users; empty: nothing by itself
};

constexpr std::string_view kFreeForm = "free-form curves and surfaces";
constexpr std::string_view kDisplay = "settings of display and rendering";

constexpr std::array kKeywords{
    Keyword{"l", "lines"}, Keyword{"p", "points"}, Keyword{"s", "smoothing groups"},
    Keyword{"mg", "merging groups"}, Keyword{"vp", kFreeForm}, Keyword{"cstype", kFreeForm},
    Keyword{"deg", kFreeForm}, Keyword{"bmat", kFreeForm}, Keyword{"step", kFreeForm},
    Keyword{"curv", kFreeForm}, Keyword{"curv2", kFreeForm}, Keyword{"surf", kFreeForm},
    Keyword{"parm", kFreeForm}, Keyword{"trim", kFreeForm}, Keyword{"hole", kFreeForm},
    Keyword{"scrv", kFreeForm}, Keyword{"sp", kFreeForm}, Keyword{"end", kFreeForm},
    Keyword{"con", kFreeForm}, Keyword{"bevel", kDisplay}, Keyword{"c_interp", kDisplay},
    Keyword{"d_interp", kDisplay}, Keyword{"lod", kDisplay}, Keyword{"shadow_obj", kDisplay},
    Keyword{"trace_obj", kDisplay}, Keyword{"ctech", kDisplay}, Keyword{"stech", kDisplay},
    Keyword{"usemap", "texture maps (usemap)"}, Keyword{"maplib", "texture maps (usemap)"},
    // Keywords that a reader without attributes passes on.
    Keyword{"vt", ""}, Keyword{"vn", ""}, Keyword{"g", ""}, Keyword{"o", ""},
    Keyword{"usemtl", ""}, Keyword{"mtllib", ""}};

}  // namespace

void ObjRest::add_line(std::string_view keyword, std::string_view word) {
  for (const Keyword& known : kKeywords) {
    if (known.word != keyword) continue;
    const bool is_off = word.empty() || word == "off" || word == "0";
    const bool may_be_off = keyword == "s" || keyword == "mg" || known.kind == kDisplay;
    if (known.kind.empty() || (may_be_off && is_off)) return;
    ++kinds_.try_emplace(std::string(known.kind), 0).first->second;
    return;
  }
  if (unknown_lines_++ == 0) unknown_ = keyword;
}

std::optional<std::string> ObjRest::note() const {
  std::string list;
  const auto add = [&](const std::string& what, std::uint64_t count, bool counted) {
    if (count == 0) return;
    list += (list.empty() ? "" : ", ") + what;
    if (counted) list += " (" + std::to_string(count) + ")";
  };
  for (const auto& [kind, count] : kinds_)
    add(kind, count, kind == "lines" || kind == "points");
  add("weights of vertices", weights_, true);
  add("numbers after vertices that are no colour", vertex_numbers_, true);
  add("third texture coordinates", third_uv_, true);
  add("unknown lines, the first of them " + quoted(unknown_), unknown_lines_, true);
  if (list.empty()) return std::nullopt;
  return "dropped: " + list;
}

}  // namespace rlpc
