#include "encoder/input/formats/frame_names.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "common/io/messages.h"
#include "common/io/numbered_name.h"
#include "encoder/input/formats/frame_reading.h"
#include "encoder/input/formats/name_number.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The run of digits that starts at `pos`, without its leading zeros; moves `pos` past it.
std::string_view take_number(std::string_view text, std::size_t& pos) {
  while (pos < text.size() && text[pos] == '0') ++pos;
  const std::size_t first = pos;
  while (pos < text.size() && is_digit(text[pos])) ++pos;
  return text.substr(first, pos - first);
}

// What is wrong with names, and which of them fit which form.
class NameProblem {
 public:
  NameProblem(const std::vector<std::string>& names, const std::string& where)
      : names_(names), where_(where) {}

  InputError twice(const Reading& reading) const {
    for (std::size_t i = 1; i < names_.size(); ++i) {
      const std::size_t a = reading.order[i - 1];
      const std::size_t b = reading.order[i];
      if (is_less(reading.numbers[a], reading.numbers[b])) continue;
      return {where_ + ": " + shown(a) + " and " + shown(b) +
              " have the same frame number; give each frame one file, or choose files with a "
              "pattern such as " +
              pattern(reading.form, {a})};
    }
    return {where_};
  }

  InputError ambiguous(const Reading& counted, const Reading& fractions) const {
    const std::size_t last = counted.order.back();
    return {where_ + ": " + shown(last) + " may be frame " +
            std::string(counted.numbers[last].whole) + " or a part of a frame, " +
            text(fractions.numbers[last]) + "; choose with a pattern, " +
            pattern(counted.form, counted.order) + " or " + with(fractions.form, "%g")};
  }

  // No number is that of the frame in all names.
  InputError different() const {
    const auto [form, members] = largest_group();
    if (members.size() < 2) {
      return {where_ + ": the names of the " + std::to_string(names_.size()) +
              " files do not differ in one number, that of the frame: " + list({}) +
              "; move files that are not frames elsewhere, or name the frames as in "
              "walk_0001.obj"};
    }
    const std::size_t others = names_.size() - members.size();
    return {where_ + ": " + std::to_string(members.size()) + " files are named as in " +
            shown(members[0]) + ", but " + count_text(others, "file is", "files are") +
            " not: " + list(members) + "; move what is not a frame elsewhere, or choose with " +
            "a pattern such as " + pattern(form, members)};
  }

 private:
  std::string shown(std::size_t name) const {
    return fs::path(names_[name]).filename().string();
  }
  static std::string text(const NameNumber& n) {
    return std::string(n.whole) + "." + std::string(n.fraction);
  }

  // The names that are not `left_out`, which ascends; the first of them.
  std::string list(const std::vector<std::size_t>& left_out) const {
    constexpr std::size_t kMost = 5;
    std::string text;
    std::size_t count = 0;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (std::binary_search(left_out.begin(), left_out.end(), i)) continue;
      if (++count <= kMost) text += (count > 1 ? ", " : "") + shown(i);
    }
    return text + (count > kMost ? " and " + std::to_string(count - kMost) + " more" : "");
  }

  static std::string with(const NameForm& form, const std::string& conversion) {
    return std::string(form.before) + conversion + std::string(form.after);
  }

  // A pattern that selects these names; they have the form.
  std::string pattern(const NameForm& form, const std::vector<std::size_t>& members) const {
    const std::size_t width = form.number_of(names_[members[0]])->whole.size();
    bool is_padded = true;
    bool is_plain = true;
    for (const std::size_t i : members) {
      const NameNumber n = *form.number_of(names_[i]);
      const bool is_whole = n.sign == '\0' && n.fraction.empty();
      const bool has_zeros = n.whole.size() > 1 && n.whole[0] == '0';
      is_padded = is_padded && is_whole &&
                  (n.whole.size() == width || (n.whole.size() > width && !has_zeros));
      is_plain = is_plain && is_whole && !has_zeros;
    }
    return with(form, is_plain ? "%d" : is_padded ? "%0" + std::to_string(width) + "d" : "%g");
  }

  static bool has_whole_number(const NameForm& form, const std::string& name) {
    const auto number = form.number_of(name);
    return number && number->fraction.empty();
  }

  // The form that most names have with a whole number, and these names, ascending.
  std::pair<NameForm, std::vector<std::size_t>> largest_group() const {
    constexpr std::size_t kEnough = 1000;  // names: the others change little
    std::map<std::pair<std::string_view, std::string_view>, std::vector<std::size_t>> groups;
    std::pair<NameForm, std::vector<std::size_t>> best;
    for (std::size_t i = 0; i < names_.size() && i < kEnough; ++i) {
      for (const NameForm& form : forms_of(names_[i])) {
        if (!has_whole_number(form, names_[i])) continue;
        auto& group = groups[{form.before, form.after}];
        if (!group.empty() && group.back() == i) continue;
        group.push_back(i);
        if (group.size() > best.second.size()) best = {form, group};
      }
    }
    if (best.second.empty()) return best;
    best.second.clear();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (has_whole_number(best.first, names_[i])) best.second.push_back(i);
    }
    return best;
  }

  const std::vector<std::string>& names_;
  const std::string& where_;
};

