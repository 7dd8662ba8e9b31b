#include "services/transport/sieve.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "services/transport/complaints.h"
#include "services/transport/endpoints.h"
#include "services/transport/wire_shape.h"

namespace dispersa {
namespace {

// Sizes of the RTPS protocol, version 2.
constexpr std::size_t kMessageHeader = 20;
constexpr std::uint8_t kGap = 0x08;
constexpr std::uint8_t kAckNack = 0x06;
constexpr std::uint8_t kHeartbeat = 0x07;
constexpr std::uint8_t kData = 0x15;
constexpr std::uint8_t kDataFragment = 0x16;
constexpr std::uint8_t kNackFragment = 0x12;
constexpr std::uint8_t kHeartbeatFragment = 0x13;
// DDS Security: an encrypted part is a prefix, a body and a postfix.
constexpr std::uint8_t kSecureBody = 0x30;
constexpr std::uint8_t kSecurePrefix = 0x31;
constexpr std::uint8_t kSecurePostfix = 0x32;
constexpr std::uint8_t kSecureMessagePrefix = 0x33;
constexpr std::uint8_t kSecureMessagePostfix = 0x34;
// Writers, as big-endian numbers, that say who they are and shake hands.
constexpr std::uint32_t kGreeting = 0x000100c2;
constexpr std::uint32_t kHandshake = 0x000201c3;

/// Largest range that a late reader of our writers may be told to skip (endpoints.h renews writers before
/// they have written more).
constexpr std::uint64_t kMaxRange = 2 * kRenewAfter;

/// One submessage behind its header of 4 bytes.
class Submessage {
 public:
  Submessage(const std::uint8_t* body, std::size_t size, bool little_endian)
      : body_(body), size_(size), little_(little_endian) {}

  std::size_t size() const { return size_; }
  std::uint32_t U32(std::size_t at) const { return little_ ? Native(at) : __builtin_bswap32(Native(at)); }
  std::uint16_t U16(std::size_t at) const {
    std::uint16_t value = 0;
    std::memcpy(&value, body_ + at, 2);
    return little_ ? value : __builtin_bswap16(value);
  }
  std::uint32_t BigEndianU32(std::size_t at) const { return __builtin_bswap32(Native(at)); }
  /// A sequence number: its high half comes first.
  std::uint64_t Number(std::size_t at) const { return std::uint64_t{U32(at)} << 32 | U32(at + 4); }

 private:
  std::uint32_t Native(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, body_ + at, 4);
    return value;
  }

