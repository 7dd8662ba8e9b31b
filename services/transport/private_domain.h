// A DDS domain that no other run on this machine uses.
#pragma once

namespace dispersa {

/// Reserves one of the domains 40 .. 99 while it lives. A process that dies releases it. Two runs in one
/// network namespace never get the same domain. Programs without this reservation may still use it.
class PrivateDomain {
 public:
  /// Throws NetworkError if all are taken.
  PrivateDomain();
  ~PrivateDomain();
  PrivateDomain(const PrivateDomain&) = delete;
  PrivateDomain& operator=(const PrivateDomain&) = delete;

  int domain() const { return domain_; }

 private:
  int socket_ = -1;
  int domain_ = 0;
};

}  // namespace dispersa
