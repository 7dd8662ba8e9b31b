#include "core/control/law_here.h"

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

}  // namespace

LawHere::LawHere(const PluginLaw::Functions& functions) : library_(std::make_shared<const std::string>()) {
  const std::lock_guard lock(mutex);
  Laws()[library_.get()] = functions;
}

LawHere::~LawHere() {
  const std::lock_guard lock(mutex);
  Laws().erase(library_.get());
}

PluginConfig LawHere::Config(std::vector<std::pair<std::string, double>> parameters) const {
  PluginConfig config;
  config.library = library_;
  config.parameters = std::move(parameters);
  return config;
}

const PluginLaw::Functions* FunctionsHere(const PluginConfig& config) {
  const std::lock_guard lock(mutex);
  const auto found = Laws().find(config.library.get());
  return found == Laws().end() ? nullptr : &found->second;
}

}  // namespace dispersa
