#include "services/coordinator/expulsions.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "core/results/result_store.h"
#include "services/coordinator/sealed_json.h"
#include "services/transport/permissions.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kExpelledVersion = 2;  // version 1 was the object of names alone

/// A process is the one that has a host.
bool IsLiarOf(const std::string& keys, const std::pair<const std::string, Expulsion>& each) {
  return !each.second.host.empty() && !each.second.is_forgiven && KeyNameOf(each.first) == keys;
}

}  // namespace

ExpulsionMap Sentence(const ExpulsionMap& expelled, const std::string& worker, const std::string& host,
                      const std::string& reason) {
  ExpulsionMap sentence = {{worker, {reason, host}}};
  const std::string keys = KeyNameOf(worker);
  if (keys.empty() || expelled.contains(worker)) return sentence;
  int of_keys = 1, of_host = 1;
  for (const auto& each : expelled) {
    if (!IsLiarOf(keys, each)) continue;
    ++of_keys;
    of_host += each.second.host == host ? 1 : 0;
  }
  const auto words = [&](int processes, const std::string& where) {
    return std::to_string(processes) + " of its processes" + where +
           " returned false results, the last one: " + reason;
  };
  if (of_keys >= kLiarsOfKeys) {
    sentence[keys] = {words(of_keys, ""), ""};
  } else if (of_host >= kLiarsOfHost) {
    sentence[NameOnHost(keys, host)] = {words(of_host, " there"), ""};
  }
  return sentence;
}

std::optional<std::string> WhyExpelled(const ExpulsionMap& expelled, const std::string& worker,
                                       const std::string& host) {
  const std::string keys = KeyNameOf(worker);
  for (const std::string& name : {worker, NameOnHost(keys, host), keys}) {
    const auto found = expelled.find(name);
    if (found != expelled.end()) return found->second.reason;
  }
  return std::nullopt;
}

std::vector<std::string> Readmit(ExpulsionMap* expelled, const std::string& name) {
  std::vector<std::string> changed;
  for (auto each = expelled->begin(); each != expelled->end();) {
    auto& [who, expulsion] = *each;
    const bool is_process = !expulsion.host.empty();
    const bool is_meant = is_process ? IsMeantBy(name, who, expulsion.host) && !expulsion.is_forgiven
                                     : who == name || who.starts_with(name + "@");
    if (is_meant) changed.push_back(who);
    if (is_meant && is_process) expulsion.is_forgiven = true;
    each = is_meant && !is_process ? expelled->erase(each) : std::next(each);
  }
  return changed;
}

std::size_t CountExpelled(const ExpulsionMap& expelled) {
  return static_cast<std::size_t>(std::count_if(expelled.begin(), expelled.end(),
                                                [](const auto& each) { return !each.second.is_forgiven; }));
}

std::string SealedText(const ExpulsionMap& expelled) {
  Json json = Json::object();
  for (const auto& [name, expulsion] : expelled) {
    Json& entry = json[name] = {{"reason", expulsion.reason}};
    if (!expulsion.host.empty()) entry["host"] = expulsion.host;
    if (expulsion.is_forgiven) entry["forgiven"] = true;
  }
  return Sealed({{"version", kExpelledVersion}, {"expelled", std::move(json)}});
}

ExpulsionMap ReadExpulsions(const std::string& text) {
  ExpulsionMap expelled;
  try {
    const Json json = Unseal(text, kExpelledVersion);
    // A worker of version 1 may have the name "version", but no number is a reason.
    const bool is_first = !json.value("version", Json()).is_number();
    for (const auto& [name, entry] :
         (is_first ? json : json.at("expelled")).get<std::map<std::string, Json>>()) {
      if (entry.is_string()) {
        expelled[name].reason = entry;
      } else {
        expelled[name] = {entry.at("reason"), entry.value("host", ""), entry.value("forgiven", false)};
      }
    }
  } catch (const Json::exception&) {
    throw std::runtime_error("lacks a member");
  }
  return expelled;
}

}  // namespace dispersa
