// The margins of a campaign's autopilot: computed, measured in flight, and of dispersed flights.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/margins/dispersed_margins.h"
#include "core/margins/flight_margins.h"

namespace dispersa {

struct MarginsOptions {
  std::optional<std::uint64_t> cases = {};  ///< none: of the nominal flight only
  double frequency_band_percent = 100.0 * kFrequencyBand;
  bool drift = false;
};

struct MarginsResult {
  std::string autopilot;
  std::vector<ComputedMargins> computed;
  std::vector<SkippedInstant> skipped;
  std::vector<MeasuredMargins> measured;
  std::optional<CampaignMargins> dispersed;
  MarginModel of;            ///< the linearised model
  bool bends = false;        ///< the vehicle has bending modes
  std::string nominal_loss;  ///< NominalLoss(); a lost flight meets no gate
  bool passed = false;       ///< every gate is met
};

/// Flies on all usable cores.
MarginsResult MarginsOf(const Campaign& campaign, const MarginsOptions& options);

nlohmann::ordered_json SkippedJson(const std::vector<SkippedInstant>& skipped);
/// Schema "dispersa/margins/1".
nlohmann::ordered_json MarginsJson(const MarginsResult& result);

}  // namespace dispersa
