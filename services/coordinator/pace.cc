#include "services/coordinator/pace.h"

#include <cstddef>

namespace dispersa {
namespace {

constexpr std::size_t kRateOver = 10;  // measurements

}  // namespace

void Pace::Measure(double now_s, std::uint64_t done) {
  past_.push_back({now_s, done});
  if (past_.size() > kRateOver) past_.pop_front();
}

double Pace::PerSecond() const {
  if (past_.size() < 2) return 0.0;
  std::uint64_t results = 0;
  for (std::size_t i = 1; i < past_.size(); ++i)
    if (past_[i].done > past_[i - 1].done) results += past_[i].done - past_[i - 1].done;
  return static_cast<double>(results) / (past_.back().now_s - past_.front().now_s);
}

std::optional<double> TimeLeft(const LedgerProgress& progress, double rate_per_s) {
  if (rate_per_s <= 0.0) return std::nullopt;
  return static_cast<double>(progress.waiting + progress.assigned) / rate_per_s;
}

}  // namespace dispersa
