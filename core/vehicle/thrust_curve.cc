#include "core/vehicle/thrust_curve.h"

#include <algorithm>

#include "core/math/table.h"
#include "core/vehicle/thin_table.h"

namespace dispersa {
namespace {

double GreatestOf(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

// The integral of a value that is linear between the times.
double AreaUnder(const std::vector<double>& values, const std::vector<double>& time_s) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i)
    sum += 0.5 * (values[i] + values[i + 1]) * (time_s[i + 1] - time_s[i]);
  return sum;
}

}  // namespace

double ThrustCurve::Greatest() const { return GreatestOf(thrust_n); }

double ThrustCurve::Impulse() const { return AreaUnder(thrust_n, time_s); }

double ThrustCurve::Flown() const { return flow_kg_s.empty() ? 0.0 : AreaUnder(flow_kg_s, time_s); }

double ThrustCurve::FullFlowTime() const {
  return flow_kg_s.empty() ? Impulse() / Greatest() : Flown() / GreatestOf(flow_kg_s);
}

ThrustCurve InVacuum(ThrustCurve at_sea_level, double exit_area_m2) {
  for (double& thrust_n : at_sea_level.thrust_n)
    if (thrust_n > 0.0) thrust_n += kSeaLevelPressure_pa * exit_area_m2;
  return at_sea_level;
}

void Describe(Fields& fields, ThrustCurve& curve) {
  curve.thinned = {};
  fields.Quantities("time", kTime, kNonNegative, 2, kThrustCurveRows, curve.time_s,
                    "since ignition, from 0; linear between points. More than 1000 rows are thinned: the "
                    "impulse stays, validate states the error");
  fields.Quantities("thrust", kForce, kNonNegative, 2, kThrustCurveRows, curve.thrust_n, "as measured");
  fields.OptionalQuantities(
      "mass_flow", kMassFlow, kNonNegative, 2, kThrustCurveRows, curve.flow_kg_s,
      "its integral is the propellant, within 1 %; default: proportional to the thrust");
  fields.OptionalQuantities("chamber_pressure", kGasPressure, kNonNegative, 2, kThrustCurveRows,
                            curve.pressure_pa, "of the test; checked against the thrust, not used in flight");
  // Its reader compares them with the vehicle; nothing else uses them.
  std::optional<double> stated_kg;
  fields.OptionalNumber("published_propellant_mass_kg", kPositive, stated_kg,
                        "as the header of an .eng file states it; the vehicle's, within 1 %");
  fields.OptionalNumber("published_motor_mass_kg", kPositive, stated_kg,
                        "with propellant, likewise; at most the mass of what it is a part of");
  fields.Check([&] {
    const auto refuse_count = [&](std::size_t count, const std::string& what, const std::string& allowed) {
      fields.Refuse(
          "",
          "there are " + std::to_string(curve.time_s.size()) + " times and " + std::to_string(count) + what,
          allowed);
      curve = {};
    };
    if (curve.thrust_n.size() != curve.time_s.size())
      return refuse_count(curve.thrust_n.size(), " thrusts", "one thrust for each time");
    if (!curve.flow_kg_s.empty() && curve.flow_kg_s.size() != curve.time_s.size())
      return refuse_count(curve.flow_kg_s.size(), " mass flows",
                          "one mass flow for each time, or none at all");
    if (!curve.pressure_pa.empty() && curve.pressure_pa.size() != curve.time_s.size())
      return refuse_count(curve.pressure_pa.size(), " chamber pressures",
                          "one chamber pressure for each time, or none at all");
    if (curve.time_s[0] != 0.0)
      fields.Refuse("time[0]", fields.Quote("time[0]") + " is not the time of ignition",
                    "0 as the first time");
    for (std::size_t i = 1; i < curve.time_s.size(); ++i) {
      if (curve.time_s[i] > curve.time_s[i - 1]) continue;
      const std::string at = "time[" + std::to_string(i) + "]",
                        before = "time[" + std::to_string(i - 1) + "]";
      fields.Refuse(at, fields.Quote(at) + " is not later than " + fields.Quote(before) + " before it",
                    "times that increase");
    }
    if (curve.Greatest() == 0.0)
      fields.Refuse("thrust", "the thrust is 0 at all times", "a thrust above 0 somewhere");
    if (!curve.flow_kg_s.empty() && curve.Flown() == 0.0)
      fields.Refuse("mass_flow", "the mass flow is 0 at all times", "a mass flow above 0 somewhere");
    if (curve.time_s.size() <= kThrustCurveCorners || !IsStrictlyIncreasing(curve.time_s)) return;
    curve = Thin(curve);
    // The campaign's text carries the corners alone.
    fields.Replace("time", kTime, curve.time_s);
    fields.Replace("thrust", kForce, curve.thrust_n);
    if (!curve.flow_kg_s.empty()) fields.Replace("mass_flow", kMassFlow, curve.flow_kg_s);
    if (!curve.pressure_pa.empty()) fields.Replace("chamber_pressure", kGasPressure, curve.pressure_pa);
  });
}

