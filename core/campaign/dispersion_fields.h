// A campaign's `dispersions`, as the rows of the table say.
#pragma once

#include "core/campaign/campaign.h"
#include "core/input/fields.h"

namespace dispersa {

/// Fills dispersions, wind_statistics and wind_table. Spreads boosters of which each draws its own values.
/// The campaign has its vehicle, or one without stages if it is unknown. Nothing is checked against a vehicle
/// that is not `is_sound`.
void DescribeDispersions(Fields& fields, bool is_sound, Campaign& campaign);

}  // namespace dispersa
