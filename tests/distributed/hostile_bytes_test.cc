// Bytes from strangers: malformed ones, which could harm a decoder or the middleware, are told from
// well-formed ones.
#include "services/transport/convert.h"
#include "services/transport/endpoints.h"
#include "services/transport/sieve.h"
#include "services/transport/wire_shape.h"
#include "tests/fuzz.h"
#include "tests/test.h"

namespace dispersa::hostile_bytes_test {

using Bytes = std::vector<std::uint8_t>;

using fuzz::Inputs;

template <typename PubSubType>
Bytes Encode(typename PubSubType::type message) {
  GuardedType<PubSubType> type;
  rtps::SerializedPayload_t payload(type.SizeOf(&message));
  EXPECT_TRUE(type.Encode(&message, payload));
  return Bytes(payload.data, payload.data + payload.length);
}

/// False: refused.
template <typename PubSubType>
bool Decode(const Bytes& bytes, typename PubSubType::type* message) {
  GuardedType<PubSubType> type;
  rtps::SerializedPayload_t payload(static_cast<std::uint32_t>(std::max<std::size_t>(bytes.size(), 1)));
  payload.length = static_cast<std::uint32_t>(bytes.size());
  if (!bytes.empty()) std::memcpy(payload.data, bytes.data(), bytes.size());
  EXPECT_TRUE(type.Decode(payload, message));
  return !GuardedType<PubSubType>::refused;
}

Report SampleReport() {
  Report report{"worker", 99, 3, std::string(64, 'f'), {}, {{8, 3}, {9, 3}}};
  CaseResult result;
  result.reason = "why";
  result.inputs = {1.0, 2.0, 3.0};
  result.metrics = {};
  report.flown = {{1, result}, {2, result}};
  return report;
}
Orders SampleOrders() {
  return {"w", 7, {{"flight", 3, {1, 2}}, {"flight", 4, {}}}, {}, {6, 7}, true, "because"};
}
WorkerStatus SampleStatus() {
  return {"u", "host", 42, "engine", 3, 4, WorkerState::kFlying, 17, 99, {5, 6}, {{7, 5}}};
}

/// Decodes the sample, and the sample damaged in many ways; each must be refused or decoded, and nothing else
/// happen.
template <typename PubSubType>
void Fuzz(const typename PubSubType::type& sample) {
  typename PubSubType::type message;
  const Bytes good = Encode<PubSubType>(sample);
  ASSERT_TRUE(Decode<PubSubType>(good, &message));
  ASSERT_TRUE(Encode<PubSubType>(message) == good);
  std::mt19937_64 chance(fuzz::Seed());
  for (std::uint64_t i = 0; i < Inputs(); ++i) {
    Bytes bytes = good;
    for (std::uint64_t k = chance() % 4; k < 4; ++k) {
      const std::size_t at = chance() % bytes.size();
      switch (chance() % 4) {
        case 0:
          bytes[at] = static_cast<std::uint8_t>(chance());
          break;
        case 1:
          bytes.resize(at + 1);
          break;
        case 2:
          std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at + 4, bytes.size())), 0xff);
          break;
        default:
          bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), chance() % 9, 0);
      }
    }
    if (!Decode<PubSubType>(bytes, &message)) continue;
    if (const auto plain = FromIdl(message)) (void)WhyInvalid(*plain);  // what it answers: validity_test.cc
  }
}

TEST(HostileBytes, EveryDecoderSurvivesDamagedSamples) {
  fuzz::Chance();  // says how to repeat it
  Fuzz<idl::ReportV3PubSubType>(ToIdl(SampleReport()));
  Fuzz<idl::OrdersV1PubSubType>(ToIdl(SampleOrders()));
  Fuzz<idl::WorkerStatusV2PubSubType>(ToIdl(SampleStatus()));
  Fuzz<idl::TextRequestV1PubSubType>(ToIdl(TextRequest{"w", "f", 3}));
  Fuzz<idl::TextV1PubSubType>(ToIdl(TextPart{"w", "f", "n", "e", 9, 2, "bytes"}));
  Fuzz<idl::CampaignRefusalV2PubSubType>(ToIdl(CampaignRefusal{"w", 1, "f", "r"}));
  Fuzz<idl::ProgressV1PubSubType>(ToIdl(CampaignProgress{1, "i", "f", "n", "s", 2, 3, 4, 5, 6}));
  Fuzz<idl::RequestV1PubSubType>(ToIdl(Request{"c", 1, "list", "{}", "data"}));
  Fuzz<idl::ReplyV1PubSubType>(ToIdl(Reply{"c", 1, 0, "{}", "data"}));
}

TEST(HostileBytes, SevenBytesAreRefused) {
  const Bytes seven = {0xff, 0xff, 0xff, 0xff, 1, 2, 3};
  idl::ReportV3 report;
  EXPECT_FALSE(Decode<idl::ReportV3PubSubType>(seven, &report));
  idl::TextV1 text;
  EXPECT_FALSE(Decode<idl::TextV1PubSubType>(seven, &text));
  EXPECT_FALSE(Decode<idl::TextV1PubSubType>({}, &text));
}

