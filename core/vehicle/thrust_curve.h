// A motor's thrust over the time since ignition, as tests give it, and the same prepared for burns.
//
// Thrust is linear between the corners. So is the mass flow, as given, or proportional to the vacuum thrust
// (a constant exhaust velocity). The burnt mass is then a parabola on each piece, in closed form. The
// propellant is used up where the curve ends.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/input/fields.h"
#include "core/math/aligned_rows.h"

namespace dispersa {

/// Sea level of the U.S. Standard Atmosphere, 1976: the pressure of a static firing "at sea level".
inline constexpr double kSeaLevelPressure_pa = 101325.0;
/// Every corner ends an integration step.
inline constexpr std::size_t kThrustCurveCorners = 1000;
/// Rows of a file. More than kThrustCurveCorners are thinned to that many, or fewer.
inline constexpr std::size_t kThrustCurveRows = 1'000'000;
/// A corner is left out if the curve moves by less, as a part of its greatest value.
inline constexpr double kThinnedCurveTolerance = 1e-4;

/// How a curve of few corners was made of a file of many rows (rows 0: it was not).
struct ThinnedCurve {
  std::size_t rows = 0;
  double thrust_error = 0.0;  ///< greatest difference at a row, as a part of the greatest thrust
  double flow_error = 0.0;    ///< the same of the mass flow
};

struct ThrustCurve {
  std::vector<double> time_s;    ///< since ignition, from 0, each larger than the one before
  std::vector<double> thrust_n;  ///< in vacuum; 0 or more
  /// 0 or more (empty: proportional to the thrust). Its integral must be the propellant within 1 %, and is
  /// scaled to it exactly.
  std::vector<double> flow_kg_s = {};
  /// Chamber pressure of the test (empty: not given). It is checked against the thrust. Flights do not use
  /// it.
  std::vector<double> pressure_pa = {};
  ThinnedCurve thinned = {};

  bool empty() const { return time_s.empty(); }
  double Greatest() const;
  double Impulse() const;       ///< N s
  double Flown() const;         ///< the sum of flow_kg_s, kg
  double FullFlowTime() const;  ///< in which the largest flow would use up all propellant, s
};

void Describe(Fields& fields, ThrustCurve& curve);

/// A curve of at most kThrustCurveCorners corners for one of more. The corners are rows of the curve. Their
/// values are the least-squares fit to the curve, and its impulse and flow are kept, to rounding.
ThrustCurve Thin(const ThrustCurve& curve);

/// Flows given sum up to the propellant within this.
inline constexpr double kFlowSumTolerance = 0.01;

/// The vacuum curve of a curve measured at sea-level pressure: P + p A_e. If the measured thrust is 0,
/// nothing flows, and it stays 0.
ThrustCurve InVacuum(ThrustCurve at_sea_level, double exit_area_m2);

/// A curve by level, thrust over its greatest thrust, prepared to be looked up.
struct BurnCurve {
  /// The row of a piece has 8 numbers: a time on it (s), the level of thrust there and its slope (1/s), the
  /// share of the propellant left there, the level of the flow over its largest and its slope (1/s), and two
  /// unused. The time is the piece's start. For the last piece it is the end, so that exactly nothing is left
  /// there.
  static constexpr int kRowSize = 8;
  AlignedRows rows;
  std::vector<double> begin_s;  ///< of each piece
  double end_s = 0.0;
  double impulse_per_flow = 1.0;  ///< the area under the levels of thrust over that under those of the flow
};
BurnCurve Prepare(const ThrustCurve& curve);

}  // namespace dispersa