  const std::uint8_t* body_;
  std::size_t size_;
  bool little_;
};

/// Bytes of the submessage with this head of 4 bytes; `rest`: those of the datagram behind the head.
std::size_t LengthOf(const std::uint8_t* head, std::size_t rest) {
  const std::uint8_t kind = head[0];
  const std::size_t length = Submessage(head, 4, (head[1] & 1) != 0).U16(2);
  // 0: up to the end, but for the two kinds that may be empty (PAD, INFO_TS).
  return (length == 0 && kind != 0x01 && kind != 0x09) ? rest : length;
}

const char* HarmOfSubmessage(std::uint8_t kind, const Submessage& what) {
  // Reader and writer (4 bytes each) come first, in DATA and DATA_FRAG behind flags and an offset.
  switch (kind) {
    case kGap: {
      if (what.size() < 28) return "a GAP that is cut off";
      const std::uint64_t first = what.Number(8), base = what.Number(16);
      if (first == 0 || base < first || base - first > kMaxRange || what.U32(24) > 256)
        return "a GAP of an absurd range";
      return nullptr;
    }
    case kHeartbeat: {
      if (what.size() < 28) return "a HEARTBEAT that is cut off";
      const std::uint64_t first = what.Number(8), last = what.Number(16);
      if (first == 0 || first >> 62 != 0 || last + 1 < first || last - first + 1 > kMaxRange) {
        return "a HEARTBEAT of an absurd range";
      }
      return nullptr;
    }
    case kAckNack:
      if (what.size() < 24 || what.Number(8) >> 62 != 0 || what.U32(16) > 256)
        return "an ACKNACK out of bounds";
      return nullptr;
    case kData:
      if (what.size() < 20 || what.U16(2) > what.size() - 4) return "a DATA that is cut off";
      return nullptr;
    case kDataFragment: {
      if (what.size() < 32 || what.U16(2) > what.size() - 4) return "a DATA_FRAG that is cut off";
      const std::uint32_t sample = what.U32(28), fragment = what.U16(26);
      if (sample > kMaxSampleBytes + 1024) return "a sample of more than 1 MiB";
      if (fragment == 0 || what.U32(20) == 0 || std::uint64_t{what.U32(20) - 1} * fragment >= sample) {
        return "a fragment outside of its sample";
      }
      return nullptr;
    }
    default:
      return nullptr;
  }
}

bool IsSecure(std::uint8_t kind) { return kind >= kSecureBody && kind <= kSecureMessagePostfix; }

// `before`: the kind of the submessage before it. The library reads a body of the length that is written in
// it.
const char* HarmOfSecure(std::uint8_t kind, std::uint8_t before, const Submessage& what) {
  switch (kind) {
    case kSecurePrefix:
      return what.size() == 20 ? nullptr : "an encrypted submessage without its head";
    case kSecureBody:
      if (before != kSecurePrefix || what.size() < 4 || what.BigEndianU32(0) > what.size() - 4) {
        return "an encrypted submessage that is cut off";
      }
      return nullptr;
    case kSecurePostfix:
      if (before != kSecureBody || what.size() < 20) return "an encrypted submessage without its end";
      return nullptr;
    default:
      return "a kind of encryption that is not used";
  }
}

const char* HarmOfPlain(std::uint8_t kind, const Submessage& what) {
  switch (kind) {
    case kGap:
    case kHeartbeat:
    case kAckNack:
    case kNackFragment:
    case kHeartbeatFragment:
    case kData:
    case kDataFragment: {
      const std::size_t writer_at = kind == kData || kind == kDataFragment ? 8 : 4;
      if (what.size() < writer_at + 4) return "a submessage that is cut off";
      const std::uint32_t writer = what.BigEndianU32(writer_at);
      if (kind == kData && (writer == kGreeting || writer == kHandshake)) return nullptr;
      // Discovery in plain is there, empty, and its readers ask until they know that it is empty.
      const bool is_builtin = (writer & 0xc0) == 0xc0 && writer >> 24 == 0;
      if (is_builtin && (kind == kHeartbeat || kind == kAckNack)) return nullptr;
      return "a message in plain where all are encrypted";
    }
    default:
      return nullptr;
  }
}

constexpr std::uint16_t kEndOfList = 0x0001, kEntityName = 0x0062, kIdentityToken = 0x1001;

/// The first parameter of this kind in a list, behind its head.
std::optional<std::size_t> FindParameter(const Submessage& list, std::size_t at, std::uint16_t kind) {
  while (at + 4 <= list.size()) {
    const std::uint16_t found = list.U16(at);
    at += 4;
    if (found == kind) return at;
    if (found == kEndOfList) break;
    at += list.U16(at - 2);
  }
  return std::nullopt;
}

/// What the DATA of a participant's announcement says of it.
void ReadAnnouncement(const std::uint8_t* body, std::size_t size, std::uint8_t flags, Greeting& greeting) {
  constexpr std::uint8_t kHasQos = 0x02;
  constexpr std::size_t kDataHead = 20, kEncapsulation = 4;
  std::optional<std::size_t> at = kDataHead;
  if ((flags & kHasQos) != 0) at = FindParameter({body, size, (flags & 1) != 0}, *at, kEndOfList);
  if (!at || *at + kEncapsulation > size) return;
  const Submessage announcement(body, size, (body[*at + 1] & 1) != 0);
  const std::size_t list = *at + kEncapsulation;
  greeting.has_keys = FindParameter(announcement, list, kIdentityToken).has_value();
  at = FindParameter(announcement, list, kEntityName);
  if (!at || size < *at + 4) return;
  const std::size_t with_zero = announcement.U32(*at);
  if (with_zero == 0 || with_zero > size - *at - 4) return;
  greeting.name = {reinterpret_cast<const char*>(body) + *at + 4, with_zero - 1};
}

thread_local Greeting last_greeting;

class Sieve : public ReceivingTransport {
 public:
  Sieve(const rtps::ChainingTransportDescriptor& descriptor, bool with_keys, Door door)
      : ReceivingTransport(descriptor),
        descriptor_(descriptor, with_keys, std::move(door)),
        with_keys_(with_keys) {}

  rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  // A port that another program took meanwhile, Fast DDS only logs.
  bool OpenInputChannel(const rtps::Locator_t& local, rtps::TransportReceiverInterface* receiver,
                        uint32_t max_size) override {
    if (ChainingTransport::OpenInputChannel(local, receiver, max_size)) return true;
    if (const auto& doors = descriptor_.door.doors) doors->Refuse(rtps::IPLocator::getPhysicalPort(local));
    return false;
  }

