#include <algorithm>
#include <set>
#include <tuple>

#include "core/vehicle/vehicle.h"

namespace dispersa {
namespace {

// Far above anything that flies, and far below what overflows.
constexpr Range kStiffnesses = UpTo(1e15), kModuli = UpTo(1e13), kDiameters = UpTo(100.0),
                kMassesPerLength = UpTo(1e6);

// A stiffness is given, or a round tube's.
void DescribeStiffness(Fields& fields, BeamSection& section, bool timoshenko) {
  constexpr const char* kAllowed =
      "bending_stiffness_n_m2, or a tube: outer_diameter_m, thickness_m and modulus_gpa";
  Taper& bending = section.bending_stiffness_n_m2;
  Taper& shear = section.shear_stiffness_n;
  Taper& diameter = section.outer_diameter_m;
  Taper& wall = section.thickness_m;
  fields.Either({{Has("outer_diameter", kLength),
                  [&] {
                    fields.Misplaced("bending_stiffness", kBendingStiffness,
                                     "both a bending stiffness and a tube are given", kAllowed);
                    fields.Ends("outer_diameter", kLength, kDiameters, diameter.top, diameter.bottom, true,
                                "of a round tube");
                    fields.Ends("thickness", kLength, kDiameters, wall.top, wall.bottom, true,
                                "of its wall; half the diameter: a solid rod");
                    fields.Quantity("modulus", kModulus, kModuli, section.modulus_pa,
                                    "Young's modulus of the tube");
                    fields.Number("poisson_ratio", Between(0.0, 0.5), section.poisson_ratio,
                                  "of the tube, for shear", 0.3);
                  }},
                 {Has("bending_stiffness", kBendingStiffness),
                  [&] {
                    fields.Ends("bending_stiffness", kBendingStiffness, kStiffnesses, bending.top,
                                bending.bottom, true, "E I in plane y, instead of a tube");
                    fields.Ends("shear_stiffness", kForce, kStiffnesses, shear.top, shear.bottom, timoshenko,
                                "kappa G A in plane y; needed with theory: timoshenko");
                  }},
                 {Else(), [&] {
                    fields.Missing({"bending_stiffness_n_m2", "outer_diameter_m"}, kAllowed);
                  }}});
}

void Describe(Fields& fields, LumpedMass& lump) {
  fields.Quantity("station", kLength, kNonNegative, lump.station_m, "station of the beam that carries it");
  fields.Either({{Has("element"),
                  [&] {
                    fields.Text("element", lump.element,
                                "of the stage's structure, or a body it jettisons; fixed at the station, not "
                                "spread along the beam");
                    lump.name = lump.element;
                  }},
                 {Else(), [&] {
                    fields.Text("name", lump.name, "of a body, if the stage's sections give masses");
                    fields.Quantity("mass", kMass, kPositive, lump.mass_kg, "of the body");
                    fields.Quantity("cg_station", kLength, kNonNegative, lump.cg_station_m,
                                    "of its centre of gravity; default: station_*", lump.station_m);
                    fields.Quantity("inertia", kInertia, kNonNegative, lump.inertia_kg_m2,
                                    "transverse, about its own centre of gravity", 0.0);
                  }}});
}

void Describe(Fields& fields, BeamStage& stage, bool timoshenko) {
  fields.List("sections", 1, 50, stage.sections,
              "they carry all of a stack's mass; where they overlap, stiffnesses add",
              [&](Fields& section, BeamSection& value) { Describe(section, value, timoshenko); });
  const auto with_mass = static_cast<std::size_t>(
      std::count_if(stage.sections.begin(), stage.sections.end(),
                    [](const BeamSection& section) { return section.mass_per_length_kg_m.top > 0.0; }));
  stage.own_masses = with_mass > 0 && with_mass == stage.sections.size();
  if (with_mass > 0 && !stage.own_masses)
    fields.Refuse("sections", "some sections have a mass per length and some have none",
                  "mass_per_length_kg_m in every section of the stage, or in none: then the stage's "
                  "structure says what it "
                  "weighs");
  fields.List("lumped_masses", 0, 50, stage.lumped_masses, "rigid bodies",
              [](Fields& body, LumpedMass& lump) { Describe(body, lump); });
  for (std::size_t i = 0; i < stage.lumped_masses.size(); ++i) {
    const std::string item = "lumped_masses[" + std::to_string(i) + "]";
    if (stage.own_masses && !stage.lumped_masses[i].element.empty())
      fields.Refuse(item + ".element", "the stage's sections give masses, and its structure does not count",
                    "name, mass_*, station_*, optional cg_station_* and inertia_kg_m2");
    if (!stage.own_masses && stage.lumped_masses[i].element.empty())
      fields.Refuse(item, "missing key 'element'", "an element of the stage's structure, with station_*");
  }
}

// The columns of a table, a row for each station of each mode.
struct ModeRows {
  std::vector<double> stage, propellant_kg, mode, frequency_rad_s, mass_kg, station_m, deflection, slope_1_m;
  std::vector<std::string> plane;
};

// As people state a mode's.
constexpr Unit kModeFrequency[] = {{"hz", kTwoPi}, {"rad_s", 1.0}};

void Describe(Fields& fields, ModeRows& rows, std::size_t stages) {
  const double last_stage = static_cast<double>(stages > 0 ? stages : kMaxStages);
  fields.Numbers("stage", Between(1.0, last_stage), 1, SIZE_MAX, rows.stage,
                 "lowest stage of the stack, from 1");
  fields.Quantities("propellant", kMass, kNonNegative, 1, SIZE_MAX, rows.propellant_kg, "of that stage");
  fields.Words("plane", {"y", "z"}, rows.plane, "y alone: the same in both planes");
  fields.Numbers("mode", Between(1.0, 20.0), 1, SIZE_MAX, rows.mode, "from 1");
  fields.Quantities("frequency", kModeFrequency, kPositive, 1, SIZE_MAX, rows.frequency_rad_s, "of the mode");
  fields.Quantities("generalized_mass", kMass, kPositive, 1, SIZE_MAX, rows.mass_kg, "of the mode");
  fields.Quantities("station", kLength, kNonNegative, 1, SIZE_MAX, rows.station_m, "increasing");
  fields.Numbers("deflection", kAnyNumber, 1, SIZE_MAX, rows.deflection, "at the station");
  fields.Numbers("slope_1_m", kAnyNumber, 1, SIZE_MAX, rows.slope_1_m,
                 "d deflection / d station; stations grow aft");
}

using ModeKey =
    std::tuple<int, double, BeamPlane, int>;  // in the order of a table: propellant negative, so falling

ModeKey KeyOf(const TabledMode& m) { return {m.stage, -m.propellant_kg, m.plane, m.mode}; }

bool AreWhole(Fields& fields, const char* column, const std::vector<double>& values) {
  bool all = true;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (values[row] == static_cast<double>(static_cast<int>(values[row]))) continue;
    const std::string at = std::string(column) + "[" + std::to_string(row) + "]";
    fields.Refuse(at, fields.Quote(at) + " is not a whole number", "a whole number");
    all = false;
  }
  return all;
}

// The rows to modes, in the order of KeyOf; none if they do not fit together, which has then been said.
class ModeTable {
 public:
  ModeTable(Fields& fields, const ModeRows& rows) : fields_(fields), rows_(rows) {}

