#include "core/vehicle/aerodynamics_build_up.h"

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/drag.h"
#include "core/vehicle/fins.h"
#include "core/vehicle/mould_line.h"
#include "core/vehicle/normal_force.h"
#include "core/vehicle/shock_expansion.h"

namespace dispersa {
namespace {

// Dense where the coefficients bend, so that linear interpolation stays within 1 % of the methods.
const std::vector<double> kMach = {0.0,   0.1,   0.3,   0.5,   0.6,   0.7,   0.75, 0.8,   0.825, 0.85,  0.875,
                                   0.9,   0.925, 0.95,  0.975, 1.0,   1.025, 1.05, 1.075, 1.1,   1.125, 1.15,
                                   1.175, 1.2,   1.225, 1.25,  1.275, 1.3,   1.35, 1.4,   1.45,  1.5,   1.6,
                                   1.7,   1.8,   2.0,   2.25,  2.5,   2.75,  3.0,  3.5,   4.0,   4.5,   5.0,
                                   6.0,   7.0,   8.0,   10.0,  12.0,  14.5,  17.0, 20.0};
const std::vector<double> kIncidence_deg = {
    0.0,  1.0,  2.0,  3.0,  4.0,  5.0,  6.0,   8.0,   10.0,  12.0,  15.0,  18.0,  22.0,  26.0,  30.0,  35.0,
    40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0, 110.0, 120.0, 130.0, 140.0, 150.0, 160.0, 170.0, 175.0, 180.0};

// The normal-force slope leaves slender-body theory between these two Mach numbers.
constexpr double kSlenderMach = 0.8;
constexpr double kCarryOverMach = 2.0;
// The share of shock-expansion theory's excess over slender-body theory that is used. Shock-expansion theory
// overestimates the lift carried over onto cylinders. Linear cross-flow theory underestimates it, and gives
// 0.3 of that excess (an ogive of fineness 3 with 7 diameters of cylinder at Mach 2).
constexpr double kCarryOverShare = 0.5;
// Mach-number independence: above this the slope holds.
constexpr double kHypersonicMach = 8.0;
constexpr double kUnknownNozzleShare = 0.5;  // of the base, for four nozzles in a circle (at most 0.69)

double SmoothStep(double low, double high, double x) {
  const double t = Clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// One stack's body with what its coefficients are made from.
class Stack {
 public:
  Stack(const Vehicle& vehicle, std::size_t index) : Stack(vehicle, vehicle.stages[index]) {
    // A stage has its fins once, in whichever of its burns.
    for (std::size_t i = index; i < vehicle.stages.size();
         i = static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(i))) + 1)
      for (const FinSet& fins : vehicle.stages[i].fins)
        fins_.push_back({fins, 0.5 * vehicle.stages[i].diameter_m});
  }
  Stack(const Vehicle& vehicle, const Stage& lowest)
      : body_(CutMouldLine(vehicle.profile, lowest.bottom_station_m)),
        integrals_(Integrate(body_)),
        slender_(SlenderBody(integrals_)),
        diameter_m_(lowest.diameter_m),
        area_m2_(kPi / 4.0 * Square(lowest.diameter_m)),
        base_area_m2_(kPi * Square(integrals_.base_radius_m)),
        roughness_m_(vehicle.surface_roughness_m) {
    const double exit_m2 = lowest.motor.nozzle_exit_area_m2;
    nozzle_share_ = exit_m2 > 0.0 ? Clamp(exit_m2 / base_area_m2_, 0.0, 1.0) : kUnknownNozzleShare;
  }

  AeroTable Table() const {
    AeroTable table;
    table.reference_area_m2 = area_m2_;
    table.reference_length_m = diameter_m_;
    table.mach = kMach;
    for (const double incidence_deg : kIncidence_deg) {
      table.incidence_rad.push_back(incidence_deg * kRadPerDeg);
    }
    for (const double mach : kMach) AddRow(mach, table);
    return table;
  }

 private:
  void AddRow(double mach, AeroTable& table) const {
    const double friction = Friction(mach) + FinFriction(mach);
    const double forward = friction + ForebodyDrag(mach) + PoweredBaseDrag(mach) + FinWaveDrag(mach);
    const double backward = friction + FlatFaceDrag(mach) * base_area_m2_ / area_m2_;
    const NormalForceSlope slope = WithFins(mach, PotentialSlope(mach));
    const NormalForceSlope backward_slope = WithFins(mach, slender_);
    for (const double incidence_deg : kIncidence_deg) {
      const bool nose_first = incidence_deg <= 90.0;
      const double folded_rad = (nose_first ? incidence_deg : 180.0 - incidence_deg) * kRadPerDeg;
      const double cosine = incidence_deg == 90.0 ? 0.0 : Cos(folded_rad);
      table.ca.push_back((nose_first ? forward : -backward) * Square(cosine));
      const NormalForceSlope& potential = nose_first ? slope : backward_slope;
      AddNormalForce(mach, folded_rad, potential, table);
    }
    table.cmq_per_rad.push_back(PitchDamping() + FinPitchDamping(mach));
    table.clp_per_rad.push_back(RollDamping(mach) + FinRollDampingOf(mach));
  }

