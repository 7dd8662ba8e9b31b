#include "core/campaign_yaml/campaign_ids.h"

#include <algorithm>
#include <initializer_list>
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

// Removes the keys that decide nothing of what is `kept`.
void Keep(std::initializer_list<Decides> kept, InputNode& node, Decides around = Decides::kAsAround) {
  for (InputNode& item : node.items) Keep(kept, item, around);
  std::erase_if(node.members, [&](InputMember& member) {
    const Decides what = member.decides == Decides::kAsAround ? around : member.decides;
    if (std::find(kept.begin(), kept.end(), what) == kept.end()) return true;
    Keep(kept, member.value, what);
    return false;
  });
}

InputNode Kept(std::initializer_list<Decides> kept, InputNode tree) {
  Keep(kept, tree);
  return tree;
}

}  // namespace

std::string VehicleSha256(const InputNode& vehicle) {
  return Sha256Hex(CanonicalText(Kept({Decides::kAsAround}, vehicle)));
}

std::string RequirementsId(const InputNode& campaign) {
  InputNode judged = Kept({Decides::kVerdict}, campaign);
  if (InputNode limited = LimitedMetrics(campaign); !limited.items.empty())
    SetMember(judged, "metrics", std::move(limited));
  // The place among the others does not change what is required.
  if (InputNode* requirements = judged.Find("requirements"))
    std::sort(requirements->items.begin(), requirements->items.end(),
              [](const InputNode& a, const InputNode& b) { return CanonicalText(a) < CanonicalText(b); });
  return Sha256Hex(CanonicalText(judged));
}

std::string OwnMetricsId(const std::string& flight_id, const std::vector<OwnMetric>& metrics) {
  if (metrics.empty()) return "";
  std::string text = flight_id + "\n";
  for (const OwnMetric& metric : metrics) text += metric.name + " = " + metric.expression + "\n";
  return Sha256Hex(text);
}

std::string DesignId(const InputNode& campaign) {
  return Sha256Hex(CanonicalText(Kept({Decides::kAsAround, Decides::kFlightOnly}, campaign)));
}

std::string FlightId(const InputNode& campaign, SamplingMethod method) {
  // The strata of a Latin hypercube and the bounds of replicates depend on the number of cases; every other
  // case stands for itself.
  const bool counts =
      method == SamplingMethod::kLatinHypercube || campaign.Find("sampling")->Find("replicates") != nullptr;
  InputNode deciding = Kept(
      {Decides::kAsAround, Decides::kFlightOnly, Decides::kDraws, counts ? Decides::kCount : Decides::kDraws},
      campaign);
  InputNode engine = ScalarAt(campaign, EngineVersion());
  engine.quoted = true;
  SetMember(deciding, "engine", std::move(engine));
  return Sha256Hex(CanonicalText(deciding));
}

}  // namespace dispersa
