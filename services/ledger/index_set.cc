#include "services/ledger/index_set.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "core/math/assertion.h"

namespace dispersa {

void IndexSet::AddRange(std::uint64_t first, std::uint64_t end) {
  if (first >= end) return;
  count_ += end - first;
  auto after = end_of_.lower_bound(first);
  DISPERSA_ASSERT(after == end_of_.end() || after->first >= end);
  if (after != end_of_.end() && after->first == end) {
    end = after->second;
    after = end_of_.erase(after);
  }
  if (after != end_of_.begin()) {
    const auto before = std::prev(after);
    DISPERSA_ASSERT(before->second <= first);
    if (before->second == first) {
      before->second = end;
      return;
    }
  }
  end_of_.emplace_hint(after, first, end);
}

bool IndexSet::Remove(std::uint64_t index) {
  auto after = end_of_.upper_bound(index);
  if (after == end_of_.begin()) return false;
  const auto interval = std::prev(after);
  const auto [first, end] = *interval;
  if (index >= end) return false;
  if (first == index) {
    end_of_.erase(interval);
  } else {
    interval->second = index;
  }
  if (index + 1 < end) end_of_.emplace(index + 1, end);
  DISPERSA_ASSERT(count_ > 0, index);
  --count_;
  return true;
}

std::vector<std::uint64_t> IndexSet::TakeRun(std::uint64_t limit) {
  if (end_of_.empty()) return {};
  const auto [first, end] = *end_of_.begin();
  DISPERSA_ASSERT(limit > 0 && first < end && end - first <= count_, limit, first, end, count_);
  const std::uint64_t size = std::min(limit, end - first);
  std::vector<std::uint64_t> run(size);
  std::iota(run.begin(), run.end(), first);
  end_of_.erase(end_of_.begin());
  if (first + size < end) end_of_.emplace(first + size, end);
  count_ -= size;
  return run;
}

}  // namespace dispersa