TEST(HostileBytes, ASequenceThatSaysToBeLongerThanItsSampleIsNotAllocated) {
  Bytes bytes = Encode<idl::RequestV1PubSubType>(ToIdl(Request{"c", 1, "list", "{}", "data"}));
  // The length of the data stands before its four bytes.
  for (std::uint8_t size : {std::uint8_t{5}, std::uint8_t{0xff}}) {
    bytes[bytes.size() - 8] = size;
    if (size == 0xff) std::fill(bytes.end() - 8, bytes.end() - 4, 0xff);
    idl::RequestV1 request;
    EXPECT_FALSE(Decode<idl::RequestV1PubSubType>(bytes, &request)) << int{size};
  }
  EXPECT_FALSE(HasShape("[B]", Bytes(kMaxSampleBytes + 1, 0).data(), kMaxSampleBytes + 1));
}

TEST(HostileBytes, AnUnknownStateOrOutcomeIsNoMessage) {
  idl::WorkerStatusV2 status = ToIdl(SampleStatus());
  status.state(static_cast<idl::WorkerStateV2>(4));
  EXPECT_FALSE(FromIdl(status));
  idl::ReportV3 report = ToIdl(SampleReport());
  report.flown()[0].outcome("exploded");
  EXPECT_FALSE(FromIdl(report));
}

// ---- datagrams

void Put32(Bytes& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}
void PutNumber(Bytes& bytes, std::uint64_t number) {
  Put32(bytes, static_cast<std::uint32_t>(number >> 32));
  Put32(bytes, static_cast<std::uint32_t>(number));
}
Bytes Datagram(std::uint8_t kind, const Bytes& body) {
  Bytes bytes = {'R', 'T', 'P', 'S', 2, 3, 1, 15};
  bytes.resize(20);
  bytes.insert(bytes.end(), {kind, 1, static_cast<std::uint8_t>(body.size()),
                             static_cast<std::uint8_t>(body.size() >> 8)});
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}
std::string Harm(const Bytes& bytes, bool with_keys = false) {
  const char* harm = HarmOf(bytes.data(), bytes.size(), with_keys);
  return harm == nullptr ? "none" : harm;
}
Bytes Gap(std::uint64_t first, std::uint64_t base, std::uint32_t bits = 0) {
  Bytes body(8);
  PutNumber(body, first);
  PutNumber(body, base);
  Put32(body, bits);
  return Datagram(0x08, body);
}
Bytes Heartbeat(std::uint64_t first, std::uint64_t last) {
  Bytes body(8);
  PutNumber(body, first);
  PutNumber(body, last);
  Put32(body, 1);
  return Datagram(0x07, body);
}
Bytes Fragment(std::uint32_t number, std::uint16_t size, std::uint32_t sample) {
  Bytes body(20);
  body[2] = 28;
  Put32(body, number);
  Put32(body, 1u | std::uint32_t{size} << 16);
  Put32(body, sample);
  body.resize(64);
  return Datagram(0x16, body);
}

TEST(Sieve, LetsTheProtocolPass) {
  EXPECT_EQ(Harm(Gap(1, 2)), "none");
  EXPECT_EQ(Harm(Gap(1, 1'000'001, 256)), "none");
  EXPECT_EQ(Harm(Heartbeat(1, 0)), "none") << "nothing written yet";
  EXPECT_EQ(Harm(Heartbeat(5000, 5511)), "none");
  EXPECT_EQ(Harm(Fragment(4, 65000, 256 << 10)), "none");
  EXPECT_EQ(Harm(Datagram(0x09, Bytes(8))), "none");
}

