#include "common/cli/command_line.h"

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <memory>
#include <numeric>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/files/messages.h"

namespace rlpc {
namespace {

constexpr int kUsage = 64;
constexpr std::size_t kColumn = 26;  // start of descriptions
constexpr std::size_t kWidth = 80;

// Formats "  --name VALUE          description", wrapped.
std::string entry(const std::string& term, const std::string& description) {
  std::string out = "  " + term;
  std::size_t column = out.size();
  if (column + 2 > kColumn) {
    out += '\n';
    column = 0;
  }
  bool first = true;
  std::istringstream words(description);
  for (std::string word; words >> word; first = false) {
    if (!first && column + 1 + word.size() > kWidth) {
      out += '\n';
      column = 0;
      first = true;
    }
    const std::string gap(first ? kColumn - column : 1, ' ');
    out += gap + word;
    column += gap.size() + word.size();
  }
  return out + "\n";
}

std::string option_entry(const CLI::Option* option) {
  std::string term;
  for (const char c : option->get_name(option->get_positional(), true)) {
    term += c == ',' ? std::string(", ") : std::string(1, c);
  }
  if (!option->get_option_text().empty()) term += " " + option->get_option_text();
  return entry(term, option->get_description());
}

class HelpPages : public CLI::Formatter {
 public:
  explicit HelpPages(HelpText text) : text_(std::move(text)) {}

  std::string make_help(const CLI::App* app, std::string /*name*/,
                        CLI::AppFormatMode mode) const override {
    const bool all = mode == CLI::AppFormatMode::All;
    std::string out =
        app->get_description() + "\nUsage: " + app->get_name() + " " + text_.usage + "\n\n";
    for (const auto* option :
         app->get_options([](const CLI::Option* o) { return o->get_positional(); })) {
      out += option_entry(option);
    }
    for (const std::string& group : all ? app->get_groups() : text_.main_groups) {
      const auto options = app->get_options([&group](const CLI::Option* o) {
        return o->get_group() == group && o->nonpositional();
      });
      if (options.empty()) continue;
      out += "\n" + group + ":\n";
      for (const auto* option : options) out += option_entry(option);
    }
    out += "\n" + text_.examples + "\n";
    if (all) return out + "\n" + text_.details + "\n";
    return out + "\nAll options, details and exit codes: " + app->get_name() + " --help-all\n";
  }

 private:
  HelpText text_;
};

// Returns the edit distance: letters to insert, remove or replace.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({replaced, row[j] + 1, row[j + 1] + 1}));
    }
  }
  return row.back();
}

// Returns the option that was probably meant; "" if none is similar.
std::string similar_option(const CLI::App& app, const std::string& word) {
  std::string nearest;
  std::size_t min_distance = 3;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      const std::size_t distance = edit_distance(word, "--" + name);
      if (distance >= min_distance) continue;
      min_distance = distance;
      nearest = "--" + name;
    }
  }
  return nearest;
}

// Returns the arguments that are not options, in their order.
std::vector<std::string> plain_words(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    words.insert(words.end(), option->results().begin(), option->results().end());
  }
  const std::vector<std::string> surplus = app.remaining();
  words.insert(words.end(), surplus.begin(), surplus.end());
  return words;
}

// Returns the index of the mesh of a point cache: the mesh with its name, otherwise the one
// before it; a stream has none.
std::size_t mesh_of_cache(const std::vector<std::string>& meshes, const std::string& cache) {
  const auto begins_like_cache = [&](const std::string& mesh) {
    return mesh.substr(0, mesh.rfind('.')) == cache.substr(0, cache.rfind('.'));
  };
  const auto named = std::find_if(meshes.begin(), meshes.end(), begins_like_cache);
  if (named != meshes.end()) return static_cast<std::size_t>(named - meshes.begin());
  return meshes.back().ends_with(".rlpc") ? 0 : meshes.size() - 1;
}

