// same_flights CAMPAIGNS LIBRARY...: flies a few cases of the shipped campaigns with the core of this build
// and with each flight library, and compares every bit. Exit code 0: all equal; 1: not.
#include <dlfcn.h>
#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <string>
#include <vector>

#include "core/campaign_yaml/load.h"
#include "tests/compilers/fly_cases.h"
#include "tests/same_events.h"

namespace dispersa {
namespace {

struct Sample {
  const char* campaign;
  std::uint64_t first, count;
};
// Every case of table3 and full draws all that it disperses; the first and the last aero20 corner are the
// farthest apart.
constexpr Sample kSamples[] = {{"table3", 0, 2}, {"full", 0, 3}, {"aero20", 0, 1}, {"aero20", 15, 1}};

std::string Difference(const std::vector<std::string>& names, const std::vector<double>& expected,
                       const std::vector<double>& actual) {
  if (actual.size() != expected.size()) return "count differs";
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (std::bit_cast<std::uint64_t>(expected[i]) != std::bit_cast<std::uint64_t>(actual[i]))
      return fmt::format("{} is {:a}, not {:a}", names[i], actual[i], expected[i]);
  return {};
}

// The first difference, in words. Empty if every bit is the same.
std::string Difference(const CaseResult& expected, const CaseResult& actual) {
  if (expected.inputs_digest != actual.inputs_digest) return "the inputs differ";
  if (actual.outcome != expected.outcome || actual.end_time_s != expected.end_time_s ||
      actual.end_stage != expected.end_stage || actual.reason != expected.reason)
    return fmt::format("it ends at {:a} s ({}), not at {:a} s ({})", actual.end_time_s, actual.reason,
                       expected.end_time_s, expected.reason);
  if (const std::string text = Difference(MetricNames(), expected.metrics, actual.metrics); !text.empty())
    return "metric " + text;
  if (!AreSame(actual.events, expected.events)) return "the events differ";
  if (actual.digest != expected.digest)
    return fmt::format("digest is {}, not {}", actual.digest.Hex(), expected.digest.Hex());
  return {};
}

std::vector<CaseResult> FlyAll(FlyCasesFunction fly, const std::vector<Campaign>& campaigns) {
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < std::size(kSamples); ++i)
    fly(campaigns[i], kSamples[i].first, kSamples[i].count, &results);
  return results;
}

FlyCasesFunction Open(const char* path) {
  void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  void* const symbol = library ? dlsym(library, kFlyCasesSymbol) : nullptr;
  if (!symbol) fmt::print(stderr, "{}\n", dlerror());
  return reinterpret_cast<FlyCasesFunction>(symbol);
}

int Compare(const std::string& folder, const std::vector<const char*>& libraries) {
  std::vector<Campaign> campaigns;
  std::vector<std::string> labels;
  for (const Sample& sample : kSamples) {
    campaigns.push_back(LoadCampaign(fmt::format("{}/{}.yaml", folder, sample.campaign)));
    for (std::uint64_t i = 0; i < sample.count; ++i)
      labels.push_back(fmt::format("{} case {}", sample.campaign, sample.first + i));
  }
  const std::vector<CaseResult> expected = FlyAll(DispersaFlyCases, campaigns);
  int problems = 0;
  const auto report = [&](const std::string& text) {
    fmt::print("{}\n", text);
    ++problems;
  };
  for (std::size_t i = 0; i < labels.size(); ++i) fmt::print("{}: {}\n", labels[i], expected[i].digest.Hex());
  // Were all flights alike, so would be those of a wrong library.
  for (std::size_t i = 1; i < labels.size(); ++i)
    if (Difference(expected[0], expected[i]).empty())
      report(labels[i] + " is no other flight than the first");
  for (const char* library : libraries) {
    const FlyCasesFunction fly = Open(library);
    if (!fly) return 1;
    const std::vector<CaseResult> actual = FlyAll(fly, campaigns);
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (const std::string text = Difference(expected[i], actual[i]); !text.empty())
        report(fmt::format("{}: {}: {}", library, labels[i], text));
  }
  return problems == 0 ? 0 : 1;
}

}  // namespace
}  // namespace dispersa

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: same_flights CAMPAIGNS LIBRARY...\n");
    return 2;
  }
  return dispersa::Compare(argv[1], std::vector<const char*>(argv + 2, argv + argc));
}
