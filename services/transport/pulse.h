// A coordinator's question to itself, through the middleware.
#pragma once

#include <memory>
#include <string>

#include "services/transport/doors.h"
#include "services/transport/network.h"

namespace dispersa {

/// A client in the process of the coordinator. It asks each door (doors.h) again and again. The coordinator's
/// thread answers between two rounds. So without an answer neither clients nor workers can reach the
/// coordinator, busy or idle.
class Pulse {
 public:
  explicit Pulse(const NetworkOptions& network);
  ~Pulse();

  /// As a client.
  const std::string& name() const;
  /// The participant that all doors have to know.
  ParticipantPrefix prefix() const;
  /// From now on so many doors have to answer.
  void Expect(int doors);
  /// Number of questions that all doors have answered.
  long beats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dispersa
