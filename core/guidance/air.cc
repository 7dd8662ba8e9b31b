#include "core/guidance/air.h"

#include <algorithm>

#include "core/environment/surroundings.h"
#include "core/math/functions.h"
#include "core/vehicle/heat_flux.h"

namespace dispersa {

namespace {

struct Flow {
  double density_kg_m3, ground_speed_m_s;
};
Flow FlowAt(const GuidanceMission& mission, const NavigatedState& state, double altitude_m) {
  const AirTable& table = mission.air ? *mission.air : StandardAir();
  const lanes::AirPressure<double> air = lanes::AirAt(table, altitude_m);
  const Vector3 turns(0.0, 0.0, mission.earth.rotation_rate_rad_s);
  return {air.pressure_pa / air.energy_j_kg, (state.v_IC_I - turns.cross(state.p_EoC_I)).norm()};
}

double AltitudeOf(const Earth& earth, const NavigatedState& state) {
  return ToGeodetic(earth, InertialToEarth(earth, state.time_s, state.p_EoC_I)).altitude_m;
}

}  // namespace

double DynamicPressure(const GuidanceMission& mission, const NavigatedState& state) {
  const Flow flow = FlowAt(mission, state, AltitudeOf(mission.earth, state));
  return 0.5 * flow.density_kg_m3 * Square(flow.ground_speed_m_s);
}

bool FeelsAir(const GuidanceMission& mission, const GuidedStage& stage, const NavigatedState& state) {
  constexpr double kFelt = 1e-4;
  return DynamicPressure(mission, state) * stage.cross_section_m2 > kFelt * stage.burn.vacuum_thrust_n;
}

double BeyondCriterion(const GuidanceMission& mission, const MassDrop& drop, const NavigatedState& state) {
  const double altitude_m = AltitudeOf(mission.earth, state);
  if (drop.trigger == JettisonTrigger::kAtAltitude) return altitude_m - drop.threshold;
  const Flow flow = FlowAt(mission, state, altitude_m);
  // The least altitude in the same measure: density falls to an e-th over this height.
  constexpr double kFall_m = 6e3;
  return std::min((altitude_m - kFreeMolecularAltitude_m) / kFall_m,
                  Log(drop.threshold / HeatFlux(flow.density_kg_m3, flow.ground_speed_m_s)));
}

}  // namespace dispersa
