// A transport in front of the middleware that drops datagrams which could harm it. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "services/transport/doors.h"
#include "services/transport/fast_dds.h"

namespace dispersa {

/// The harm of a datagram to the middleware, judged without it; nullptr if it is harmless, else why it is
/// dropped.
///
/// Fast DDS reserves the size that a fragment claims for the whole sample. It walks through every
/// sequence number that a GAP or a HEARTBEAT names: a range of 10^9 stops it for minutes (CVE-2025-64438). It
/// trusts the lengths in a datagram, encrypted or not. It also accepts plain data for an endpoint whose
/// messages are all encrypted. With keys, the only plain samples are a participant's greeting and the
/// handshake.
const char* HarmOf(const std::uint8_t* datagram, std::size_t size, bool with_keys = false);

/// The greeting in a harmless datagram, if there is one.
std::optional<Greeting> GreetingIn(const std::uint8_t* datagram, std::size_t size);

/// One of a coordinator's participants, or (without doors) any other program's.
struct Door {
  std::shared_ptr<Doors> doors;
  int number = 0;
};

/// `inner` behind the sieve. Dropped datagrams are counted and logged with their sender, at most once a
/// second. At a door greetings pass as the doors want it. Elsewhere only a coordinator's pass: the port may
/// have been that of a coordinator before, to which all workers go on to greet.
std::shared_ptr<rtps::TransportDescriptorInterface> Sieved(
    std::shared_ptr<rtps::TransportDescriptorInterface> inner, bool with_keys, const Door& door);

/// The last greeting that passed on this thread. The middleware tells of a new participant on the thread that
/// reads its greeting, and not all releases tell whether it has keys.
const Greeting& LastGreeting();

}  // namespace dispersa
