#include "services/transport/permissions.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "services/transport/topics.h"

namespace dispersa {
namespace {

// A rule applies to all partitions that it names, whichever of its topics: so one rule for each partition.
struct Rule {
  const char* verb;  ///< "publish" or "subscribe"
  std::vector<std::string> topics;
  std::string partition;
};

std::vector<Rule> RulesOf(Role role, const std::string& name, Right right) {
  const std::string own = PartitionOf(OwnPrefix(name)) + "*", all = "*", none;
  const std::string client = PartitionOf(ClientPrefix(name, right)) + "*";
  switch (role) {
    case Role::kCoordinator:
      return {{"publish", {kProgressTopic, kResultTopic}, none},
              {"publish", {kOrdersTopic, kTextTopic, kReplyTopic}, PartitionOf("*")},
              {"subscribe",
               {kStatusTopic, kReportTopic, kTextRequestTopic, kCampaignRefusalTopic, kRequestTopic},
               all},
              // It asks itself how it does (--health).
              {"publish", {kRequestTopic}, own},
              {"subscribe", {kReplyTopic}, own}};
    case Role::kWorker:
      return {{"publish", {kStatusTopic, kReportTopic, kTextRequestTopic, kCampaignRefusalTopic}, own},
              {"subscribe", {kOrdersTopic, kTextTopic}, own}};
    case Role::kClient:
      return {{"publish", {kRequestTopic}, client},
              {"subscribe", {kReplyTopic}, client},
              {"subscribe", {kProgressTopic, kResultTopic}, none}};
    case Role::kObserver:
      return {{"subscribe", {kProgressTopic, kResultTopic}, none}};
  }
  return {};
}

constexpr char kDomains[] = "<domains><id_range><min>0</min><max>99</max></id_range></domains>";
constexpr char kHead[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
    "xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-Security/20170801/";

std::string Element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + text + "</" + name + ">";
}

std::string ToXml(const Rule& rule) {
  std::string topics;
  for (const std::string& topic : rule.topics) topics += Element("topic", topic);
  return "   <allow_rule>\n    " + std::string(kDomains) + "\n    <" + rule.verb + ">" +
         Element("topics", topics) + Element("partitions", Element("partition", rule.partition)) + "</" +
         rule.verb + ">\n   </allow_rule>\n";
}

std::string ToXml(std::time_t time) { return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(time)); }

}  // namespace

const char* Name(Role role) {
  constexpr const char* kNames[] = {"coordinator", "worker", "client", "observer"};
  return kNames[static_cast<int>(role)];
}

std::optional<Role> ParseRole(const std::string& text) {
  const auto* found =
      std::find_if(kRoles.begin(), kRoles.end(), [&](Role role) { return Name(role) == text; });
  return found == kRoles.end() ? std::nullopt : std::optional(*found);
}

const char* Name(Right right) {
  constexpr const char* kNames[] = {"read", "run", "administer"};
  return kNames[static_cast<int>(right)];
}

std::optional<Right> ParseRight(const std::string& text) {
  const auto* found =
      std::find_if(kRights.begin(), kRights.end(), [&](Right right) { return Name(right) == text; });
  return found == kRights.end() ? std::nullopt : std::optional(*found);
}

std::string OwnPrefix(const std::string& name) { return name + "_"; }

// Names of keys begin with a letter or a digit. So no permission of other keys covers such a name.
std::string ClientPrefix(const std::string& name, Right right) {
  return std::string("_") + Name(right) + "_" + OwnPrefix(name);
}

namespace {

/// Behind the right, if there is one.
std::size_t NameBegins(const std::string& who) {
  const std::size_t end = who.starts_with('_') ? who.find('_', 1) : std::string::npos;
  return end != std::string::npos && ParseRight(who.substr(1, end - 1)) ? end + 1 : 0;
}

}  // namespace

Right RightOf(const std::string& client) {
  const std::size_t begin = NameBegins(client);
  return begin == 0 ? Right::kRun : *ParseRight(client.substr(1, begin - 2));
}

std::string KeyNameOf(const std::string& who) {
  const std::size_t begin = NameBegins(who), end = who.find('_', begin);
  return end == std::string::npos ? "" : who.substr(begin, end - begin);
}

std::string AccountOf(const std::string& who) {
  const std::string keys = KeyNameOf(who);
  return keys.empty() ? who : keys;
}

// Each writer and reader has keys of its own, which only those have who are allowed to match it: what the
// coordinator tells one worker another worker can neither read nor forge. Submessages are encrypted and not
// only what they carry, so that nobody can forge acknowledgements or gaps either.
std::string GovernanceDocument() {
  return std::string(kHead) +
         "omg_shared_ca_governance.xsd\">\n <domain_access_rules>\n  <domain_rule>\n   " + kDomains +
         "\n"
         "   <allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
         "   <enable_join_access_control>true</enable_join_access_control>\n"
         "   <discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
         "   <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
         "   <rtps_protection_kind>NONE</rtps_protection_kind>\n"
         "   <topic_access_rules>\n    <topic_rule>\n"
         "     <topic_expression>*</topic_expression>\n"
         "     <enable_discovery_protection>true</enable_discovery_protection>\n"
         "     <enable_liveliness_protection>true</enable_liveliness_protection>\n"
         "     <enable_read_access_control>true</enable_read_access_control>\n"
         "     <enable_write_access_control>true</enable_write_access_control>\n"
         "     <metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
         "     <data_protection_kind>NONE</data_protection_kind>\n"
         "    </topic_rule>\n   </topic_access_rules>\n"
         "  </domain_rule>\n </domain_access_rules>\n</dds>\n";
}

std::string PermissionsDocument(Role role, const std::string& name, Right right, const std::string& subject,
                                std::time_t not_before, std::time_t not_after) {
  std::string rules;
  for (const Rule& rule : RulesOf(role, name, right)) rules += ToXml(rule);
  return std::string(kHead) + "omg_shared_ca_permissions.xsd\">\n <permissions>\n  <grant name=\"" +
         Name(role) + "\">\n   " + Element("subject_name", subject) + "\n   " +
         Element("validity",
                 Element("not_before", ToXml(not_before)) + Element("not_after", ToXml(not_after))) +
         "\n" + rules + "   <default>DENY</default>\n  </grant>\n </permissions>\n</dds>\n";
}

}  // namespace dispersa
