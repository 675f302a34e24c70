// Expects that a parser fails, and how, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "common/result.h"

namespace rlpc {

template <class T>
void expect_error(const Result<T>& parsed, Errc code, const std::string& rule,
                  const std::string& element) {
  ASSERT_FALSE(parsed) << rule << ' ' << element;
  EXPECT_EQ(parsed.error().code, code) << element;
  EXPECT_EQ(parsed.error().rule, rule) << element;
  EXPECT_EQ(parsed.error().element, element);
}
template <class T>
void expect_invalid(const Result<T>& parsed, const std::string& rule,
                    const std::string& element) {
  expect_error(parsed, Errc::kInvalid, rule, element);
}

// bit_pos: as in the error.
template <class T>
void expect_error_at(const Result<T>& parsed, Errc code, const std::string& rule,
                     const std::string& element, std::uint64_t bit_pos) {
  expect_error(parsed, code, rule, element);
  if (parsed) return;
  EXPECT_EQ(parsed.error().bit_pos, bit_pos) << element;
}

}  // namespace rlpc
