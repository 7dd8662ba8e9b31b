// Units as people write them.
#pragma once

#include <string_view>

namespace dispersa {

/// "m/s" for "m_s", the end of a name. Empty if it is not a unit.
std::string_view UnitText(std::string_view unit);

}  // namespace dispersa
