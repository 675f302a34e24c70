// Options of programs in the messages of libraries, which name settings in quotes:
// 'gof_frames', or with a value, 'profile = high'.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace rlpc {

struct SettingOption {
  std::string_view setting;  // "gof_frames"; with a value, "rdo = false", for that value alone
  std::string_view option;   // "--gof", "--no-rdo"
};

// Replaces quoted settings of the table by their options: 'gof_frames' by --gof, and 'profile =
// high' by --profile high if the table has `profile` without a value. All other text stays.
std::string with_options(std::string_view message, std::span<const SettingOption> table);

}  // namespace rlpc
