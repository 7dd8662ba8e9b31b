#include "core/vehicle/propulsion.h"

#include <algorithm>

#include "core/math/functions.h"
#include "core/vehicle/cut_off.h"
#include "core/vehicle/prepared_burn.h"
#include "core/vehicle/throttled_burn.h"

namespace dispersa {

double MotorBurn::Fraction(double since_ignition_s) const {
  return since_ignition_s < 0.0 || since_ignition_s > duration_s
             ? 0.0
             : PreparedBurn(*this).At(since_ignition_s).fraction;
}

double MotorBurn::Propellant(double since_ignition_s) const {
  return PreparedBurn(*this).At(since_ignition_s).propellant_kg;
}

double MotorBurn::ExhaustVelocity() const {
  const double at_full_thrust_m_s = vacuum_thrust_n / full_flow_kg_s;
  return curve ? at_full_thrust_m_s * curve->impulse_per_flow : at_full_thrust_m_s;
}

std::vector<double> MotorBurn::Kinks(double ignition_s) const {
  const double burnout_s = ignition_s + duration_s;
  std::vector<double> kinks;
  const auto add = [&](double kink_s) {
    if (kink_s > ignition_s && kink_s < burnout_s) kinks.push_back(kink_s);
  };
  if (curve) {
    for (const double begin_s : curve->begin_s) add(ignition_s + begin_s / curve_rate);
  } else {
    add(ignition_s + rise_s);
    add(burnout_s - tail_s);
    std::sort(kinks.begin(), kinks.end());
  }
  return kinks;
}

MotorBurn BuildBurn(const Stage& stage, double thrust_factor, double flow_factor) {
  const ThrustCurve& curve = stage.motor.thrust_curve;
  return BuildBurn(stage, thrust_factor, flow_factor,
                   curve.empty() ? nullptr : std::make_shared<const BurnCurve>(Prepare(curve)));
}

Stage AsStage(const Boosters& boosters) {
  Stage one;
  one.propellant_mass_kg = boosters.propellant_mass_kg;
  one.motor = boosters.motor;
  one.grain = boosters.grain;
  one.tanks = boosters.tanks;
  return one;
}

MotorBurn BuildOneBoosterBurn(const Boosters& boosters, double thrust_factor, double flow_factor) {
  return BuildBurn(AsStage(boosters), thrust_factor, flow_factor);
}

MotorBurn BuildBoosterBurn(const Boosters& boosters, double thrust_factor, double flow_factor) {
  MotorBurn all = BuildOneBoosterBurn(boosters, thrust_factor, flow_factor);
  if (boosters.cant_rad > 0.0) {
    all.vacuum_thrust_n *= Cos(boosters.cant_rad);
    all.exit_area_m2 *= Cos(boosters.cant_rad);
  }
  all.vacuum_thrust_n *= boosters.count;
  all.full_flow_kg_s *= boosters.count;
  all.propellant_mass_kg *= boosters.count;
  all.left_kg *= boosters.count;
  all.residual_kg *= boosters.count;
  all.exit_area_m2 *= boosters.count;
  return all;
}

MotorBurn BuildBurn(const Stage& stage, double thrust_factor, double flow_factor,
                    std::shared_ptr<const BurnCurve> curve) {
  const Motor& motor = stage.motor;
  MotorBurn burn;
  if (stage.is_liquid()) curve = nullptr;
  burn.vacuum_thrust_n = motor.thrust_n * thrust_factor;
  burn.full_flow_kg_s = stage.propellant_mass_kg / motor.burning_time_s * flow_factor;
  burn.propellant_mass_kg = stage.propellant_mass_kg;
  burn.rise_s = motor.ignition_rise_s;
  burn.tail_s = motor.tail_off_s;
  burn.exit_area_m2 = motor.nozzle_exit_area_m2;
  // The area under the trapezoid is the propellant: two half ramps lengthen the burn.
  burn.duration_s = stage.propellant_mass_kg / burn.full_flow_kg_s + 0.5 * (burn.rise_s + burn.tail_s);
  if (curve) {
    burn.curve_rate = flow_factor;
    burn.duration_s = curve->end_s / flow_factor;
    burn.curve = std::move(curve);
  }
  if (stage.is_liquid()) {
    burn.residual_kg = motor.residual_mass_kg;
    SetPropellant(motor, burn.propellant_mass_kg, burn);
  }
  return burn;
}

namespace {

void SetThrottled(const Motor& engine, double propellant_kg, const CutOffCommand& command, MotorBurn& burn) {
  const ThrottledBurn throttled =
      Throttled(engine.throttle, {propellant_kg, burn.residual_kg, burn.full_flow_kg_s}, command);
  burn.propellant_mass_kg = propellant_kg;
  burn.duration_s = throttled.curve.end_s;
  burn.left_kg = throttled.left_kg;
  burn.curve = std::make_shared<const BurnCurve>(throttled.curve);
}

}  // namespace

void SetPropellant(const Motor& engine, double propellant_kg, MotorBurn& burn) {
  CutOffCommand command{HUGE_VAL, burn.tail_s};
  if (engine.cut_off == CutOff::kAtTime) command.at_s = std::max(engine.cut_off_s - CutOffLead(engine), 0.0);
  SetThrottled(engine, propellant_kg, command, burn);
}

void SetTailOff(double factor, const Stage& stage, MotorBurn& burn) {
  if (burn.curve && !stage.is_liquid()) return;
  const double longer_s = (factor - 1.0) * burn.tail_s;
  burn.tail_s += longer_s;
  if (stage.is_liquid())
    SetPropellant(stage.motor, burn.propellant_mass_kg, burn);
  else
    burn.duration_s += 0.5 * longer_s;
}

void CutOffAt(double since_ignition_s, MotorBurn& burn) {
  if (since_ignition_s >= burn.duration_s) return;
  burn.left_kg = burn.Propellant(since_ignition_s);
  burn.duration_s = since_ignition_s;
}

void CommandCutOff(const Motor& engine, double since_ignition_s, MotorBurn& burn) {
  if (burn.tail_s == 0.0) return CutOffAt(since_ignition_s, burn);
  if (since_ignition_s < burn.duration_s)
    SetThrottled(engine, burn.propellant_mass_kg, {since_ignition_s, burn.tail_s}, burn);
}

}  // namespace dispersa
