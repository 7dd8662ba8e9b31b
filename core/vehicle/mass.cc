#include "core/vehicle/mass.h"

#include <algorithm>
#include <utility>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/burning_stack.h"

namespace dispersa {

namespace {

struct Tube {
  double mass_kg;
  double top_m;
  double bottom_m;
  double outer_radius_m;
  double inner_radius_m;
};

void Add(const Tube& tube, StackMass& stack) {
  const double radii = Square(tube.outer_radius_m) + Square(tube.inner_radius_m);
  const double length = tube.bottom_m - tube.top_m;
  const double station = 0.5 * (tube.top_m + tube.bottom_m);
  stack.fixed_mass_kg += tube.mass_kg;
  stack.fixed_first_moment_kg_m += tube.mass_kg * station;
  stack.fixed_second_moment_kg_m2 += tube.mass_kg * (0.25 * radii + Square(length) / 12.0 + Square(station));
  stack.fixed_axial_inertia_kg_m2 += 0.5 * tube.mass_kg * radii;
}

Tube TubeOf(const Jettison& jettison) {
  return {jettison.mass_kg, jettison.top_station_m, jettison.bottom_station_m,
          0.5 * jettison.outer_diameter_m, 0.5 * jettison.inner_diameter_m};
}

// Full tanks of a stage that does not burn: no moment of inertia about the axis (DrainingMass).
void Add(const Tank& tank, StackMass& stack) {
  const double radius2 = 0.25 * Square(tank.diameter_m);
  const double height = tank.propellant_mass_kg / (tank.density_kg_m3 * kPi * radius2);
  const double station = tank.bottom_station_m - 0.5 * height;
  stack.fixed_mass_kg += tank.propellant_mass_kg;
  stack.fixed_first_moment_kg_m += tank.propellant_mass_kg * station;
  stack.fixed_second_moment_kg_m2 +=
      tank.propellant_mass_kg * (0.25 * radius2 + Square(height) / 12.0 + Square(station));
}

// The dry mass of a stage with a table, and what was added to it.
void AddTable(const Stage& stage, double dry_kg, StackMass& stack) {
  const StageMassTable& flown = stage.flown_mass;
  stack.fixed_mass_kg += dry_kg - flown.added_kg;
  stack.fixed_first_moment_kg_m += flown.dry_factor * flown.rows->first_moment_kg_m;
  stack.fixed_second_moment_kg_m2 += flown.dry_factor * flown.rows->second_moment_kg_m2;
  stack.fixed_axial_inertia_kg_m2 += flown.dry_factor * flown.rows->axial_inertia_kg_m2;
  for (std::size_t k = 0; k < kSideSums; ++k) stack.sides[k] += flown.dry_factor * flown.rows->sides[k];
  if (flown.added_kg == 0.0) return;
  const MassElement& e = stage.structure[flown.element];
  Add(Tube{flown.added_kg, e.top_station_m, e.bottom_station_m, 0.5 * e.outer_diameter_m,
           0.5 * e.inner_diameter_m},
      stack);
}

// By the mass in all tanks, which is `propellant_kg` when they are full.
DrainingMass Draining(const std::vector<Tank>& tanks, double propellant_kg) {
  DrainingMass sum;
  for (const Tank& tank : tanks) {
    const double share = tank.propellant_mass_kg / propellant_kg, bottom = tank.bottom_station_m;
    const double radius2 = 0.25 * Square(tank.diameter_m);
    const double height_per_kg = share / (tank.density_kg_m3 * kPi * radius2);  // of all propellant
    sum.first_per_kg_m += share * bottom;
    sum.first_per_kg2_m -= share * 0.5 * height_per_kg;
    sum.second_per_kg_m2 += share * (Square(bottom) + 0.25 * radius2);
    sum.second_per_kg2_m2 -= share * bottom * height_per_kg;
    sum.second_per_kg3_m2 += share * Square(height_per_kg) / 3.0;
  }
  return sum;
}

}  // namespace

MassProperties StackMass::At(double propellant_kg) const {
  lanes::BurningStack<double> stack;
  lanes::SetStack(stack, 0, *this);
  return lanes::MassesAt(stack, propellant_kg);
}

double DryMass(const Vehicle& vehicle, int stage) {
  const auto& stages = vehicle.stages;
  const std::size_t i = static_cast<std::size_t>(LastBurn(vehicle, stage));
  const double above = i + 1 < stages.size() ? stages[i + 1].liftoff_mass_kg : 0.0;
  double dry = stages[i].liftoff_mass_kg - above - stages[i].propellant_mass_kg;
  for (const Jettison& jettison : stages[i].jettisoned) dry -= jettison.mass_kg;
  const Boosters& boosters = vehicle.boosters;
  if (i == 0) dry -= boosters.LiftOffMass();
  return dry;
}

JettisonedMass BuildBoosterMass(const Boosters& boosters) {
  StackMass one;
  Add(Tube{boosters.dry_mass_kg, boosters.top_station_m, boosters.bottom_station_m, 0.5 * boosters.diameter_m,
           0.5 * boosters.diameter_m},
      one);
  // Two or more at equal angles: their distances from the axis count whole in roll and by half across.
  const double apart = boosters.dry_mass_kg * Square(boosters.radius_m);
  const double n = boosters.count;
  return {0, n * one.fixed_mass_kg, n * one.fixed_first_moment_kg_m,
          n * (one.fixed_second_moment_kg_m2 + 0.5 * apart), n * (one.fixed_axial_inertia_kg_m2 + apart)};
}

BoosterPropellant BuildBoosterPropellant(const Boosters& boosters) {
  BoosterPropellant all;
  all.radius_m = boosters.radius_m;
  if (boosters.is_liquid()) {
    all.drains = true;
    all.tanks = Draining(boosters.tanks, boosters.count * boosters.propellant_mass_kg);
    // So far with shares of the mass in all: a tank's, of which there is one in each booster.
    const double n = boosters.count;
    DrainingMass& t = all.tanks;
    t.first_per_kg_m *= n;
    t.first_per_kg2_m *= n;
    t.second_per_kg_m2 *= n;
    t.second_per_kg2_m2 *= n;
    t.second_per_kg3_m2 *= n;
    return all;
  }
  const Grain& g = boosters.grain;
  const double area_m2 = 0.25 * (Square(g.outer_diameter_m) - Square(g.inner_diameter_m));
  all.station_m = 0.5 * (g.top_station_m + g.bottom_station_m);
  all.length_m = g.bottom_station_m - g.top_station_m;
  all.outer_radius_m = 0.5 * g.outer_diameter_m;
  all.kilograms_per_area_m2 = boosters.count * boosters.propellant_mass_kg / area_m2;
  return all;
}

SideSums StackMass::SidesAt(double propellant_kg) const {
  SideSums sums = sides;
  if (table == nullptr) return sums;
  const SideSums burning = table->SidesOfPropellant(propellant_kg);
  for (std::size_t k = 0; k < kSideSums; ++k) sums[k] += burning[k];
  return sums;
}

bool StackMass::HasSides() const {
  return (table != nullptr && !table->side_rows.empty()) ||
         std::any_of(sides.begin(), sides.end(), [](double sum) { return sum != 0.0; });
}

MixtureOf BuildMixture(const std::vector<Tank>& tanks, double load_kg, double residual_kg, double factor) {
  MixtureOf mixture{Draining(tanks, load_kg), residual_kg};
  if (factor == 1.0) return mixture;
  DrainingMass& sum = mixture.tanks = {};
  const double first = tanks[0].propellant_mass_kg / load_kg;
  const double drawn = factor * first / (1.0 - first + factor * first);
  double lasts = 1.0;  // the part of the usable propellant that flows before a tank ends the burn
  for (std::size_t k = 0; k < tanks.size(); ++k) {
    const Tank& tank = tanks[k];
    const double loaded = tank.propellant_mass_kg / load_kg;
    const double share = k == 0 ? drawn : loaded * (1.0 - drawn) / (1.0 - first);
    lasts = std::min(lasts, loaded / share);
    const double kept_kg = tank.propellant_mass_kg - share * load_kg;
    const double bottom = tank.bottom_station_m, radius2 = 0.25 * Square(tank.diameter_m);
    const double height_per_kg = 1.0 / (tank.density_kg_m3 * kPi * radius2);
    // Powers of kept + share m in the moments m_k (b - h/2) and m_k (b² - b h + h²/3 + r²/4).
    const double one = bottom, two = -0.5 * height_per_kg;
    const double square = Square(bottom) + 0.25 * radius2, less = -bottom * height_per_kg,
                 cube = Square(height_per_kg) / 3.0;
    sum.first_kg_m += kept_kg * (one + kept_kg * two);
    sum.first_per_kg_m += share * (one + 2.0 * kept_kg * two);
    sum.first_per_kg2_m += Square(share) * two;
    sum.second_kg_m2 += kept_kg * (square + kept_kg * (less + kept_kg * cube));
    sum.second_per_kg_m2 += share * (square + kept_kg * (2.0 * less + 3.0 * kept_kg * cube));
    sum.second_per_kg2_m2 += Square(share) * (less + 3.0 * kept_kg * cube);
    sum.second_per_kg3_m2 += Square(share) * share * cube;
  }
  mixture.residual_kg = load_kg - (load_kg - residual_kg) * lasts;
  return mixture;
}

double PropellantDensity(const Stage& stage) {
  const Grain& g = stage.grain;
  const double area = 0.25 * kPi * (Square(g.outer_diameter_m) - Square(g.inner_diameter_m));
  return stage.propellant_mass_kg / (area * (g.bottom_station_m - g.top_station_m));
}

std::vector<JettisonedMass> BuildJettisonedMasses(const Vehicle& vehicle) {
  std::vector<JettisonedMass> all;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i)
    for (const Jettison& jettison : vehicle.stages[i].jettisoned) {
      StackMass alone;
      Add(TubeOf(jettison), alone);
      all.push_back({static_cast<int>(i), alone.fixed_mass_kg, alone.fixed_first_moment_kg_m,
                     alone.fixed_second_moment_kg_m2, alone.fixed_axial_inertia_kg_m2});
    }
  return all;
}

