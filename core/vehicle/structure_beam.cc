#include "core/vehicle/structure_beam.h"

#include <algorithm>

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/vehicle/beam_masses.h"
#include "core/vehicle/vehicle.h"

namespace dispersa {

namespace {

/// Stations are written to the millimetre; boundaries nearer than this are one.
constexpr double kSameStation_m = 1e-6;
/// Of a section.
constexpr double kShortest_m = 1e-3;

double Fraction(const BeamSection& section, double station_m) {
  return (station_m - section.top_station_m) / (section.bottom_station_m - section.top_station_m);
}

double PlaneFactor(const BeamSection& section, BeamPlane plane) {
  return plane == BeamPlane::kZ ? section.z_to_y_stiffness : 1.0;
}

class BeamChecker {
 public:
  explicit BeamChecker(const Vehicle& vehicle) : vehicle_(vehicle), beam_(*vehicle.structure_beam) {}

  std::vector<StructProblem> Run() {
    for (std::size_t i = 0; i < beam_.sensors.size(); ++i) {
      if (beam_.sensors[i].station_m > vehicle_.stages[0].bottom_station_m)
        Add("sensors[" + std::to_string(i) + "].station_m", "lies aft of the vehicle",
            "at most " + std::to_string(vehicle_.stages[0].bottom_station_m) + " m");
    }
    if (!beam_.table.empty()) {
      CheckTable();
      if (vehicle_.boosters.count > 0)
        Add("modes_table", "has the modes of a stack that keeps its boosters",
            "structure_beam.stages, from which the modes with them and without them follow");
      return std::move(problems_);
    }
    if (vehicle_.boosters.count > 0 && !(vehicle_.boosters.attachment_station_m > 0.0)) {
      problems_.push_back({"boosters", "missing key 'attachment_station_m'",
                           "the station at which structure_beam carries them"});
      return std::move(problems_);
    }
    if (beam_.stages.size() != vehicle_.stages.size()) {
      Add("stages", "has " + std::to_string(beam_.stages.size()) + " entries",
          "one for each of the " + std::to_string(vehicle_.stages.size()) + " stages");
      return std::move(problems_);
    }
    for (std::size_t i = 0; i < beam_.stages.size(); ++i)
      if (!vehicle_.stages[i].restarts) CheckStage(i);
    for (std::size_t i = 0; problems_.empty() && i < beam_.stages.size(); ++i)
      if (!vehicle_.stages[i].restarts) CheckStack(i);
    return std::move(problems_);
  }

 private:
  void Add(const std::string& path, const std::string& message, const std::string& allowed) {
    problems_.push_back({"structure_beam." + path, message, allowed});
  }

  // A restart of a stage has no entry of its own in the file.
  std::string EntryOf(std::size_t i) const {
    const auto first = vehicle_.stages.begin();
    const auto restarts = std::count_if(first, first + static_cast<std::ptrdiff_t>(i),
                                        [](const Stage& stage) { return stage.restarts; });
    return "stages[" + std::to_string(i - static_cast<std::size_t>(restarts)) + "]";
  }

  // What leaves in any of the stage's burns.
  const std::vector<Jettison>& JettisonedOf(std::size_t i) const {
    return vehicle_.stages[static_cast<std::size_t>(LastBurn(vehicle_, static_cast<int>(i)))].jettisoned;
  }

  void CheckStage(std::size_t i) {
    const BeamStage& stage = beam_.stages[i];
    const std::string path = EntryOf(i);
    for (std::size_t k = 0; k < stage.sections.size(); ++k)
      CheckSection(stage.sections[k], vehicle_.stages[i].bottom_station_m,
                   path + ".sections[" + std::to_string(k) + "]");
    std::vector<std::string> names;
    for (const MassElement& e : vehicle_.stages[i].structure) names.push_back(e.name);
    for (const Jettison& j : JettisonedOf(i)) names.push_back(j.name);
    for (std::size_t k = 0; k < stage.lumped_masses.size(); ++k) {
      const LumpedMass& lump = stage.lumped_masses[k];
      const std::string item = path + ".lumped_masses[" + std::to_string(k) + "]";
      if (lump.element.empty()) continue;
      if (std::find(names.begin(), names.end(), lump.element) == names.end())
        Add(item + ".element",
            "'" + lump.element + "' is no element of the stage's structure and no body that it jettisons",
            "one of " + Joined(names));
      for (std::size_t j = 0; j < k; ++j) {
        if (stage.lumped_masses[j].element == lump.element)
          Add(item + ".element", "'" + lump.element + "' is lumped twice", "each element once");
      }
    }
  }

