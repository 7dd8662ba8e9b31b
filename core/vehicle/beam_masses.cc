#include "core/vehicle/beam_masses.h"

#include <algorithm>
#include <limits>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/linear.h"
#include "core/vehicle/booster_course.h"
#include "core/vehicle/mass.h"

namespace dispersa {

namespace {

double TubeGyration2(double outer_diameter_m, double inner_diameter_m) {
  return (Square(outer_diameter_m) + Square(inner_diameter_m)) / 16.0;
}

SpreadMass Spread(double mass_kg, double top_m, double bottom_m, double outer_diameter_m,
                  double inner_diameter_m) {
  const double per_length = mass_kg / (bottom_m - top_m);
  const double gyration2 = TubeGyration2(outer_diameter_m, inner_diameter_m);
  return {top_m, bottom_m, {per_length, per_length}, {gyration2, gyration2}};
}

SpreadMass Of(const BeamSection& s) {
  SpreadMass mass{s.top_station_m, s.bottom_station_m, s.mass_per_length_kg_m, {}};
  if (s.modulus_pa > 0.0) {
    mass.gyration2_m2 = {
        TubeGyration2(s.outer_diameter_m.top, s.outer_diameter_m.top - 2.0 * s.thickness_m.top),
        TubeGyration2(s.outer_diameter_m.bottom, s.outer_diameter_m.bottom - 2.0 * s.thickness_m.bottom)};
  }
  return mass;
}

// f(weight, station) over the points of Gauss's rule that is exact up to degree 7.
template <typename F>
void Gauss(double top_m, double bottom_m, F f) {
  constexpr double kPoint[2] = {0.33998104358485626480, 0.86113631159405257522};
  constexpr double kWeight[2] = {0.65214515486254614263, 0.34785484513745385737};
  const double middle = 0.5 * (top_m + bottom_m), half = 0.5 * (bottom_m - top_m);
  for (const int i : {0, 1}) {
    f(half * kWeight[i], middle - half * kPoint[i]);
    f(half * kWeight[i], middle + half * kPoint[i]);
  }
}

// Mass, first and second moment about a station.
struct Moments {
  double zeroth = 0.0, first = 0.0, second = 0.0;
};

// The quadratic polynomial in station by which spread masses are multiplied to have the wanted moments about
// `origin`.
struct Polynomial {
  std::array<double, 3> coefficients;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;  // over the masses
  double given_kg = 0.0, given_first = 0.0;                                   // of the masses before

  Polynomial(const std::vector<SpreadMass>& spread, const Moments& wanted, double origin) {
    Matrix3 gram = Matrix3::Zero();
    for (const SpreadMass& mass : spread)
      Gauss(mass.top_station_m, mass.bottom_station_m, [&](double weight, double station) {
        const double element_kg = weight * mass.MassPerLength(station);
        const double arm = station - origin;
        const double powers[3] = {1.0, arm, Square(arm)};
        const double moments[3] = {1.0, arm, Square(arm) + mass.Gyration2(station)};
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column)
            gram(row, column) += element_kg * moments[row] * powers[column];
        }
        given_kg += element_kg;
        given_first += element_kg * arm;
      });
    const Vector3 c = gram.fullPivLu().solve(Vector3(wanted.zeroth, wanted.first, wanted.second));
    coefficients = {c[0] - c[1] * origin + c[2] * Square(origin), c[1] - 2.0 * c[2] * origin, c[2]};
    for (const SpreadMass& mass : spread) {
      std::vector<double> places = {mass.top_station_m, mass.bottom_station_m};
      const double turning = origin - 0.5 * c[1] / c[2];
      if (turning > mass.top_station_m && turning < mass.bottom_station_m) places.push_back(turning);
      for (const double place : places) {
        const double value = c[0] + (place - origin) * (c[1] + (place - origin) * c[2]);
        least = std::min(least, value);
        greatest = std::max(greatest, value);
      }
    }
  }
};

struct TabledParts {
  BeamMasses masses;
  double least = 0.0, greatest = 0.0;  // by which spread masses are multiplied
};

FixedMass Fixed(const LumpedMass& lump) {
  return {lump.station_m, lump.mass_kg, lump.cg_station_m, lump.inertia_kg_m2};
}