FrameFiles in_order(const std::vector<std::string>& paths,
                    const std::vector<std::size_t>& order) {
  FrameFiles files;
  for (const std::size_t i : order) files.paths.push_back(paths[i]);
  return files;
}

// Adds notes about gaps between numbers.
FrameFiles with_notes(const std::vector<std::string>& paths, const Reading& reading) {
  FrameFiles files = in_order(paths, reading.order);
  const auto values = sorted_values(reading);
  if (values.size() < 2) return files;
  const double smallest = smallest_step(values);
  const double step = reading.has_fractions ? std::min(smallest, 1.0) : 1.0;
  const std::size_t gaps = count_gaps(values, step);
  if (gaps == 0) return files;
  if (gaps == values.size() - 1 && gaps > 1 && count_gaps(values, smallest) == 0) {
    files.notes.push_back("the numbers of the frames go up in steps of " +
                          std::to_string(std::llround(smallest)) +
                          "; each file is one frame, without gaps");
    return files;
  }
  std::size_t first = 1;
  while (values[first] - values[first - 1] <= 1.1 * step) ++first;
  const std::string place = files.paths[first - 1] + " and " + files.paths[first];
  files.notes.push_back(gaps == 1 ? "there is no frame between " + place + "; the gap is closed"
                                  : "the numbers of the frames have " + std::to_string(gaps) +
                                        " gaps, the first between " + place +
                                        "; the gaps are closed");
  return files;
}

// Names that differ in nothing but one date and time.
std::optional<FrameFiles> sort_dates(const std::vector<std::string>& paths) {
  std::vector<DatedName> dates;
  for (const std::string& path : paths) {
    auto date = find_date(path);
    if (!date || (!dates.empty() && date->form != dates[0].form)) return std::nullopt;
    dates.push_back(std::move(*date));
  }
  std::vector<std::size_t> order(paths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return dates[a].digits < dates[b].digits; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (dates[order[i - 1]].digits == dates[order[i]].digits) return std::nullopt;
  }
  return in_order(paths, order);
}

// What a pattern with %g stands for.
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

// The whole number of a name that a pattern with %d selects. Of negative ones, the width may
// include the sign, as in C, or not.
std::optional<std::int64_t> number_of(const NumberedName& pattern, const std::string& name) {
  constexpr std::uint64_t kMost = INT64_MAX;
  if (const auto number = pattern.number_of(name)) {
    return *number <= kMost ? std::optional(static_cast<std::int64_t>(*number)) : std::nullopt;
  }
  const auto number = NameForm{pattern.prefix, pattern.suffix}.number_of(name);
  if (!number || number->sign != '-' || !number->fraction.empty()) return std::nullopt;
  constexpr std::size_t kMaxDigits = 18;
  const std::size_t digits = number->significant().size();
  if (digits == 0 || digits > kMaxDigits) return std::nullopt;
  const std::size_t written = number->whole.size();
  if (written != std::max(digits, pattern.width) &&
      written + 1 != std::max(digits + 1, pattern.width)) {
    return std::nullopt;
  }
  std::int64_t value = 0;
  for (const char c : number->significant()) value = 10 * value + (c - '0');
  return -value;
}

