#include "services/transport/neighbours.h"

#include <algorithm>

#include "services/transport/complaints.h"
#include "services/transport/endpoints.h"
#include "services/transport/sieve.h"

namespace dispersa {
namespace {

constexpr std::chrono::seconds kHandshakePatience(5);
constexpr std::size_t kMostHandshakes = 1024;  // strangers may make up participants without end
constexpr char kBadKeys[] =
    "its keys are of another authority, expired or damaged, its Debian is another one, or the first contact "
    "with it was interrupted";
constexpr char kNoKeys[] = "it has no keys";

std::string WhoIs(const rtps::GUID_t& participant, const rtps::RemoteLocatorList& addresses) {
  const auto& unicast = addresses.unicast;
  return ParticipantOf(participant) +
         (unicast.empty() ? "" : " at " + rtps::IPLocator::ip_to_string(unicast.front()));
}

ParticipantPrefix PrefixOf(const rtps::GUID_t& guid) {
  ParticipantPrefix prefix;
  std::copy_n(guid.guidPrefix.value, prefix.size(), prefix.begin());
  return prefix;
}

}  // namespace

// Its readers and writers come last, after the handshake.
void Neighbours::TellJoined(const rtps::GUID_t& endpoint) const {
  if (doors_) doors_->Joined(PrefixOf(endpoint));
}

bool Neighbours::IsIn(const rtps::GUID_t& writer, const std::string& partition) const {
  const Lock lock(mutex_);
  const auto known = partitions_.find(writer);
  return known != partitions_.end() && known->second == std::vector<std::string>{partition};
}

void Neighbours::OnFound(const rtps::GUID_t& participant, const rtps::RemoteLocatorList& addresses) {
  const Lock lock(mutex_);
  ++found_;
  if (doors_) doors_->Found(PrefixOf(participant));
  const bool it_has_keys = HasKeys(participant);
  if (we_have_keys_ && it_has_keys) {
    if (kIsFoundFirst && handshakes_.size() < kMostHandshakes) {
      handshakes_[participant] = {std::chrono::steady_clock::now() + kHandshakePatience,
                                  WhoIs(participant, addresses)};
    }
  } else if (we_have_keys_ != it_has_keys) {
    TellJoined(participant);  // it never will
    Complain("participant", WhoIs(participant, addresses),
             we_have_keys_ ? kNoKeys : "it has keys, and we have none to show (--keys)");
  }
}

void Neighbours::OnGone(const rtps::GUID_t& participant) {
  const Lock lock(mutex_);
  handshakes_.erase(participant);
  if (doors_) doors_->Gone(PrefixOf(participant));
}

void Neighbours::OnAuthenticated(const rtps::GUID_t& participant, bool is_authorized) {
  const Lock lock(mutex_);
  handshakes_.erase(participant);
  if (is_authorized) return;
  TellJoined(participant);  // it never will
  Complain("participant", ParticipantOf(participant), HasKeys(participant) ? kBadKeys : kNoKeys);
}

bool Neighbours::HasKeys(const rtps::GUID_t& participant) const {
  const Greeting& greeting = LastGreeting();
  return greeting.from == PrefixOf(participant) ? greeting.has_keys : we_have_keys_;
}

void Neighbours::LogSilent() {
  const Lock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(handshakes_, [&](const auto& each) {
    const bool is_silent = now > each.second.due;
    if (is_silent) Complain("participant", each.second.who, kBadKeys);
    return is_silent;
  });
}

// A participant that changes partitions could use its permission for one partition in another. It is not
// heard any more.
void Neighbours::OnWriter(const rtps::GUID_t& writer, const std::vector<std::string>& partitions) {
  const Lock lock(mutex_);
  TellJoined(writer);
  const auto [known, is_new] = partitions_.try_emplace(writer, partitions);
  if (!is_new && known->second != partitions) known->second.clear();
}

void Neighbours::OnWriterGone(const rtps::GUID_t& writer) {
  const Lock lock(mutex_);
  partitions_.erase(writer);
}

void Neighbours::OnReader(const rtps::GUID_t& reader) { TellJoined(reader); }

}  // namespace dispersa