ThrustCurve Thin(const ThrustCurve& curve) {
  std::vector<const std::vector<double>*> columns;
  for (const auto* column : {&curve.thrust_n, &curve.flow_kg_s, &curve.pressure_pa})
    if (!column->empty()) columns.push_back(column);
  const std::vector<std::size_t> corners =
      ChooseCorners(curve.time_s, columns, kThrustCurveCorners, kThinnedCurveTolerance);
  ThrustCurve thin;
  for (std::size_t corner : corners) thin.time_s.push_back(curve.time_s[corner]);
  thin.thrust_n = FitCorners(curve.time_s, curve.thrust_n, corners);
  if (!curve.flow_kg_s.empty()) thin.flow_kg_s = FitCorners(curve.time_s, curve.flow_kg_s, corners);
  if (!curve.pressure_pa.empty()) thin.pressure_pa = FitCorners(curve.time_s, curve.pressure_pa, corners);
  thin.thinned = {
      curve.time_s.size(), GreatestMiss(curve.time_s, curve.thrust_n, corners, thin.thrust_n),
      curve.flow_kg_s.empty() ? 0.0 : GreatestMiss(curve.time_s, curve.flow_kg_s, corners, thin.flow_kg_s)};
  return thin;
}

BurnCurve Prepare(const ThrustCurve& curve) {
  const std::vector<double>& flow = curve.flow_kg_s.empty() ? curve.thrust_n : curve.flow_kg_s;
  const double greatest_n = curve.Greatest(), greatest_flow = GreatestOf(flow);
  const double flown = AreaUnder(flow, curve.time_s);
  const std::size_t pieces = curve.time_s.size() - 1;
  BurnCurve prepared;
  prepared.end_s = curve.time_s.back();
  if (!curve.flow_kg_s.empty())
    prepared.impulse_per_flow = curve.Impulse() / greatest_n / (flown / greatest_flow);
  double burnt = 0.0;
  for (std::size_t i = 0; i < pieces; ++i) {
    const double length_s = curve.time_s[i + 1] - curve.time_s[i];
    const bool is_last = i + 1 == pieces;
    const std::size_t at = is_last ? i + 1 : i;
    prepared.begin_s.push_back(curve.time_s[i]);
    prepared.rows.insert(prepared.rows.end(),
                         {curve.time_s[at], curve.thrust_n[at] / greatest_n,
                          (curve.thrust_n[i + 1] - curve.thrust_n[i]) / length_s / greatest_n,
                          is_last ? 0.0 : 1.0 - burnt / flown, flow[at] / greatest_flow,
                          (flow[i + 1] - flow[i]) / length_s / greatest_flow, 0.0, 0.0});
    burnt += 0.5 * (flow[i] + flow[i + 1]) * length_s;
  }
  return prepared;
}

}  // namespace dispersa
