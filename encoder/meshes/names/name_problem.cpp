#include "encoder/meshes/names/name_problem.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>

#include "common/files/messages.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

std::string with(const NameForm& form, const std::string& conversion) {
  return std::string(form.before) + conversion + std::string(form.after);
}

bool has_whole_number(const NameForm& form, const std::string& name) {
  const auto number = form.number_of(name);
  return number && number->fraction.empty();
}

}  // namespace

InputError NameProblem::twice(const Reading& reading) const {
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

InputError NameProblem::ambiguous(const std::vector<Reading>& rivals) const {
  std::string text = where_ + ": the names can be read in " +
                     (rivals.size() == 2 ? "two" : std::to_string(rivals.size())) +
                     " orders; choose with a pattern: ";
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    text += (i > 0 ? ", or " : "") + pattern(rivals[i].form, rivals[i].order) + " for " +
            beginning(rivals[i].order);
  }
  return {text};
}

InputError NameProblem::pointless(const Reading& counted, const Reading& fractions) const {
  return {where_ + ": the names can be read in two orders: as fractions, " +
          beginning(fractions.order) + ", which need a point, as in t_0.25.obj; or as whole " +
          "numbers, " + beginning(counted.order) + ", which the pattern " +
          pattern(counted.form, counted.order) + " chooses"};
}

InputError NameProblem::different(const Reading* doubtful) const {
  const auto [form, members] = largest_group();
  const std::string all =
      doubtful == nullptr ? "" : with(doubtful->form, "%g") + " for all, as numbers";
  if (members.size() < 2) {
    return {where_ + ": the names of the " + std::to_string(names_.size()) +
            " files do not differ in one number, that of the frame: " + list({}) +
            "; move files that are not frames elsewhere, or name the frames as in "
            "walk_0001.obj" +
            (all.empty() ? "" : ", or choose with the pattern " + all)};
  }
  const std::size_t others = names_.size() - members.size();
  return {where_ + ": " + std::to_string(members.size()) + " files are named as in " +
          shown(members[0]) + ", but " + count_text(others, "file is", "files are") +
          " not: " + list(members) + "; move what is not a frame elsewhere, or choose with " +
          "a pattern such as " + pattern(form, members) + (all.empty() ? "" : ", or " + all)};
}

std::string NameProblem::shown(std::size_t name) const {
  return fs::path(names_[name]).filename().string();
}

// Returns the first names of an order.
std::string NameProblem::beginning(const std::vector<std::size_t>& order) const {
  constexpr std::size_t kCount = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kCount, order.size()); ++i) {
    text += (i > 0 ? ", " : "") + shown(order[i]);
  }
  return text + (order.size() > kCount ? " ..." : "");
}

// Lists the first of the names that are not in `left_out`, which ascends.
std::string NameProblem::list(const std::vector<std::size_t>& left_out) const {
  constexpr std::size_t kMaxListed = 5;
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (std::binary_search(left_out.begin(), left_out.end(), i)) continue;
    if (++count <= kMaxListed) text += (count > 1 ? ", " : "") + shown(i);
  }
  return text +
         (count > kMaxListed ? " and " + std::to_string(count - kMaxListed) + " more" : "");
}

// Returns a pattern that selects these names, which have the form. Patterns for whole numbers
// allow no gaps.
std::string NameProblem::pattern(const NameForm& form,
                                 const std::vector<std::size_t>& members) const {
  const std::size_t width = form.number_of(names_[members[0]])->whole.size();
  bool is_padded = true;
  bool is_plain = true;
  double min = 0.0;
  double max = 0.0;
  for (const std::size_t i : members) {
    const NameNumber n = *form.number_of(names_[i]);
    const bool is_whole = n.sign == '\0' && n.fraction.empty();
    const bool has_zeros = n.whole.size() > 1 && n.whole[0] == '0';
    is_padded = is_padded && is_whole &&
                (n.whole.size() == width || (n.whole.size() > width && !has_zeros));
    is_plain = is_plain && is_whole && !has_zeros;
    min = i == members[0] ? n.value() : std::min(min, n.value());
    max = i == members[0] ? n.value() : std::max(max, n.value());
  }
  if (max - min >= static_cast<double>(members.size())) return with(form, "%g");
  return with(form, is_plain ? "%d" : is_padded ? "%0" + std::to_string(width) + "d" : "%g");
}

// Returns the form that most names have with a whole number, and these names, ascending.
std::pair<NameForm, std::vector<std::size_t>> NameProblem::largest_group() const {
  constexpr std::size_t kEnough = 1000;  // number of names; the others change little
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

}  // namespace rlpc