// A tube of the mass model: spread over its length, or fixed at one station if the beam lumps it.
template <class Tube>
void AddTube(const Tube& tube, double mass_kg, const BeamStage& beam, BeamMasses& masses) {
  const SpreadMass spread = Spread(mass_kg, tube.top_station_m, tube.bottom_station_m, tube.outer_diameter_m,
                                   tube.inner_diameter_m);
  const auto lump = std::find_if(beam.lumped_masses.begin(), beam.lumped_masses.end(),
                                 [&](const LumpedMass& l) { return l.element == tube.name; });
  if (lump == beam.lumped_masses.end()) {
    masses.spread.push_back(spread);
    return;
  }
  const double length = tube.bottom_station_m - tube.top_station_m;
  masses.fixed.push_back({lump->station_m, mass_kg, 0.5 * (tube.top_station_m + tube.bottom_station_m),
                          mass_kg * (spread.gyration2_m2.top + Square(length) / 12.0)});
}

// Height of a tank's liquid, which stands on the bottom (StackMass).
double HeightOf(const Tank& tank, double mass_kg) {
  return mass_kg / (tank.density_kg_m3 * 0.25 * kPi * Square(tank.diameter_m));
}

// Grain or liquids of a stage.
void AddPropellant(const Stage& s, double grain_kg, BeamMasses& masses) {
  if (s.is_liquid()) {
    for (const Tank& tank : s.tanks) {
      const double mass_kg = grain_kg * tank.propellant_mass_kg / s.propellant_mass_kg;
      masses.spread.push_back(Spread(mass_kg, tank.bottom_station_m - HeightOf(tank, mass_kg),
                                     tank.bottom_station_m, tank.diameter_m, 0.0));
    }
    return;
  }
  const Grain& g = s.grain;
  const double length = g.bottom_station_m - g.top_station_m;
  const double outer2 = Square(g.outer_diameter_m);
  // It burns from the bore outwards (StackMass).
  const double inner2 = outer2 - 4.0 * grain_kg / (kPi * PropellantDensity(s) * length);
  const double gyration2 = (outer2 + inner2) / 16.0;
  masses.spread.push_back(
      {g.top_station_m, g.bottom_station_m, {grain_kg / length, grain_kg / length}, {gyration2, gyration2}});
}

// A stage whose masses a table gives: its parts with their propellant, spread masses multiplied such that
// mass, centre of gravity and inertia of all are the table's.
TabledParts PartsOf(const Stage& stage, const BeamStage& beam, double dry_kg, double propellant_kg) {
  TabledParts parts;
  BeamMasses& own = parts.masses;
  if (beam.own_masses) {
    for (const BeamSection& section : beam.sections) own.spread.push_back(Of(section));
    for (const LumpedMass& lump : beam.lumped_masses) own.fixed.push_back(Fixed(lump));
  } else {
    for (const MassElement& e : stage.structure) AddTube(e, dry_kg * e.fraction, beam, own);
  }
  if (propellant_kg > 0.0) AddPropellant(stage, propellant_kg, own);
  const StageMassTable& table = stage.flown_mass;
  const MassRows::Sums burning = table.rows->OfPropellant(propellant_kg);
  Moments wanted{dry_kg + propellant_kg,
                 table.dry_factor * table.rows->first_moment_kg_m + burning.first_moment_kg_m,
                 table.dry_factor * table.rows->second_moment_kg_m2 + burning.second_moment_kg_m2};
  if (table.added_kg != 0.0) {
    const MassElement& e = stage.structure[table.element];
    const double length = e.bottom_station_m - e.top_station_m,
                 middle = 0.5 * (e.top_station_m + e.bottom_station_m);
    wanted.first += table.added_kg * middle;
    wanted.second += table.added_kg * (TubeGyration2(e.outer_diameter_m, e.inner_diameter_m) +
                                       Square(length) / 12.0 + Square(middle));
  }
  const double origin = wanted.first / wanted.zeroth;
  wanted.second -= wanted.first * origin;
  wanted.first = 0.0;
  for (const FixedMass& lump : own.fixed) {
    const double arm = lump.cg_station_m - origin;
    wanted.zeroth -= lump.mass_kg;
    wanted.first -= lump.mass_kg * arm;
    wanted.second -= lump.inertia_kg_m2 + lump.mass_kg * Square(arm);
  }
  const Polynomial fitted(own.spread, wanted, origin);
  for (SpreadMass& mass : own.spread) mass.scale = fitted.coefficients;
  parts.least = fitted.least;
  parts.greatest = fitted.greatest;
  return parts;
}

