// Command lines of the programs, based on CLI11: --help fits on one screen, --help-all is
// complete.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rlpc {

struct HelpText {
  std::string usage;                     // "INPUT -o OUT [OPTIONS]"
  std::vector<std::string> main_groups;  // groups of options that --help shows
  std::string examples;                  // end of both pages
  std::string details;                   // --help-all only
};

// Adds --help, --help-all and --version. Must be called after adding all other options. The
// placeholder of a value ("FILE") is the option_text() of the option.
void add_help(CLI::App& app, HelpText text, const std::string& version);

// Reads the command line. Returns the exit code if the program should end: 0 after a help page,
// 64 after an error, which is reported on standard error.
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

// Returns advice on point caches that follow a mesh without their option; "" if there are none.
// Must be called after parse_command_line().
std::string point_cache_advice(const CLI::App& app);

}  // namespace rlpc
