// Errors of the reader of OBJ files, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "encoder/meshes/obj/obj_reader.h"

namespace rlpc {

inline std::string obj_error(const std::string& text) {
  const auto mesh = parse_obj(text, "a.obj");
  return mesh ? "no error" : mesh.error().message;
}

inline void expect_obj_error(const std::string& text, const std::string& part) {
  const std::string error = obj_error(text);
  EXPECT_NE(error.find(part), std::string::npos) << text << "\n" << error;
}

}  // namespace rlpc
