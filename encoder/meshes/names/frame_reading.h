// Numbers of names read in one way, and checks whether names are written that way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/names/name_number.h"

namespace rlpc {

// Numbers of all names, read in one way, and the order of the frames.
struct Reading {
  NameForm form;
  std::vector<NameNumber> numbers;  // [name]
  std::vector<std::size_t> order;   // names, sorted by number
  bool has_fractions = false;
  bool has_twice = false;  // a number occurs twice
};

// Returns the reading of names that all have this form; it refers to their texts.
std::optional<Reading> read_numbers(const NameForm& form,
                                    const std::vector<std::string>& names);

enum class Signs : std::uint8_t {
  kSigns,     // or none
  kDoubtful,  // hyphens after a word before every number, that may be separators
  kUnlikely,  // the same, but more likely separators
  kNone,      // separators are taken for signs, or signs for separators
};

// Judges whether the hyphens of names are what the reading takes them for. A sign follows a
// separator, or is missing in some names; the hyphen of walk-1 follows a word. Both occur
// before times: there, a hyphen is more likely a separator if one of the times is 0.
Signs signs_of(const Reading& reading);

// Whether whole numbers are without padding, or padded with zeros to one width.
bool are_padded_alike(const Reading& reading);

// Whether a program may have written these digits as numbers with fractions, or as a counter
// that follows a point: a fixed number of digits, or no zeros that can be left out.
bool can_be_written(const Reading& reading);

// Reads the whole numbers of a reading as fractions, if they follow other digits and one or two
// other characters in place of a point: 0.25 in t_0_25 or t0p25.
std::optional<Reading> read_as_fractions(const Reading& reading);

// Whether the digits of the reading follow a point after other digits, as in v003.0001.
bool is_after_point(const Reading& reading);

// Whether "v" alone stands before the number: its whole part is a version.
bool follows_version(const Reading& reading);

}  // namespace rlpc
