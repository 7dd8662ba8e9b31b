#include "core/modes/mode_table.h"

#include <algorithm>

namespace dispersa {

double ModeTable::At(int plane, int mode, int column, double kg) const {
  std::size_t level = 0;
  while (level + 2 < propellant_kg.size() && kg < propellant_kg[level + 1]) ++level;
  const int low = static_cast<int>(level);
  if (propellant_kg.size() == 1) return Row(plane, 0, mode)[column];
  const double fraction =
      std::clamp((propellant_kg[level] - kg) / (propellant_kg[level] - propellant_kg[level + 1]), 0.0, 1.0);
  const double from = Row(plane, low, mode)[column], to = Row(plane, low + 1, mode)[column];
  return from + fraction * (to - from);
}

}  // namespace dispersa
