// Messages between coordinator and workers as plain data. idl/dispersion.idl explains each field. These are
// its types without the middleware.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/case_result.h"

namespace dispersa {

enum class WorkerState { kReady, kFlying, kDraining, kLeft };
constexpr const char* WorkerStateName(WorkerState state) {
  constexpr const char* kNames[] = {"ready", "flying", "draining", "left"};
  return kNames[static_cast<int>(state)];
}

struct StartedCase {
  std::uint64_t case_index = 0;
  std::uint64_t attempt = 0;

  bool operator==(const StartedCase&) const = default;
};

struct WorkerStatus {
  std::string worker;
  std::string host;
  std::uint32_t pid = 0;
  std::string engine_version;
  std::uint32_t slots = 1;
  std::uint32_t credits = 2;
  WorkerState state = WorkerState::kReady;
  std::uint64_t flown = 0;
  std::uint64_t coordinator_epoch = 0;
  std::vector<std::uint64_t> held;
  std::vector<StartedCase> started;
};

/// Cases to fly.
struct FlyOrder {
  std::string flight_id;
  std::uint64_t attempt = 0;
  std::vector<std::uint64_t> cases;

  bool operator==(const FlyOrder&) const = default;
};

/// To one worker.
struct Orders {
  std::string worker;
  std::uint64_t coordinator_epoch = 0;
  std::vector<FlyOrder> assignments;
  std::vector<std::uint64_t> revoked;
  std::vector<std::uint64_t> acknowledged;
  bool leave = false;
  std::string refusal;
};

struct FlownCase {
  std::uint64_t attempt = 0;
  CaseResult result;
  bool is_quarantined = false;  ///< the case ended every process that flew it and has no result (the reason
                                ///< says how it ended them)
};

struct Report {
  std::string worker;
  std::uint64_t coordinator_epoch = 0;
  std::uint64_t number = 0;
  std::string flight_id;
  std::vector<FlownCase> flown;
  std::vector<StartedCase> started;
};

struct TextRequest {
  std::string worker;
  std::string flight_id;
  std::uint64_t offset = 0;
};

/// A part of a campaign's text.
struct TextPart {
  std::string worker;
  std::string flight_id;
  std::string name;
  std::string engine_version;
  std::uint64_t size = 0;
  std::uint64_t offset = 0;
  std::string bytes;
};

/// By a worker, of a campaign.
struct CampaignRefusal {
  std::string worker;
  std::uint64_t coordinator_epoch = 0;
  std::string flight_id;
  std::string reason;
  bool engine_fault = false;  ///< a rule of the worker's program is broken: it leaves
};

/// How far a campaign is.
struct CampaignProgress {
  std::uint64_t coordinator_epoch = 0;
  std::string campaign_id;
  std::string flight_id;
  std::string name;
  std::string state;
  std::uint64_t total = 0;
  std::uint64_t done = 0;
  std::uint64_t quarantined = 0;
  std::uint64_t assigned = 0;
  std::uint32_t workers = 0;
};

/// By a client.
struct Request {
  std::string client;
  std::uint64_t number = 0;
  std::string method;
  std::string arguments;
  std::string data;
};

struct Reply {
  std::string client;
  std::uint64_t number = 0;
  int code = 0;
  std::string text;
  std::string data;
};

}  // namespace dispersa