unsigned CarriedBy(const Vehicle& vehicle, int stage) {
  unsigned carried = stage == 0 && vehicle.boosters.count > 0 ? kBoostersGone : 0u, bit = 1;
  for (std::size_t i = 0; i < vehicle.stages.size(); ++i)
    for (std::size_t k = 0; k < vehicle.stages[i].jettisoned.size(); ++k, bit <<= 1)
      if (static_cast<int>(i) >= stage) carried |= bit;
  return carried;
}

StackMass Without(StackMass stack, int lowest_stage, const std::vector<JettisonedMass>& jettisons,
                  unsigned gone) {
  for (std::size_t i = 0; i < jettisons.size(); ++i) {
    const JettisonedMass& jettison = jettisons[i];
    if (!(gone >> i & 1u) || jettison.stage < lowest_stage) continue;
    stack.fixed_mass_kg -= jettison.mass_kg;
    stack.fixed_first_moment_kg_m -= jettison.first_moment_kg_m;
    stack.fixed_second_moment_kg_m2 -= jettison.second_moment_kg_m2;
    stack.fixed_axial_inertia_kg_m2 -= jettison.axial_inertia_kg_m2;
  }
  return stack;
}

std::vector<StackMass> BuildStackMasses(const Vehicle& vehicle) {
  const int count = static_cast<int>(vehicle.stages.size());
  std::vector<StackMass> stacks(vehicle.stages.size());
  for (int lowest = 0; lowest < count; ++lowest) {
    StackMass& stack = stacks[static_cast<std::size_t>(lowest)];
    if (vehicle.stages[static_cast<std::size_t>(lowest)].restarts) {
      stack = stacks[static_cast<std::size_t>(lowest) - 1];  // by what is left in the tanks
      stack.propellant_mass_kg = vehicle.stages[static_cast<std::size_t>(lowest)].propellant_mass_kg;
      continue;
    }
    for (int i = lowest; i < count; i = LastBurn(vehicle, i) + 1) {
      const Stage& stage = vehicle.stages[static_cast<std::size_t>(i)];
      const double dry = DryMass(vehicle, i);
      if (stage.flown_mass.rows)
        AddTable(stage, dry, stack);
      else
        for (const MassElement& e : stage.structure)
          Add({dry * e.fraction, e.top_station_m, e.bottom_station_m, 0.5 * e.outer_diameter_m,
               0.5 * e.inner_diameter_m},
              stack);
      const Stage& at_last = vehicle.stages[static_cast<std::size_t>(LastBurn(vehicle, i))];
      for (const Jettison& jettison : at_last.jettisoned) Add(TubeOf(jettison), stack);
      const Grain& g = stage.grain;
      if (stage.flown_mass.rows) {
        if (i == lowest) continue;
        const MassRows::Sums sums = stage.flown_mass.rows->OfPropellant(stage.propellant_mass_kg);
        stack.fixed_mass_kg += stage.propellant_mass_kg;
        stack.fixed_first_moment_kg_m += sums.first_moment_kg_m;
        stack.fixed_second_moment_kg_m2 += sums.second_moment_kg_m2;
        stack.fixed_axial_inertia_kg_m2 += sums.axial_inertia_kg_m2;
        const SideSums sides = stage.flown_mass.rows->SidesOfPropellant(stage.propellant_mass_kg);
        for (std::size_t k = 0; k < kSideSums; ++k) stack.sides[k] += sides[k];
        continue;
      }
      for (const Tank& tank : stage.tanks)
        if (i > lowest) Add(tank, stack);
      if (i > lowest && !stage.is_liquid())
        Add({stage.propellant_mass_kg, g.top_station_m, g.bottom_station_m, 0.5 * g.outer_diameter_m,
             0.5 * g.inner_diameter_m},
            stack);
    }
    const Stage& burning = vehicle.stages[static_cast<std::size_t>(lowest)];
    stack.propellant_mass_kg = burning.propellant_mass_kg;
    if (burning.flown_mass.rows) {
      stack.table = burning.flown_mass.rows.get();
      continue;
    }
    if (burning.is_liquid()) {
      stack.drains = true;
      stack.tanks = BuildMixture(burning.tanks, burning.propellant_mass_kg, burning.motor.residual_mass_kg,
                                 burning.mixture_ratio_factor)
                        .tanks;
      stack.fixed_first_moment_kg_m += std::exchange(stack.tanks.first_kg_m, 0.0);
      stack.fixed_second_moment_kg_m2 += std::exchange(stack.tanks.second_kg_m2, 0.0);
      continue;
    }
    const double length_m = burning.grain.bottom_station_m - burning.grain.top_station_m;
    stack.grain_station_m = 0.5 * (burning.grain.top_station_m + burning.grain.bottom_station_m);
    stack.grain_outer2_m2 = Square(0.5 * burning.grain.outer_diameter_m);
    stack.grain_inner_per_kg_m2 = 1.0 / (kPi * PropellantDensity(burning) * length_m);
    stack.grain_length2_m2 = Square(length_m) / 12.0;
  }
  // After its restarts were copied: boosters have left before the first stage burns again.
  if (vehicle.boosters.count > 0) {
    const JettisonedMass empty = BuildBoosterMass(vehicle.boosters);
    stacks[0].fixed_mass_kg += empty.mass_kg;
    stacks[0].fixed_first_moment_kg_m += empty.first_moment_kg_m;
    stacks[0].fixed_second_moment_kg_m2 += empty.second_moment_kg_m2;
    stacks[0].fixed_axial_inertia_kg_m2 += empty.axial_inertia_kg_m2;
  }
  return stacks;
}

}  // namespace dispersa
