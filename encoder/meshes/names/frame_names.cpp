#include "encoder/meshes/names/frame_names.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "common/files/ascii.h"
#include "encoder/meshes/names/name_number.h"
#include "encoder/meshes/names/name_order.h"
#include "encoder/meshes/names/name_problem.h"

namespace rlpc {

namespace {

// Returns the run of digits that starts at `pos`, without its leading zeros; moves `pos` past
// it.
std::string_view take_number(std::string_view text, std::size_t& pos) {
  while (pos < text.size() && text[pos] == '0') ++pos;
  const std::size_t first = pos;
  while (pos < text.size() && is_digit(text[pos])) ++pos;
  return text.substr(first, pos - first);
}

// Sorts names that differ only in one date and time.
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

std::string pattern_of(const NameForm& form) {
  return std::string(form.before) + "%g" + std::string(form.after);
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
      // Compare bytes, as char is signed on some machines.
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
  // Sort the input, so that its order does not depend on what lists it.
  std::sort(paths.begin(), paths.end(), natural_less);
  const NameOrder order = find_order(paths);
  const NameProblem problem(paths, where);
  if (order.pointless) return problem.pointless(*order.chosen, *order.pointless);
  if (order.chosen) {
    FrameFiles files = with_notes(paths, *order.chosen);
    if (order.unlikely) {
      files.notes.push_back("the hyphens before the numbers are read as separators; " +
                            pattern_of(order.unlikely->form) + " reads them as signs");
    }
    return files;
  }
  if (!order.rivals.empty()) return problem.ambiguous(order.rivals);
  if (auto dated = sort_dates(paths)) return std::move(*dated);
  if (order.twice && !order.doubtful) return problem.twice(*order.twice);
  return problem.different(order.doubtful ? &*order.doubtful : nullptr);
}

}  // namespace rlpc
