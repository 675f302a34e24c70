// Files beside this one, compiled in: a tool needs nothing but itself.
#pragma once

#include <string_view>

namespace rlpc {

extern const std::string_view kPageCss;     // page.css
extern const std::string_view kChartsJs;    // charts.js
extern const std::string_view kViewerHtml;  // viewer.html
extern const std::string_view kViewerJs;    // viewer.js

}  // namespace rlpc
