// Errors about the names of files, with patterns that resolve them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/names/name_order.h"

namespace rlpc {

// Describes what is wrong with names, and which of them fit which form.
class NameProblem {
 public:
  // Keeps references to both. where: the folder or pattern.
  NameProblem(const std::vector<std::string>& names, const std::string& where)
      : names_(names), where_(where) {}

  // The error that a reading gives two names one number.
  InputError twice(const Reading& reading) const;
  // The error that several readings can be meant, with different orders.
  InputError ambiguous(const std::vector<Reading>& rivals) const;
  // The error that whole numbers may be fractions, with something else in place of the point.
  InputError pointless(const Reading& counted, const Reading& fractions) const;
  // The error that no number is the frame number in all names; `doubtful`, if not null, has
  // all.
  InputError different(const Reading* doubtful) const;

 private:
  std::string shown(std::size_t name) const;
  std::string beginning(const std::vector<std::size_t>& order) const;
  std::string list(const std::vector<std::size_t>& left_out) const;
  std::string pattern(const NameForm& form, const std::vector<std::size_t>& members) const;
  std::pair<NameForm, std::vector<std::size_t>> largest_group() const;

  const std::vector<std::string>& names_;
  const std::string& where_;
};

}  // namespace rlpc
