#include "decoder/report/gof_pictures.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "decoder/report/coarse_report.h"
#include "decoder/report/group_picture.h"
#include "decoder/report/svg_axis.h"

namespace rlpc {
namespace {

constexpr double kCaptionHeight = 20;  // caption of a view
constexpr double kLegendTop = kPictureHeight + kCaptionHeight + 14;
constexpr double kRow = 18;
constexpr double kColumn = 112;
constexpr std::size_t kColumns = 6;
constexpr std::size_t kMaxRows = 10;
constexpr std::size_t kMaxEntries = kMaxRows * kColumns;  // entries of a legend

// Mesh to draw: the whole mesh, the largest coarse mesh that is allowed, or some vertices
// alone.
struct ShownMesh {
  CoarseMesh mesh;
  std::string note;
};

std::string triangles_text(std::size_t count) { return grouped_text(count) + " triangles"; }

ShownMesh shown_mesh(const CoarseMeshes& meshes, std::uint32_t max_triangles) {
  const MeshSize whole = meshes.size(meshes.num_layers());
  if (whole.num_triangles > 0 && whole.num_triangles <= max_triangles)
    return {meshes.mesh(meshes.num_layers()), ""};
  const std::vector<std::uint32_t> fitting = layers_of_pictures(meshes, max_triangles);
  if (!fitting.empty()) {
    const std::uint32_t layers = fitting.back();
    return {meshes.mesh(layers),
            "The coarse mesh of " + std::to_string(layers) + " layers, with " +
                triangles_text(meshes.size(layers).num_triangles) + ": all " +
                grouped_text(whole.num_triangles) + " are too many."};
  }
  const std::uint32_t every = (whole.num_vertices - 1) / max_triangles + 1;
  ShownMesh shown;
  for (std::uint32_t v = 0; v < whole.num_vertices; v += every)
    shown.mesh.vertices.push_back(v);
  if (whole.num_triangles > 0) {
    shown.note = "Vertices alone: " + triangles_text(whole.num_triangles) +
                 " are too many, and there is no coarse mesh.";
  }
  if (every > 1) {
    shown.note += (shown.note.empty() ? "One of every " : " One of every ") +
                  std::to_string(every) + " vertices.";
  }
  return shown;
}

std::string legend(const ColouredVertices& vertices, std::size_t num_groups,
                   std::size_t& num_entries) {
  std::vector<std::uint32_t> sizes(num_groups);
  for (const std::uint32_t group : vertices.group) ++sizes[group];
  std::string svg;
  std::size_t left_out = 0;
  num_entries = 0;
  for (std::size_t group = 0; group < num_groups; ++group) {
    if (sizes[group] == 0) continue;
    if (num_entries == kMaxEntries) {
      ++left_out;
      continue;
    }
    const std::size_t row = num_entries / kColumns;
    const double x = 8 + kColumn * static_cast<double>(num_entries % kColumns);
    const double y = kLegendTop + kRow * static_cast<double>(row);
    svg += "<rect x=\"" + pixel_text(x) + "\" y=\"" + pixel_text(y) +
           "\" width=\"11\" height=\"11\" rx=\"2\" fill=\"" +
           colour_text(vertices.colours[group]) + "\"/>\n" +
           svg_text(x + 16, y + 10, "start",
                    std::to_string(group) + ": " + grouped_text(sizes[group]));
    ++num_entries;
  }
  if (left_out > 0) {
    const double y = kLegendTop + kRow * kMaxRows;
    svg += svg_text(8, y + 10, "start", "and " + std::to_string(left_out) + " more");
    num_entries += kColumns;  // a row
  }
  return svg;
}

class Pictures {
 public:
  Pictures(const PicturedFrame& frame, std::uint32_t max_triangles)
      : shown_(shown_mesh(*frame.meshes, max_triangles)),
        front_(projected(frame.xyz)),
        back_(projected(frame.xyz, ViewFrom::kBehind)) {}

  GofPicture of(std::string name, const std::string& noun, std::string title,
                const ColouredVertices& vertices) const {
    GofPicture picture{std::move(name), std::move(title), {}, {}, 2 * kPictureWidth, 0};
    picture.notes.push_back("The list has each " + noun + " with its number of vertices.");
    if (!shown_.note.empty()) picture.notes.push_back(shown_.note);
    const double y = kPictureHeight + 14;
    std::size_t entries = 0;
    picture.body = group_picture(shown_.mesh, front_, vertices, 0, 0) +
                   group_picture(shown_.mesh, back_, vertices, kPictureWidth, 0) +
                   svg_text(kPictureWidth / 2, y, "middle", "from the front") +
                   svg_text(3 * kPictureWidth / 2, y, "middle", "from behind") +
                   legend(vertices, vertices.colours.size(), entries);
    const std::size_t rows = (entries + kColumns - 1) / kColumns;
    picture.height = kLegendTop + kRow * static_cast<double>(rows);
    return picture;
  }