// The name of a frame that is missing, with signs as another has them.
std::string name_with(const NumberedName& pattern, std::int64_t number,
                      const std::string& other) {
  if (number >= 0) return pattern.with(static_cast<std::uint64_t>(number));
  const auto known = NameForm{pattern.prefix, pattern.suffix}.number_of(other);
  std::string digits = std::to_string(-number);
  const std::size_t width = known ? known->whole.size() : pattern.width;
  if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
  return pattern.prefix + "-" + digits + pattern.suffix;
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
  for (std::string& name : found) name = (pattern.parent_path() / name).string();
  return with_notes(found, *reading);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view m = take_number(a, i);
      const std::string_view n = take_number(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      // As bytes: char is signed on some machines.
      if (a[i] != b[j])
        return static_cast<std::uint8_t>(a[i]) < static_cast<std::uint8_t>(b[j]);
      ++i;
      ++j;
    }
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a < b;  // equal except for leading zeros
}

InputResult<FrameFiles> sort_frames(std::vector<std::string> paths, const std::string& where) {
  if (paths.size() == 1) return FrameFiles{std::move(paths)};
  // The same order of the input, whatever lists it.
  std::sort(paths.begin(), paths.end(), natural_less);
  const NameProblem problem(paths, where);
  std::optional<Reading> counted;
  std::optional<Reading> fractions;
  std::optional<Reading> twice;
  for (const NameForm& form : forms_of(paths[0])) {
    auto reading = read_numbers(form, paths);
    if (!reading || !is_plausible(*reading)) continue;
    auto& place = reading->has_twice ? twice : reading->has_fractions ? fractions : counted;
    if (!place) place = std::move(reading);
  }
  if (counted && fractions) {
    const Reading* const chosen = choose_reading(*counted, *fractions);
    if (chosen == nullptr) return problem.ambiguous(*counted, *fractions);
    return with_notes(paths, *chosen);
  }
  if (counted || fractions) return with_notes(paths, counted ? *counted : *fractions);
  if (auto dated = sort_dates(paths)) return std::move(*dated);
  if (twice) return problem.twice(*twice);
  return problem.different();
}

InputResult<FrameFiles> select_frames(const std::string& pattern,
                                      const std::vector<std::string>& names) {
  const fs::path path(pattern);
  const std::string file_name = path.filename().string();
  if (const auto form = form_of_any_number(file_name)) {
    return select_any_number(path, *form, names);
  }
  const auto numbered = parse_pattern(file_name);
  if (!numbered) {
    return InputError{pattern +
                      ": expected one %d, %04d (any width) or %g in the file name, as in "
                      "walk_%04d.obj"};
  }
  std::vector<NumberedFile> found;
  for (const std::string& name : names) {
    if (const auto number = number_of(*numbered, name)) found.push_back({*number, name});
  }
  if (found.empty()) {
    return InputError{pattern + ": no such file, for example " + numbered->with(0) + " or " +
                      numbered->with(1)};
  }
  std::sort(found.begin(), found.end(), [](const NumberedFile& a, const NumberedFile& b) {
    return std::pair(a.number, a.name) < std::pair(b.number, b.name);
  });
  FrameFiles files;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string file = (path.parent_path() / found[i].name).string();
    const std::int64_t expected = found[0].number + static_cast<std::int64_t>(i);
    if (found[i].number < expected) {
      return InputError{file + ": has the same frame number as " + found[i - 1].name +
                        "; give each frame one file"};
    }
    if (found[i].number > expected) {
      return InputError{
          (path.parent_path() / name_with(*numbered, expected, found[0].name)).string() +
          ": this frame is missing, though " + found[i].name +
          " exists; number the files without gaps"};
    }
    files.paths.push_back(file);
  }
  return files;
}

}  // namespace rlpc
