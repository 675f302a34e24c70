// Progress bar on a terminal, after some seconds with the time left; erased when the work is
// done.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

#include "common/files/time_left.h"

namespace rlpc {

class ProgressBar {
 public:
  ProgressBar(std::string_view what, bool wanted)
      : what_(what), shown_(wanted && isatty(fileno(stderr)) != 0) {
    show(0.0);
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }

  // Shows progress. fraction: 0 to 1.
  void show(double fraction) {
    if (!shown_) return;
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start_;
    const std::string text = progress_text(fraction, left_.update(past.count(), fraction));
    if (text == text_) return;
    text_ = text;
    constexpr int kWidth = 30;
    const auto full =
        static_cast<std::size_t>(static_cast<int>(fraction * 100.0) * kWidth / 100);
    const std::string bar = std::string(full, '#') + std::string(kWidth - full, '.');
    std::fprintf(stderr, "\r%s [%s] %s\033[K", what_.c_str(), bar.c_str(), text.c_str());
    std::fflush(stderr);
  }

 private:
  std::string what_;
  bool shown_;
  TimeLeft left_;
  std::string text_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace rlpc
