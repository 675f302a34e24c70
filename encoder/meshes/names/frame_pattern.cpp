#include "encoder/meshes/names/frame_pattern.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "common/files/messages.h"
#include "common/files/numbered_name.h"
#include "encoder/meshes/names/name_number.h"
#include "encoder/meshes/names/name_problem.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

// Returns the form that a pattern with %g describes.
std::optional<NameForm> form_of_any_number(std::string_view pattern) {
  const std::size_t place = pattern.find("%g");
  if (place == pattern.npos || pattern.find('%', place + 1) != pattern.npos) {
    return std::nullopt;
  }
  return NameForm{pattern.substr(0, place), pattern.substr(place + 2)};
}

struct NumberedFile {
  std::int64_t number = 0;
  std::string name;
};

// Returns the whole number of a name that a pattern with %d selects. The width may include the
// sign, as in C, or not.
std::optional<std::int64_t> number_of(const NumberedName& pattern, const std::string& name) {
  const auto number = NameForm{pattern.prefix, pattern.suffix}.number_of(name);
  if (!number || !number->fraction.empty()) return std::nullopt;
  constexpr std::size_t kMaxDigits = 18;
  const std::size_t digits = std::max<std::size_t>(number->significant().size(), 1);
  if (digits > kMaxDigits) return std::nullopt;
  const std::size_t written = number->whole.size();
  const bool is_as_wide = written == std::max(digits, pattern.width);
  const bool is_as_wide_with_sign =
      number->sign != '\0' && written + 1 == std::max(digits + 1, pattern.width);
  if (!is_as_wide && !is_as_wide_with_sign) return std::nullopt;
  std::int64_t value = 0;
  for (const char c : number->significant()) value = 10 * value + (c - '0');
  return number->sign == '-' ? -value : value;
}

// Returns the name of a missing frame, with the kind of signs of another.
std::string name_with(const NumberedName& pattern, std::int64_t number,
                      const std::string& other) {
  if (number >= 0) return pattern.with(static_cast<std::uint64_t>(number));
  const auto known = NameForm{pattern.prefix, pattern.suffix}.number_of(other);
  std::string digits = std::to_string(-number);
  const std::size_t width = known ? known->whole.size() : pattern.width;
  if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
  return pattern.prefix + "-" + digits + pattern.suffix;
}

// Returns the files that are not among `selected` but have some number in place of the
// pattern's, with a hyphen before it as its sign.
std::vector<std::string> left_out(NameForm form, const std::vector<std::string>& selected,
                                  const std::vector<std::string>& names) {
  const std::size_t sign = sign_length_before(form.before, form.before.size());
  form.before.remove_suffix(sign);
  const std::set<std::string_view> known(selected.begin(), selected.end());
  std::vector<std::string> others;
  for (const std::string& name : names) {
    if (form.number_of(name) && !known.contains(name)) others.push_back(name);
  }
  std::sort(others.begin(), others.end());
  return others;
}

// Returns the pattern that also selects those.
std::string wider_pattern(const fs::path& pattern, const NameForm& form) {
  const std::size_t sign = sign_length_before(form.before, form.before.size());
  const std::string_view before = form.before.substr(0, form.before.size() - sign);
  return (pattern.parent_path() / (std::string(before) + "%g" + std::string(form.after)))
      .string();
}

void note_left_out(const fs::path& pattern, const NameForm& form,
                   const std::vector<std::string>& selected,
                   const std::vector<std::string>& names, FrameFiles& files) {
  const auto others = left_out(form, selected, names);
  if (others.empty()) return;
  files.notes.push_back(count_text(others.size(), "file is", "files are") +
                        " left out, whose numbers are written in another way: " + others[0] +
                        (others.size() > 1 ? " ..." : "") + "; " +
                        wider_pattern(pattern, form) + " takes every number");
}

InputResult<FrameFiles> select_any_number(const fs::path& pattern, const NameForm& form,
                                          const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& name : names) {
    if (form.number_of(name)) found.push_back(name);
  }
  if (found.empty()) {
    return InputError{pattern.string() + ": no such file; %g stands for a number such as 12, " +
                      "-007 or 1.25"};
  }
  const auto reading = read_numbers(form, found);
  if (reading->has_twice) return NameProblem(found, pattern.string()).twice(*reading);
  std::vector<std::string> paths;
  paths.reserve(found.size());
  for (const std::string& name : found) {
    paths.push_back((pattern.parent_path() / name).string());
  }
  FrameFiles files = with_notes(paths, *reading);
  note_left_out(pattern, form, found, names, files);
  return files;
}

// Returns files by number; there must be no gaps.
InputResult<FrameFiles> without_gaps(const fs::path& pattern, const NumberedName& numbered,
                                     const std::vector<NumberedFile>& found) {
  FrameFiles files;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string file = (pattern.parent_path() / found[i].name).string();
    const std::int64_t expected = found[0].number + static_cast<std::int64_t>(i);
    if (found[i].number < expected) {
      return InputError{file + ": has the same frame number as " + found[i - 1].name +
                        "; give each frame one file"};
    }
    if (found[i].number > expected) {
      return InputError{
          (pattern.parent_path() / name_with(numbered, expected, found[0].name)).string() +
          ": this frame is missing, though " + found[i].name +
          " exists; number the files without gaps"};
    }
    files.paths.push_back(file);
  }
  return files;
}

InputResult<FrameFiles> select_whole_numbers(const fs::path& pattern,
                                             const NumberedName& numbered,
                                             const std::vector<std::string>& names) {
  std::vector<NumberedFile> found;
  for (const std::string& name : names) {
    if (const auto number = number_of(numbered, name)) found.push_back({*number, name});
  }
  const NameForm form{numbered.prefix, numbered.suffix};
  if (found.empty()) {
    const auto others = left_out(form, {}, names);
    return InputError{
        pattern.string() + ": no such file, for example " + numbered.with(0) + " or " +
        numbered.with(1) +
        (others.empty() ? "" : "; " + wider_pattern(pattern, form) + " takes " + others[0])};
  }
  std::sort(found.begin(), found.end(), [](const NumberedFile& a, const NumberedFile& b) {
    return std::pair(a.number, a.name) < std::pair(b.number, b.name);
  });
  auto files = without_gaps(pattern, numbered, found);
  if (!files) return files;
  std::vector<std::string> selected;
  selected.reserve(found.size());
  for (const NumberedFile& file : found) selected.push_back(file.name);
  note_left_out(pattern, form, selected, names, *files);
  return files;
}

}  // namespace

InputResult<FrameFiles> select_frames(const std::string& pattern,
                                      const std::vector<std::string>& names) {
  const fs::path path(pattern);
  const std::string file_name = path.filename().string();
  if (const auto form = form_of_any_number(file_name)) {
    return select_any_number(path, *form, names);
  }
  const auto numbered = parse_pattern(file_name);
  if (numbered) return select_whole_numbers(path, *numbered, names);
  return InputError{
      pattern +
      ": expected one %d, %04d or #### (any width), or %g in the file name, as in "
      "walk_%04d.obj" +
      advice_on_pattern(file_name)};
}

}  // namespace rlpc
