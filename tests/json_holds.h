// JSON that holds what a test names, whatever it holds besides.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/test.h"

namespace dispersa {

/// Of an object each key of `part`, of anything else the same value.
template <typename Json>
testing::AssertionResult Holds(const Json& json, const std::string& part) {
  Json patched = json;
  patched.merge_patch(Json::parse(part));
  if (patched == json) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "it lacks " << Json::diff(json, patched).dump();
}

}  // namespace dispersa
