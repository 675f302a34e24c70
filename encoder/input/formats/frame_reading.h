// The numbers of names read in one way, and whether that way can be meant.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "encoder/input/formats/name_number.h"

namespace rlpc {

// The numbers of all names, read in one way, and the order of the frames.
struct Reading {
  NameForm form;
  std::vector<NameNumber> numbers;  // [name]
  std::vector<std::size_t> order;   // names by number
  bool has_fractions = false;
  bool has_twice = false;  // a number
};

// The reading of names that all have this form; it refers to their texts.
std::optional<Reading> read_numbers(const NameForm& form,
                                    const std::vector<std::string>& names);

// Whether signs and fractions are where frames have them: not hyphens after words, nor the
// frames of takes and versions after a point.
bool is_plausible(const Reading& reading);

// Which of two plausible readings of the same digits is meant; null: it cannot be known.
const Reading* choose_reading(const Reading& counted, const Reading& fractions);

std::vector<double> sorted_values(const Reading& reading);
// The smallest difference from one to the next, infinite without two; differences beyond
// `step`.
double smallest_step(const std::vector<double>& values);
std::size_t count_gaps(const std::vector<double>& values, double step);

}  // namespace rlpc
