// Which of the coordinator's participants serves a peer, and when a peer may join. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/program/mutex.h"

namespace dispersa {

/// The 12 bytes that name a participant.
using ParticipantPrefix = std::array<std::uint8_t, 12>;

/// The names of participants.
inline constexpr char kWorkerParticipant[] = "dispersa-worker";
inline constexpr char kCoordinatorParticipant[] = "dispersa-coordinator";

/// The announcement of a participant, which it repeats every second.
struct Greeting {
  ParticipantPrefix from{};
  std::string name;  ///< as the sender wants it; of our programs that of the program
  bool is_farewell = false;
  bool has_keys = false;
};

/// A coordinator has one participant of Fast DDS for each kPlaces peers, a door. All peers greet at the first
/// one's port, so the others may have any ports. The sieve hands each greeting over to the door of its
/// sender, or drops it while others join.
///
/// With keys Fast DDS 2.9 keeps one handshake message for each peer, at most 100: at the next peer it fails
/// (`assert` in SecurityManager.cpp:1498), or lets nobody in. It also sends each peer's keys to all others of
/// the participant, 23 datagrams for each pair. So the peers of a participant are few.
///
/// Thread-safe. Times are seconds from any origin.
class Doors {
 public:
  /// Doors at most. With keys no more than what joined within a minute twenty times of twenty (capacity.md).
  static constexpr std::size_t kMost = 16, kMostWithKeys = 7;
  /// Workers of a door, and others (clients, observers): neither keeps the other out.
  static constexpr std::size_t kForWorkers = 30, kForOthers = 6, kPlaces = kForWorkers + kForOthers;
  /// Workers that join at a time, and others that do.
  static constexpr std::size_t kAtOnce = 16;
  /// A peer that has not joined after this time lets the next one begin.
  static constexpr double kJoin_s = 5.0;
  /// A peer that the middleware has not found after this time loses its place.
  static constexpr double kFind_s = 10.0;

  explicit Doors(const std::string& address, bool with_keys = false);
  ~Doors();
  Doors(const Doors&) = delete;
  Doors& operator=(const Doors&) = delete;

  /// A door is open, whose participant is discovered at `port`. Doors are numbered from 0 on.
  void Open(std::uint16_t port);
  /// This port could not be bound: whether it was so.
  void Refuse(std::uint16_t port);
  bool WasRefused(std::uint16_t port) const;
  /// Few places are left, and another door may be opened.
  bool IsShort() const;

  /// The door of a peer, or none: it may not join now, because others join or because all places are taken.
  struct Answer {
    std::optional<int> door;
    bool is_full = false;
  };
  Answer DoorOf(const Greeting& greeting, double now_s);
  /// Its participant knows it; it has joined, or may not; it is gone.
  void Found(const ParticipantPrefix& peer);
  void Joined(const ParticipantPrefix& peer);
  void Gone(const ParticipantPrefix& peer);
  /// This peer uses all doors.
  void OpenAllTo(const ParticipantPrefix& peer);

  /// What the sieve of `door` does with a greeting: true if it is for this door. Otherwise it is handed over
  /// or dropped.
  bool Admits(int door, const Greeting& greeting, const std::uint8_t* datagram, std::size_t size,
              const std::string& sender);

 private:
  struct Peer {
    int door;
    bool is_worker, is_found = false, is_joining = true;
    double since_s;
  };

  void HandOver(int door, const std::uint8_t* datagram, std::size_t size) const
      DISPERSA_PROVED(requires_capability(mutex_));

  std::string address_;
  const std::size_t most_;
  int socket_;
  mutable Mutex mutex_;
  std::vector<std::uint16_t> ports_ DISPERSA_GUARDED_BY(mutex_);  ///< by door
  std::set<std::uint16_t> refused_ DISPERSA_GUARDED_BY(mutex_);
  std::map<ParticipantPrefix, Peer> peers_ DISPERSA_GUARDED_BY(mutex_);
  std::optional<ParticipantPrefix> everywhere_ DISPERSA_GUARDED_BY(mutex_);
};

}  // namespace dispersa