 private:
  ShownMesh shown_;
  std::vector<Point> front_;
  std::vector<Point> back_;
};

struct Noun {
  const char* one;
  const char* many;
};

Noun noun_of(GroupKind kind) {
  switch (kind) {
    case GroupKind::kNone:
      break;
    case GroupKind::kClusters:
      return {"cluster", "clusters"};
    case GroupKind::kBones:
      return {"bone", "bones"};
    case GroupKind::kPatches:
      return {"patch", "patches"};
  }
  return {"group", "groups"};
}

std::string counted(std::size_t count, const Noun& noun) {
  return grouped_text(count) + " " + (count == 1 ? noun.one : noun.many);
}

std::string title_of(const VertexGroups& groups) {
  std::string title = counted(groups.num_groups, noun_of(groups.kind));
  if (groups.kind == GroupKind::kPatches) return title;
  if (groups.kind == GroupKind::kClusters) {
    if (groups.seeds.empty()) return title + ", none with a seed triangle";
    if (groups.seeds.size() == groups.num_groups) return title + ", seed triangles outlined";
    return title + ", " + grouped_text(groups.seeds.size()) +
           " with a seed triangle, which is outlined";
  }
  return title + "; each vertex shows that of the greatest weight";
}

std::string frames_text(const PicturedFrame& frame) {
  const VertexGroups& gof = frame.groups;
  if (gof.num_frames == 1) return "Frame " + std::to_string(frame.frame) + ", a GOF of its own";
  return "Frame " + std::to_string(frame.frame) + ", in the inter GOF " +
         std::to_string(gof.first_frame) + " to " +
         std::to_string(gof.first_frame + gof.num_frames - 1);
}

}  // namespace

std::vector<GofPicture> gof_pictures(const PicturedFrame& frame, std::uint32_t max_triangles) {
  const Pictures pictures(frame, max_triangles);
  std::vector<GofPicture> all;
  const VertexGroups& groups = frame.groups;
  if (groups.kind != GroupKind::kNone) {
    const CoarseMesh whole = frame.meshes->mesh(frame.meshes->num_layers());
    const std::vector<Colour> colours =
        group_colours(groups.num_groups, groups.group_of_vertex, whole.triangles);
    const Noun noun = noun_of(groups.kind);
    all.push_back(pictures.of(noun.many, noun.one, title_of(groups),
                              {groups.group_of_vertex, colours, groups.seeds}));
    all.back().notes.insert(all.back().notes.begin(), frames_text(frame) + ".");
  }
  const auto layer_of_vertex = frame.meshes->layer_of_vertex();
  const std::vector<std::uint32_t> layers(layer_of_vertex.begin(), layer_of_vertex.end());
  const std::vector<Colour> colours = ramp_colours(frame.meshes->num_layers());
  all.push_back(
      pictures.of("layers", "layer",
                  counted(frame.meshes->num_layers(), {"vertex layer", "vertex layers"}) +
                      ", of which 0 is the coarsest",
                  {layers, colours, {}}));
  all.back().notes.insert(all.back().notes.begin(),
                          "Frame " + std::to_string(frame.frame) + ".");
  return all;
}

std::string svg_file(const GofPicture& picture) {
  constexpr double kLine = 18;
  const double top = 26 + kLine * static_cast<double>(picture.notes.size());
  const std::string width = pixel_text(picture.width);
  const std::string height = pixel_text(top + picture.height + 8);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
      "\" viewBox=\"0 0 " + width + " " + height +
      "\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<style>:root{color-scheme:light dark}text{fill:#444}"
      "@media(prefers-color-scheme:dark){text{fill:#ccc}}</style>\n" +
      svg_text(8, 20, "start", picture.title, " font-size=\"15\" font-weight=\"bold\"");
  double y = 20;
  for (const std::string& note : picture.notes) svg += svg_text(8, y += kLine, "start", note);
  return svg + "<g transform=\"translate(0 " + pixel_text(top) + ")\">\n" + picture.body +
         "</g>\n</svg>\n";
}

void add_picture_section(HtmlPage& page, const PicturedFrame& frame) {
  std::string html;
  for (const GofPicture& picture : gof_pictures(frame, kMaxPageTriangles)) {
    std::string caption = "<b>" + escape_html(picture.title) + "</b>";
    for (const std::string& note : picture.notes) caption += "<br>" + escape_html(note);
    html += "<figure class=\"card\"><svg class=\"groups\" viewBox=\"0 0 " +
            pixel_text(picture.width) + " " + pixel_text(picture.height) +
            "\" role=\"img\">\n" + picture.body + "</svg><figcaption>" + caption +
            "</figcaption></figure>\n";
  }
  page.add_section("Pictures",
                   "From two sides. rlpcinfo --frame F shows another frame, with its GOF.",
                   "<div class=\"pictures coloured\">\n" + html + "</div>\n");
}

}  // namespace rlpc
