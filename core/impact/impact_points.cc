#include "core/impact/impact_points.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/jettison.h"
#include "core/flight/dispersed_vehicle.h"
#include "core/flight/sequence.h"
#include "core/math/constants.h"
#include "core/optimization/parallel_for.h"
#include "core/vehicle/cut_off.h"
#include "core/vehicle/mass.h"

namespace dispersa {
namespace {

/// No rows but the first one and those of events.
constexpr double kEventsOnly_s = 1e6;
/// Flights whose rows are in memory at a time: about 10 MB.
constexpr std::size_t kFlownTogether = 2000;

class HistoryReader {
 public:
  explicit HistoryReader(const History& history) : history_(history) {}

  double At(std::size_t row, const char* column) const { return history_.at(row, FindHistoryColumn(column)); }
  int Stack(std::size_t row) const { return static_cast<int>(At(row, "stage")) - 1; }
  /// The history gives attitude relative to local north, east and down. The position gives these axes in I.
  RigidBodyState State(const Earth& earth, std::size_t row) const {
    RigidBodyState s;
    s.p_EoC_I = {At(row, "eci_x_m"), At(row, "eci_y_m"), At(row, "eci_z_m")};
    s.v_IC_I = {At(row, "eci_vx_m_s"), At(row, "eci_vy_m_s"), At(row, "eci_vz_m_s")};
    s.w_IB_B = kRadPerDeg * Vector3(At(row, "p_deg_s"), At(row, "q_deg_s"), At(row, "r_deg_s"));
    const Geodetic place = ToGeodetic(earth, s.p_EoC_I);
    s.q_IB = QuaternionOf(NedAxes(place.latitude_rad, place.longitude_rad)) *
             FromYawPitchRoll({At(row, "yaw_deg") * kRadPerDeg, At(row, "pitch_deg") * kRadPerDeg,
                               At(row, "roll_deg") * kRadPerDeg});
    return s;
  }