  double SkinFriction(double mach) const {
    return SkinFrictionCoefficient(mach, integrals_.length_m, roughness_m_);
  }

  /// On the body's curvature: Hoerner, Fluid-Dynamic Drag, 6-17.
  double Friction(double mach) const {
    const double fineness = integrals_.length_m / (2.0 * integrals_.largest_radius_m);
    const double form = 1.0 + 1.5 / Pow(fineness, 1.5) + 7.0 / (Square(fineness) * fineness);
    return SkinFriction(mach) * form * integrals_.wetted_area_m2 / area_m2_;
  }

  double ForebodyDrag(double mach) const {
    double area_m2 = 0.0;
    for (const MouldSection& section : body_) area_m2 += PressureDragArea(section, mach);
    return area_m2 / area_m2_;
  }

  double PoweredBaseDrag(double mach) const {
    return BaseDrag(mach) * (1.0 - nozzle_share_) * base_area_m2_ / area_m2_;
  }

  NormalForceSlope PotentialSlope(double mach) const {
    if (mach <= kSlenderMach) return slender_;
    const NormalForceSlope fast =
        ShockExpansion(body_, Clamp(mach, kShockExpansionMach, kHypersonicMach)).normal_force;
    const double share = kCarryOverShare * SmoothStep(kSlenderMach, kCarryOverMach, mach);
    return {slender_.area_m2 + share * (fast.area_m2 - slender_.area_m2),
            slender_.moment_m3 + share * (fast.moment_m3 - slender_.moment_m3)};
  }

  void AddNormalForce(double mach, double folded_rad, const NormalForceSlope& slope, AeroTable& table) const {
    const double sine = Sin(folded_rad);
    const double mean_diameter_m = integrals_.planform_area_m2 / integrals_.length_m;
    const double eta = CrossFlowEndFactor(integrals_.length_m / mean_diameter_m, mach);
    const double cross = eta * CrossFlowDrag(mach * sine) * Square(sine);
    const double potential = 0.5 * Sin(2.0 * folded_rad) * Cos(0.5 * folded_rad);
    const double force_m2 = slope.area_m2 * potential + cross * integrals_.planform_area_m2;
    const double moment_m3 = slope.moment_m3 * potential + cross * integrals_.planform_moment_m3;
    table.cn.push_back(force_m2 / area_m2_);
    table.xcp_station_m.push_back(sine == 0.0 ? slope.moment_m3 / slope.area_m2 : moment_m3 / force_m2);
  }

  /// The incidence that a pitch rate adds at station x is q (x - x_mid) / V; each cross-section's
  /// momentum A V^2 times it changes along the body (Munk, Lighthill).
  double PitchDamping() const {
    const double middle_m = 0.5 * integrals_.length_m;
    const double sum_m4 = base_area_m2_ * Square(integrals_.length_m - middle_m) -
                          (integrals_.volume_moment_m4 - middle_m * integrals_.volume_m3);
    return -4.0 * sum_m4 / (area_m2_ * Square(diameter_m_));
  }

  /// Skin friction turns with the surface by p r / V.
  double RollDamping(double mach) const {
    return -2.0 * SkinFriction(mach) * integrals_.roll_moment_m4 / (area_m2_ * Square(diameter_m_));
  }

  struct Mounted {
    FinSet fins;
    double radius_m;
  };