  void receive(rtps::TransportReceiverInterface* next, const rtps::octet* data, uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    if (const char* harm = HarmOf(data, size, with_keys_)) {
      Complain("datagram", rtps::IPLocator::ip_to_string(remote), harm);
      return;
    }
    if (const auto greeting = GreetingIn(data, size)) {
      const auto& [doors, number] = descriptor_.door;
      if (doors ? !doors->Admits(number, *greeting, data, size, rtps::IPLocator::ip_to_string(remote))
                : !greeting->is_farewell && greeting->name != kCoordinatorParticipant)
        return;
      last_greeting = *greeting;
    }
    next->OnDataReceived(data, size, local, remote);
  }

 private:
  struct Descriptor : rtps::ChainingTransportDescriptor {
    Descriptor(std::shared_ptr<TransportDescriptorInterface> inner, bool keys, Door which)
        : ChainingTransportDescriptor(std::move(inner)), with_keys(keys), door(std::move(which)) {}
    Descriptor(const ChainingTransportDescriptor& other, bool keys, Door which)
        : ChainingTransportDescriptor(other), with_keys(keys), door(std::move(which)) {}
    rtps::TransportInterface* create_transport() const override { return new Sieve(*this, with_keys, door); }
    // Fast DDS 2.9 takes it for the bytes after which a writer asks all its readers what they lack, and
    // counts the bytes that its sending thread has sent since it began. So from the first megabyte on, each
    // endpoint told to one new participant was followed by a question to all: 300 workers never came to rest.
    // Without these questions the periodic ones serve.
    uint32_t min_send_buffer_size() const override { return std::numeric_limits<std::int32_t>::max(); }
    bool with_keys;
    Door door;
  };
  friend std::shared_ptr<rtps::TransportDescriptorInterface> dispersa::Sieved(
      std::shared_ptr<rtps::TransportDescriptorInterface>, bool, const Door&);

  Descriptor descriptor_;
  bool with_keys_;
};

}  // namespace

const char* HarmOf(const std::uint8_t* datagram, std::size_t size, bool with_keys) {
  if (size < kMessageHeader || std::memcmp(datagram, "RTPS", 4) != 0) return "not of the protocol";
  std::uint8_t before = 0;
  for (std::size_t at = kMessageHeader; at < size;) {
    if (size - at < 4) return "a submessage that is cut off";
    const std::uint8_t kind = datagram[at];
    const bool little_endian = (datagram[at + 1] & 1) != 0;
    const std::size_t rest = size - at - 4;
    const std::size_t length = LengthOf(datagram + at, rest);
    if (length > rest) return "a submessage that is cut off";
    const Submessage what(datagram + at + 4, length, little_endian);
    const char* harm = nullptr;
    if (IsSecure(kind)) {
      harm = with_keys ? HarmOfSecure(kind, before, what) : "it is encrypted, and we have no keys";
    } else {
      if (before == kSecurePrefix || before == kSecureBody) return "an encrypted submessage that is cut off";
      if (with_keys) harm = HarmOfPlain(kind, what);
      if (harm == nullptr) harm = HarmOfSubmessage(kind, what);
    }
    if (harm != nullptr) return harm;
    before = kind;
    at += 4 + length;
  }
  return nullptr;
}

std::optional<Greeting> GreetingIn(const std::uint8_t* datagram, std::size_t size) {
  constexpr std::size_t kPrefixAt = 8, kDataHead = 20;
  constexpr std::uint8_t kHasData = 0x04;
  for (std::size_t at = kMessageHeader; at + 4 <= size;) {
    const std::uint8_t kind = datagram[at], flags = datagram[at + 1];
    const std::size_t length = LengthOf(datagram + at, size - at - 4);
    const std::uint8_t* const body = datagram + at + 4;
    if (kind == kData && length >= kDataHead && Submessage(body, length, true).BigEndianU32(8) == kGreeting) {
      Greeting greeting;
      std::copy_n(datagram + kPrefixAt, greeting.from.size(), greeting.from.begin());
      greeting.is_farewell = (flags & kHasData) == 0;
      if (!greeting.is_farewell) ReadAnnouncement(body, length, flags, greeting);
      return greeting;
    }
    at += 4 + length;
  }
  return std::nullopt;
}

std::shared_ptr<rtps::TransportDescriptorInterface> Sieved(
    std::shared_ptr<rtps::TransportDescriptorInterface> inner, bool with_keys, const Door& door) {
  return std::make_shared<Sieve::Descriptor>(std::move(inner), with_keys, door);
}

const Greeting& LastGreeting() { return last_greeting; }

}  // namespace dispersa
