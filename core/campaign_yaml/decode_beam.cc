#include "core/campaign_yaml/decode_beam.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "core/campaign_yaml/yaml_reader.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

/// Far above anything that flies, and far below what overflows.
constexpr Range UpTo(double high) { return {0.0, high, true, false}; }
constexpr Range kStiffnesses = UpTo(1e15), kModuli = UpTo(1e13), kDiameters = UpTo(100.0),
                kMassesPerLength = UpTo(1e6);

Taper Ends(MapReader& map, const std::string& stem, Dimension dimension, const Range& range) {
  const auto ends = map.Ends(stem, dimension, range);
  return {ends[0], ends[1]};
}

// A section's stiffness is either given or a tube's.
void DecodeStiffness(MapReader& map, bool timoshenko, BeamSection& section, ProblemList& problems) {
  const bool tube = map.Has("outer_diameter", kLength);
  const bool given = map.Has("bending_stiffness", kBendingStiffness);
  if (!tube && !given)
    map.NoteMissing({"bending_stiffness_n_m2", "bending_stiffness_kn_m2", "bending_stiffness_mn_m2",
                     "outer_diameter_m", "outer_diameter_km", "outer_diameter_mm", "outer_diameter_um"});
  if (tube == given) {
    map.IgnoreQuantity("bending_stiffness", kBendingStiffness);
    map.IgnoreQuantity("outer_diameter", kLength);
    map.IgnoreQuantity("thickness", kLength);
    map.IgnoreQuantity("modulus", kModulus);
    map.IgnoreQuantity("shear_stiffness", kForce);
    map.Ignore("poisson_ratio");
    AddProblem(problems, map.node(), map.path(),
               tube ? "both a bending stiffness and a tube are given" : "no stiffness is given",
               "bending_stiffness_n_m2, or a tube: outer_diameter_m, thickness_m and modulus_gpa");
    return;
  }
  if (tube) {
    section.outer_diameter_m = Ends(map, "outer_diameter", kLength, kDiameters);
    section.thickness_m = Ends(map, "thickness", kLength, kDiameters);
    section.modulus_pa = map.Quantity("modulus", kModulus, kModuli);
    section.poisson_ratio = map.Number("poisson_ratio", Between(0.0, 0.5), 0.3);
    return;
  }
  section.bending_stiffness_n_m2 = Ends(map, "bending_stiffness", kBendingStiffness, kStiffnesses);
  if (timoshenko || map.Has("shear_stiffness", kForce))
    section.shear_stiffness_n = Ends(map, "shear_stiffness", kForce, kStiffnesses);
}

// `has_mass` receives whether it gives a mass per length.
BeamSection DecodeSection(const InputNode& node, const std::string& path, bool timoshenko, bool* has_mass,
                          ProblemList& problems) {
  MapReader map(node, path, problems);
  BeamSection section;
  section.name = map.Text("name");
  section.top_station_m = map.Quantity("top_station", kLength, kNonNegative);
  section.bottom_station_m = map.Quantity("bottom_station", kLength, kPositive);
  DecodeStiffness(map, timoshenko, section, problems);
  section.z_to_y_stiffness = map.Number("z_to_y_stiffness", Between(0.01, 100.0), 1.0);
  *has_mass = map.Has("mass_per_length", kMassPerLength);
  if (*has_mass)
    section.mass_per_length_kg_m = Ends(map, "mass_per_length", kMassPerLength, kMassesPerLength);
  return section;
}

LumpedMass DecodeLumpedMass(const InputNode& node, const std::string& path, bool own_masses,
                            ProblemList& problems) {
  MapReader map(node, path, problems);
  LumpedMass lump;
  lump.station_m = map.Quantity("station", kLength, kNonNegative);
  if (!own_masses) {
    lump.element = map.Text("element");
    lump.name = lump.element;
    return lump;
  }
  lump.name = map.Text("name");
  lump.mass_kg = map.Quantity("mass", kMass, kPositive);
  lump.cg_station_m = map.Quantity("cg_station", kLength, kNonNegative, lump.station_m);
  lump.inertia_kg_m2 = map.Quantity("inertia", kInertia, kNonNegative, 0.0);
  return lump;
}

