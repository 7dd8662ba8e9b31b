// Two campaigns compared case by case: what `dispersa compare` prints and the paper's page shows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/report/case_columns.h"
#include "core/statistics/paired.h"

namespace dispersa {

struct MetricComparison {
  std::string metric;
  PairedDifference difference;  ///< of b - a and b / a, with 95 % intervals; a lost flight is infinitely bad
  /// Pairs in which b is better than a, with the largest gain first.
  struct BetterCase {
    std::uint64_t case_index = 0;
    double a = 0.0, b = 0.0;  ///< NaN: lost
  };
  std::vector<BetterCase> better;
};

struct Comparison {
  std::size_t pairs = 0;     ///< cases that both have, with equal draws
  std::size_t unpaired = 0;  ///< cases of either that the other lacks or drew otherwise
  std::vector<MetricComparison> metrics;
};

/// What controllers are usually compared by: of each, less is better.
const std::vector<std::string>& ComparedMetrics();

inline constexpr double kComparisonConfidence = 0.95;

/// Pairs by case index; a pair counts when all inputs that were read of both are equal. Metrics are those of
/// which less is better.
Comparison Compare(const CaseColumns& a, const CaseColumns& b, const std::vector<std::string>& metrics);

/// As <table>; the names stand for a and b.
std::string ComparisonTable(const Comparison& comparison, const std::string& name_a,
                            const std::string& name_b);

/// The cases in which b is better than a, folded away when they are many.
std::string BetterCasesList(const MetricComparison& metric, const std::string& name_a,
                            const std::string& name_b);

}  // namespace dispersa
