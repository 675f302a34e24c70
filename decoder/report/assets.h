// Files beside this one, compiled in: a tool needs nothing but itself.
#pragma once

#include <string_view>

namespace rlpc {

extern const std::string_view kPageCss;       // page.css
extern const std::string_view kChartsJs;      // charts.js
extern const std::string_view kMeshViewHtml;  // mesh_view.html
extern const std::string_view kMeshViewJs;    // ../viewer, mesh_view.js

}  // namespace rlpc
