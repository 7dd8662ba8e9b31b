#include "core/flight/flight_sums.h"

namespace dispersa {

ErrorSums Total(const ErrorSums (&stages)[kMaxStages]) {
  ErrorSums total;
  for (const ErrorSums& stage : stages) {
    total.squares += stage.squares;
    total.count += stage.count;
    if (stage.peak <= total.peak) continue;
    total.peak = stage.peak;
    total.peak_time_s = stage.peak_time_s;
  }
  return total;
}

}  // namespace dispersa