TEST(Sieve, DropsWhatWouldStopOrFillTheMiddleware) {
  EXPECT_EQ(Harm(Gap(1, 1'000'000'000)), "a GAP of an absurd range");
  EXPECT_EQ(Harm(Gap(1, std::uint64_t{1} << 62)), "a GAP of an absurd range");
  EXPECT_EQ(Harm(Gap(5, 4)), "a GAP of an absurd range");
  EXPECT_EQ(Harm(Gap(0, 4)), "a GAP of an absurd range");
  EXPECT_EQ(Harm(Gap(1, 2, 257)), "a GAP of an absurd range");
  EXPECT_EQ(Harm(Datagram(0x08, Bytes(20))), "a GAP that is cut off");
  EXPECT_EQ(Harm(Heartbeat(1, 1'000'000'000)), "a HEARTBEAT of an absurd range");
  EXPECT_EQ(Harm(Heartbeat(0, 1)), "a HEARTBEAT of an absurd range");
  EXPECT_EQ(Harm(Fragment(1, 65000, 50'000'000)), "a sample of more than 1 MiB");
  EXPECT_EQ(Harm(Fragment(9, 65000, 256 << 10)), "a fragment outside of its sample");
  EXPECT_EQ(Harm(Fragment(0, 65000, 256 << 10)), "a fragment outside of its sample");
  EXPECT_EQ(Harm(Fragment(1, 0, 256 << 10)), "a fragment outside of its sample");
  EXPECT_EQ(Harm(Bytes{'H', 'T', 'T', 'P'}), "not of the protocol");
  Bytes cut = Gap(1, 2);
  cut.pop_back();
  EXPECT_EQ(Harm(cut), "a submessage that is cut off");
}

/// DATA of this writer, a big-endian number.
Bytes Data(std::uint32_t writer) {
  Bytes body(8);
  body[2] = 16;
  Put32(body, __builtin_bswap32(writer));
  body.resize(24);
  return Datagram(0x15, body);
}
/// Prefix, body and postfix, the body of `size` bytes that says that it has `told`.
Bytes Encrypted(std::uint32_t told, std::uint16_t size) {
  Bytes bytes = Datagram(0x31, Bytes(20));
  bytes.insert(bytes.end(), {0x30, 1, static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size >> 8)});
  Bytes body;
  Put32(body, __builtin_bswap32(told));
  body.resize(size);
  bytes.insert(bytes.end(), body.begin(), body.end());
  bytes.insert(bytes.end(), {0x32, 1, 20, 0});
  bytes.resize(bytes.size() + 20);
  return bytes;
}

TEST(Sieve, WithKeysNothingPassesInPlainButTheHandshake) {
  EXPECT_EQ(Harm(Data(0x000100c2), true), "none") << "greeting";
  EXPECT_EQ(Harm(Data(0x000201c3), true), "none") << "handshake";
  EXPECT_EQ(Harm(Encrypted(96, 100), true), "none");
  const char plain[] = "a message in plain where all are encrypted";
  EXPECT_EQ(Harm(Data(0x00000103), true), plain) << "of a topic";
  EXPECT_EQ(Harm(Data(0x000003c2), true), plain) << "of discovery in plain";
  EXPECT_EQ(Harm(Data(0xff0003c2), true), plain) << "of encrypted discovery";
  EXPECT_EQ(Harm(Data(0xff0202c3), true), plain) << "of the exchange of keys";
  EXPECT_EQ(Harm(Gap(1, 2), true), plain);
  EXPECT_EQ(Harm(Heartbeat(1, 0), true), plain);
  EXPECT_EQ(Harm(Fragment(4, 65000, 256 << 10), true), plain);
  // An encrypted one in front of it does not open the door.
  Bytes both = Encrypted(96, 100);
  const Bytes forged = Data(0x00000103);
  both.insert(both.end(), forged.begin() + 20, forged.end());
  EXPECT_EQ(Harm(both, true), plain);
  for (const std::uint32_t writer : {0x00000103u, 0x000003c2u}) EXPECT_EQ(Harm(Data(writer)), "none");
}

TEST(Sieve, DropsEncryptedSubmessagesThatClaimMoreThanThereIs) {
  EXPECT_EQ(Harm(Encrypted(97, 100), true), "an encrypted submessage that is cut off");
  EXPECT_EQ(Harm(Encrypted(0xffffffff, 100), true), "an encrypted submessage that is cut off");
  EXPECT_EQ(Harm(Datagram(0x30, Bytes(20)), true), "an encrypted submessage that is cut off") << "no prefix";
  EXPECT_EQ(Harm(Datagram(0x32, Bytes(20)), true), "an encrypted submessage without its end") << "no body";
  EXPECT_EQ(Harm(Datagram(0x31, Bytes(19)), true), "an encrypted submessage without its head");
  EXPECT_EQ(Harm(Datagram(0x33, Bytes(20)), true), "a kind of encryption that is not used");
  EXPECT_EQ(Harm(Encrypted(96, 100)), "it is encrypted, and we have no keys");
  // A submessage in plain in the place of the body would be read as one that is only signed.
  Bytes bytes = Datagram(0x31, Bytes(20));
  const Bytes forged = Data(0x00000103);
  bytes.insert(bytes.end(), forged.begin() + 20, forged.end());
  EXPECT_EQ(Harm(bytes, true), "an encrypted submessage that is cut off");
}

TEST(Sieve, JudgesAnyDatagram) {
  std::mt19937_64 chance = fuzz::Chance();
  for (std::uint64_t i = 0; i < Inputs(); ++i) {
    Bytes bytes = chance() % 3 == 0   ? Gap(chance() % 9, chance() % 99)
                  : chance() % 2 == 0 ? Fragment(1, 100, 2000)
                                      : Encrypted(96, 100);
    for (std::uint64_t k = chance() % 8; k > 0; --k)
      bytes[20 + chance() % (bytes.size() - 20)] = static_cast<std::uint8_t>(chance());
    bytes.resize(20 + chance() % (bytes.size() - 19));
    (void)Harm(bytes, chance() % 2 == 0);
  }
}

TEST(Printable, KeepsALogClean) {
  EXPECT_EQ(Printable("plain text"), "plain text");
  EXPECT_EQ(Printable("\x1b[31mred\n\xc2\x9b"), "\\x1b[31mred\\x0a\\xc2\\x9b");
  EXPECT_EQ(Printable(std::string(300, 'a')), std::string(200, 'a') + "...");
}

}  // namespace dispersa::hostile_bytes_test
