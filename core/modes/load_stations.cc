#include "core/modes/load_stations.h"

#include <algorithm>
#include <cmath>

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/modes/lift_distribution.h"
#include "core/modes/load_table.h"
#include "core/structure/free_body.h"
#include "core/structure/mass_points.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/booster_course.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

constexpr int kEvenCandidates = 240;
constexpr double kAhead_m = 1e-3;
constexpr int kProportions = 36;
// Of the range of propellant, and of the length by which the centre of pressure lies aft of slender-body
// theory's.
constexpr double kLevels[] = {0.0, 0.25, 0.5, 0.75, 1.0}, kAft[] = {-0.1, -0.05, 0.0, 0.05, 0.1};

// Moments along the candidates, over the largest of each.
using Moments = std::vector<double>;

void ScaleToLargest(Moments& moments) {
  double largest = 0.0;
  for (const double m : moments) largest = std::max(largest, std::fabs(m));
  if (largest > 0.0)
    for (double& m : moments) m /= largest;
}

// Ahead of the pivot: behind it no section carries anything but the nozzle.
std::vector<double> Candidates(const BeamMasses& masses, double bottom_m, double pivot_m) {
  const double end_m = std::min(bottom_m, pivot_m);
  std::vector<double> stations;
  for (int i = 1; i < kEvenCandidates; ++i) stations.push_back(end_m * i / kEvenCandidates);
  const auto add = [&](double station_m) {
    if (station_m > 0.0 && station_m < end_m) stations.push_back(station_m);
  };
  for (const SpreadMass& m : masses.spread) add(m.top_station_m), add(m.bottom_station_m);
  // A body's moment about its station comes in at once.
  for (const FixedMass& m : masses.fixed) add(m.station_m), add(m.station_m - kAhead_m);
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  return stations;
}

// A side force at a station and a couple.
struct SideLoad {
  double force = 1.0, at_m = 0.0, couple_m = 0.0;
};
// A load and the body's answer: the moments of the mass ahead, less `applied`.
Moments Answer(const std::vector<double>& stations, const FreeBody& body, const SideLoad& load,
               const Moments& applied) {
  const double push = load.force / body.mass_kg,
               turn = (load.force * (body.cg_station_m - load.at_m) + load.couple_m) /
                      body.inertia_kg_m2;  // its growth per metre ahead
  Moments moments(stations.size());
  double force_n = 0.0, about_nose_n_m = 0.0;  // of the mass ahead
  std::size_t next = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    for (; next < body.points.size() && body.points[next].fixed_at_m <= stations[i]; ++next) {
      const MassPoint& m = body.points[next];
      const double carried_n = m.mass_kg * (push + turn * (body.cg_station_m - m.cg_station_m));
      force_n += carried_n;
      about_nose_n_m += carried_n * m.cg_station_m - m.inertia_kg_m2 * turn;
    }
    moments[i] = force_n * stations[i] - about_nose_n_m - applied[i];
  }
  ScaleToLargest(moments);
  return moments;
}

// The moments of a unit normal force ahead of each station, with the centre of pressure `aft_m` of
// slender-body theory's.
Moments LiftAhead(const LiftDistribution& lift, const std::vector<double>& stations, double aft_m) {
  Moments moments(stations.size());
  lift.ForEach([](double) { return 1.0; },
               [&](double at_m, double slender, double shift) {
                 for (std::size_t i = stations.size(); i-- > 0 && stations[i] > at_m;)
                   moments[i] += (slender + aft_m * shift) * (stations[i] - at_m);
               });
  return moments;
}

// Of boosters: a side force at their nozzles, and a couple. Both come in at their attachment.
std::vector<Moments> ByBoosters(const std::vector<double>& stations, const FreeBody& body,
                                const Boosters& boosters) {
  const SideLoad force{1.0, boosters.nozzle_station_m, 0.0}, couple{0.0, 0.0, 1.0};
  std::vector<Moments> moments;
  for (const SideLoad& load : {force, couple}) {
    Moments applied(stations.size(), 0.0);
    for (std::size_t i = 0; i < stations.size(); ++i)
      if (stations[i] >= boosters.attachment_station_m)
        applied[i] = load.force * (stations[i] - load.at_m) + load.couple_m;
    moments.push_back(Answer(stations, body, load, applied));
  }
  return moments;
}

// Both in any proportion.
void AddBoth(const Moments& one, const Moments& other, std::vector<Moments>& family) {
  for (int k = 0; k < kProportions; ++k) {
    const double angle = kPi * k / kProportions, cosine = Cos(angle), sine = Sin(angle);
    Moments both(one.size());
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = std::fabs(cosine * one[i] + sine * other[i]);
    ScaleToLargest(both);
    family.push_back(std::move(both));
  }
}