  std::vector<TabledMode> Modes() {
    if (!AreWhole(fields_, "stage", rows_.stage) || !AreWhole(fields_, "mode", rows_.mode)) return {};
    for (const std::size_t size :
         {rows_.propellant_kg.size(), rows_.mode.size(), rows_.frequency_rad_s.size(), rows_.mass_kg.size(),
          rows_.station_m.size(), rows_.deflection.size(), rows_.slope_1_m.size(), rows_.plane.size()}) {
      if (size == rows_.stage.size()) continue;
      fields_.Refuse("", "the columns have different lengths", "one value a row in each column");
      return {};
    }
    if (!Collect() || !HaveShapes() || !FitTogether()) return {};
    std::sort(modes_.begin(), modes_.end(),
              [](const TabledMode& a, const TabledMode& b) { return KeyOf(a) < KeyOf(b); });
    return std::move(modes_);
  }

 private:
  bool Refuse(const char* column, std::size_t row, const std::string& message, const std::string& allowed) {
    fields_.Refuse(std::string(column) + "[" + std::to_string(row) + "]", message, allowed);
    return false;
  }

  bool Collect() {
    std::set<ModeKey> seen;
    for (std::size_t row = 0; row < rows_.stage.size(); ++row) {
      TabledMode m{static_cast<int>(rows_.stage[row]) - 1,
                   rows_.propellant_kg[row],
                   kBeamPlanes[rows_.plane[row] == "z"],
                   static_cast<int>(rows_.mode[row]),
                   rows_.frequency_rad_s[row],
                   rows_.mass_kg[row],
                   {},
                   {},
                   {}};
      if (modes_.empty() || KeyOf(modes_.back()) != KeyOf(m)) {
        if (!seen.insert(KeyOf(m)).second)
          return Refuse("mode", row, "the mode was given before, further up",
                        "all rows of a mode one after the other");
        modes_.push_back(std::move(m));
        first_row_.push_back(row);
      } else if (modes_.back().frequency_rad_s != m.frequency_rad_s ||
                 modes_.back().generalized_mass_kg != m.generalized_mass_kg) {
        return Refuse("frequency", row, "frequency or generalized mass change within a mode",
                      "the same in all rows of a mode");
      }
      TabledMode& current = modes_.back();
      if (!current.station_m.empty() && !(rows_.station_m[row] > current.station_m.back()))
        return Refuse("station", row, "the stations of a mode do not increase",
                      "rows of increasing station_m");
      current.station_m.push_back(rows_.station_m[row]);
      current.deflection.push_back(rows_.deflection[row]);
      current.slope_1_m.push_back(rows_.slope_1_m[row]);
    }
    return true;
  }

