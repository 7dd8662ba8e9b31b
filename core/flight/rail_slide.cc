#include "core/flight/rail_slide.h"

#include <algorithm>

#include "core/dynamics/air_data.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

// From the Earth-fixed axes of time 0 to those of another time.
Matrix3 TurnedWithEarth(const Earth& earth, double time_s) {
  const SinCos turn = SineCosine(earth.rotation_rate_rad_s * time_s);
  Matrix3 turned;
  turned << turn.cos, -turn.sin, 0.0, turn.sin, turn.cos, 0.0, 0.0, 0.0, 1.0;
  return turned;
}

}  // namespace

RailSlide::RailSlide(const LauncherModel& model, const Rail& rail, const RigidBodyState& lift_off)
    : model_(model), rail_(rail), lift_off_(lift_off), along_(Rotate(lift_off.q_IB, Vector3(1.0, 0.0, 0.0))) {
  std::array<double, kLauncherSize> y{};
  WriteState(lift_off_, y.data());
  cg_station_m_ = model_.Evaluate({}, 0.0, y.data()).cg_station_m;
}

RigidBodyState RailSlide::StateAt(double time_s, double travel_m, double speed_m_s,
                                  double cg_station_m) const {
  const Earth& earth = model_.plant().environment.earth;
  const Matrix3 turned = TurnedWithEarth(earth, time_s);
  RigidBodyState s = lift_off_;  // its rate in body axes stays
  s.p_EoC_I = turned * (lift_off_.p_EoC_I + (travel_m + cg_station_m_ - cg_station_m) * along_);
  s.v_IC_I = Vector3(0.0, 0.0, earth.rotation_rate_rad_s).cross(s.p_EoC_I) + speed_m_s * (turned * along_);
  s.q_IB = QuaternionOf(turned) * lift_off_.q_IB;
  return s;
}

RailSlide::Rates RailSlide::RatesAt(const LauncherPhase& phase, double time_s, double travel_m,
                                    double speed_m_s) const {
  // Where the centre of gravity is within the body does not matter to the forces.
  const RigidBodyState s = StateAt(time_s, travel_m, speed_m_s, cg_station_m_);
  std::array<double, kLauncherSize> y{};
  WriteState(s, y.data());
  const LauncherInstant now = model_.Evaluate(phase, time_s, y.data());
  const Earth& earth = model_.plant().environment.earth;
  const Vector3 rate(0.0, 0.0, earth.rotation_rate_rad_s);
  const Vector3 felt_I = Gravitation(earth, s.p_EoC_I) - rate.cross(rate.cross(s.p_EoC_I)) +
                         Rotate(s.q_IB, Vector3(now.loads.force_n / now.loads.mass_kg));
  const Vector3 along_I = Rotate(s.q_IB, Vector3(1.0, 0.0, 0.0));
  const double along_m_s2 = felt_I.dot(along_I);
  const double friction_m_s2 = rail_.friction * (felt_I - along_m_s2 * along_I).norm();
  // At rest it stays unless it is pushed by more than friction, upwards: the rail's foot holds it.
  const double acceleration = along_m_s2 - friction_m_s2;
  return {speed_m_s, speed_m_s > 0.0 ? acceleration : std::max(acceleration, 0.0), now.cg_station_m};
}

void RailSlide::Step(const LauncherPhase& phase, double from_s, double to_s, double& travel_m,
                     double& speed_m_s) const {
  const double h = to_s - from_s;
  const auto at = [&](double part, const Rates& slope) {
    return RatesAt(phase, from_s + part * h, travel_m + part * h * slope.speed_m_s,
                   std::max(speed_m_s + part * h * slope.acceleration_m_s2, 0.0));
  };
  const Rates k1 = RatesAt(phase, from_s, travel_m, speed_m_s);
  const Rates k2 = at(0.5, k1), k3 = at(0.5, k2), k4 = at(1.0, k3);
  travel_m += h / 6.0 * (k1.speed_m_s + 2.0 * k2.speed_m_s + 2.0 * k3.speed_m_s + k4.speed_m_s);
  speed_m_s +=
      h / 6.0 *
      (k1.acceleration_m_s2 + 2.0 * k2.acceleration_m_s2 + 2.0 * k3.acceleration_m_s2 + k4.acceleration_m_s2);
  if (!(travel_m > 0.0 && speed_m_s > 0.0)) {
    travel_m = std::max(travel_m, 0.0);
    speed_m_s = std::max(speed_m_s, 0.0);
  }
}

void RailSlide::Advance(const LauncherPhase& phase, double from_s, double to_s, double* y) {
  Step(phase, from_s, to_s, travel_m_, speed_m_s_);
  const Rates end = RatesAt(phase, to_s, travel_m_, speed_m_s_);
  WriteState(StateAt(to_s, travel_m_, speed_m_s_, end.cg_station_m), y);
}

bool RailSlide::Follow(const LauncherPhase& phase, double step_s, double limit_s, Way& way) const {
  while (way.time_s < limit_s && !way.stops()) {
    const double to_s = std::min(way.time_s + step_s, limit_s);
    const Way before = way;
    Step(phase, before.time_s, to_s, way.travel_m, way.speed_m_s);
    way.time_s = to_s;
    if (!(way.travel_m >= rail_.length_m)) continue;
    double low_s = before.time_s, high_s = to_s;
    for (int i = 0; i < 40; ++i) {
      const double middle_s = 0.5 * (low_s + high_s);
      double m = before.travel_m, m_s = before.speed_m_s;
      Step(phase, before.time_s, middle_s, m, m_s);
      (m < rail_.length_m ? low_s : high_s) = middle_s;
    }
    way.time_s = high_s;
    return true;
  }
  return false;
}

}  // namespace dispersa
