#include "decoder/report/html_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "decoder/report/assets.h"

namespace rlpc {

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "–" : value > 0 ? "∞" : "−∞";
  if (value == 0) return "0";
  char text[64];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  const int exponent = std::atoi(std::strchr(text, 'e') + 1);  // after rounding
  if (exponent < -5 || exponent >= 9) return text;
  std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - 1 - exponent), value);
  return text;
}

std::string grouped_text(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

HtmlPage::HtmlPage(std::string_view title) : title_(escape_html(title)) {}

void HtmlPage::add_fact(std::string_view name, std::string_view text) {
  facts_ += "<dt>" + escape_html(name) + "</dt><dd>" + escape_html(text) + "</dd>\n";
}

void HtmlPage::add_key_figures(const std::vector<KeyFigure>& figures) {
  body_ += "<div class=\"figures\">\n";
  for (const KeyFigure& figure : figures) {
    body_ += "<div class=\"card key\"><b>" + escape_html(figure.value) + "</b><span>" +
             escape_html(figure.name) + "</span></div>\n";
  }
  body_ += "</div>\n";
}

void HtmlPage::add_section(std::string_view title, std::string_view note,
                           std::string_view html) {
  body_ += "<section>\n<h2>" + escape_html(title) + "</h2>\n";
  if (!note.empty()) body_ += "<p class=\"note\">" + escape_html(note) + "</p>\n";
  body_ += html;
  body_ += "</section>\n";
}

std::string HtmlPage::text() const {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>";
  page += title_ + "</title>\n<style>\n";
  page += kPageCss;
  page += "</style>\n</head>\n<body>\n<main>\n<h1>" + title_ + "</h1>\n<dl class=\"facts\">\n";
  page += facts_ + "</dl>\n" + body_ + "</main>\n<script>\n";
  page += kChartsJs;
  page += "</script>\n";
  if (viewer_) {
    page += "<script>\n\"use strict\";\n(() => {\n";
    page += kMeshViewJs;
    page += "})();\n</script>\n";
  }
  return page + "</body>\n</html>\n";
}

}  // namespace rlpc
