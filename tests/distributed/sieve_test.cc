// The limits of the sieve: the largest datagram that passes, and the smallest that does not.
#include "services/transport/sieve.h"

#include "tests/test.h"

namespace dispersa::sieve_test {

using Bytes = std::vector<std::uint8_t>;

/// Numbers in either byte order, as a submessage's flag says.
class Body {
 public:
  explicit Body(bool little_endian) : little_(little_endian) {}
  Body& U16(std::uint16_t value) { return Put(value, 2); }
  Body& U32(std::uint32_t value) { return Put(value, 4); }
  Body& Number(std::uint64_t value) {
    U32(static_cast<std::uint32_t>(value >> 32));
    return U32(static_cast<std::uint32_t>(value));
  }
  Body& Fill(std::size_t size) {
    bytes.resize(size);
    return *this;
  }
  Bytes bytes;

 private:
  Body& Put(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) {
      const int shift = 8 * (little_ ? i : size - 1 - i);
      bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    }
    return *this;
  }
  bool little_;
};

struct Part {
  std::uint8_t kind;
  Body body;
  bool little_endian = true;
  bool to_the_end = false;  ///< its length is 0: whatever follows in the packet
  std::uint8_t flags = 0;   ///< besides the byte order
};

Bytes Packet(const std::vector<Part>& parts) {
  Bytes bytes = {'R', 'T', 'P', 'S', 2, 3, 1, 15};
  bytes.resize(20);
  for (const Part& part : parts) {
    const std::size_t size = part.to_the_end ? 0 : part.body.bytes.size();
    bytes.insert(bytes.end(), {part.kind, static_cast<std::uint8_t>(part.little_endian | part.flags)});
    Body length(part.little_endian);
    length.U16(static_cast<std::uint16_t>(size));
    bytes.insert(bytes.end(), length.bytes.begin(), length.bytes.end());
    bytes.insert(bytes.end(), part.body.bytes.begin(), part.body.bytes.end());
  }
  return bytes;
}
std::string Harm(const std::vector<Part>& parts, bool with_keys = false) {
  const Bytes bytes = Packet(parts);
  const char* harm = HarmOf(bytes.data(), bytes.size(), with_keys);
  return harm == nullptr ? "none" : harm;
}

constexpr std::uint8_t kAckNack = 0x06, kHeartbeat = 0x07, kInfoTime = 0x09, kData = 0x15, kFragment = 0x16;
constexpr std::uint32_t kTopicWriter = 0x00000103, kDiscoveryWriter = 0x000003c2;

/// DATA or DATA_FRAG up to where they differ. `offset`: from behind itself to the payload.
Body Head(bool little_endian, std::uint16_t offset) {
  Body body(little_endian);
  return body.U16(0).U16(offset).U32(0).U32(0).Number(1);
}
Part Fragment(std::uint32_t number, std::uint16_t size, std::uint32_t sample, bool little_endian = true) {
  return {kFragment, Head(little_endian, 28).U32(number).U16(1).U16(size).U32(sample).Fill(64),
          little_endian};
}
Part Heartbeat(std::uint64_t first, std::uint64_t last, bool little_endian = true) {
  Body body(little_endian);
  return {kHeartbeat, body.U32(0).U32(0).Number(first).Number(last).U32(1), little_endian};
}
Part AckNack(std::uint64_t base, std::uint32_t bits, std::uint32_t writer = 0) {
  Body body(true);
  body.U32(0).U32(__builtin_bswap32(writer));
  return {kAckNack, body.Number(base).U32(bits).Fill(24)};
}
/// Something harmless in front.
Part Time() { return {kInfoTime, Body(true).Fill(8)}; }

