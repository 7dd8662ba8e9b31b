#include "core/control/law_here.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

namespace dispersa {
namespace {

std::mutex mutex;

std::map<const std::string*, PluginLaw::Functions>& Laws() {
  static std::map<const std::string*, PluginLaw::Functions> laws;
  return laws;
}

thread_local std::vector<PluginConfig> offered;

}  // namespace

LawHere::LawHere(const PluginLaw::Functions& functions) : library_(std::make_shared<const std::string>()) {
  const std::lock_guard lock(mutex);
  Laws()[library_.get()] = functions;
}

LawHere::~LawHere() {
  std::erase_if(offered, [this](const PluginConfig& config) { return config.library == library_; });
  const std::lock_guard lock(mutex);
  Laws().erase(library_.get());
}

PluginConfig LawHere::Config(std::vector<std::pair<std::string, double>> parameters) const {
  PluginConfig config;
  config.library = library_;
  config.parameters = std::move(parameters);
  return config;
}

void LawHere::Offer(PluginConfig config) { offered.push_back(std::move(config)); }

std::optional<PluginConfig> OfferedLaw(const std::string& sha256) {
  const auto found = std::find_if(offered.rbegin(), offered.rend(),
                                  [&](const PluginConfig& config) { return config.sha256 == sha256; });
  return found == offered.rend() ? std::nullopt : std::optional(*found);
}

bool IsAbsent(const PluginConfig& config) { return config.in_python && FunctionsHere(config) == nullptr; }

const PluginLaw::Functions* FunctionsHere(const PluginConfig& config) {
  const std::lock_guard lock(mutex);
  const auto found = Laws().find(config.library.get());
  return found == Laws().end() ? nullptr : &found->second;
}

}  // namespace dispersa
