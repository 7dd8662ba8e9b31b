// The chosen cross-sections see the largest bending moment of loads that they were not chosen by.
#include "core/modes/load_stations.h"

#include "core/campaign_yaml/load.h"
#include "core/math/constants.h"
#include "core/modes/lift_distribution.h"
#include "core/modes/load_table.h"
#include "core/structure/free_body.h"
#include "core/vehicle/mass.h"
#include "tests/test.h"

namespace dispersa::modes_load_stations_test {
namespace {

/// The moments on sections of a body that a unit force at `at_m` accelerates; the force acts behind all of
/// them.
std::vector<double> Carried(const std::vector<double>& stations, const FreeBody& body, double at_m) {
  std::vector<double> moments;
  for (const double s : stations) {
    double sum = 0.0;
    for (const MassPoint& m : body.points) {
      if (m.fixed_at_m > s) break;
      const double turn = (body.cg_station_m - at_m) / body.inertia_kg_m2;
      sum += m.mass_kg * (1.0 / body.mass_kg + turn * (body.cg_station_m - m.cg_station_m)) *
                 (s - m.cg_station_m) +
             m.inertia_kg_m2 * turn;
    }
    moments.push_back(sum);
  }
  return moments;
}

struct Missed {
  double worst = 0.0, mean = 0.0;
};

/// By how much `chosen` stations see less than a fine row of stations, over proportions of the two forces,
/// levels of propellant and centres of pressure between those that the choice looks at.
Missed MissedBy(const Vehicle& vehicle, int stage, const std::vector<double>& chosen) {
  const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
  const double end_m = std::min(lowest.bottom_station_m, lowest.gimbal.pivot_station_m);
  std::vector<double> stations = chosen;
  for (int i = 1; i < 1000; ++i) stations.push_back(end_m * i / 1000.0);
  for (const FixedMass& m : BuildBeamMasses(vehicle, stage, 0.0).fixed)
    if (m.station_m < end_m) stations.push_back(m.station_m);
  std::sort(stations.begin(), stations.end());
  const LiftDistribution lift = DistributeLift(vehicle, stage);
  Missed missed;
  int cases = 0;
  for (const double part : {0.0, 0.2, 0.35, 0.5, 0.8, 1.0}) {
    const FreeBody body(BuildBeamMasses(vehicle, stage, part * lowest.propellant_mass_kg), stations);
    std::vector<double> by_pivot = Carried(stations, body, lowest.gimbal.pivot_station_m);
    for (const double of_length : {-0.06, 0.0, 0.05}) {
      const double aft_m = of_length * lowest.bottom_station_m;
      std::vector<double> by_air = Carried(stations, body, lift.slender_station_m + aft_m);
      lift.ForEach([](double) { return 1.0; },
                   [&](double at_m, double slender, double shift) {
                     for (std::size_t i = 0; i < stations.size(); ++i)
                       by_air[i] -= (slender + aft_m * shift) * std::max(stations[i] - at_m, 0.0);
                   });
      const auto largest = [](const std::vector<double>& of) {
        return std::fabs(*std::max_element(of.begin(), of.end(),
                                           [](double a, double b) { return std::fabs(a) < std::fabs(b); }));
      };
      const double air = largest(by_air), pivot = largest(by_pivot);
      for (int k = 0; k < 37; ++k) {
        double all = 0.0, seen = 0.0;
        for (std::size_t i = 0; i < stations.size(); ++i) {
          const double m = std::fabs(std::cos(kPi * k / 37) * by_air[i] / air +
                                     std::sin(kPi * k / 37) * by_pivot[i] / pivot);
          all = std::max(all, m);
          if (std::find(chosen.begin(), chosen.end(), stations[i]) != chosen.end()) seen = std::max(seen, m);
        }
        missed.worst = std::max(missed.worst, 1.0 - seen / all);
        missed.mean += 1.0 - seen / all;
        ++cases;
      }
    }
  }
  missed.mean /= cases;
  return missed;
}

TEST(LoadStations, SeeTheLargestMoment) {
  for (const char* file :
       {"/vehicles/slv4.yaml", "/gallery/falcon9/vehicle.yaml", "/gallery/vega/vehicle.yaml"}) {
    const Vehicle vehicle = LoadVehicle(std::string(DISPERSA_CAMPAIGNS) + file);
    for (const int stage : {0, 1}) {
      const LoadStations stations = ChooseLoadStations(vehicle, stage, kLoadStations);
      const std::vector<double>& chosen = stations.station_m;
      // The scouts, of which flights believe nine tenths of what is said of them.
      const Missed by_scouts = MissedBy(vehicle, stage, {chosen.begin(), chosen.begin() + kScoutStations});
      EXPECT_GT(stations.scouts_see, 0.8) << file << stage;
      EXPECT_GT(1.0 - by_scouts.worst, 0.95 * stations.scouts_see) << file << stage;
      const Missed missed = MissedBy(vehicle, stage, chosen);
      RecordProperty(std::string(file) + std::to_string(stage),
                     std::to_string(missed.worst) + ", mean " + std::to_string(missed.mean));
      EXPECT_LT(missed.worst, 0.005) << file << stage << ", " << chosen.size() << " stations";
      EXPECT_LT(missed.mean, 0.0004) << file << stage;
      // As many even ones see less.
      std::vector<double> even;
      const Stage& lowest = vehicle.stages[static_cast<std::size_t>(stage)];
      const double end_m = std::min(lowest.bottom_station_m, lowest.gimbal.pivot_station_m);
      for (std::size_t i = 1; i <= chosen.size(); ++i)
        even.push_back(end_m * static_cast<double>(i) / static_cast<double>(chosen.size() + 1));
      EXPECT_GT(MissedBy(vehicle, stage, even).worst, 2.0 * missed.worst) << file << stage;
    }
  }
}

// Beside boosters: all four loads at once, in proportions that the choice does not look at.
TEST(LoadStations, SeeTheLargestMomentBesideBoosters) {
  for (const char* file : {"/gallery/soyuz/vehicle.yaml", "/gallery/ariane5/vehicle.yaml"}) {
    const Vehicle vehicle = LoadVehicle(std::string(DISPERSA_CAMPAIGNS) + file);
    const Stage& core = vehicle.stages[0];
    const Boosters& boosters = vehicle.boosters;
    const LoadStations found = ChooseLoadStations(vehicle, 0, kLoadStations);
    const double end_m = std::min(core.bottom_station_m, core.gimbal.pivot_station_m);
    std::vector<double> stations = found.station_m;
    for (int i = 1; i < 1000; ++i) stations.push_back(end_m * i / 1000.0);
    const double link_m = boosters.attachment_station_m;
    stations.push_back(link_m);
    stations.push_back(link_m - 1e-3);
    std::sort(stations.begin(), stations.end());
    const LiftDistribution lift = DistributeLift(vehicle, 0);
    double worst = 0.0, worst_scouts = 0.0, sum = 0.0;
    int cases = 0;
    for (const bool gone : {false, true})
      for (const double part : gone ? std::vector{0.05, 0.3, 0.55} : std::vector{0.65, 0.8, 0.95}) {
        const FreeBody body(
            BuildBeamMasses(vehicle, 0, part * core.propellant_mass_kg, gone ? kBoostersGone : 0u), stations);
        for (const double of_length : {-0.06, 0.0, 0.05}) {
          const double aft_m = of_length * core.bottom_station_m;
          std::vector<std::vector<double>> loads = {Carried(stations, body, core.gimbal.pivot_station_m),
                                                    Carried(stations, body, lift.slender_station_m + aft_m)};
          lift.ForEach([](double) { return 1.0; },
                       [&](double at_m, double slender, double shift) {
                         for (std::size_t i = 0; i < stations.size(); ++i)
                           loads[1][i] -= (slender + aft_m * shift) * std::max(stations[i] - at_m, 0.0);
                       });
          if (!gone) {
            // Two side forces of the boosters that differ by a couple.
            for (const double at_m : {boosters.nozzle_station_m, boosters.nozzle_station_m - 30.0}) {
              loads.push_back(Carried(stations, body, at_m));
              for (std::size_t i = 0; i < stations.size(); ++i)
                if (stations[i] >= link_m) loads.back()[i] -= stations[i] - at_m;
            }
          }
          std::vector<double> largest;
          for (const std::vector<double>& load : loads) {
            double most = 0.0;
            for (const double m : load) most = std::max(most, std::fabs(m));
            largest.push_back(most);
          }
          for (int k = 0; k < 60; ++k) {
            double all = 0.0, seen = 0.0, by_scouts = 0.0;
            for (std::size_t i = 0; i < stations.size(); ++i) {
              double m = 0.0;
              for (std::size_t load = 0; load < loads.size(); ++load)
                m += std::cos(0.7 * k * (1.0 + 0.63 * static_cast<double>(load))) * loads[load][i] /
                     largest[load];
              all = std::max(all, std::fabs(m));
              const auto at = std::find(found.station_m.begin(), found.station_m.end(), stations[i]);
              if (at == found.station_m.end()) continue;
              seen = std::max(seen, std::fabs(m));
              if (at - found.station_m.begin() < kScoutStations)
                by_scouts = std::max(by_scouts, std::fabs(m));
            }
            worst = std::max(worst, 1.0 - seen / all);
            if (gone) worst_scouts = std::max(worst_scouts, 1.0 - by_scouts / all);
            sum += 1.0 - seen / all;
            ++cases;
          }
        }
      }
    RecordProperty(std::string(file), std::to_string(found.station_m.size()) + " stations, scouts see " +
                                          std::to_string(found.scouts_see) + ", missed at most " +
                                          std::to_string(worst) + ", mean " + std::to_string(sum / cases));
    EXPECT_LT(worst, 0.02) << file;
    EXPECT_LT(sum / cases, 0.001) << file;
    // Flights believe the scouts where the boosters have left.
    EXPECT_GT(1.0 - worst_scouts, 0.9 * found.scouts_see) << file;
  }
}

TEST(LoadStations, AreAtMostAsManyAsThereIsRoomFor) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  const std::vector<double> few = ChooseLoadStations(vehicle, 0, 5).station_m,
                            all = ChooseLoadStations(vehicle, 0, 100).station_m;
  EXPECT_EQ(few.size(), 5u);
  EXPECT_LE(all.size(), static_cast<std::size_t>(kLoadStations));
  EXPECT_GT(MissedBy(vehicle, 0, few).worst, MissedBy(vehicle, 0, all).worst);
}

// Drawn masses are looked at where the nominal ones are.
TEST(LoadStations, OfDrawnMassesAreTheNominalOnes) {
  const Vehicle vehicle = LoadVehicle(DISPERSA_CAMPAIGNS "/vehicles/slv4.yaml");
  Vehicle lighter = vehicle;
  lighter.stages[0].propellant_mass_kg *= 0.7;
  lighter.stages[0].liftoff_mass_kg -= 0.3 * vehicle.stages[0].propellant_mass_kg;
  const LoadTable nominal = BuildLoadTable(vehicle, 0), own = BuildLoadTable(lighter, 0),
                  of_nominal = BuildLoadTable(lighter, 0, &nominal);
  EXPECT_EQ(of_nominal.station_m, nominal.station_m);
  EXPECT_EQ(of_nominal.stations, nominal.stations);
  EXPECT_NE(own.station_m, nominal.station_m);
  EXPECT_NE(of_nominal.first_kg_m, nominal.first_kg_m);
}

}  // namespace
}  // namespace dispersa::modes_load_stations_test
