// Which of a coordinator's participants serves a peer, and when it may join.
#include "services/transport/doors.h"

#include "tests/test.h"

namespace dispersa::doors_test {

Greeting From(std::size_t number, const std::string& name = kWorkerParticipant) {
  Greeting greeting{.name = name};
  greeting.from[0] = static_cast<std::uint8_t>(number >> 8);
  greeting.from[1] = static_cast<std::uint8_t>(number);
  return greeting;
}

/// Without keys, and with them.
class DoorsTest : public testing::TestWithParam<bool> {
 protected:
  /// Whether it was let in, and then joined.
  bool Join(std::size_t number, double now_s) {
    if (!doors_.DoorOf(From(number), now_s).door) return false;
    doors_.Found(From(number).from);
    doors_.Joined(From(number).from);
    return true;
  }

  const std::size_t most_ = GetParam() ? Doors::kMostWithKeys : Doors::kMost;
  Doors doors_{"127.0.0.1", GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Keys, DoorsTest, testing::Bool());

TEST_P(DoorsTest, FewJoinAtATimeAndTheOthersLater) {
  doors_.Open(7405);
  for (std::size_t i = 0; i < Doors::kAtOnce; ++i) EXPECT_EQ(doors_.DoorOf(From(i), 0.0).door, 0) << i;
  const auto next = doors_.DoorOf(From(100), 0.0);
  EXPECT_FALSE(next.door);
  EXPECT_FALSE(next.is_full) << "it waits for others, not for a place";
  EXPECT_EQ(doors_.DoorOf(From(3), 0.0).door, 0) << "whoever is in stays in";
  EXPECT_EQ(doors_.DoorOf(From(200, "dispersa-client"), 0.0).door, 0) << "a client does not wait for workers";
  doors_.Found(From(3).from);
  EXPECT_FALSE(doors_.DoorOf(From(100), 0.0).door) << "it is found, but its handshake goes on";
  doors_.Joined(From(3).from);
  EXPECT_EQ(doors_.DoorOf(From(100), 0.0).door, 0);
  EXPECT_FALSE(doors_.DoorOf(From(101), 0.0).door);
  EXPECT_EQ(doors_.DoorOf(From(101), Doors::kJoin_s).door, 0) << "nobody holds up the others for ever";
}

TEST_P(DoorsTest, NoDoorHasMorePeersThanPlaces) {
  std::map<int, std::size_t> taken;
  std::size_t let_in = 0;
  for (std::size_t open = 1; open <= most_; ++open) {
    doors_.Open(7405);
    for (std::size_t i = 0; i < Doors::kPlaces; ++i) let_in += Join(let_in, 0.0) ? 1 : 0;
    EXPECT_EQ(let_in, open * Doors::kForWorkers);
    EXPECT_EQ(doors_.IsShort(), open < most_) << open;
    EXPECT_EQ(doors_.DoorOf(From(let_in), 0.0).is_full, open == most_) << open;
    EXPECT_TRUE(doors_.DoorOf(From(9000 + open, "dispersa-client"), 0.0).door)
        << "clients have places of their own";
  }
  for (std::size_t i = 0; i < let_in; ++i) ++taken[*doors_.DoorOf(From(i), 0.0).door];
  for (const auto& [door, workers] : taken) EXPECT_EQ(workers, Doors::kForWorkers) << door;
  doors_.Gone(From(7).from);
  EXPECT_TRUE(Join(9900, 0.0)) << "a place is free again";
}

TEST_P(DoorsTest, ClientsAloneHaveDoorsOpenedToo) {
  for (std::size_t client = 0; client < most_ * Doors::kForOthers; ++client) {
    if (doors_.IsShort()) doors_.Open(7405);
    ASSERT_TRUE(doors_.DoorOf(From(client, "dispersa-client"), 0.0).door) << client;
    doors_.Found(From(client).from);
    doors_.Joined(From(client).from);
  }
  EXPECT_TRUE(doors_.DoorOf(From(9999, "dispersa-client"), 0.0).is_full);
  EXPECT_TRUE(Join(1, 0.0)) << "workers have their own";
}

TEST_P(DoorsTest, APeerThatTheMiddlewareDoesNotFindLosesItsPlace) {
  doors_.Open(7405);
  for (std::size_t i = 0; i < Doors::kForWorkers; ++i)
    ASSERT_TRUE(doors_.DoorOf(From(i), i < Doors::kAtOnce ? 0.0 : Doors::kJoin_s).door) << i;
  doors_.Found(From(0).from);
  EXPECT_FALSE(doors_.DoorOf(From(100), 2 * Doors::kJoin_s).door) << "all places are taken";
  for (std::size_t i = 0; i + 1 < Doors::kAtOnce; ++i)
    EXPECT_TRUE(doors_.DoorOf(From(100 + i), 0.1 + Doors::kFind_s).door) << i;
  EXPECT_FALSE(doors_.DoorOf(From(200), 0.1 + Doors::kFind_s).door) << "the first one was found and stays";
}

TEST_P(DoorsTest, FarewellsAndOtherCoordinatorsTakeNoPlace) {
  doors_.Open(7405);
  Greeting farewell = From(1);
  farewell.is_farewell = true;
  EXPECT_FALSE(doors_.DoorOf(farewell, 0.0).door);
  EXPECT_FALSE(doors_.DoorOf(From(2, kCoordinatorParticipant), 0.0).door);
  EXPECT_TRUE(doors_.DoorOf(From(1), 0.0).door);
  EXPECT_TRUE(doors_.DoorOf(farewell, 0.0).door) << "its door has to know that it leaves";
}

}  // namespace dispersa::doors_test