 private:
  const History& history_;
};

/// Centre of gravity of the empty stage alone.
double DryStation(const Stage& stage) {
  double station_m = 0.0;
  for (const MassElement& element : stage.structure)
    station_m += element.fraction * 0.5 * (element.top_station_m + element.bottom_station_m);
  return station_m;
}

/// The top of the stage: the bottom of the stage above, or the nose.
double TopStation(const Vehicle& vehicle, int stage) {
  const std::size_t above = static_cast<std::size_t>(LastBurn(vehicle, stage)) + 1;
  return above < vehicle.stages.size() ? vehicle.stages[above].bottom_station_m : 0.0;
}

/// Centre of gravity of one that has burnt out, with what its tanks have left.
double SpentStation(const Boosters& boosters, const EachBooster& one) {
  const double shell_m = 0.5 * (boosters.top_station_m + boosters.bottom_station_m);
  const double left_kg = one.burn.left_kg;
  if (!(left_kg > 0.0)) return shell_m;
  const DrainingMass& tanks = one.tanks;
  const double first_kg_m =
      tanks.first_kg_m + left_kg * (tanks.first_per_kg_m + left_kg * tanks.first_per_kg2_m);
  return (one.dry_kg * shell_m + first_kg_m) / (one.dry_kg + left_kg);
}

/// Since lift-off, if the vehicle has boosters.
std::optional<double> BoosterSeparation(const Vehicle& vehicle, const LauncherPlant& plant,
                                        const CampaignFlights& flights) {
  if (!plant.boosters) return std::nullopt;
  const double ignition_s = -vehicle.hold_down_s;
  const StageTimes core = {ignition_s, ignition_s + plant.stacks[0].burn.duration_s, 0.0};
  const MotorBurn* last = &plant.boosters->each[0].burn;
  for (const EachBooster& one : plant.boosters->each)
    if (one.burn.duration_s > last->duration_s) last = &one.burn;
  return BuildBoosterTimes(vehicle.boosters, *last, core, flights.model().definition().autopilot.tick_s)
      .separation_s;
}

}  // namespace

std::vector<ImpactPoint> ImpactPoints(const CampaignFlights& flights, const CaseResult& result,
                                      const History& history, const FallSteps& steps) {
  const FlightInputs inputs = flights.Draw(result.case_index);
  const Vehicle vehicle = WithDispersedMasses(flights.model().definition().vehicle, inputs);
  const LauncherPlant plant = flights.model().PlantFor(inputs, result.case_index);
  const Environment& environment = plant.environment;
  const HistoryReader rows(history);
  std::vector<ImpactPoint> points;
  const auto fall = [&](ImpactPoint point, const FallingBody& body, const FallState& start) {
    point.case_index = result.case_index;
    point.from_time_s = start.time_s;
    point.from_altitude_m = ToGeodetic(environment.earth, start.p_EoP_I).altitude_m;
    point.impact = Fall(environment, body, start, steps);
    points.push_back(std::move(point));
  };

  const std::optional<double> boosters_left_s = BoosterSeparation(vehicle, plant, flights);
  for (std::size_t row = 0; boosters_left_s && row < history.rows(); ++row) {
    // The row of the event shows the state without them.
    if (std::fabs(rows.At(row, "time_s") - *boosters_left_s) > kSameInstant_s || rows.Stack(row) != 0)
      continue;
    if (row + 1 < history.rows() && rows.At(row + 1, "time_s") - *boosters_left_s < kSameInstant_s) continue;
    const RigidBodyState left = rows.State(environment.earth, row);
    const Boosters& boosters = vehicle.boosters;
    const double since_s = *boosters_left_s + vehicle.hold_down_s;
    const LauncherStack& stack = plant.stacks[0];
    const MassProperties mass = MassesOn(plant, 0, kBoostersGone, stack.burn.Propellant(since_s), since_s);
    const Vector3 aside_m = LateralMoment(stack, stack.burn.Propellant(since_s)) / mass.mass_kg;
    for (const EachBooster& one : plant.boosters->each) {
      const FallingBody body = {
          one.dry_kg + one.burn.left_kg,
          TumblingCylinderDragArea(boosters.bottom_station_m - boosters.top_station_m, boosters.diameter_m)};
      const double ahead_m = mass.cg_station_m - SpentStation(boosters, one);
      const RigidBodyState spent =
          AtPoint(left, Vector3(ahead_m, one.y_m - aside_m.y(), one.z_m - aside_m.z()));
      fall({.stage = 0, .lost = false}, body, {*boosters_left_s, spent.p_EoC_I, spent.v_IC_I});
    }
    break;
  }

  for (std::size_t row = 1; row < history.rows(); ++row) {
    const int below = rows.Stack(row - 1);
    if (rows.Stack(row) == below) continue;
    // The row shows the full stack above, with its tip-off rates. The stage below does not have these rates.
    const auto stage = static_cast<std::size_t>(below);
    if (vehicle.stages[stage + 1].restarts) continue;  // nothing has left
    RigidBodyState above = rows.State(environment.earth, row);
    above.w_IB_B -= Vector3(inputs.stages[stage].tip_off_roll_rad_s, inputs.stages[stage].tip_off_pitch_rad_s,
                            inputs.stages[stage].tip_off_yaw_rad_s);
    const StackMass& mass = plant.stacks[stage + 1].mass;
    const double aft_m = DryStation(vehicle.stages[stage]) - mass.At(mass.propellant_mass_kg).cg_station_m;
    const RigidBodyState spent = AtPoint(above, Vector3(-aft_m, 0.0, 0.0));
    // If the engine is cut off at a velocity, only the flight knows the propellant left.
    const double spent_kg = EndsAtSpeed(vehicle.stages[stage].motor)
                                ? rows.At(row - 1, "mass_kg") - rows.At(row, "mass_kg")
                                : DryMass(vehicle, below) + plant.stacks[stage].burn.left_kg;
    const double length_m = vehicle.stages[stage].bottom_station_m - TopStation(vehicle, below);
    fall({.stage = below + 1, .lost = false},
         {spent_kg, TumblingCylinderDragArea(length_m, vehicle.stages[stage].diameter_m)},
         {rows.At(row, "time_s"), spent.p_EoC_I, spent.v_IC_I});
  }

  // The flight itself has followed its last stage to the ground.
  if (flights.model().definition().course.ends == FlightEnd::kImpact &&
      result.outcome == Outcome::kCompleted) {
    const auto metric = [&](const char* name) { return result.metrics[MetricColumn(name)]; };
    ImpactPoint point{.case_index = result.case_index,
                      .stage = static_cast<int>(vehicle.stages.size()),
                      .from_time_s = metric("apogee_time_s"),
                      .from_altitude_m = metric("apogee_altitude_km") * 1e3};
    point.impact =
        Impact{.time_s = metric("impact_time_s"),
               .place = {metric("impact_latitude_deg") * kRadPerDeg,
                         metric("impact_longitude_deg") * kRadPerDeg, vehicle.descent.ground_altitude_m},
               .speed_m_s = metric("impact_speed_m_s"),
               .peak_altitude_m = point.from_altitude_m};
    points.push_back(point);
  }

  if (result.outcome != Outcome::kCompleted) {
    // A loss has no row of its own. With a row at its tick the last one is the flight's end.
    const double tick_s = flights.model().definition().autopilot.tick_s;
    History again;
    again.step_s = std::max(1.0, std::floor(result.end_time_s / tick_s + 1e-6)) * tick_s;
    flights.FlyCase(result.case_index, &again);
    if (again.rows() == 0) return points;  // refused before it flew
    const HistoryReader last(again);
    const std::size_t end = again.rows() - 1;
    const RigidBodyState state = last.State(environment.earth, end);
    if (state.p_EoC_I.allFinite() && state.v_IC_I.allFinite()) {
      const Stage& stage = vehicle.stages[static_cast<std::size_t>(result.end_stage) - 1];
      fall({.stage = result.end_stage, .lost = true},
           {last.At(end, "mass_kg"), TumblingCylinderDragArea(stage.bottom_station_m, stage.diameter_m)},
           {last.At(end, "time_s"), state.p_EoC_I, state.v_IC_I});
    }
  }
  return points;
}

std::vector<ImpactPoint> FlyToImpact(const CampaignFlights& flights, const std::vector<std::uint64_t>& cases,
                                     int threads, const std::function<void(const CaseResult&)>& flown) {
  struct Flown {
    CaseResult result;
    History history;
  };
  std::vector<ImpactPoint> points;
  for (std::size_t first = 0; first < cases.size(); first += kFlownTogether) {
    std::vector<CaseOrder> orders;
    for (std::size_t i = first; i < std::min(cases.size(), first + kFlownTogether); ++i)
      orders.push_back({cases[i], kEventsOnly_s});
    std::vector<Flown> together(orders.size());
    flights.FlyCases(orders, threads, [&](std::size_t i, CaseResult result, const History& history) {
      flown(result);
      together[i] = {std::move(result), history};
    });
    std::vector<std::vector<ImpactPoint>> fallen(orders.size());
    ParallelFor(orders.size(), static_cast<std::size_t>(std::max(1, threads)), [&](std::size_t i) {
      fallen[i] = ImpactPoints(flights, together[i].result, together[i].history);
    });
    for (const auto& of_case : fallen) points.insert(points.end(), of_case.begin(), of_case.end());
  }
  return points;
}

}  // namespace dispersa
