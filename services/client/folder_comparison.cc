#include "services/client/folder_comparison.h"

#include <algorithm>
#include <numeric>
#include <system_error>
#include <utility>

#include "core/campaign/case_result.h"
#include "core/campaign_yaml/text_differences.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight_inputs.h"
#include "core/input/input_error.h"
#include "core/results/output_file.h"
#include "services/client/stored_campaign.h"

namespace dispersa {
namespace {

/// A name that neither campaign has is no fault of one of them.
void CheckKnown(const Campaign& a, const Campaign& b, const std::vector<std::string>& metrics) {
  for (const std::string& metric : metrics) {
    const std::vector<std::string>& names = MetricNames();
    if (MetricsOf(a).Find(metric) || MetricsOf(b).Find(metric) ||
        std::find(names.begin(), names.end(), metric) != names.end())
      continue;
    throw InputError("--metric: '" + metric + "' " + WhyNotMeasured(a, metric),
                     "a name in cases.csv without its prefix 'metric_'");
  }
}

/// Both must have what is asked for.
void CheckMeasured(const std::string& name, const Campaign& campaign,
                   const std::vector<std::string>& metrics) {
  for (const std::string& metric : metrics)
    if (const std::string why = WhyNotMeasured(campaign, metric); !why.empty())
      throw InputError("--metric: " + name + ": '" + metric + "' " + why,
                       "a metric that both campaigns have");
}

void CheckSameDefinitions(const Campaign& a, const Campaign& b, const std::vector<std::string>& metrics) {
  for (const OwnMetric& own : a.own_metrics)
    if (std::find(metrics.begin(), metrics.end(), own.name) != metrics.end() &&
        !FindOwn({own}, b.own_metrics))
      throw InputError("--metric: '" + own.name + "' has another expression in each campaign",
                       "a metric that means the same in both");
}

std::vector<CampaignChange> ChangesOf(const Campaign& a, const Campaign& b) {
  std::vector<CampaignChange> changes;
  for (const ValueDifference& each : DifferencesOf(a.canonical_yaml, b.canonical_yaml))
    changes.push_back({each.path, each.a, each.b});
  return changes;
}

}  // namespace

CaseColumns AllColumns(const ResultFolder& folder) {
  std::vector<int> inputs(InputCount(folder.stages()));
  std::iota(inputs.begin(), inputs.end(), 0);
  return ReadColumns(folder, inputs);
}

FolderComparison CompareFolders(const std::string& name_a, const std::string& name_b,
                                const std::vector<std::string>& metrics, double practical_share) {
  const StoredCampaign a = OpenStored(name_a);
  const StoredCampaign b = OpenStored(name_b);
  CheckKnown(a.campaign, b.campaign, metrics);
  CheckMeasured(name_a, a.campaign, metrics);
  CheckMeasured(name_b, b.campaign, metrics);
  CheckSameDefinitions(a.campaign, b.campaign, metrics);
  FolderComparison compared = {{}, AllColumns(a.folder), AllColumns(b.folder)};
  compared.comparison = Compare({name_a, a.folder.Provenance("engine"), a.campaign, compared.a, a.cases},
                                {name_b, b.folder.Provenance("engine"), b.campaign, compared.b, b.cases},
                                metrics, ChangesOf(a.campaign, b.campaign), practical_share);
  for (const auto& [stored, side] :
       {std::pair{&a, &compared.comparison.a}, std::pair{&b, &compared.comparison.b}})
    if (const auto nominal = NominalOf(stored->campaign, side->engine))
      side->nominal_loss = NominalLoss(*nominal);
  return compared;
}

void WriteComparison(const FolderComparison& compared, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("--out: " + folder.string() + ": " + error.message(), "a folder that can be written");
  WriteFile(folder / "compare.json", ComparisonJson(compared.comparison));
  WriteFile(folder / "compare.html", ComparisonPage(compared.comparison, compared.a, compared.b));
}

}  // namespace dispersa
