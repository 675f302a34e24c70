// Files in this folder, compiled in, so that a program is self-contained.
#pragma once

#include <string_view>

namespace rlpc {

extern const std::string_view kPageCss;       // page.css
extern const std::string_view kChartsJs;      // charts.js
extern const std::string_view kMeshViewHtml;  // mesh_view.html
extern const std::string_view kMeshViewJs;    // ../viewer, mesh_view.js

}  // namespace rlpc
