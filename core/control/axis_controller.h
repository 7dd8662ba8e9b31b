// One axis of the autopilot: from the attitude error and its rate to an angular acceleration.
//
// Signs: e = reference - true about the body axis, and u > 0 accelerates the body in the positive direction.
// So the plant is e'' = -u + disturbance, and b = 1 > 0 as (18) and (32) need. The paper's (14) has the
// opposite sign, u = -delta.
//
// Everything here is plain data. law.h and axis_step.h hold the laws, written once for any number of flights.
#pragma once

#include <cstdint>
#include <vector>

#include "core/control/autopilot_config.h"
#include "core/control/filter.h"
#include "core/control/fuzzy.h"

namespace dispersa {

/// The law of one axis in one stage, of one flight or of W side by side.
template <class T>
struct StageLawOf {
  T kp_1_s2 = T(0.0);
  T kd_1_s = T(0.0);
  T p11 = T(0.0), p12 = T(0.0), p22 = T(0.0);  ///< P of the Lyapunov equation
  T pn_error = T(0.0), pn_rate = T(0.0);       ///< P_n: its last column, or the configured one
  T gamma = T(0.0);                            ///< 0: not adaptive
  T ki_1_s3 = T(0.0);                          ///< of the integral
  DigitalSectionOf<T> filters[kFilterSections];

  /// With a flight's factors on P_n.
  StageLawOf WithPnFactors(double of_error, double of_rate) const {
    StageLawOf law = *this;
    law.pn_error = law.pn_error * T(of_error);
    law.pn_rate = law.pn_rate * T(of_rate);
    return law;
  }
};
using StageLaw = StageLawOf<double>;

/// A law whose numbers change at a constant rate from a time since ignition on.
template <class T>
struct LawPieceOf {
  T from_s = T(0.0);
  StageLawOf<T> at;    ///< then
  StageLawOf<T> rate;  ///< of each number, 1/s
};
using LawPiece = LawPieceOf<double>;

/// The law of one axis, prepared for flight and shared by all flights.
struct AxisLaw {
  AxisConfig config;
  std::vector<StageLaw> stages;               ///< at ignition
  std::vector<std::vector<LawPiece>> pieces;  ///< of each scheduled stage, empty for the others
};
/// In a scheduled stage every number of StageLaw, digital sections included, is a straight line between the
/// times of its entries. Sections stay stable: the coefficients of stable ones fill a triangle. Their gain at
/// rest stays 1: it is linear in them. No command jumps. P and P_n belong to the entries' gains; between
/// entries they belong to neither.
AxisLaw BuildAxisLaw(const AxisConfig& config, double tick_s);

/// The law in a stage at a time since its ignition.
StageLaw LawAt(const AxisLaw& law, int stage, double since_ignition_s);

/// All memory of one axis, for one flight or for W flights side by side: values of 64 bits.
template <class T, class Bits = T>
struct AxisMemory {
  T departure_rad_s2[kFuzzyRules];  ///< of the consequents from their start
  Bits rules_fired;                 ///< bit i: rule i has fired
  T previous_v;
  T saturation;       ///< -1, 0, 1: the last deflection command was limited in this sense of u
  T integral_rad_s2;  ///< of a PID law
  T total_gain;       ///< adaptive augmentation
  T model_started;    ///< its reference model: 0 or 1
  T model_error_rad;
  T model_rate_rad_s;  ///< rate of the model, for composite adaptation the predicted one
  T model_integral_rad_s2;
  T high_pass;  ///< its spectral damper
  T low_pass;
  T filters[kFilterSections][2];  ///< memory of the sections
};

/// The memory of one flight, made afresh for each.
struct AxisState : AxisMemory<double, std::uint64_t> {
  AxisState() : AxisMemory<double, std::uint64_t>{} { total_gain = 1.0; }
};

struct AxisTelemetry {
  double command_rad_s2 = 0.0;    ///< u
  double adaptation_norm = 0.0;   ///< of the consequents less their start
  double v = 0.0;                 ///< 1/2 e'Pe
  double v_rate_sign = 0.0;       ///< -1, 0, 1: of the change of v since the last tick
  double total_gain = 1.0;        ///< of the augmentation, after the tick
  std::uint32_t rules_fired = 0;  ///< since the flight began
  bool projected = false;         ///< a consequent stands at its bound
  bool frozen = false;            ///< adaptation held by saturation or dead zone
};

/// Starts a stage's rules, integral and augmentation: at lift-off, and at ignitions if so configured.
void ResetAxis(AxisState& state);

/// One tick, in order since ignition. `pn_error_factor` and `pn_rate_factor` scale P_n (the study of Fig. 5).
/// Both are 1 in flight.
double StepAxis(const AxisLaw& law, int stage, double error_rad, double rate_rad_s, double pn_error_factor,
                double pn_rate_factor, double tick_s, AxisState& state, AxisTelemetry& telemetry,
                double since_ignition_s = 0.0);

}  // namespace dispersa