BeamStage DecodeBeamStage(const InputNode& node, const std::string& path, bool timoshenko,
                      ProblemList& problems) {
  MapReader map(node, path, problems);
  BeamStage stage;
  std::size_t with_mass = 0;
  map.Each("sections", 1, 50, [&](const InputNode& item, const std::string& item_path) {
    bool has_mass = false;
    stage.sections.push_back(DecodeSection(item, item_path, timoshenko, &has_mass, problems));
    with_mass += has_mass;
  });
  stage.own_masses = with_mass > 0 && with_mass == stage.sections.size();
  if (with_mass > 0 && !stage.own_masses)
    AddProblem(problems, *node.Find("sections"), map.PathOf("sections"),
               "some sections have a mass per length and some have none",
               "mass_per_length_kg_m in every section of the stage, or in none: then the stage's structure "
               "says what it weighs");
  map.Each("lumped_masses", 0, 50, [&](const InputNode& item, const std::string& item_path) {
    stage.lumped_masses.push_back(DecodeLumpedMass(item, item_path, stage.own_masses, problems));
  });
  return stage;
}

using ModeKey =
    std::tuple<int, double, BeamPlane, int>;  // in the order of a table: propellant negative, so falling

ModeKey KeyOf(const TabledMode& m) { return {m.stage, -m.propellant_kg, m.plane, m.mode}; }

// The rows of a table, one a station, to modes.
std::vector<TabledMode> DecodeModeTable(const InputNode& node, const std::string& path, std::size_t stages,
                                        ProblemList& problems) {
  std::vector<TabledMode> modes;
  const std::size_t before = problems.size();
  std::vector<double> stage, propellant_kg, mode, frequency_rad_s, mass_kg, station_m, deflection, slope_1_m;
  std::vector<BeamPlane> plane;
  {
    MapReader map(node, path, problems);
    const auto cells = [&](const char* name) { return node.Find(name); };
    stage = map.Numbers("stage", Between(1.0, static_cast<double>(stages > 0 ? stages : kMaxStages)), 1);
    propellant_kg = map.Quantities("propellant", kMass, kNonNegative, 1);
    mode = map.Numbers("mode", Between(1.0, 20.0), 1);
    frequency_rad_s = map.Quantities("frequency", kFrequency, kPositive, 1);
    mass_kg = map.Quantities("generalized_mass", kMass, kPositive, 1);
    station_m = map.Quantities("station", kLength, kNonNegative, 1);
    deflection = map.Numbers("deflection", kAnyNumber, 1);
    slope_1_m = map.Numbers("slope_1_m", kAnyNumber, 1);
    map.Each("plane", 1, SIZE_MAX, [&](const InputNode& item, const std::string& item_path) {
      SayExpects(item_path, {.kind = Expectation::Kind::kWords, .words = {"y", "z"}});
      if (item.text != "y" && item.text != "z")
        AddProblem(problems, item, item_path, item.Describe() + " is not a choice", "one of y, z");
      plane.push_back(item.text == "z" ? BeamPlane::kZ : BeamPlane::kY);
    });
    for (const char* name : {"stage", "mode"}) {
      const InputNode* column = cells(name);
      if (column == nullptr || problems.size() > before) continue;
      for (std::size_t row = 0; row < column->items.size(); ++row) {
        const double value = name[0] == 's' ? stage[row] : mode[row];
        if (value != static_cast<double>(static_cast<int>(value)))
          AddProblem(problems, column->items[row], path,
                     column->items[row].Describe() + " is not a whole number", "a whole number");
      }
    }
  }
  if (node.file == nullptr || problems.size() > before) return modes;
  const std::size_t rows = stage.size();
  for (const std::size_t size : {propellant_kg.size(), mode.size(), frequency_rad_s.size(), mass_kg.size(),
                                 station_m.size(), deflection.size(), slope_1_m.size(), plane.size()}) {
    if (size == rows) continue;
    AddProblem(problems, node, path, "the columns have different lengths", "one value a row in each column");
    return modes;
  }
  const auto report = [&](const char* column, std::size_t row, const std::string& message,
                          const std::string& allowed) {
    AddProblem(problems, node.Find(column)->items[row], path, message, allowed);
  };
  std::vector<std::size_t> first_row;
  std::set<ModeKey> seen;
  for (std::size_t row = 0; row < rows; ++row) {
    TabledMode m{static_cast<int>(stage[row]) - 1,
                 propellant_kg[row],
                 plane[row],
                 static_cast<int>(mode[row]),
                 frequency_rad_s[row],
                 mass_kg[row],
                 {},
                 {},
                 {}};
    if (modes.empty() || KeyOf(modes.back()) != KeyOf(m)) {
      if (!seen.insert(KeyOf(m)).second) {
        report("mode", row, "the mode was given before, further up",
               "all rows of a mode one after the other");
        return {};
      }
      modes.push_back(std::move(m));
      first_row.push_back(row);
    } else if (modes.back().frequency_rad_s != m.frequency_rad_s ||
               modes.back().generalized_mass_kg != m.generalized_mass_kg) {
      report("frequency_hz", row, "frequency or generalized mass change within a mode",
             "the same in all rows of a mode");
      return {};
    }
    TabledMode& current = modes.back();
    if (!current.station_m.empty() && !(station_m[row] > current.station_m.back())) {
      report("station_m", row, "the stations of a mode do not increase", "rows of increasing station_m");
      return {};
    }
    current.station_m.push_back(station_m[row]);
    current.deflection.push_back(deflection[row]);
    current.slope_1_m.push_back(slope_1_m[row]);
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const bool moves = std::any_of(modes[i].deflection.begin(), modes[i].deflection.end(),
                                   [](double d) { return d != 0.0; });
    if (modes[i].station_m.size() < 2 || !moves) {
      report("station_m", first_row[i], "the mode has less than two stations, or no deflection",
             "two or more stations, some deflection");
      return {};
    }
    const auto same_beam = [&](const TabledMode& m) {
      return m.stage == modes[i].stage && m.plane == modes[i].plane;
    };
    const TabledMode& first = *std::find_if(modes.begin(), modes.end(), same_beam);
    if (first.station_m != modes[i].station_m) {
      report("station_m", first_row[i], "the mode has other stations than the first of its stage and plane",
             "the same stations for all modes of a stage and plane");
      return {};
    }
    const auto count = [&](double propellant) {
      return std::count_if(modes.begin(), modes.end(), [&](const TabledMode& m) {
        return same_beam(m) && m.propellant_kg == propellant;
      });
    };
    if (count(first.propellant_kg) != count(modes[i].propellant_kg)) {
      report("propellant_kg", first_row[i],
             "this propellant has another number of modes than the first of its stage and plane",
             "as many modes at every propellant of a stage and plane");
      return {};
    }
  }
  const auto by_z_only = [&](const TabledMode& z) {
    return z.plane == BeamPlane::kZ && std::none_of(modes.begin(), modes.end(), [&](const TabledMode& y) {
             return y.stage == z.stage && y.plane == BeamPlane::kY;
           });
  };
  const auto lonely = std::find_if(modes.begin(), modes.end(), by_z_only);
  if (lonely != modes.end()) {
    report("plane", first_row[static_cast<std::size_t>(lonely - modes.begin())],
           "the stage has modes in plane z and none in plane y",
           "plane y, which stands for both, or both planes");
    return {};
  }
  std::sort(modes.begin(), modes.end(),
            [](const TabledMode& a, const TabledMode& b) { return KeyOf(a) < KeyOf(b); });
  return modes;
}

