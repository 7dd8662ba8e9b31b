#include "core/statistics/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <boost/sort/pdqsort/pdqsort.hpp>

#include "core/math/assertion.h"
#include "core/math/matrices.h"

namespace dispersa {
namespace {

constexpr int kBootstrapSamples = 200;
/// Of many cases, groups of them are drawn again: as good for a standard error, and a million cases are no
/// work.
constexpr std::size_t kBootstrapGroups = 1000;

std::vector<std::uint32_t> Order(const std::vector<double>& values) {
  // Values beside their positions: a comparison reads what lies together.
  struct Place {
    double value;
    std::uint32_t position;
  };
  std::vector<Place> places(values.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) places[i] = {values[i], i};
  boost::sort::pdqsort_branchless(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return (a.value < b.value) | ((a.value == b.value) & (a.position < b.position));
  });
  std::vector<std::uint32_t> order(places.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = places[i].position;
  return order;
}

/// More classes see finer dependence, fewer have less noise.
std::size_t ClassCount(std::size_t n) {
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(n))), 3, 100);
}

std::vector<std::uint8_t> Classes(const Ranked& x, std::size_t count) {
  const std::vector<std::uint32_t>& order = x.order();
  std::vector<std::uint8_t> classes(x.size());
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const bool equal = rank > 0 && x.ranks()[order[rank]] == x.ranks()[order[rank - 1]];
    classes[order[rank]] =
        equal ? classes[order[rank - 1]] : static_cast<std::uint8_t>(rank * count / order.size());
  }
  return classes;
}

/// Sums over the cases of a class.
struct ClassSums {
  double n = 0.0, sum = 0.0, squares = 0.0;

  void Add(const ClassSums& more) {
    n += more.n;
    sum += more.sum;
    squares += more.squares;
  }
};

double Epsilon(const std::vector<ClassSums>& classes) {
  double n = 0.0, sum = 0.0, squares = 0.0, between = 0.0, used = 0.0;
  for (const ClassSums& each : classes) {
    if (each.n == 0.0) continue;
    n += each.n;
    sum += each.sum;
    squares += each.squares;
    between += each.sum * each.sum / each.n;
    used += 1.0;
  }
  const double total = squares - sum * sum / n;
  if (!(total > 0.0) || used < 2.0 || n <= used) return 0.0;
  const double within = squares - between;
  return 1.0 - (n - 1.0) / (n - used) * within / total;
}

/// Values within classes, as what an index is computed from: about their mean, so that the squares lose no
/// digits.
class Classified {
 public:
  Classified(const Ranked& x, const std::vector<double>& y)
      : classes_(Classes(x, ClassCount(x.size()))),
        y_(y),
        mean_(std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size())) {}

  std::size_t size() const { return classes_.size(); }
  std::size_t classes() const { return ClassCount(size()); }
  std::size_t ClassOf(std::size_t i) const { return classes_[i]; }
  ClassSums Of(std::size_t i) const {
    const double value = y_[i] - mean_;
    return {1.0, value, value * value};
  }
  std::vector<ClassSums> Sums() const {
    std::vector<ClassSums> sums(classes());
    for (std::size_t i = 0; i < size(); ++i) sums[ClassOf(i)].Add(Of(i));
    return sums;
  }

 private:
  std::vector<std::uint8_t> classes_;
  const std::vector<double>& y_;
  double mean_;
};

/// A group of cases: its sums in each class that it reaches.
using Group = std::vector<std::pair<std::size_t, ClassSums>>;

std::vector<Group> GroupsOf(const Classified& values) {
  std::vector<Group> groups(std::min(values.size(), kBootstrapGroups));
  std::vector<ClassSums> sums(values.classes());
  for (std::size_t first = 0; first < groups.size(); ++first) {
    std::fill(sums.begin(), sums.end(), ClassSums());
    for (std::size_t i = first; i < values.size(); i += groups.size())
      sums[values.ClassOf(i)].Add(values.Of(i));
    for (std::size_t c = 0; c < sums.size(); ++c)
      if (sums[c].n > 0.0) groups[first].emplace_back(c, sums[c]);
  }
  return groups;
}

double Correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
}

}  // namespace

Ranked::Ranked(const std::vector<double>& values) : order_(Order(values)), ranks_(values.size()) {
  for (std::size_t first = 0; first < order_.size();) {
    std::size_t end = first + 1;
    while (end < order_.size() && values[order_[end]] == values[order_[first]]) ++end;
    for (std::size_t i = first; i < end; ++i)
      ranks_[order_[i]] = 0.5 * (static_cast<double>(first + end) + 1.0);
    first = end;
  }
}

