// A set of case indices, stored as intervals: a campaign's queue is a few of them.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace dispersa {

class IndexSet {
 public:
  /// Adds first, first + 1, ..., end - 1; none of them may be in the set.
  void AddRange(std::uint64_t first, std::uint64_t end);
  void Add(std::uint64_t index) { AddRange(index, index + 1); }
  /// Returns false if it is not in the set.
  bool Remove(std::uint64_t index);
  /// Removes and returns the lowest indices that follow each other, at most `limit` >= 1 of them.
  std::vector<std::uint64_t> TakeRun(std::uint64_t limit);

  std::uint64_t Count() const { return count_; }
  bool Empty() const { return count_ == 0; }

 private:
  std::map<std::uint64_t, std::uint64_t> end_of_;  ///< first -> end; intervals never touch each other
  std::uint64_t count_ = 0;
};

}  // namespace dispersa