// Shells and grains or liquids of all boosters together, with the moments of inertia of the mass model: what
// their distance from the axis adds counts by half about either lateral axis.
void AddBoosters(const Vehicle& vehicle, double stage_kg, BeamMasses& masses) {
  const Boosters& b = vehicle.boosters;
  const double apart2 = 0.5 * Square(b.radius_m);
  const double dry_kg = b.count * b.dry_mass_kg, length = b.bottom_station_m - b.top_station_m;
  masses.fixed.push_back(
      {b.attachment_station_m, dry_kg, 0.5 * (b.top_station_m + b.bottom_station_m),
       dry_kg * (TubeGyration2(b.diameter_m, b.diameter_m) + Square(length) / 12.0 + apart2)});
  const double propellant_kg = BoosterCourse(vehicle).PropellantOfAll(stage_kg);
  if (!(propellant_kg > 0.0)) return;
  for (const Tank& tank : b.tanks) {
    const double mass_kg = propellant_kg * tank.propellant_mass_kg / b.propellant_mass_kg;
    const double height = HeightOf(tank, mass_kg / b.count);
    masses.fixed.push_back(
        {b.attachment_station_m, mass_kg, tank.bottom_station_m - 0.5 * height,
         mass_kg * (TubeGyration2(tank.diameter_m, 0.0) + Square(height) / 12.0 + apart2)});
  }
  if (b.is_liquid()) return;
  const BoosterPropellant g = BuildBoosterPropellant(b);
  const double outer2 = Square(g.outer_radius_m), inner2 = outer2 - propellant_kg / g.kilograms_per_area_m2;
  masses.fixed.push_back({b.attachment_station_m, propellant_kg, g.station_m,
                          propellant_kg * (0.25 * (outer2 + inner2) + Square(g.length_m) / 12.0 + apart2)});
}

}  // namespace

double SpreadMass::MassPerLength(double station_m) const {
  const double fraction = (station_m - top_station_m) / (bottom_station_m - top_station_m);
  return mass_per_length_kg_m.At(fraction) * (scale[0] + station_m * (scale[1] + station_m * scale[2]));
}

double SpreadMass::Gyration2(double station_m) const {
  return gyration2_m2.At((station_m - top_station_m) / (bottom_station_m - top_station_m));
}

bool IsLumped(const BeamStage& stage, const std::string& element) {
  return std::any_of(stage.lumped_masses.begin(), stage.lumped_masses.end(),
                     [&](const LumpedMass& lump) { return lump.element == element; });
}

OwnMassScale ScaleOwnMasses(const Vehicle& vehicle, int stage) {
  const std::size_t i = static_cast<std::size_t>(stage);
  const BeamStage& beam = vehicle.structure_beam->stages[i];
  OwnMassScale scale;
  // The dry stage of the mass model, about station 0, then about its centre of gravity, which keeps the
  // equations' condition; the polynomial is in the distance from there.
  const double dry_kg = DryMass(vehicle, stage);
  Moments wanted;
  for (const MassElement& e : vehicle.stages[i].structure) {
    wanted.zeroth += dry_kg * e.fraction;
    wanted.first += dry_kg * e.fraction * 0.5 * (e.top_station_m + e.bottom_station_m);
  }
  const double origin = wanted.first / wanted.zeroth;
  scale.stage_kg = wanted.zeroth;
  scale.stage_cg_m = origin;
  wanted.first = 0.0;
  for (const MassElement& e : vehicle.stages[i].structure) {
    const double length = e.bottom_station_m - e.top_station_m;
    wanted.second += dry_kg * e.fraction *
                     (TubeGyration2(e.outer_diameter_m, e.inner_diameter_m) + Square(length) / 12.0 +
                      Square(0.5 * (e.top_station_m + e.bottom_station_m) - origin));
  }
  double given_first = 0.0;
  for (const LumpedMass& lump : beam.lumped_masses) {
    const double arm = lump.cg_station_m - origin;
    wanted.zeroth -= lump.mass_kg;
    wanted.first -= lump.mass_kg * arm;
    wanted.second -= lump.inertia_kg_m2 + lump.mass_kg * Square(arm);
    scale.given_kg += lump.mass_kg;
    given_first += lump.mass_kg * arm;
  }
  std::vector<SpreadMass> spread;
  for (const BeamSection& section : beam.sections) spread.push_back(Of(section));
  Polynomial fitted(spread, wanted, origin);
  scale.given_kg += fitted.given_kg;
  scale.given_cg_m = origin + (given_first + fitted.given_first) / scale.given_kg;
  scale.polynomial = fitted.coefficients;
  scale.least = fitted.least;
  scale.greatest = fitted.greatest;
  return scale;
}

