#include "core/tuning/tuning_budget.h"

#include <string>
#include <utility>
#include <vector>

#include "core/input/input_error.h"
#include "core/tuning/stage_design.h"

namespace dispersa {

int SearchesOf(const Campaign& campaign, const AutopilotConfig& autopilot) {
  return static_cast<int>(campaign.vehicle.stages.size()) + (IsAugmented(autopilot) ? 1 : 0);
}

int PopulationOf(const TuningOptions& options) {
  return options.dispersed > 0 ? kHeldPopulation : kTuningPopulation;
}

int GenerationsOf(const TuningOptions& options, int searches) {
  const int population = PopulationOf(options);
  return (options.evaluations / searches - population) / (population - kElites);
}

void CheckTuning(const Campaign& campaign, const AutopilotConfig& autopilot, const TuningOptions& options) {
  const int stages = static_cast<int>(campaign.vehicle.stages.size());
  std::vector<InputProblem> problems;
  const auto add = [&](const std::string& path, const std::string& message, const std::string& allowed) {
    problems.push_back({"", 0, 0, path, message, allowed});
  };
  if (options.seed == campaign.sampling.seed)
    add("seed", "the tuning would fly the cases of campaign '" + campaign.name + "'",
        "any but the campaign's own, " + std::to_string(campaign.sampling.seed));
  if (options.cases < 1 || options.cases > 10000)
    add("cases", std::to_string(options.cases) + " is out of range", "1 to 10000");
  const int population = PopulationOf(options);
  const int least = 2 * population * SearchesOf(campaign, autopilot);
  if (options.evaluations < least || options.evaluations > 1000000)
    add("evaluations", std::to_string(options.evaluations) + " is out of range",
        std::to_string(least) + " (two generations of " + std::to_string(population) + " for each " +
            (IsAugmented(autopilot) ? "stage and the augmentation" : "stage") + ") to 1000000");
  if (options.dispersed < 0 || options.dispersed > 1000)
    add("dispersed", std::to_string(options.dispersed) + " is out of range", "0 to 1000");
  for (const StructProblem& problem : Problems(autopilot, stages))
    add(problem.path, problem.message, problem.allowed);
  for (const AxisConfig* axis : {&autopilot.pitch, &autopilot.yaw, &autopilot.roll})
    if (InfoOf(axis->law).adaptation && axis->adaptation.p_n)
      add("adaptation.p_n", "is fixed, but P_n follows from the gains that are to be found", "no p_n");
  if (options.regulator)
    for (const auto& [axis, name] : {std::pair{&autopilot.pitch, "pitch"}, {&autopilot.yaw, "yaw"}})
      if (!InfoOf(axis->law).integral)
        add(std::string(name) + ".law",
            std::string(InfoOf(axis->law).name) + " has no integral, which is a state of the regulator",
            "pid, pid_aac");
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace dispersa
