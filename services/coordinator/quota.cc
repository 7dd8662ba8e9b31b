#include "services/coordinator/quota.h"

#include <charconv>
#include <sstream>

#include "core/input/printable.h"
#include "services/coordinator/retention.h"

namespace dispersa {
namespace {

std::optional<std::uint64_t> ReadCount(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stopped == end && number > 0 ? std::optional(number) : std::nullopt;
}

std::optional<std::uint64_t>* MemberOf(Quota& quota, const std::string& name) {
  if (name == "cases") return &quota.cases;
  if (name == "campaigns") return &quota.campaigns;
  if (name == "places") return &quota.places;
  if (name == "disk") return &quota.disk;
  return nullptr;
}

std::string AddLimit(const std::string& limit, bool of_one, Quota* quota) {
  const std::size_t equals = limit.find('=');
  const std::string name = limit.substr(0, equals);
  std::optional<std::uint64_t>* const member = MemberOf(*quota, name);
  if (member == nullptr || equals == std::string::npos) {
    return "'" + Printable(limit) +
           "' is no limit, allowed: cases=N, campaigns=N, places=N and disk=SIZE, with commas between them, "
           "for "
           "all owners, or after OWNER: for one of them";
  }
  const std::string value = limit.substr(equals + 1);
  if (of_one && value == "none") {
    *member = Quota::kNoLimit;
    return "";
  }
  const auto number = name == "disk" ? ReadSize(value) : ReadCount(value);
  if (!number) {
    return "'" + Printable(value) + "' is no value of " + name +
           ", allowed: " + (name == "disk" ? "a size as 200GB" : "a whole number from 1") +
           (of_one ? ", or none" : "; none only after OWNER:");
  }
  *member = number;
  return "";
}

}  // namespace

std::string Quotas::Add(const std::string& text) {
  const std::size_t colon = text.find(':');
  const bool of_one = colon != std::string::npos;
  const std::string owner = text.substr(0, of_one ? colon : 0);
  if (of_one && owner.empty()) {
    return "'" + Printable(text) + "' has no owner before ':', allowed: the name of a client's keys";
  }
  Quota& quota = of_one ? of_one_[owner] : of_all_;
  std::istringstream limits(text.substr(of_one ? colon + 1 : 0) + ",");
  for (std::string limit; std::getline(limits, limit, ',');) {
    if (const std::string problem = AddLimit(limit, of_one, &quota); !problem.empty()) return problem;
  }
  return "";
}

Quota Quotas::Of(const std::string& owner) const {
  Quota quota = of_all_;
  const auto own = of_one_.find(owner);
  if (own == of_one_.end()) return quota;
  for (const auto member : {&Quota::cases, &Quota::campaigns, &Quota::places, &Quota::disk})
    if (own->second.*member) quota.*member = own->second.*member;
  return quota;
}

}  // namespace dispersa
