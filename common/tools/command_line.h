// The command line of a program, on top of CLI11: --help fits one screen, --help-all has it
// all.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rlpc {

struct HelpText {
  std::string usage;                     // "INPUT -o OUT [OPTIONS]"
  std::vector<std::string> main_groups;  // the groups of options that --help shows
  std::string examples;                  // last on both pages
  std::string details;                   // on the page of --help-all only
};

// Adds --help, --help-all and --version, after all other options. The placeholder of an
// option's value ("FILE") is its option_text(); nothing else of CLI11's own is shown.
void add_help(CLI::App& app, HelpText text, const std::string& version);

// Reads the command line. Returns the exit code if nothing is left to do: 0 after a help page,
// 64 after an error, which is reported on standard error.
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

}  // namespace rlpc
