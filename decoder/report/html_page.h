// Self-contained HTML page: needs no network and no other file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// Replaces & < > and quotes by entities, for text and attributes.
std::string escape_html(std::string_view text);

// Formats a number with significant digits: "0.0123", "1234", "0.000012".
std::string number_text(double value, int digits = 4);

// Formats "1,234,567".
std::string grouped_text(std::uint64_t value);

// Key figure with its caption: {"1.05", "bits per vertex and frame"}.
struct KeyFigure {
  std::string value;
  std::string name;
};

class HtmlPage {
 public:
  explicit HtmlPage(std::string_view title);

  // In the functions below, arguments are HTML, except `name`, `text` and figures.
  void add_fact(std::string_view name, std::string_view text);
  void add_key_figures(const std::vector<KeyFigure>& figures);
  void add_section(std::string_view title, std::string_view note, std::string_view html);
  // Includes the script of the mesh viewer (mesh_view.h).
  void use_viewer() { viewer_ = true; }

  std::string text() const;

 private:
  std::string title_;
  std::string facts_;
  std::string body_;
  bool viewer_ = false;
};

}  // namespace rlpc
