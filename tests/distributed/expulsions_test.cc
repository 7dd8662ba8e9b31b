// Who is expelled for whose lies, and who comes back.
#include "services/coordinator/expulsions.h"

#include <nlohmann/json.hpp>

#include "tests/test.h"

namespace dispersa::expulsions_test {

std::vector<std::string> NamesOf(const ExpulsionMap& expelled) {
  std::vector<std::string> names;
  for (const auto& [name, expulsion] : expelled) names.push_back(name);
  return names;
}

ExpulsionMap With(ExpulsionMap expelled, const std::string& worker, const std::string& host) {
  for (const auto& each : Sentence(expelled, worker, host, "why")) expelled.insert(each);
  return expelled;
}

TEST(Expulsions, WithoutKeysOnlyProcesses) {
  ExpulsionMap expelled;
  for (const char* worker : {"a1", "b2", "c3", "d4"}) expelled = With(expelled, worker, "host");
  EXPECT_THAT(NamesOf(expelled), ElementsAre("a1", "b2", "c3", "d4"));
  EXPECT_EQ(WhyExpelled(expelled, "e5", "host"), std::nullopt);
}

// A liar may say another host each time.
TEST(Expulsions, ThreeProcessesOnThreeHostsAreTheKeys) {
  ExpulsionMap expelled = With(With({}, "node1_a", "h1"), "node1_b", "h2");
  EXPECT_THAT(NamesOf(expelled), ElementsAre("node1_a", "node1_b"));
  EXPECT_EQ(WhyExpelled(expelled, "node1_c", "h1"), std::nullopt);
  expelled = With(expelled, "node1_c", "h3");
  EXPECT_THAT(NamesOf(expelled), ElementsAre("node1", "node1_a", "node1_b", "node1_c"));
  EXPECT_EQ(WhyExpelled(expelled, "node1_d", "h4"),
            "3 of its processes returned false results, the last one: why");
  EXPECT_EQ(WhyExpelled(expelled, "node10_d", "h4"), std::nullopt);
}

TEST(Expulsions, ALieOfAnExpelledProcessCountsOnce) {
  const ExpulsionMap expelled = With({}, "node1_a", "h");
  EXPECT_THAT(NamesOf(With(With(expelled, "node1_a", "h"), "node1_a", "h")), ElementsAre("node1_a"));
}

TEST(Expulsions, AHostIsThatOfTheKeysAlone) {
  const ExpulsionMap expelled = With(With({}, "node1_a", "h"), "node1_b", "h");
  EXPECT_THAT(NamesOf(expelled), ElementsAre("node1@h", "node1_a", "node1_b"));
  EXPECT_TRUE(WhyExpelled(expelled, "node1_c", "h"));
  EXPECT_FALSE(WhyExpelled(expelled, "node1_c", "g"));
  EXPECT_FALSE(WhyExpelled(expelled, "node2_c", "h"));
  EXPECT_THAT(NamesOf(With(With(With({}, "a_1", "h"), "b_2", "h"), "c_3", "h")),
              ElementsAre("a_1", "b_2", "c_3"));
}

TEST(Expulsions, WhoIsReadmittedBeginsAnew) {
  ExpulsionMap expelled = With(With({}, "node1_a", "h"), "node1_b", "h");
  EXPECT_THAT(Readmit(&expelled, "node2"), IsEmpty());
  EXPECT_THAT(Readmit(&expelled, "node"), IsEmpty());
  EXPECT_THAT(Readmit(&expelled, "node1@g"), IsEmpty());
  EXPECT_THAT(Readmit(&expelled, "node1@h"), ElementsAre("node1@h", "node1_a", "node1_b"));
  EXPECT_THAT(Readmit(&expelled, "node1@h"), IsEmpty());
  EXPECT_EQ(CountExpelled(expelled), 0u);
  EXPECT_TRUE(WhyExpelled(expelled, "node1_a", "h")) << "its results are not trusted";
  EXPECT_FALSE(WhyExpelled(expelled, "node1_c", "h"));
  EXPECT_THAT(NamesOf(Sentence(expelled, "node1_c", "h", "why")), ElementsAre("node1_c"));
}

TEST(Expulsions, FilesAreReadAsTheyAreWritten) {
  ExpulsionMap expelled = With(With({}, "node1_a", "h"), "node1_b", "h");
  Readmit(&expelled, "node1_a");
  EXPECT_EQ(ReadExpulsions(SealedText(expelled)), expelled);
  EXPECT_EQ(ReadExpulsions(R"({"node1": "why"})"), (ExpulsionMap{{"node1", {"why"}}}))
      << "of an earlier version";
  const ExpulsionMap odd = {{"version", {"no number"}}};
  EXPECT_EQ(ReadExpulsions(R"({"version": "no number"})"), odd) << "a worker's name";
  EXPECT_EQ(ReadExpulsions(SealedText(odd)), odd);
  EXPECT_EQ(ErrorOf<std::runtime_error>([] { ReadExpulsions("{\"a\": 1}"); }), "lacks a member");
}

}  // namespace dispersa::expulsions_test