  NormalForceSlope WithFins(double mach, NormalForceSlope slope) const {
    for (const Mounted& m : fins_) {
      const FinForce force = ForceOfFins(m.fins, m.radius_m, mach);
      slope.area_m2 += force.area_m2;
      slope.moment_m3 += force.area_m2 * force.station_m;
    }
    return slope;
  }
  /// On both sides of flat plates, thickened: Hoerner, Fluid-Dynamic Drag, 6-6.
  double FinFriction(double mach) const {
    double area_m2 = 0.0;
    for (const Mounted& m : fins_) {
      const double chord_m = 0.5 * (m.fins.root_chord_m + m.fins.tip_chord_m);
      area_m2 += 2.0 * m.fins.count * FinArea(m.fins) * (1.0 + 2.0 * m.fins.thickness_m / chord_m) *
                 SkinFrictionCoefficient(mach, chord_m, roughness_m_);
    }
    return area_m2 / area_m2_;
  }
  double FinWaveDrag(double mach) const {
    double area_m2 = 0.0;
    for (const Mounted& m : fins_) area_m2 += FinWaveDragArea(m.fins, mach);
    return area_m2 / area_m2_;
  }
  /// The incidence that a pitch rate adds where the fins are, about the middle as the body's.
  double FinPitchDamping(double mach) const {
    double sum_m4 = 0.0;
    for (const Mounted& m : fins_) {
      const FinForce force = ForceOfFins(m.fins, m.radius_m, mach);
      sum_m4 += force.area_m2 * Square(force.station_m - 0.5 * integrals_.length_m);
    }
    return -2.0 * sum_m4 / (area_m2_ * Square(diameter_m_));
  }
  double FinRollDampingOf(double mach) const {
    double sum_m4 = 0.0;
    for (const Mounted& m : fins_) sum_m4 += FinRollDamping(m.fins, m.radius_m, mach);
    return -2.0 * sum_m4 / (area_m2_ * Square(diameter_m_));
  }

  std::vector<Mounted> fins_;
  std::vector<MouldSection> body_;
  BodyIntegrals integrals_;
  NormalForceSlope slender_;
  double diameter_m_;
  double area_m2_;
  double base_area_m2_;
  double roughness_m_;
  double nozzle_share_;
};

}  // namespace

std::vector<AeroTable> BuildAerodynamics(const Vehicle& vehicle) {
  DISPERSA_ASSERT(!vehicle.profile.empty() && ProfileProblems(vehicle.profile).empty());
  std::vector<AeroTable> tables;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i) tables.push_back(Stack(vehicle, i).Table());
  return tables;
}

namespace {

bool LacksDamping(const AeroTable& table) {
  return table.cmq_per_rad.empty() || table.clp_per_rad.empty() ||
         std::any_of(table.yaw_plane.begin(), table.yaw_plane.end(), LacksDamping) ||
         std::any_of(table.lighter.begin(), table.lighter.end(),
                     [](const AeroConfiguration& lighter) { return LacksDamping(lighter.table); });
}

void AddDamping(const AeroTable& built, AeroTable& table) {
  // On q d / (2 V) and q S d: the moment of a rate is in proportion to S d^2.
  const double scale = built.reference_area_m2 * Square(built.reference_length_m) /
                       (table.reference_area_m2 * Square(table.reference_length_m));
  const auto fill = [&](const std::vector<double>& from, std::vector<double>& to) {
    if (!to.empty()) return;
    const Table1D over_mach{built.mach, from};
    for (double mach : table.mach) to.push_back(scale * over_mach(mach));
  };
  fill(built.cmq_per_rad, table.cmq_per_rad);
  fill(built.clp_per_rad, table.clp_per_rad);
  for (AeroTable& yaw : table.yaw_plane) AddDamping(built, yaw);
  for (AeroConfiguration& lighter : table.lighter) AddDamping(built, lighter.table);
}

bool HasYawPlane(const AeroTable& table) {
  return !table.yaw_plane.empty() ||
         std::any_of(table.lighter.begin(), table.lighter.end(),
                     [](const AeroConfiguration& lighter) { return HasYawPlane(lighter.table); });
}
void AddYawPlane(AeroTable& table) {
  for (AeroConfiguration& lighter : table.lighter) AddYawPlane(lighter.table);
  if (!table.yaw_plane.empty()) return;
  AeroTable same = table;
  same.lighter.clear();
  table.yaw_plane.push_back(std::move(same));
}

}  // namespace

bool NeedsProfile(const Vehicle& vehicle) {
  return vehicle.aerodynamics.empty() ||
         std::any_of(vehicle.aerodynamics.begin(), vehicle.aerodynamics.end(), LacksDamping);
}

std::vector<AeroTable> AerodynamicsOf(const Vehicle& vehicle) {
  if (vehicle.aerodynamics.empty()) return BuildAerodynamics(vehicle);
  std::vector<AeroTable> tables = vehicle.aerodynamics;
  if (NeedsProfile(vehicle)) {
    const std::vector<AeroTable> built = BuildAerodynamics(vehicle);
    for (std::size_t i = 0; i < tables.size(); ++i) AddDamping(built[i], tables[i]);
  }
  if (std::any_of(tables.begin(), tables.end(), HasYawPlane))
    for (AeroTable& table : tables) AddYawPlane(table);
  return tables;
}

}  // namespace dispersa