BeamSensor DecodeSensor(const InputNode& node, const std::string& path, ProblemList& problems) {
  MapReader map(node, path, problems);
  BeamSensor sensor;
  sensor.name = map.Text("name");
  sensor.station_m = map.Quantity("station", kLength, kNonNegative);
  return sensor;
}

}  // namespace

std::optional<StructureBeam> DecodeStructureBeam(const InputNode& node, const std::string& path,
                                                 std::size_t stages, ProblemList& problems) {
  MapReader map(node, path, problems);
  StructureBeam beam;
  map.Each("sensors", 0, 100, [&](const InputNode& item, const std::string& item_path) {
    beam.sensors.push_back(DecodeSensor(item, item_path, problems));
  });
  beam.rotary_inertia = map.Flag("rotary_inertia", true);
  beam.flown_modes = static_cast<int>(map.Integer("flown_modes", 0, kMostFlownModes, 3));
  beam.damping_ratio = map.Number("damping_ratio", Between(0.0, 0.5), 0.01);
  if (const InputNode* table = map.Optional("modes_table")) {
    if (table->file == nullptr) return std::nullopt;
    beam.table =
        DecodeModeTable(*table, table->file == node.file ? map.PathOf("modes_table") : "", stages, problems);
    return beam;
  }
  beam.timoshenko = map.Choice<bool>("theory", {{"euler_bernoulli", false}, {"timoshenko", true}}, false);
  beam.modes = static_cast<int>(map.Integer("modes", 1, 10, 3));
  beam.propellant_levels = static_cast<int>(map.Integer("propellant_levels", 2, 101, 11));
  beam.elements = static_cast<int>(map.Integer("elements", 20, 400, 60));
  map.Each("stages", std::max<std::size_t>(stages, 1), stages > 0 ? stages : kMaxStages,
           [&](const InputNode& item, const std::string& item_path) {
             beam.stages.push_back(DecodeBeamStage(item, item_path, beam.timoshenko, problems));
           });
  return beam;
}

}  // namespace dispersa