  bool HaveShapes() {
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      const bool moves = std::any_of(modes_[i].deflection.begin(), modes_[i].deflection.end(),
                                     [](double d) { return d != 0.0; });
      if (modes_[i].station_m.size() < 2 || !moves)
        return Refuse("station", first_row_[i], "the mode has less than two stations, or no deflection",
                      "two or more stations, some deflection");
    }
    return true;
  }

  static bool SameBeam(const TabledMode& a, const TabledMode& b) {
    return a.stage == b.stage && a.plane == b.plane;
  }

  bool FitTogether() {
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      const auto same_beam = [&](const TabledMode& m) { return SameBeam(m, modes_[i]); };
      const TabledMode& first = *std::find_if(modes_.begin(), modes_.end(), same_beam);
      if (first.station_m != modes_[i].station_m)
        return Refuse("station", first_row_[i],
                      "the mode has other stations than the first of its stage and plane",
                      "the same stations for all modes of a stage and plane");
      const auto count = [&](double propellant) {
        return std::count_if(modes_.begin(), modes_.end(), [&](const TabledMode& m) {
          return same_beam(m) && m.propellant_kg == propellant;
        });
      };
      if (count(first.propellant_kg) != count(modes_[i].propellant_kg))
        return Refuse("propellant", first_row_[i],
                      "this propellant has another number of modes than the first of its stage and plane",
                      "as many modes at every propellant of a stage and plane");
    }
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      const TabledMode& z = modes_[i];
      const bool has_y = std::any_of(modes_.begin(), modes_.end(), [&](const TabledMode& y) {
        return y.stage == z.stage && y.plane == BeamPlane::kY;
      });
      if (z.plane == BeamPlane::kZ && !has_y)
        return Refuse("plane", first_row_[i], "the stage has modes in plane z and none in plane y",
                      "plane y, which stands for both, or both planes");
    }
    return true;
  }

  Fields& fields_;
  const ModeRows& rows_;
  std::vector<TabledMode> modes_;
  std::vector<std::size_t> first_row_;  // of each mode
};

}  // namespace

void Describe(Fields& fields, BeamSection& section, bool timoshenko) {
  fields.Text("name", section.name, "name of the section");
  fields.Quantity("top_station", kLength, kNonNegative, section.top_station_m, "upper end");
  fields.Quantity("bottom_station", kLength, kPositive, section.bottom_station_m,
                  "lower end, not aft of the stage's bottom_station_*");
  DescribeStiffness(fields, section, timoshenko);
  fields.Number("z_to_y_stiffness", Between(0.01, 100.0), section.z_to_y_stiffness,
                "stiffness of plane z over plane y, in bending and shear", 1.0);
  fields.Ends("mass_per_length", kMassPerLength, kMassesPerLength, section.mass_per_length_kg_m.top,
              section.mass_per_length_kg_m.bottom, false,
              "dry; in all sections of a stage, or in none: its structure gives it");
}

void Describe(Fields& fields, StructureBeam& beam, std::size_t stages, std::size_t bodies) {
  fields.List("sensors", 0, 100, beam.sensors,
              "further places with deflection and slope; the nozzle pivot is always shown");
  fields.Flag("rotary_inertia", beam.rotary_inertia, true,
              "of the cross-sections; false: the beam has less inertia than the vehicle");
  fields.Integer("flown_modes", 0, kMostFlownModes, beam.flown_modes,
                 "modes flown per plane; 0: rigid; none from half the autopilot's sampling frequency on", 3);
  fields.Number("damping_ratio", Between(0.0, 0.5), beam.damping_ratio, "of every mode in flight", 0.01);
  ModeRows rows;
  fields.Either({{Has("modes_table"),
                  [&] {
                    fields.Table("modes_table", "a CSV file",
                                 "a CSV file of a finite-element model's modes, instead of the keys below",
                                 [&](Fields& columns) {
                                   Describe(columns, rows, stages);
                                   columns.Check([&] { beam.table = ModeTable(columns, rows).Modes(); });
                                 });
                  }},
                 {Else(), [&] {
                    fields.Choice<bool>("theory", {{"euler_bernoulli", false}, {"timoshenko", true}},
                                        beam.timoshenko, "a beam without shear, or with shear", false);
                    fields.Integer("modes", 1, 10, beam.modes, "in each plane", 3);
                    fields.Integer("propellant_levels", 2, 101, beam.propellant_levels,
                                   "evenly spaced from full to empty", 11);
                    fields.Integer("elements", 20, 400, beam.elements, "least; more if 0.1 % needs it", 40);
                    fields.List(
                        "stages", std::max<std::size_t>(bodies, 1), bodies > 0 ? bodies : kMaxStages,
                        beam.stages,
                        "one per stage, none for a restart; its sections fly while the stage is attached",
                        [&](Fields& stage, BeamStage& value) { Describe(stage, value, beam.timoshenko); });
                  }}});
}

}  // namespace dispersa
