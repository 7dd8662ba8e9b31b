#include "core/campaign_yaml/campaign_ids.h"

#include <algorithm>
#include <utility>

#include "core/campaign_yaml/canonical.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/sha256.h"
#include "core/flight/engine_version.h"

namespace dispersa {
namespace {

// The items of `metrics` that requirements name.
InputNode LimitedMetrics(const InputNode& campaign) {
  InputNode limited = ListAt(campaign);
  const InputNode* metrics = campaign.Find("metrics");
  const InputNode* requirements = campaign.Find("requirements");
  if (metrics == nullptr || requirements == nullptr) return limited;
  for (const InputNode& metric : metrics->items) {
    const bool is_limited = std::any_of(requirements->items.begin(), requirements->items.end(),
                                        [&](const InputNode& requirement) {
                                          const InputNode* name = requirement.Find("metric");
                                          return name != nullptr && name->text == metric.Find("name")->text;
                                        });
    if (!is_limited) continue;
    InputNode& item = limited.items.emplace_back(MapAt(campaign));
    for (const char* key : {"name", "expression"}) SetMember(item, key, *metric.Find(key));
  }
  return limited;
}

}  // namespace

std::string VehicleSha256(const InputNode& vehicle) {
  InputNode rigid = vehicle;
  std::erase_if(rigid.members, [](const InputMember& member) {
    return member.key == "structure_beam" || member.key == "sensors" || member.key == "nozzles" ||
           member.key == "limits" || member.key == "loss_of_control" || member.key == "descent";
  });
  // Nor does a point mass know what its actuators lack, what its structure bears, or how an engine tails off.
  if (InputNode* stages = rigid.Find("stages"))
    for (InputNode& stage : stages->items) {
      if (InputNode* motor = stage.Find("motor"))
        if (InputNode* liquid = motor->Find("liquid"))
          std::erase_if(liquid->members,
                        [](const InputMember& member) { return member.key.starts_with("tail_off_"); });
      if (InputNode* gimbal = stage.Find("gimbal"))
        std::erase_if(gimbal->members, [](const InputMember& member) {
          return member.key.starts_with("dead_zone_") || member.key.starts_with("friction_") ||
                 member.key.starts_with("resolution_");
        });
    }
  if (InputNode* boosters = rigid.Find("boosters"))
    std::erase_if(boosters->members,
                  [](const InputMember& member) { return member.key.starts_with("attachment_station_"); });
  return Sha256Hex(CanonicalText(rigid));
}

std::string RequirementsId(const InputNode& campaign) {
  InputNode judged = MapAt(campaign);
  for (const char* key : {"requirements", "verdicts"}) {
    if (const InputNode* value = campaign.Find(key)) SetMember(judged, key, *value);
  }
  if (InputNode limited = LimitedMetrics(campaign); !limited.items.empty())
    SetMember(judged, "metrics", std::move(limited));
  // Neither words about a requirement nor its place among the others change what is required.
  if (InputNode* requirements = judged.Find("requirements")) {
    for (InputNode& requirement : requirements->items)
      std::erase_if(requirement.members, [](const InputMember& member) {
        return member.key == "id" || member.key == "rationale" || member.key == "source";
      });
    std::sort(requirements->items.begin(), requirements->items.end(),
              [](const InputNode& a, const InputNode& b) { return CanonicalText(a) < CanonicalText(b); });
  }
  return Sha256Hex(CanonicalText(judged));
}

std::string OwnMetricsId(const std::string& flight_id, const std::vector<OwnMetric>& metrics) {
  if (metrics.empty()) return "";
  std::string text = flight_id + "\n";
  for (const OwnMetric& metric : metrics) text += metric.name + " = " + metric.expression + "\n";
  return Sha256Hex(text);
}

std::string DesignId(const InputNode& campaign) {
  InputNode design = MapAt(campaign);
  for (const char* key : {"vehicle", "reference", "autopilot", "guidance", "flight", "dispersions",
                          "correlations", "derived"}) {
    if (const InputNode* value = campaign.Find(key)) SetMember(design, key, *value);
  }
  const InputNode& sampling = *campaign.Find("sampling");
  InputNode points = MapAt(campaign);
  for (const char* key : {"method", "replicates", "table"}) {
    if (const InputNode* value = sampling.Find(key)) SetMember(points, key, *value);
  }
  SetMember(design, "sampling", std::move(points));
  return Sha256Hex(CanonicalText(design));
}

std::string FlightId(const InputNode& campaign, SamplingMethod method) {
  InputNode deciding = MapAt(campaign);
  for (const char* key : {"vehicle", "reference", "autopilot", "guidance", "flight", "dispersions",
                          "correlations", "derived"}) {
    if (const InputNode* value = campaign.Find(key)) SetMember(deciding, key, *value);
  }
  InputNode sampling = MapAt(campaign);
  SetMember(sampling, "method", *campaign.Find("sampling")->Find("method"));
  SetMember(sampling, "seed", *campaign.Find("sampling")->Find("seed"));
  for (const char* key : {"replicates", "table"}) {
    if (const InputNode* value = campaign.Find("sampling")->Find(key)) SetMember(sampling, key, *value);
  }
  // The strata of a Latin hypercube and the bounds of replicates depend on the number of cases; every other
  // case stands for itself.
  if (method == SamplingMethod::kLatinHypercube || campaign.Find("sampling")->Find("replicates") != nullptr) {
    SetMember(sampling, "cases", *campaign.Find("sampling")->Find("cases"));
  }
  SetMember(deciding, "sampling", std::move(sampling));
  InputNode engine = ScalarAt(campaign, EngineVersion());
  engine.quoted = true;
  SetMember(deciding, "engine", std::move(engine));
  return Sha256Hex(CanonicalText(deciding));
}

}  // namespace dispersa
