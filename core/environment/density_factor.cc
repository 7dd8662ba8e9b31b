#include "core/environment/density_factor.h"

namespace dispersa {

AirState Scaled(const AirState& air, double density_factor) {
  return {air.temperature_k, density_factor * air.pressure_pa, density_factor * air.density_kg_m3,
          air.speed_of_sound_m_s};
}

}  // namespace dispersa
