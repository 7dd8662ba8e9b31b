// Other participants on the network, as the middleware finds them. Internal to this folder.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "services/program/mutex.h"
#include "services/transport/doors.h"
#include "services/transport/fast_dds.h"

namespace dispersa {

/// Logs participants refused at discovery, which the middleware often refuses silently. It also knows the
/// partitions of others' writers. With keys, the permissions say who may be in which partition.
class Neighbours : public Discovery {
 public:
  /// `doors`: those of a coordinator, which get to know what becomes of their peers.
  explicit Neighbours(bool we_have_keys, std::shared_ptr<Doors> doors = nullptr)
      : we_have_keys_(we_have_keys), doors_(std::move(doors)) {}

  /// Whether the writer is in this partition and never was in another.
  bool IsIn(const rtps::GUID_t& writer, const std::string& partition) const;
  /// Logs, from time to time, participants that have shown no valid keys for some seconds. A participant that
  /// finds the other's keys bad falls silent, so the other side sees only silence.
  void LogSilent();
  /// Number of participants that were found so far.
  long found() const { return found_; }

 private:
  void OnFound(const rtps::GUID_t& participant, const rtps::RemoteLocatorList& addresses) override;
  void OnGone(const rtps::GUID_t& participant) override;
  void OnAuthenticated(const rtps::GUID_t& participant, bool is_authorized) override;
  void OnWriter(const rtps::GUID_t& writer, const std::vector<std::string>& partitions) override;
  void OnWriterGone(const rtps::GUID_t& writer) override;
  void OnReader(const rtps::GUID_t& reader) override;
  void TellJoined(const rtps::GUID_t& endpoint) const;
  /// As its greeting said, if it was the last one; else as we have.
  bool HasKeys(const rtps::GUID_t& participant) const;

  struct Handshake {
    std::chrono::steady_clock::time_point due;
    std::string who;
  };

  bool we_have_keys_;
  std::shared_ptr<Doors> doors_;
  std::atomic<long> found_ = 0;
  mutable Mutex mutex_;
  std::map<rtps::GUID_t, std::vector<std::string>> partitions_ DISPERSA_GUARDED_BY(mutex_);
  std::map<rtps::GUID_t, Handshake> handshakes_ DISPERSA_GUARDED_BY(mutex_);
};

}  // namespace dispersa
