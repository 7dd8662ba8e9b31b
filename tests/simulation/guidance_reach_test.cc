// Closed-loop guidance at the edge of its reach, with each stage's specific impulse in steps of 0.1 %.
#include "tests/guidance_reach.h"

namespace dispersa::guidance_reach_test {
namespace {

TEST(GuidanceReach, IsNoWorseThanOpenLoopInSmallSteps) {
  std::vector<double> percentages;
  for (int i = -50; i <= 50; ++i) percentages.push_back(0.1 * i);
  const std::vector<ReachCase> cases = FlyReach(percentages);
  PrintReach(cases);
  ExpectReach(cases);
}

}  // namespace
}  // namespace dispersa::guidance_reach_test
