#include "core/statistics/normal.h"

#include <boost/math/distributions/normal.hpp>

namespace dispersa {

double NormalProbability(double z) { return boost::math::cdf(boost::math::normal(), z); }

double NormalQuantile(double probability) {
  return boost::math::quantile(boost::math::normal(), probability);
}

}  // namespace dispersa
