// A vehicle's way along its launcher rail (core/vehicle/rail.h), until it leaves.
//
// The rail turns with the Earth. Along its direction e, for the travel s of the body:
//
//   s'' = e . (F / m + g - w x (w x p)) - friction |across| sign(s')
//
// F are all forces but gravitation, `across` is the part of the bracket at right angles to e, which the rail
// carries, and w is the Earth's rate. Coriolis' force is at right angles to e. The centre of gravity moves
// through the body as propellant burns; the state follows it. Method: classical Runge-Kutta of fourth order.
#pragma once

#include "core/dynamics/launcher.h"
#include "core/flight/launch_frame.h"
#include "core/vehicle/rail.h"

namespace dispersa {

class RailSlide {
 public:
  /// `model` must outlive it. `lift_off`: at time 0, at rest on the rotating Earth, along the rail.
  RailSlide(const LauncherModel& model, const Rail& rail, const RigidBodyState& lift_off);

  /// Moves on, and writes the state at `to_s`.
  void Advance(const LauncherPhase& phase, double from_s, double to_s, double* y);
  /// A way along the rail before the flight takes it.
  struct Way {
    double time_s = 0.0, travel_m = 0.0, speed_m_s = 0.0;

    /// Above the rail's foot, which holds it until thrust exceeds weight and friction. It would slide back.
    bool stops() const { return travel_m > 0.0 && !(speed_m_s > 0.0); }
  };
  /// Goes on in steps of `step_s` to the end of the rail, until it stops, or until `limit_s`. True if it gets
  /// to the end.
  bool Follow(const LauncherPhase& phase, double step_s, double limit_s, Way& way) const;

  double speed_m_s() const { return speed_m_s_; }

 private:
  struct Rates {
    double speed_m_s, acceleration_m_s2, cg_station_m;
  };
  RigidBodyState StateAt(double time_s, double travel_m, double speed_m_s, double cg_station_m) const;
  Rates RatesAt(const LauncherPhase& phase, double time_s, double travel_m, double speed_m_s) const;
  void Step(const LauncherPhase& phase, double from_s, double to_s, double& travel_m,
            double& speed_m_s) const;

  const LauncherModel& model_;
  const Rail rail_;
  const RigidBodyState lift_off_;
  const Vector3 along_;        ///< the rail's direction, at time 0 in I
  double cg_station_m_ = 0.0;  ///< at lift-off
  double travel_m_ = 0.0, speed_m_s_ = 0.0;
};

}  // namespace dispersa
