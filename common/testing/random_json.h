// Random JSON texts that attack parsers: nested, wide, long and repeated mixtures. For tests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace rlpc {

class RandomJson {
 public:
  explicit RandomJson(std::uint32_t seed) : state_(seed) {}

  // Returns a valid text of about `bytes` bytes, nested at most max_depth levels deep.
  std::string text(std::size_t bytes, int max_depth) {
    const std::size_t kind = below(6);
    if (kind == 0) return nested(max_depth, bytes);
    if (kind == 1) return wide_array(bytes);
    if (kind == 2) return wide_object(bytes);
    std::string out;
    value(out, bytes, max_depth);
    return out;
  }

 private:
  // Linear congruential generator (Numerical Recipes), without its weak low bits.
  std::uint32_t next() {
    state_ = state_ * 1664525U + 1013904223U;
    return state_ >> 8;
  }
  std::size_t below(std::size_t n) { return next() % n; }

  std::string word(std::size_t bytes) {
    static constexpr const char* kLetters[] = {"a", "\\n", "\\u00e4", "\xC3\xA4", "\\\"", " "};
    std::string out = "\"";
    const bool is_mixed = below(2) == 0;
    while (out.size() < bytes + 1) out += is_mixed ? kLetters[below(6)] : "a";
    return out + "\"";
  }

  std::string scalar(std::size_t bytes) {
    static constexpr const char* kScalars[] = {
        "0",    "true", "null", "-1.5e-7", "18446744073709551615",
        "1e30", "[]",   "{}",   "\"\"",    "[0]"};
    return below(8) == 0 ? word(below(bytes + 1)) : kScalars[below(10)];
  }

  std::string name() {
    switch (below(3)) {
      case 0:
        return word(below(3));  // often repeated
      case 1:
        return word(below(60));
      default:
        return "\"" + std::to_string(next()) + "\"";
    }
  }

  std::string nested(int depth, std::size_t bytes) {
    const bool has_objects = below(2) == 0;
    std::string out;
    std::string end;
    for (int d = 0; d < depth; ++d) {
      const bool is_object = has_objects && below(2) == 0;
      out += is_object ? "{" + name() + ":" : "[";
      end.insert(0, is_object ? "}" : "]");
      // Later siblings make their parent grow.
      for (std::size_t i = below(4); i > 0 && out.size() < bytes; --i) {
        end.insert(0, is_object ? "," + name() + ":0" : ",0");
      }
    }
    return out + "0" + end;
  }

  std::string wide_array(std::size_t bytes) {
    const std::string item = scalar(20);
    std::string out = "[" + item;
    while (out.size() < bytes) out += "," + item;
    return out + "]";
  }

  std::string wide_object(std::size_t bytes) {
    const std::string item = scalar(20);
    const bool are_numbered = below(2) == 0;
    std::string out = "{" + name() + ":" + item;
    for (std::size_t i = 0; out.size() < bytes && i < 3000; ++i) {
      out += ",";
      out += are_numbered ? "\"" + std::to_string(i) + "\"" : name();
      out += ":" + item;
    }
    return out + "}";
  }

  void value(std::string& out, std::size_t bytes, int depth) {
    const std::size_t kind = below(4);
    if (depth == 0 || bytes < 8 || kind == 0) {
      out += scalar(bytes);
      return;
    }
    const bool is_object = kind == 1;
    const std::size_t end = out.size() + bytes;
    out += is_object ? '{' : '[';
    for (bool is_first = true; out.size() < end; is_first = false) {
      if (!is_first) out += ',';
      if (is_object) out += name() + ":";
      value(out, (end - std::min(end, out.size())) / (1 + below(4)), depth - 1);
    }
    out += is_object ? '}' : ']';
  }

  std::uint32_t state_;
};

}  // namespace rlpc
