// A campaign's tree to what is flown or optimised. The files that it names are put in the place of their
// names.
#pragma once

#include <optional>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/input/field_reader.h"

namespace dispersa {

/// A campaign as its file describes it: with a reference, or with a trajectory problem to be solved first.
struct DecodedCampaign {
  Campaign campaign;                          ///< without canonical_yaml and ids
  std::optional<TrajectoryProblem> optimize;  ///< from the `optimize` block, which replaces `reference`
};

/// The use of a campaign, which decides the keys that it needs.
enum class CampaignUse {
  kFly,       ///< autopilot, sampling and a reference
  kRead,      ///< as kFly, but a control law in Python may be missing
  kOptimize,  ///< a vehicle, and a reference or an `optimize` block
  kCheck,     ///< the first if it has a reference, else the second
};

DecodedCampaign DecodeCampaign(InputNode& root, CampaignUse use, std::vector<InputProblem>& problems,
                               FileSource* files, std::vector<InputProblem>* warnings);

/// The keys of a campaign's file, for those that have none.
void DescribeCampaignFile(Fields& fields);

}  // namespace dispersa
