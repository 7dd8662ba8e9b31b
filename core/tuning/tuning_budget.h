// The budget of a tuning, and checks of its options against campaign and autopilot.
#pragma once

#include "core/campaign/campaign.h"
#include "core/tuning/tuning_options.h"

namespace dispersa {

/// Of a generation, so many designs go on as they are.
inline constexpr int kElites = 2;

/// Stages, and the augmentation.
int SearchesOf(const Campaign& campaign, const AutopilotConfig& autopilot);
int PopulationOf(const TuningOptions& options);
/// Generations of a search after the initial one.
int GenerationsOf(const TuningOptions& options, int searches);
/// Throws InputError, as Tune does.
void CheckTuning(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options);

}  // namespace dispersa
