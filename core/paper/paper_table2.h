// The optimal results that the paper prints in its Table 2.
#pragma once

namespace dispersa {

inline constexpr double kPaperHeight_km = 500.406;
inline constexpr double kPaperVelocity_m_s = 7612.585;
inline constexpr double kPaperAngle_deg = 0.0000055;

}  // namespace dispersa