TEST(SieveLimits, TheFirstByteOfAFragmentIsOneOfItsSample) {
  const char outside[] = "a fragment outside of its sample";
  for (const bool little_endian : {true, false}) {
    EXPECT_EQ(Harm({Fragment(3, 1000, 2001, little_endian)}), "none");
    EXPECT_EQ(Harm({Fragment(3, 1000, 2000, little_endian)}), outside) << "it begins where the sample ends";
    EXPECT_EQ(Harm({Fragment(1, 1000, 0, little_endian)}), outside);
  }
}

TEST(SieveLimits, ASampleHasAtMost1MiBAndItsHeader) {
  EXPECT_EQ(Harm({Fragment(1, 65000, (1 << 20) + 1024)}), "none");
  EXPECT_EQ(Harm({Fragment(1, 65000, (1 << 20) + 1025)}), "a sample of more than 1 MiB");
}

TEST(SieveLimits, ASubmessageToThePacketsEndIsJudgedAsAnyOther) {
  Part last = Fragment(3, 1000, 2000);
  last.to_the_end = true;
  EXPECT_EQ(Harm({Time(), last}), "a fragment outside of its sample");
  last = Fragment(3, 1000, 2001);
  last.to_the_end = true;
  EXPECT_EQ(Harm({Time(), last}), "none");
  Part empty_time{kInfoTime, Body(true)};
  EXPECT_EQ(Harm({empty_time, Heartbeat(1, 1 << 30)}), "a HEARTBEAT of an absurd range")
      << "a time may be empty: what follows is judged";
}

TEST(SieveLimits, APayloadBeginsWithinItsSubmessage) {
  for (const bool little_endian : {true, false}) {
    const auto data = [&](std::uint16_t offset) {
      return Harm({{kData, Head(little_endian, offset).Fill(24), little_endian}});
    };
    EXPECT_EQ(data(20), "none");
    EXPECT_EQ(data(21), "a DATA that is cut off");
    EXPECT_EQ(data(0xffff), "a DATA that is cut off");
    Part fragment = Fragment(1, 1000, 2000, little_endian);
    const auto with_offset = [&](std::uint16_t offset) {
      const Bytes head = Head(little_endian, offset).bytes;
      std::copy(head.begin(), head.end(), fragment.body.bytes.begin());
      return Harm({fragment});
    };
    EXPECT_EQ(with_offset(60), "none");
    EXPECT_EQ(with_offset(61), "a DATA_FRAG that is cut off");
  }
}

TEST(SieveLimits, AHeartbeatSaysAShortRangeOfPossibleNumbers) {
  const char absurd[] = "a HEARTBEAT of an absurd range";
  for (const bool little_endian : {true, false}) {
    EXPECT_EQ(Harm({Heartbeat(1, 1 << 21, little_endian)}), "none");
    EXPECT_EQ(Harm({Heartbeat(1, (1 << 21) + 1, little_endian)}), absurd);
    EXPECT_EQ(Harm({Heartbeat(9, 8, little_endian)}), "none") << "none is kept";
    EXPECT_EQ(Harm({Heartbeat(9, 7, little_endian)}), absurd);
    const std::uint64_t large = std::uint64_t{1} << 62;
    EXPECT_EQ(Harm({Heartbeat(large - 1, large - 1, little_endian)}), "none");
    EXPECT_EQ(Harm({Heartbeat(large, large, little_endian)}), absurd);
  }
}

TEST(SieveLimits, AnAckNackHasAtMost256Bits) {
  EXPECT_EQ(Harm({AckNack(1, 256)}), "none");
  EXPECT_EQ(Harm({AckNack(1, 257)}), "an ACKNACK out of bounds");
  EXPECT_EQ(Harm({AckNack(std::uint64_t{1} << 62, 0)}), "an ACKNACK out of bounds");
}

constexpr std::uint8_t kQos = 2, kPayload = 4;

