// The budget of a tuning, and checks of its options against campaign and autopilot.
#pragma once

#include "core/campaign/campaign.h"
#include "core/tuning/tuning_options.h"

namespace dispersa {

/// Number of designs of a generation that pass on unchanged.
inline constexpr int kElites = 2;

/// Number of searches: one for each stage, and one for the augmentation.
int SearchesOf(const Campaign& campaign, const AutopilotConfig& autopilot);
int PopulationOf(const TuningOptions& options);
/// Number of generations of a search after the initial one.
int GenerationsOf(const TuningOptions& options, int searches);
/// Throws InputError, as Tune does.
void CheckTuning(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options);

}  // namespace dispersa