std::string surplus_text(const CLI::App& app, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (!word.starts_with("-")) continue;
    const std::string similar = similar_option(app, word.substr(0, word.find('=')));
    return "unknown option " + word +
           (similar.empty() ? "" : "; did you mean " + similar + "?");
  }
  std::string cache_advice = point_cache_advice(app);
  if (!cache_advice.empty()) return cache_advice;
  const bool has_points = app.get_option_no_throw("--points") != nullptr;
  return "unexpected argument" + std::string(words.size() == 1 ? " " : "s ") +
         CLI::detail::join(words, " ") +
         (has_points ? "; put patterns in quotes, as in 'walk_*.obj'" : "");
}

// Returns whether a word is the value of an option whose value may be missing: any number,
// valid or not, and any other word that the option accepts.
bool is_value_of(CLI::Option& option, std::string word) {
  if (!word.empty() && word[0] >= '0' && word[0] <= '9') return true;
  const CLI::Validator* const check = option.get_validator(0);
  return check != nullptr && (*check)(word).empty();
}

// Moves options whose optional value is missing to the end of the command line, where no
// argument follows that CLI11 would take for the value.
std::vector<std::string> without_taken_arguments(CLI::App& app,
                                                 std::vector<std::string> words) {
  std::vector<std::string> moved;
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--") {
      kept.insert(kept.end(), moved.begin(), moved.end());
      moved.assign(words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
      break;
    }
    CLI::Option* const option =
        words[i].starts_with("--") ? app.get_option_no_throw(words[i]) : nullptr;
    const bool may_lack_value = option != nullptr && option->get_items_expected_min() == 0 &&
                                option->get_items_expected_max() == 1;
    const bool has_value =
        i + 1 < words.size() && may_lack_value && is_value_of(*option, words[i + 1]);
    (may_lack_value && !has_value ? moved : kept).push_back(std::move(words[i]));
  }
  kept.insert(kept.end(), moved.begin(), moved.end());
  return kept;
}

}  // namespace

std::string point_cache_advice(const CLI::App& app) {
  if (app.get_option_no_throw("--points") == nullptr) return "";
  std::vector<std::string> options{"--points"};
  if (app.get_option_no_throw("--points-b") != nullptr) options = {"--points-a", "--points-b"};
  std::vector<std::string> meshes;
  std::vector<std::string> caches;
  std::string meant;
  for (const std::string& word : plain_words(app)) {
    if (meshes.empty() || !(word.ends_with(".pc2") || word.ends_with(".mdd"))) {
      meshes.push_back(word);
      continue;
    }
    caches.push_back(word);
    const std::size_t number = std::min(mesh_of_cache(meshes, word), options.size() - 1);
    meant += " " + options[number] + " " + word;
  }
  if (caches.empty()) return "";
  return "unexpected argument" + std::string(caches.size() == 1 ? " " : "s ") +
         CLI::detail::join(caches, " ") + "; did you mean" + meant + "?";
}

void add_help(CLI::App& app, HelpText text, const std::string& version) {
  app.set_help_flag("-h,--help", "The options most used")->group("Help");
  app.set_help_all_flag("--help-all", "This page")->group("Help");
  app.set_version_flag("--version", app.get_name() + " " + version, "The version")
      ->group("Help");
  app.formatter(std::make_shared<HelpPages>(std::move(text)));
}

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words =
      without_taken_arguments(app, std::vector<std::string>(argv + 1, argv + argc));
  std::reverse(words.begin(), words.end());  // App::parse() expects the reverse order
  try {
    app.parse(std::move(words));
  } catch (const CLI::ExtrasError&) {
    print_message(app.get_name(), surplus_text(app, app.remaining()));
    std::cerr << "Run with --help for more information.\n";
    return kUsage;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    print_message(app.get_name(), error.what());
    std::cerr << "Run with --help for more information.\n";
    return kUsage;
  }
  return std::nullopt;
}

}  // namespace rlpc
