#include "services/transport/doors.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "services/transport/complaints.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

double Seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Doors::Doors(const std::string& address, bool with_keys)
    : address_(address.empty() ? "127.0.0.1" : address),
      most_(with_keys ? kMostWithKeys : kMost),
      socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (socket_ < 0) throw NetworkError(std::string("no UDP socket: ") + std::strerror(errno));
}

Doors::~Doors() { close(socket_); }

void Doors::Open(std::uint16_t port) {
  const Lock lock(mutex_);
  ports_.push_back(port);
}

void Doors::Refuse(std::uint16_t port) {
  const Lock lock(mutex_);
  refused_.insert(port);
}

bool Doors::WasRefused(std::uint16_t port) const {
  const Lock lock(mutex_);
  return refused_.contains(port);
}

// One burst finds its places while the next door opens.
bool Doors::IsShort() const {
  const Lock lock(mutex_);
  const auto workers = static_cast<std::size_t>(
      std::count_if(peers_.begin(), peers_.end(), [](const auto& each) { return each.second.is_worker; }));
  return ports_.size() < most_ && (ports_.size() * kForWorkers < workers + kAtOnce ||
                                   ports_.size() * kForOthers < peers_.size() - workers + kForOthers / 2);
}

Doors::Answer Doors::DoorOf(const Greeting& greeting, double now_s) {
  const Lock lock(mutex_);
  if (const auto known = peers_.find(greeting.from); known != peers_.end()) return {known->second.door};
  if (greeting.is_farewell || greeting.name == kCoordinatorParticipant) return {};
  std::erase_if(peers_, [&](const auto& each) {
    return !each.second.is_found && now_s - each.second.since_s > kFind_s;
  });
  const bool is_worker = greeting.name == kWorkerParticipant;
  std::size_t joining = 0;
  // Places that this peer may take, by door.
  std::vector<std::size_t> left(ports_.size(), is_worker ? kForWorkers : kForOthers);
  for (const auto& [prefix, peer] : peers_) {
    if (peer.is_worker == is_worker) --left[static_cast<std::size_t>(peer.door)];
    if (peer.is_worker == is_worker && peer.is_joining && now_s - peer.since_s < kJoin_s) ++joining;
  }
  const auto emptiest = std::max_element(left.begin(), left.end());
  const bool has_place = emptiest != left.end() && *emptiest > 0;
  if (!has_place && left.size() >= most_) return {std::nullopt, true};
  if (!has_place || joining >= kAtOnce) return {};
  const int door = static_cast<int>(emptiest - left.begin());
  peers_[greeting.from] = {.door = door, .is_worker = is_worker, .since_s = now_s};
  return {door};
}

void Doors::Found(const ParticipantPrefix& peer) {
  const Lock lock(mutex_);
  if (const auto known = peers_.find(peer); known != peers_.end()) known->second.is_found = true;
}

void Doors::Joined(const ParticipantPrefix& peer) {
  const Lock lock(mutex_);
  if (const auto known = peers_.find(peer); known != peers_.end()) known->second.is_joining = false;
}

void Doors::Gone(const ParticipantPrefix& peer) {
  const Lock lock(mutex_);
  peers_.erase(peer);
}

void Doors::OpenAllTo(const ParticipantPrefix& peer) {
  const Lock lock(mutex_);
  peers_.erase(peer);
  everywhere_ = peer;
}

// By a datagram to ourselves, so that a door that does not react holds up no other one.
void Doors::HandOver(int door, const std::uint8_t* datagram, std::size_t size) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(ports_[static_cast<std::size_t>(door)]);
  inet_pton(AF_INET, address_.c_str(), &to.sin_addr);
  // One that is lost is repeated by its sender.
  (void)sendto(socket_, datagram, size, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

bool Doors::Admits(int door, const Greeting& greeting, const std::uint8_t* datagram, std::size_t size,
                   const std::string& sender) {
  {
    const Lock lock(mutex_);
    if (everywhere_ == greeting.from) {
      for (int other = 1; door == 0 && other < static_cast<int>(ports_.size()); ++other)
        HandOver(other, datagram, size);
      return true;
    }
  }
  const Answer answer = DoorOf(greeting, Seconds());
  if (answer.door == door) return true;
  if (answer.door) {
    const Lock lock(mutex_);
    HandOver(*answer.door, datagram, size);
  } else if (answer.is_full) {
    Complain(
        "greeting", sender,
        fmt::format("this coordinator serves {} workers and {} others at most; it waits until one leaves",
                    kForWorkers * most_, kForOthers * most_));
  }
  return false;
}

}  // namespace dispersa