SensitivityIndex FirstOrderIndex(const Ranked& x, const std::vector<double>& y, std::uint64_t seed) {
  DISPERSA_ASSERT(x.size() == y.size(), x.size(), y.size());
  if (x.size() < 8) return {};
  const Classified values(x, y);
  const std::vector<ClassSums> all = values.Sums();
  const double index = Epsilon(all);
  const std::vector<Group> groups = GroupsOf(values);
  std::mt19937_64 random(seed);
  double sum = 0.0, squares = 0.0;
  for (int sample = 0; sample < kBootstrapSamples; ++sample) {
    std::vector<ClassSums> drawn(all.size());
    for (std::size_t k = 0; k < groups.size(); ++k)
      for (const auto& [of, sums] : groups[random() % groups.size()]) drawn[of].Add(sums);
    const double value = Epsilon(drawn);
    sum += value;
    squares += value * value;
  }
  const double spread =
      std::sqrt(std::max(0.0, (squares - sum * sum / kBootstrapSamples) / (kBootstrapSamples - 1)));
  return {std::clamp(index, 0.0, 1.0), std::clamp(index - 1.96 * spread, 0.0, 1.0),
          std::clamp(index + 1.96 * spread, 0.0, 1.0)};
}

std::vector<double> RestOf(const Ranked& x, const std::vector<double>& y) {
  DISPERSA_ASSERT(x.size() == y.size(), x.size(), y.size());
  const std::size_t count = ClassCount(x.size());
  const std::vector<std::uint8_t> classes = Classes(x, count);
  std::vector<double> sums(count), sizes(count), rest = y;
  for (std::size_t i = 0; i < y.size(); ++i) {
    sums[classes[i]] += y[i];
    sizes[classes[i]] += 1.0;
  }
  for (std::size_t i = 0; i < y.size(); ++i) rest[i] -= sums[classes[i]] / sizes[classes[i]];
  return rest;
}

double FirstOrderShare(const Ranked& x, const std::vector<double>& y) {
  DISPERSA_ASSERT(x.size() == y.size(), x.size(), y.size());
  return x.size() < 8 ? 0.0 : Epsilon(Classified(x, y).Sums());
}

double RankCorrelation(const Ranked& x, const Ranked& y) {
  return x.size() == 0 ? 0.0 : Correlation(x.ranks(), y.ranks());
}

std::vector<double> PartialRankCorrelations(const std::vector<const Ranked*>& x, const Ranked& y) {
  const auto d = static_cast<Eigen::Index>(x.size());
  std::vector<double> result(x.size(), 0.0);
  // A regression needs a few cases for each of its inputs.
  if (d == 0 || y.size() < 3 * x.size() + 3) return result;
  std::vector<const Ranked*> all = x;
  all.push_back(&y);
  Eigen::MatrixXd correlations = Eigen::MatrixXd::Identity(d + 1, d + 1);
  for (Eigen::Index i = 0; i <= d; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      correlations(i, j) = correlations(j, i) =
          RankCorrelation(*all[static_cast<std::size_t>(i)], *all[static_cast<std::size_t>(j)]);
    }
  }
  // Inputs that say the same twice are told apart by nothing: a little noise shares the effect among them.
  correlations.diagonal().array() += 1e-9;
  const Eigen::MatrixXd precision = InverseOf(correlations);
  for (Eigen::Index i = 0; i < d; ++i) {
    const double partial = -precision(i, d) / std::sqrt(precision(i, i) * precision(d, d));
    if (std::isfinite(partial)) result[static_cast<std::size_t>(i)] = std::clamp(partial, -1.0, 1.0);
  }
  return result;
}

double RankSumP(const Ranked& x, const std::vector<bool>& marked) {
  DISPERSA_ASSERT(x.size() == marked.size(), x.size(), marked.size());
  const std::vector<double>& ranks = x.ranks();
  const auto n = static_cast<double>(x.size());
  double m = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    squares += (ranks[i] - 0.5 * (n + 1.0)) * (ranks[i] - 0.5 * (n + 1.0));
    if (!marked[i]) continue;
    m += 1.0;
    sum += ranks[i];
  }
  // Of m ranks drawn from all without putting back.
  const double variance = n > 1.0 ? m * (n - m) / (n * (n - 1.0)) * squares : 0.0;
  if (!(variance > 0.0)) return 1.0;
  const double away = std::max(0.0, std::fabs(sum - 0.5 * m * (n + 1.0)) - 0.5) / std::sqrt(variance);
  return std::min(1.0, 2.0 * cdf(complement(boost::math::normal(), away)));
}

std::vector<double> FalseDiscoveryRates(const std::vector<double>& p_values) {
  const std::vector<std::uint32_t> order = Order(p_values);
  std::vector<double> rates(p_values.size());
  double least = 1.0;
  for (std::size_t i = order.size(); i-- > 0;) {
    least =
        std::min(least, p_values[order[i]] * static_cast<double>(order.size()) / static_cast<double>(i + 1));
    rates[order[i]] = least;
  }
  return rates;
}

}  // namespace dispersa
