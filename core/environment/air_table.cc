#include "core/environment/air_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/environment/atmosphere.h"
#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/table.h"

namespace dispersa {

namespace {

constexpr std::size_t kPressureTerms = 7;
constexpr std::size_t kEnergyTerms = 6;

// Pressure and energy over altitude.
struct StandardsAir {
  double Pressure(double z) const { return StandardAtmosphere1976(z).pressure_pa; }
  double Energy(double z) const {
    const AirState air = StandardAtmosphere1976(z);
    return air.pressure_pa / air.density_kg_m3;
  }
};

// A weather table's air. Logarithms are linear between its altitudes.
class TablesAir {
 public:
  explicit TablesAir(const WeatherTable& table) : altitude_m_(table.altitude_m) {
    for (std::size_t i = 0; i < altitude_m_.size(); ++i) {
      const LevelAir air = AirOfLevel(table, i);
      log_pressure_.push_back(Log(air.pressure_pa));
      log_energy_.push_back(Log(air.pressure_pa / air.density_kg_m3));
    }
  }
  double Pressure(double z) const {
    return At(z, log_pressure_, [](double at) { return StandardsAir().Pressure(at); });
  }
  double Energy(double z) const {
    return At(z, log_energy_, [](double at) { return StandardsAir().Energy(at); });
  }

 private:
  template <class Standard>
  double At(double z, const std::vector<double>& logarithms, Standard standard) const {
    const double bottom = altitude_m_.front(), top = altitude_m_.back();
    if (z < bottom) return standard(z) * Exp(logarithms.front()) / standard(bottom);
    if (z > top) {
      const double above = (z - top) / kWindFade_m;
      if (above >= 1.0) return standard(z);
      return standard(z) * (above + (1.0 - above) * Exp(logarithms.back()) / standard(top));
    }
    const GridPosition at = Locate(altitude_m_, z);
    return Exp((1.0 - at.fraction) * logarithms[at.index] + at.fraction * logarithms[at.index + 1]);
  }

  const std::vector<double>& altitude_m_;
  std::vector<double> log_pressure_, log_energy_;
};

// Coefficients in powers of u of the polynomial that meets f(centre + half u) in the Chebyshev points of
// [-1, 1]: Newton's divided differences, multiplied out. Extended precision keeps the conversion's rounding
// below that of the values.
template <std::size_t N, class F>
std::array<double, N> Interpolate(F f, double centre, double half) {
  std::array<double, N> u;
  std::array<long double, N> c;
  for (std::size_t i = 0; i < N; ++i) {
    u[i] = Cos(kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(N));
    c[i] = f(centre + half * u[i]);
  }
  for (std::size_t k = 1; k < N; ++k)
    for (std::size_t i = N - 1; i >= k; --i)
      c[i] = (c[i] - c[i - 1]) / (static_cast<long double>(u[i]) - u[i - k]);
  std::array<long double, N> p{};
  for (std::size_t k = N; k-- > 0;) {  // p <- p (u - u_k) + c_k
    for (std::size_t i = N - 1; i > 0; --i) p[i] = p[i - 1] - u[k] * p[i];
    p[0] = c[k] - u[k] * p[0];
  }
  std::array<double, N> rounded;
  for (std::size_t i = 0; i < N; ++i) rounded[i] = static_cast<double>(p[i]);
  return rounded;
}

template <std::size_t N>
double At(const std::array<double, N>& p, double u) {
  double value = p[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) value = value * u + p[i];
  return value;
}

struct Cell {
  double bottom, top;
  std::array<double, kPressureTerms> pressure{};
  std::array<double, kEnergyTerms> energy{};

  double centre() const { return 0.5 * (bottom + top); }
  double half() const { return 0.5 * (top - bottom); }