  void CheckSection(const BeamSection& s, double stage_bottom_m, const std::string& path) {
    if (!(s.bottom_station_m - s.top_station_m >= kShortest_m))
      Add(path + ".bottom_station_m", "is not a millimetre aft of top_station_m",
          "a station larger than top_station_m by 0.001 m or more");
    if (s.bottom_station_m > stage_bottom_m + kSameStation_m)
      Add(path + ".bottom_station_m", "lies aft of the stage's bottom_station_m",
          "at most bottom_station_m of the stage");
    if (s.modulus_pa > 0.0) {
      for (const double end : {0.0, 1.0}) {
        if (s.thickness_m.At(end) > 0.5 * s.outer_diameter_m.At(end)) {
          Add(path + ".thickness_m", "is more than half of outer_diameter_m",
              "up to half of the diameter, a solid rod");
          break;
        }
      }
    }
  }

  // The stack of stages i and above: one beam without a gap, and all that it carries between its ends.
  void CheckStack(std::size_t i) {
    const std::string path = EntryOf(i);
    std::vector<std::pair<double, double>> pieces;
    for (std::size_t k = i; k < beam_.stages.size(); ++k) {  // a restart's are those of its stage again
      for (const BeamSection& s : beam_.stages[k].sections)
        pieces.emplace_back(s.top_station_m, s.bottom_station_m);
    }
    std::sort(pieces.begin(), pieces.end());
    const double top = pieces.front().first;
    double bottom = top;
    for (const auto& [begin, end] : pieces) {
      if (begin > bottom + kSameStation_m) {
        Add(path + ".sections",
            "the beam has a gap from station " + std::to_string(bottom) + " m to " + std::to_string(begin) +
                " m",
            "sections of this stage and those above that follow one another without a gap");
        return;
      }
      bottom = std::max(bottom, end);
    }
    const auto inside = [&](double a, double b) {
      return a >= top - kSameStation_m && b <= bottom + kSameStation_m;
    };
    const std::string beam = "the beam, which reaches from station " + std::to_string(top) + " m to " +
                             std::to_string(bottom) + " m";
    const Stage& stage = vehicle_.stages[i];
    if (!inside(stage.PropellantTop(), stage.PropellantBottom()))
      Add(path + ".sections",
          "the stage's " + std::string(stage.is_liquid() ? "tanks lie" : "grain lies") + " outside of " +
              beam,
          stage.is_liquid() ? "sections along all tanks" : "sections along the whole grain");
    for (std::size_t k = 0; k < beam_.stages[i].lumped_masses.size(); ++k) {
      const LumpedMass& lump = beam_.stages[i].lumped_masses[k];
      if (!inside(lump.station_m, lump.station_m))
        Add(path + ".lumped_masses[" + std::to_string(k) + "].station_m", "lies outside of " + beam,
            "a station of the beam");
    }
    const auto check_tube = [&](const auto& tube, const char* of) {
      if (!IsLumped(beam_.stages[i], tube.name) && !inside(tube.top_station_m, tube.bottom_station_m))
        Add(path + ".sections", "'" + tube.name + "' of the stage's " + of + " lies outside of " + beam,
            "sections along the whole element, or the element among lumped_masses");
    };
    for (const Jettison& j : JettisonedOf(i)) check_tube(j, "jettisoned bodies");
    const Boosters& boosters = vehicle_.boosters;
    if (i == 0 && boosters.count > 0 && !inside(boosters.attachment_station_m, boosters.attachment_station_m))
      problems_.push_back(
          {"boosters.attachment_station_m", "lies outside of " + beam, "a station of the beam"});
    if (stage.flown_mass.rows) CheckMassTable(i);
    if (beam_.stages[i].own_masses) {
      if (!stage.flown_mass.rows) CheckOwnMasses(i, path);
      return;
    }
    for (const MassElement& e : stage.structure) check_tube(e, "structure");
  }

  // The tubes say how the table's masses lie along the beam.
  void CheckMassTable(std::size_t i) {
    const double full_kg = vehicle_.stages[i].propellant_mass_kg;
    for (const double propellant_kg : {full_kg, 0.5 * full_kg, 0.0}) {
      const TableScale scale = ScaleToMassTable(vehicle_, static_cast<int>(i), propellant_kg);
      if (scale.least >= kLeastMassScale && scale.greatest <= kGreatestMassScale) continue;
      problems_.push_back({"stages[" + std::to_string(i) + "].mass_table",
                           "does not fit the tubes, which lie along structure_beam: with " +
                               std::to_string(propellant_kg) + " kg they would be multiplied by " +
                               std::to_string(scale.least) + " to " + std::to_string(scale.greatest),
                           "tubes of structure, grain or tanks that are multiplied by " +
                               std::to_string(kLeastMassScale) + " to " + std::to_string(kGreatestMassScale) +
                               " to have the table's centre of gravity and inertia"});
      return;
    }
  }

