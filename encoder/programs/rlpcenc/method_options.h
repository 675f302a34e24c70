// Options of rlpcenc that choose how positions and attributes are coded.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "encoder/programs/rlpcenc/encode_command_line.h"

namespace rlpc {

// Adds an option that takes one of a few words.
template <class T, class To>
CLI::Option* add_choice(CLI::App& app, const std::string& name, To& value,
                        const std::map<std::string, T>& words, const std::string& what) {
  const auto set = [&value, words](const std::string& word) { value = words.at(word); };
  return app.add_option_function<std::string>(name, set, what)
      ->check(CLI::IsMember(words).description(""))
      ->option_text("WORD");
}

// Adds a flag that turns off a default.
inline CLI::Option* add_off_switch(CLI::App& app, const std::string& name, bool& value,
                                   const std::string& what) {
  return app.add_flag_callback(
      name, [&value] { value = false; }, what);
}

void add_method_options(CLI::App& app, EncodeCommandLine& line);

}  // namespace rlpc