// Adds those of a stack that burns its propellant from `full_kg` down to `least_kg`.
void AddFamily(const Vehicle& vehicle, int stage, const std::vector<double>& stations, unsigned gone,
               double least_kg, double full_kg, std::vector<Moments>& family) {
  const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
  const LiftDistribution lift = DistributeLift(vehicle, stage);
  struct Air {
    double at_m;
    Moments ahead;
  };
  std::vector<Air> air;
  for (const double aft : kAft) {
    const double aft_m = aft * lowest.bottom_station_m;
    air.push_back({lift.slender_station_m + aft_m, LiftAhead(lift, stations, aft_m)});
  }
  for (const double part : kLevels) {
    const double propellant_kg = least_kg + part * (full_kg - least_kg);
    const FreeBody body(BuildBeamMasses(vehicle, stage, propellant_kg, gone), stations);
    std::vector<Moments> others;
    if (CarriedBy(vehicle, stage) & ~gone & kBoostersGone)
      others = ByBoosters(stations, body, vehicle.boosters);
    others.push_back(
        Answer(stations, body, {1.0, lowest.gimbal.pivot_station_m, 0.0}, Moments(stations.size(), 0.0)));
    for (const Air& each : air) {
      const Moments by_air = Answer(stations, body, {1.0, each.at_m, 0.0}, each.ahead);
      for (const Moments& other : others) AddBoth(by_air, other, family);
    }
    for (std::size_t i = 0; i + 1 < others.size(); ++i)
      for (std::size_t k = i + 1; k < others.size(); ++k) AddBoth(others[i], others[k], family);
  }
}

std::vector<Moments> FamilyOf(const Vehicle& vehicle, int stage, const std::vector<double>& stations) {
  const double full_kg = vehicle.stages[static_cast<std::size_t>(stage)].propellant_mass_kg;
  std::vector<Moments> family;
  if (!(CarriedBy(vehicle, stage) & kBoostersGone)) {
    AddFamily(vehicle, stage, stations, 0u, 0.0, full_kg, family);
    return family;
  }
  const BoosterCourse course(vehicle);
  AddFamily(vehicle, stage, stations, 0u, course.StageAtBurnout(), full_kg, family);
  AddFamily(vehicle, stage, stations, kBoostersGone, 0.0, course.StageAtSeparation(), family);
  return family;
}

/// Puts first those that see most of every moment: again and again the best one for the moment of which least
/// is seen. `chosen`: indices into the moments.
double PutScoutsFirst(const std::vector<Moments>& family, std::vector<std::size_t>& chosen) {
  std::vector<double> seen(family.size(), 0.0);
  const std::size_t scouts = std::min<std::size_t>(kScoutStations, chosen.size());
  for (std::size_t scout = 0; scout < scouts; ++scout) {
    const auto least = static_cast<std::size_t>(std::min_element(seen.begin(), seen.end()) - seen.begin());
    const auto best =
        std::max_element(chosen.begin() + static_cast<std::ptrdiff_t>(scout), chosen.end(),
                         [&](std::size_t a, std::size_t b) { return family[least][a] < family[least][b]; });
    std::iter_swap(chosen.begin() + static_cast<std::ptrdiff_t>(scout), best);
    for (std::size_t i = 0; i < family.size(); ++i) seen[i] = std::max(seen[i], family[i][chosen[scout]]);
  }
  return seen.empty() ? 0.0 : *std::min_element(seen.begin(), seen.end());
}

}  // namespace

LoadStations ChooseLoadStations(const Vehicle& vehicle, int stage, std::size_t most) {
  DISPERSA_ASSERT(!vehicle.profile.empty(), stage);
  DISPERSA_ASSERT(most > 0);
  const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
  const std::vector<double> stations = Candidates(BuildBeamMasses(vehicle, stage, lowest.propellant_mass_kg),
                                                  lowest.bottom_station_m, lowest.gimbal.pivot_station_m);
  const std::vector<Moments> family = FamilyOf(vehicle, stage, stations);
  std::vector<const Moments*> missed;
  std::vector<std::size_t> sees(stations.size());  // of the missed ones, at each station
  const auto is_seen = [](double moment) { return moment >= 1.0 - kMissedMoment; };
  for (const Moments& moments : family) {
    missed.push_back(&moments);
    for (std::size_t i = 0; i < sees.size(); ++i) sees[i] += is_seen(moments[i]);
  }
  std::vector<std::size_t> chosen;
  // The station that has the largest of most moments, then that of most of the rest.
  while (!missed.empty() && chosen.size() < most) {
    const auto best = static_cast<std::size_t>(std::max_element(sees.begin(), sees.end()) - sees.begin());
    std::erase_if(missed, [&](const Moments* moments) {
      if (!is_seen((*moments)[best])) return false;
      for (std::size_t i = 0; i < sees.size(); ++i) sees[i] -= is_seen((*moments)[i]);
      return true;
    });
    chosen.push_back(best);
  }
  LoadStations all;
  all.scouts_see = PutScoutsFirst(family, chosen);
  for (const std::size_t station : chosen) all.station_m.push_back(stations[station]);
  return all;
}

}  // namespace dispersa
