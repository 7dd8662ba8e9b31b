#include "core/environment/air_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/environment/atmosphere.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {

namespace {

constexpr std::size_t kPressureTerms = 7;
constexpr std::size_t kEnergyTerms = 6;

double Pressure(double z) { return StandardAtmosphere1976(z).pressure_pa; }
double Energy(double z) {
  const AirState air = StandardAtmosphere1976(z);
  return air.pressure_pa / air.density_kg_m3;
}

// Coefficients in powers of u of the polynomial that meets f(centre + half u) in the Chebyshev points of
// [-1, 1]: Newton's divided differences, multiplied out. Extended precision keeps the conversion's rounding
// below that of the values.
template <std::size_t N>
std::array<double, N> Interpolate(double (*f)(double), double centre, double half) {
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

  void Fit() {
    pressure = Interpolate<kPressureTerms>(&Pressure, centre(), half());
    energy = Interpolate<kEnergyTerms>(&Energy, centre(), half());
  }
  bool IsClose() const {
    constexpr int kPoints = 16;
    constexpr double kClose = 0.25 * kAirTableTolerance;
    for (int i = 0; i <= kPoints; ++i) {
      const double u = -1.0 + 2.0 * i / kPoints;
      const double z = centre() + half() * u;
      if (std::fabs(At(pressure, u) - Pressure(z)) > kClose * Pressure(z)) return false;
      if (std::fabs(At(energy, u) - Energy(z)) > kClose * Energy(z)) return false;
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

void Append(Cell cell, std::vector<Cell>& cells) {
  cell.Fit();
  const double width = cell.top - cell.bottom;
  if (cell.IsClose() || 0.5 * width < AirTable::kBucket_m) {
    cells.push_back(cell);
    return;
  }
  Append({cell.bottom, cell.centre()}, cells);
  Append({cell.centre(), cell.top}, cells);
}

AirTable Build() {
  std::vector<Cell> cells;
  const std::vector<double> kinks = Kinks();
  for (std::size_t i = 0; i + 1 < kinks.size(); ++i) Append({kinks[i], kinks[i + 1]}, cells);

  AirTable table;
  for (const Cell& cell : cells) {
    table.edges.push_back(cell.bottom);
    table.rows.insert(table.rows.end(), {cell.centre(), 1.0 / cell.half()});
    table.rows.insert(table.rows.end(), cell.pressure.begin(), cell.pressure.end());
    table.rows.insert(table.rows.end(), cell.energy.begin(), cell.energy.end());
    table.rows.push_back(0.0);
  }
  table.edges.push_back(2.0 * kAtmosphereTop_m);
  const auto buckets =
      static_cast<std::size_t>((kAtmosphereTop_m - kAtmosphereBottom_m) / AirTable::kBucket_m) + 1;
  std::size_t cell = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    const double z = kAtmosphereBottom_m + static_cast<double>(b) * AirTable::kBucket_m;
    while (table.edges[cell + 1] <= z) ++cell;
    table.bucket.push_back(static_cast<std::uint16_t>(cell));
  }
  return table;
}

}  // namespace

const AirTable& StandardAir() {
  static const AirTable table = Build();
  return table;
}

}  // namespace dispersa
