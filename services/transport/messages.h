// What travels between coordinator and workers, as plain data. idl/dispersion.idl says what each field means;
// these are its types without the middleware.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/campaign/case_result.h"

namespace dispersa {

enum class WorkerState { kStarting, kReady, kFlying, kLeaving };

struct WorkerStatus {
  std::string worker;
  std::string host;
  std::uint32_t pid = 0;
  std::string engine_version;
  std::uint32_t slots = 1;
  std::uint32_t credits = 2;
  WorkerState state = WorkerState::kStarting;
  std::uint64_t flown = 0;
  std::vector<std::uint64_t> started_cases;
};

struct CampaignDefinition {
  std::uint64_t coordinator_epoch = 0;
  std::string campaign_id;
  std::string flight_id;
  std::string engine_version;
  std::string name;
  std::string canonical_yaml;
};

/// Cases to fly.
struct FlyOrder {
  std::uint64_t coordinator_epoch = 0;
  std::string flight_id;
  std::uint64_t attempt = 0;
  std::vector<std::uint64_t> cases;
};

/// Nothing more will come: end.
struct LeaveOrder {
  std::uint64_t coordinator_epoch = 0;
};

struct StartedCase {
  std::uint64_t case_index = 0;
  std::uint64_t attempt = 0;
};

struct FlownCase {
  std::uint64_t attempt = 0;
  CaseResult result;
};

struct Report {
  std::string worker;
  std::uint64_t coordinator_epoch = 0;
  std::string flight_id;
  std::vector<FlownCase> flown;
  std::vector<StartedCase> started;
};

/// By the coordinator, of a worker.
struct Refusal {
  std::string worker;
  std::string reason;
};

/// By a worker, of a campaign.
struct CampaignRefusal {
  std::string worker;
  std::uint64_t coordinator_epoch = 0;
  std::string flight_id;
  std::string reason;
};

}  // namespace dispersa
