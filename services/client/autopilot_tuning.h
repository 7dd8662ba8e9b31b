// An autopilot's gains, found by the one procedure that tunes every law, and the file that they become.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/tuning/tune.h"
#include "services/client/observer.h"

namespace dispersa {

/// What the file's comment and the JSON repeat of the request.
struct TuningRequest {
  std::string campaign;
  std::string out;
  std::string autopilot;  ///< empty: the campaign's
  TuningOptions tuning;
};

struct TunedAutopilot {
  TuningResult result;
  std::vector<TuningRecord> log;
};

/// A search that misses its gates has still found something: the autopilot's name says so. Throws InputError,
/// Interrupted.
TunedAutopilot TuneAutopilot(const Campaign& campaign, const AutopilotConfig& autopilot,
                             const TuningOptions& options, Observer& observer);

/// An autopilot file, which begins with how it was found.
std::string TunedFile(const TuningRequest& request, const TunedAutopilot& tuned);
/// Schema "dispersa/tune/1".
nlohmann::ordered_json TuningJson(const TuningRequest& request, const TunedAutopilot& tuned);
/// "9.1 dB, 40.2 deg, 90 ms"
std::string MarginsText(const LeastMargins& m);

}  // namespace dispersa