  template <class Air>
  void Fit(const Air& air) {
    pressure = Interpolate<kPressureTerms>([&](double z) { return air.Pressure(z); }, centre(), half());
    energy = Interpolate<kEnergyTerms>([&](double z) { return air.Energy(z); }, centre(), half());
  }
  template <class Air>
  bool IsClose(const Air& air) const {
    constexpr int kPoints = 16;
    constexpr double kClose = 0.25 * kAirTableTolerance;
    for (int i = 0; i <= kPoints; ++i) {
      const double u = -1.0 + 2.0 * i / kPoints;
      const double z = centre() + half() * u;
      if (std::fabs(At(pressure, u) - air.Pressure(z)) > kClose * air.Pressure(z)) return false;
      if (std::fabs(At(energy, u) - air.Energy(z)) > kClose * air.Energy(z)) return false;
    }
    return true;
  }
};

// The altitudes at which functions of the standard, or their derivatives, jump (StandardAtmosphere1976).
std::vector<double> Kinks() {
  std::vector<double> kinks = AtmosphereKinks();
  kinks.insert(kinks.begin(), kAtmosphereBottom_m);
  return kinks;
}

template <class Air>
void Append(Cell cell, const Air& air, double narrowest_m, std::vector<Cell>& cells) {
  cell.Fit(air);
  const double width = cell.top - cell.bottom;
  if (cell.IsClose(air) || 0.5 * width < narrowest_m) {
    cells.push_back(cell);
    return;
  }
  Append({cell.bottom, cell.centre()}, air, narrowest_m, cells);
  Append({cell.centre(), cell.top}, air, narrowest_m, cells);
}

template <class Air>
AirTable Build(const Air& air, const std::vector<double>& kinks, double bucket_m) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i + 1 < kinks.size(); ++i) Append({kinks[i], kinks[i + 1]}, air, bucket_m, cells);

  AirTable table;
  table.bucket_m = bucket_m;
  table.buckets_per_m = 1.0 / bucket_m;
  for (const Cell& cell : cells) {
    table.edges.push_back(cell.bottom);
    table.rows.insert(table.rows.end(), {cell.centre(), 1.0 / cell.half()});
    table.rows.insert(table.rows.end(), cell.pressure.begin(), cell.pressure.end());
    table.rows.insert(table.rows.end(), cell.energy.begin(), cell.energy.end());
    table.rows.push_back(0.0);
  }
  table.edges.push_back(2.0 * kAtmosphereTop_m);
  const auto buckets = static_cast<std::size_t>((kAtmosphereTop_m - kAtmosphereBottom_m) / bucket_m) + 1;
  std::size_t cell = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    const double z = kAtmosphereBottom_m + static_cast<double>(b) * bucket_m;
    while (table.edges[cell + 1] <= z) ++cell;
    table.bucket.push_back(static_cast<std::uint16_t>(cell));
  }
  return table;
}

}  // namespace

const AirTable& StandardAir() {
  static const AirTable table = Build(StandardsAir(), Kinks(), AirTable::kBucket_m);
  return table;
}

AirTable MeasuredAir(const WeatherTable& table) {
  constexpr double kSame_m = 2.0;
  std::vector<double> kinks = table.altitude_m;
  const double bottom = kinks.front(), top = kinks.back();
  kinks.push_back(top + kWindFade_m);
  // Within the table the standard plays no part.
  for (double kink : Kinks()) {
    const auto is_same = [&](double own) { return std::fabs(own - kink) < kSame_m; };
    if ((kink < bottom || kink > top) && std::none_of(kinks.begin(), kinks.end(), is_same))
      kinks.push_back(kink);
  }
  std::sort(kinks.begin(), kinks.end());
  kinks.front() = kAtmosphereBottom_m;
  double narrowest_m = AirTable::kBucket_m;
  for (std::size_t i = 1; i < kinks.size(); ++i) narrowest_m = std::min(narrowest_m, kinks[i] - kinks[i - 1]);
  return Build(TablesAir(table), kinks, narrowest_m);
}

}  // namespace dispersa
