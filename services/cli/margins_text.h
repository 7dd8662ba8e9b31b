// The margins of an autopilot as text.
#pragma once

#include <string>

#include "services/client/margins_of.h"

namespace dispersa {

/// The output of `dispersa margins`.
std::string MarginsText(const MarginsResult& result);

}  // namespace dispersa
