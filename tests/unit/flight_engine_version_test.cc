#include "core/flight/engine_version.h"
#include "tests/test.h"

namespace dispersa::flight_engine_version_test {
namespace {

// tests/static/engine_version_test.py tests what the digits depend on.
TEST(EngineVersion, IsProjectVersionAndDigest) {
  EXPECT_THAT(EngineVersion(), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\\+[0-9a-f]{12}"));
}

}  // namespace
}  // namespace dispersa::flight_engine_version_test
