// Closed-loop guidance at the edge of its reach is never notably worse than open-loop flight. The long test
// of the same name goes in small steps.
#include "tests/guidance_reach.h"

namespace dispersa::guidance_reach_test {
namespace {

TEST(GuidanceReach, IsNoWorseThanOpenLoopWhateverAMotorLacks) {
  const std::vector<ReachCase> cases = FlyReach({-5.0, -3.0, -1.0, 1.0, 4.0});
  PrintReach(cases);
  ExpectReach(cases);
}

}  // namespace
}  // namespace dispersa::guidance_reach_test
