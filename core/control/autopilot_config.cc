#include "core/control/autopilot_config.h"

#include <cmath>
#include <functional>
#include <string>

#include "core/control/lyapunov.h"
#include "core/input/fields.h"
#include "core/math/constants.h"

namespace dispersa {

namespace {

using AddProblem =
    std::function<void(const std::string& path, const std::string& message, const std::string& allowed)>;

void CheckSection(const FilterSection& section, const std::string& path, double tick_s,
                  const AddProblem& add) {
  if (!(section.poles_rad_s * tick_s < kPi))
    add(path + ".poles_rad_s", "is not below half of the sampling frequency",
        "a frequency below pi / tick_s");
}

void CheckSchedule(const AxisConfig& axis, int stages, double tick_s, const AddProblem& add) {
  const ScheduleEntry ignition;
  const ScheduleEntry* before = &ignition;
  for (std::size_t i = 0; i < axis.schedule.size(); ++i) {
    const ScheduleEntry& entry = axis.schedule[i];
    const std::string path = "schedule[" + std::to_string(i) + "]";
    if (entry.stage < 1 || entry.stage > stages) {
      add(path + ".stage", "is not a stage of the vehicle", "1 to " + std::to_string(stages));
      return;
    }
    if (entry.stage < before->stage)
      add(path + ".stage", "comes after a later stage", "entries by stage and then by time");
    else if (!(entry.at_s > (entry.stage == before->stage ? before->at_s : 0.0)))
      add(path + ".at_s",
          "is not after " + std::string(entry.stage == before->stage ? "the entry before" : "ignition"),
          "times since ignition that rise, the first above 0, where the stage's own gains hold");
    const std::size_t filters = FiltersOfStage(axis, entry.stage).size();
    if (entry.filters.size() != filters)
      add(path + ".filters", "has " + std::to_string(entry.filters.size()) + " sections",
          "as many as act in the stage, " + std::to_string(filters));
    for (std::size_t k = 0; k < entry.filters.size(); ++k)
      CheckSection(entry.filters[k], path + ".filters[" + std::to_string(k) + "]", tick_s, add);
    before = &entry;
  }
}

void CheckAxis(const AxisConfig& axis, const std::string& name, int stages, double tick_s,
               std::vector<StructProblem>& problems) {
  const LawInfo& law = InfoOf(axis.law);
  const AddProblem add = [&](const std::string& path, const std::string& message,
                             const std::string& allowed) {
    problems.push_back({name + "." + path, message, allowed});
  };
  const auto is_one_a_stage = [&](const std::string& path, std::size_t entries) {
    if (static_cast<int>(entries) == stages) return true;
    add(path, "has " + std::to_string(entries) + " entries",
        "one entry for each of the vehicle's " + std::to_string(stages) + " stages");
    return false;
  };
  if (!is_one_a_stage("gains", axis.gains.size())) return;
  for (const StageList& list : kStageLists)
    if (law.*list.read_by) is_one_a_stage(list.path, list.of(axis).size());
  const std::size_t before = problems.size();
  for (std::size_t i = 0; i < axis.filters.size(); ++i) {
    const FilterSection& section = axis.filters[i];
    const std::string path = "filters[" + std::to_string(i) + "]";
    CheckSection(section, path, tick_s, add);
    if (section.stage > stages)
      add(path + ".stage", "is not a stage of the vehicle", "1 to " + std::to_string(stages));
  }
  CheckSchedule(axis, stages, tick_s, add);
  if (law.foreign && !axis.schedule.empty())
    add("schedule", "changes gains, but a plug-in gets its gains only at ignition",
        "no schedule with law: plugin");
  if (!law.adaptation) return;
  if (!(axis.adaptation.spread_1_s * tick_s <= 1.0))
    add("adaptation.spread_1_s", "overshoots the mean within a tick", "at most 1 / tick_s");
  if (!(axis.adaptation.predictor_1_s * tick_s <= 1.0))
    add("adaptation.predictor_1_s", "overshoots the measurement within a tick", "at most 1 / tick_s");
  if (problems.size() != before) return;

  const Adaptation& a = axis.adaptation;
  if (a.q(0, 1) != a.q(1, 0) || !IsPositiveDefinite(a.q))
    add("adaptation.q", "is not symmetric positive definite",
        "a symmetric matrix with positive diagonal and determinant");
  else if (a.p_n && !a.allow_unproven) {
    if (!(a.p_n->x() > 0.0) || !(a.p_n->y() > 0.0)) {
      add("adaptation.p_n",
          "is not positive: no positive definite P has this last column and gives a stable law",
          "two positive numbers, or allow_unproven: true to study it");
      return;
    }
    std::vector<std::pair<int, AxisGains>> all;
    for (std::size_t i = 0; i < axis.gains.size(); ++i)
      all.emplace_back(static_cast<int>(i) + 1, axis.gains[i]);
    for (const ScheduleEntry& entry : axis.schedule) all.emplace_back(entry.stage, entry.gains);
    for (const auto& [stage, gains] : all) {
      const Vector2 solved = SolveLyapunov(gains, a.q).col(1);
      // The file has few digits of P_n. A relative tolerance of 1e-3 still tells the right P from another
      // one.
      if (std::fabs(a.p_n->x() - solved.x()) > 1e-3 * solved.x() ||
          std::fabs(a.p_n->y() - solved.y()) > 1e-3 * solved.y()) {
        add("adaptation.p_n",
            "is not the last column of the P that solves A'P + PA = -Q for the gains of stage " +
                std::to_string(stage) + ", which is [" + std::to_string(solved.x()) + ", " +
                std::to_string(solved.y()) + "]",
            "that column, no p_n at all, or allow_unproven: true to study it");
        return;
      }
    }
  }
}

}  // namespace

std::vector<std::size_t> FiltersOfStage(const AxisConfig& axis, int stage) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < axis.filters.size(); ++i)
    if (axis.filters[i].stage == 0 || axis.filters[i].stage == stage) found.push_back(i);
  return found;
}

unsigned PluginAxes(const AutopilotConfig& autopilot) {
  unsigned axes = 0;
  const AxisConfig* const configs[] = {&autopilot.roll, &autopilot.pitch, &autopilot.yaw};
  for (unsigned axis = 0; axis < 3; ++axis)
    if (InfoOf(configs[axis]->law).foreign) axes |= 1u << axis;
  return axes;
}

std::vector<StructProblem> Problems(const AutopilotConfig& autopilot, int stages) {
  std::vector<StructProblem> problems;
  CheckAxis(autopilot.pitch, "pitch", stages, autopilot.tick_s, problems);
  CheckAxis(autopilot.yaw, "yaw", stages, autopilot.tick_s, problems);
  CheckAxis(autopilot.roll, "roll", stages, autopilot.tick_s, problems);
  if (PluginAxes(autopilot) != 0 && !autopilot.plugin) {
    const char* const axis = InfoOf(autopilot.pitch.law).foreign ? "pitch.law"
                             : InfoOf(autopilot.yaw.law).foreign ? "yaw.law"
                                                                 : "roll.law";
    problems.push_back({axis, "is a plug-in's, and the autopilot names none", "plugin: {library: FILE}"});
  }
  if (PluginAxes(autopilot) == 0 && autopilot.plugin)
    problems.push_back(
        {"plugin", "is the law of no axis", "law: plugin of pitch, yaw or roll, or no plugin"});
  return problems;
}

}  // namespace dispersa