  void CheckOwnMasses(std::size_t i, const std::string& path) {
    const OwnMassScale scale = ScaleOwnMasses(vehicle_, static_cast<int>(i));
    if (scale.least >= kLeastMassScale && scale.greatest <= kGreatestMassScale) return;
    Add(path + ".sections",
        "the masses do not fit the stage's: they are " + std::to_string(scale.given_kg) +
            " kg with the centre of gravity at station " + std::to_string(scale.given_cg_m) +
            " m, the dry stage is " + std::to_string(scale.stage_kg) + " kg at " +
            std::to_string(scale.stage_cg_m) + " m; the mass per length would be multiplied by " +
            std::to_string(scale.least) + " to " + std::to_string(scale.greatest),
        "masses that are multiplied by " + std::to_string(kLeastMassScale) + " to " +
            std::to_string(kGreatestMassScale) +
            " to have the mass, centre of gravity and inertia of the dry stage");
  }

  void CheckTable() {
    for (std::size_t i = 0; i < vehicle_.stages.size(); ++i) {
      if (!vehicle_.stages[i].jettisoned.empty())
        Add("modes_table",
            "has the modes of a stack that carries all its bodies, but stage " + std::to_string(i + 1) +
                " jettisons some",
            "structure_beam.stages, from which the modes of both follow");
      if (vehicle_.stages[i].restarts) continue;
      if (std::none_of(beam_.table.begin(), beam_.table.end(),
                       [&](const TabledMode& m) { return m.stage == static_cast<int>(i); }))
        Add("modes_table", "has no modes of stage " + std::to_string(i + 1), "modes of every stage's stack");
    }
    for (const TabledMode& m : beam_.table) {
      if (vehicle_.stages[static_cast<std::size_t>(m.stage)].restarts) {
        Add("modes_table", "has modes of stage " + std::to_string(m.stage + 1) + ", a restart",
            "modes of the stage that burns again: they hold for all its burns");
        return;
      }
      const double full = vehicle_.stages[static_cast<std::size_t>(m.stage)].propellant_mass_kg;
      if (m.propellant_kg > full * (1.0 + 1e-9)) {
        Add("modes_table",
            "has modes of stage " + std::to_string(m.stage + 1) + " at " + std::to_string(m.propellant_kg) +
                " kg",
            "at most the stage's propellant, " + std::to_string(full) + " kg");
        return;
      }
    }
  }

  static std::string Joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
  }

  const Vehicle& vehicle_;
  const StructureBeam& beam_;
  std::vector<StructProblem> problems_;
};

}  // namespace

double BeamSection::BendingStiffness(BeamPlane plane, double station_m) const {
  const double f = Fraction(*this, station_m);
  if (!(modulus_pa > 0.0)) return PlaneFactor(*this, plane) * bending_stiffness_n_m2.At(f);
  const double outer = outer_diameter_m.At(f);
  const double inner = outer - 2.0 * thickness_m.At(f);
  return PlaneFactor(*this, plane) * modulus_pa * kPi / 64.0 *
         (Square(Square(outer)) - Square(Square(inner)));
}

double BeamSection::ShearStiffness(BeamPlane plane, double station_m) const {
  const double f = Fraction(*this, station_m);
  if (!(modulus_pa > 0.0)) return PlaneFactor(*this, plane) * shear_stiffness_n.At(f);
  const double outer = outer_diameter_m.At(f);
  const double inner = outer - 2.0 * thickness_m.At(f);
  const double area = 0.25 * kPi * (Square(outer) - Square(inner));
  const double coefficient = 2.0 * (1.0 + poisson_ratio) / (4.0 + 3.0 * poisson_ratio);
  return PlaneFactor(*this, plane) * coefficient * area * modulus_pa / (2.0 * (1.0 + poisson_ratio));
}

std::vector<StructProblem> BeamProblems(const Vehicle& vehicle) {
  DISPERSA_ASSERT(vehicle.structure_beam.has_value());
  return BeamChecker(vehicle).Run();
}

}  // namespace dispersa