/// An announcement with a name of `length` bytes, its end included, of which it has those of "worker", and a
/// token of its keys or another parameter.
Part Announcement(bool little_endian, std::uint8_t flags, std::uint32_t length = 7,
                  std::uint16_t token = 0x1002) {
  Body body(little_endian);
  body.U16(0).U16(16).U32(0).U32(0).Number(1);
  const std::uint32_t writer = 0xc2000100;  // in the order of this machine
  std::memcpy(body.bytes.data() + 8, &writer, 4);
  if ((flags & kQos) != 0) body.U16(0x800f).U16(4).U32(0x62).U16(1).U16(0);
  const std::uint8_t encapsulation[] = {0, static_cast<std::uint8_t>(2 + little_endian), 0, 0};
  body.bytes.insert(body.bytes.end(), std::begin(encapsulation), std::end(encapsulation));
  body.U16(0x15).U16(4).U32(2).U16(token).U16(4).U32(0).U16(0x62).U16(12).U32(length);
  for (const char letter : {'w', 'o', 'r', 'k', 'e', 'r', '\0', '\0'}) body.bytes.push_back(letter);
  return {kData, body.U16(1).U16(0), little_endian, false, flags};
}
std::optional<Greeting> GreetingOf(const std::vector<Part>& parts) {
  Bytes bytes = Packet(parts);
  for (std::size_t i = 0; i < 12; ++i) bytes[8 + i] = static_cast<std::uint8_t>(i);
  return GreetingIn(bytes.data(), bytes.size());
}

TEST(Greetings, AreThoseOfParticipantsWithTheirNames) {
  for (const bool little_endian : {true, false}) {
    for (const std::uint8_t qos : {std::uint8_t{0}, kQos}) {
      const std::uint8_t flags = kPayload | qos;
      const auto greeting = GreetingOf({Time(), Announcement(little_endian, flags)});
      ASSERT_TRUE(greeting);
      EXPECT_EQ(greeting->name, "worker") << int{qos};
      EXPECT_EQ(greeting->from[11], 11);
      EXPECT_FALSE(greeting->is_farewell);
      EXPECT_FALSE(greeting->has_keys);
      EXPECT_TRUE(GreetingOf({Announcement(little_endian, flags, 7, 0x1001)})->has_keys);
      EXPECT_EQ(GreetingOf({Announcement(little_endian, flags, 13)})->name, "") << "longer than its datagram";
      EXPECT_EQ(GreetingOf({Announcement(little_endian, flags, 0)})->name, "");
    }
    EXPECT_TRUE(GreetingOf({Announcement(little_endian, kQos)})->is_farewell);
    EXPECT_FALSE(GreetingOf({Heartbeat(1, 2, little_endian)}));
    EXPECT_FALSE(GreetingOf({{kData, Head(little_endian, 16).Fill(64), little_endian, false, kPayload}}));
  }
}

TEST(SieveLimits, ASubmessageEndsWithinItsPacket) {
  Bytes bytes = Packet({{kHeartbeat, Heartbeat(1, 2, false).body, false}});
  EXPECT_EQ(HarmOf(bytes.data(), bytes.size()), nullptr);
  bytes.pop_back();
  EXPECT_STREQ(HarmOf(bytes.data(), bytes.size()), "a submessage that is cut off");
}

TEST(SieveLimits, WithKeysOnlyDiscoveryIsAskedForInPlain) {
  EXPECT_EQ(Harm({AckNack(1, 0, kDiscoveryWriter)}, true), "none");
  EXPECT_EQ(Harm({AckNack(1, 0, kTopicWriter)}, true), "a message in plain where all are encrypted");
}

TEST(SieveLimits, AnEncryptedSubmessageHasAnEnd) {
  const auto encrypted = [](std::size_t end) {
    Body body(true);
    body.U32(__builtin_bswap32(96));
    return Harm({{0x31, Body(true).Fill(20)}, {0x30, body.Fill(100)}, {0x32, Body(true).Fill(end)}}, true);
  };
  EXPECT_EQ(encrypted(20), "none");
  EXPECT_EQ(encrypted(19), "an encrypted submessage without its end");
}

}  // namespace dispersa::sieve_test
