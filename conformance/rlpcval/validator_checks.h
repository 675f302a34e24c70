// Checks that several headers share.
#pragma once

#include <cstdint>
#include <string>

#include "conformance/rlpcval/validator_elements.h"

namespace rlpc {

// Texts of what was expected, for reports.
std::string at_most(std::uint64_t limit);
std::string between(std::int64_t low, std::int64_t high);
std::string level_allows(std::uint32_t level_idc, std::uint64_t limit, const char* what);

bool check_alignment(ElementReader& r);

// 6.11 rest_order( exact ), which can have any values.
void read_rest_order(ElementReader& r);
// 6.11 layer_groups( ). Returns false if its end is not known.
bool check_layer_groups(ElementReader& r, std::uint32_t num_layers,
                        std::uint32_t& layer_groups);

}  // namespace rlpc
