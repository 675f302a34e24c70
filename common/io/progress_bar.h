// A progress bar: only on a terminal, erased when the work is done.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>
#include <string_view>

namespace rlpc {

class ProgressBar {
 public:
  ProgressBar(std::string_view what, bool wanted)
      : what_(what), shown_(wanted && isatty(fileno(stderr)) != 0) {}
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }

  // fraction: 0 to 1
  void show(double fraction) {
    const int percent = static_cast<int>(fraction * 100.0);
    if (!shown_ || percent == percent_) return;
    percent_ = percent;
    constexpr int kWidth = 30;
    const auto full = static_cast<std::size_t>(percent * kWidth / 100);
    const std::string bar = std::string(full, '#') + std::string(kWidth - full, '.');
    std::fprintf(stderr, "\r%s [%s] %3d %%", what_.c_str(), bar.c_str(), percent);
    std::fflush(stderr);
  }

 private:
  std::string what_;
  bool shown_;
  int percent_ = -1;
};

}  // namespace rlpc
