// A transport in front of the middleware that drops datagrams which could harm it. Internal to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

namespace dispersa {

/// What a datagram would do to the middleware, judged without it; nullptr: no harm, else why it is dropped.
/// Fast DDS 2.9 reserves what a fragment says the whole sample has, walks through every sequence number that
/// a GAP or a HEARTBEAT names (a range of 10^9 stops it for minutes, CVE-2025-64438), and trusts the lengths
/// in a datagram, encrypted or not. It also takes what comes in plain for an endpoint whose messages are all
/// encrypted: with keys, no samples pass in plain but the greeting of a participant and the handshake.
const char* HarmOf(const std::uint8_t* datagram, std::size_t size, bool with_keys = false);

/// `inner` behind the sieve. What is dropped is counted and logged, at most once a second, with its sender.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> Sieved(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> inner, bool with_keys);

}  // namespace dispersa
