#include "common/cli/setting_options.h"

#include <algorithm>
#include <optional>

namespace rlpc {
namespace {

const SettingOption* find_setting(std::string_view setting,
                                  std::span<const SettingOption> table) {
  const auto found = std::ranges::find(table, setting, &SettingOption::setting);
  return found == table.end() ? nullptr : &*found;
}

// Returns the option for the text between two quotes; none if that is not a setting.
std::optional<std::string> option_for(std::string_view quoted,
                                      std::span<const SettingOption> table) {
  constexpr std::string_view kEquals = " = ";
  if (const SettingOption* exact = find_setting(quoted, table)) {
    return std::string(exact->option);
  }
  const std::size_t equals = quoted.find(kEquals);
  if (equals == std::string_view::npos) return std::nullopt;
  const SettingOption* const named = find_setting(quoted.substr(0, equals), table);
  if (named == nullptr) return std::nullopt;
  return std::string(named->option) + " " + std::string(quoted.substr(equals + kEquals.size()));
}

}  // namespace

std::string with_options(std::string_view message, std::span<const SettingOption> table) {
  std::string text;
  while (!message.empty()) {
    const std::size_t end = message[0] == '\'' ? message.find('\'', 1) : std::string_view::npos;
    if (end != std::string_view::npos) {
      if (const auto option = option_for(message.substr(1, end - 1), table)) {
        text += *option;
        message.remove_prefix(end + 1);
        continue;
      }
    }
    text += message[0];
    message.remove_prefix(1);
  }
  return text;
}

}  // namespace rlpc