TableScale ScaleToMassTable(const Vehicle& vehicle, int stage, double propellant_kg) {
  const std::size_t i = static_cast<std::size_t>(stage);
  const TabledParts parts =
      PartsOf(vehicle.stages[i], vehicle.structure_beam->stages[i], DryMass(vehicle, stage), propellant_kg);
  return {parts.least, parts.greatest};
}

BeamMasses BuildBeamMasses(const Vehicle& vehicle, int stage, double propellant_kg, unsigned gone) {
  const BeamStage nothing_lumped;  // a rigid vehicle, or one with a table of modes
  BeamMasses masses;
  std::size_t jettison = 0;  // of the vehicle's, those of the stages below passed over
  for (std::size_t i = 0; i < static_cast<std::size_t>(stage); ++i)
    jettison += vehicle.stages[i].jettisoned.size();
  for (std::size_t i = static_cast<std::size_t>(stage), last; i < vehicle.stages.size(); i = last + 1) {
    last = static_cast<std::size_t>(LastBurn(vehicle, static_cast<int>(i)));
    const Stage& s = vehicle.stages[i];
    const BeamStage& beam = vehicle.structure_beam && i < vehicle.structure_beam->stages.size()
                                ? vehicle.structure_beam->stages[i]
                                : nothing_lumped;
    const double dry_kg = DryMass(vehicle, static_cast<int>(i));
    const double grain_kg = i == static_cast<std::size_t>(stage) ? propellant_kg : s.propellant_mass_kg;
    const bool is_tabled = s.flown_mass.rows != nullptr;
    if (is_tabled) {
      const TabledParts parts = PartsOf(s, beam, dry_kg, grain_kg);
      BeamMasses own = parts.masses;
      // Of a beam this is refused. A rigid vehicle needs the masses for the loads of its sections alone.
      if (!vehicle.structure_beam &&
          !(parts.least >= kLeastMassScale && parts.greatest <= kGreatestMassScale))
        for (SpreadMass& mass : own.spread) mass.scale = {1.0, 0.0, 0.0};
      masses.spread.insert(masses.spread.end(), own.spread.begin(), own.spread.end());
      masses.fixed.insert(masses.fixed.end(), own.fixed.begin(), own.fixed.end());
    } else if (beam.own_masses) {
      const OwnMassScale scale = ScaleOwnMasses(vehicle, static_cast<int>(i));
      for (const BeamSection& section : beam.sections) {
        masses.spread.push_back(Of(section));
        masses.spread.back().scale = scale.polynomial;
      }
      for (const LumpedMass& lump : beam.lumped_masses) masses.fixed.push_back(Fixed(lump));
    } else {
      for (const MassElement& e : s.structure) AddTube(e, dry_kg * e.fraction, beam, masses);
    }
    for (const Jettison& j : vehicle.stages[last].jettisoned) {
      if (!(gone >> jettison & 1u)) AddTube(j, j.mass_kg, beam, masses);
      ++jettison;
    }
    if (!is_tabled && grain_kg > 0.0) AddPropellant(s, grain_kg, masses);
  }
  if (stage == 0 && vehicle.boosters.count > 0 && !(gone & kBoostersGone))
    AddBoosters(vehicle, propellant_kg, masses);
  return masses;
}

}  // namespace dispersa
