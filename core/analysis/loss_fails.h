#pragma once

#include "core/campaign/campaign.h"

namespace dispersa {

/// Whether a lost flight fails a requirement whatever it measured. Of the vehicle's own limits a loss says
/// nothing: they are held against what the flight bore until then.
inline bool LossFails(const Requirement& requirement) { return !requirement.by_default; }

}  // namespace dispersa
