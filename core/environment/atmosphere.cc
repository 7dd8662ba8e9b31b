#include "core/environment/atmosphere.h"

#include <array>
#include <cstddef>

#include "core/math/functions.h"

namespace dispersa {
namespace {

// Constants of the standard, section 1.2.
constexpr double kGravity = 9.80665;          // g0, m/s²
constexpr double kEarthRadius = 6356766.0;    // r0, m
constexpr double kGasConstant = 8.31432e3;    // R*, N m/(kmol K)
constexpr double kMolecularWeight = 28.9644;  // M0, kg/kmol
constexpr double kHeatRatio = 1.4;            // gamma
constexpr double kSeaLevelPressure = 101325.0;

// Altitudes (m) of the end of the lower part, and of the start of the decrease in molecular weight.
constexpr double kUpperBase = 86000.0;
constexpr double kMixedTop = 80000.0;

double GeopotentialAltitude(double z) { return kEarthRadius * z / (kEarthRadius + z); }

AirState FromPressure(double temperature, double molecular_weight, double pressure) {
  const double specific_energy = kGasConstant / molecular_weight * temperature;
  return {temperature, pressure, pressure / specific_energy, Sqrt(kHeatRatio * specific_energy)};
}

// Table 4: geopotential altitude (m) and gradient of the molecular-scale temperature (K/m) of the layers.
struct Layer {
  double base;
  double gradient;
  double temperature = 0.0;
  double pressure = 0.0;
  double exponent = 0.0;  // -g0 M0 / (R* L); for an isothermal layer -g0 M0 / (R* T), 1/m
};

double LayerPressure(const Layer& layer, double temperature, double h) {
  // Equations 33a and 33b. Exp and Log cost half of Pow; the argument stays below 3.
  const double argument = layer.gradient == 0.0 ? h - layer.base : Log(temperature / layer.temperature);
  return layer.pressure * Exp(layer.exponent * argument);
}

std::array<Layer, 7> MakeLayers() {
  std::array<Layer, 7> layers{{{0.0, -0.0065},
                               {11000.0, 0.0},
                               {20000.0, 0.0010},
                               {32000.0, 0.0028},
                               {47000.0, 0.0},
                               {51000.0, -0.0028},
                               {71000.0, -0.0020}}};
  double temperature = 288.15;
  double pressure = kSeaLevelPressure;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    Layer& layer = layers[i];
    layer.temperature = temperature;
    layer.pressure = pressure;
    layer.exponent =
        -kGravity / (kAirGasConstant_j_kg_k * (layer.gradient == 0.0 ? temperature : layer.gradient));
    if (i + 1 == layers.size()) break;
    const double top = layers[i + 1].base;
    temperature += layer.gradient * (top - layer.base);
    pressure = LayerPressure(layer, temperature, top);
  }
  return layers;
}

// Table 8: M/M0 at every 500 m from 80 km to 86 km of geometric altitude.
constexpr std::array<double, 13> kMolecularWeightRatio = {1.000000, 0.999996, 0.999989, 0.999971, 0.999941,
                                                          0.999909, 0.999870, 0.999829, 0.999786, 0.999741,
                                                          0.999694, 0.999641, 0.999579};
constexpr double kMolecularWeightStep = 500.0;

double MolecularWeightRatio(double z) {
  if (z <= kMixedTop) return 1.0;
  const double at = (z - kMixedTop) / kMolecularWeightStep;
  std::size_t i = static_cast<std::size_t>(at);
  if (i > kMolecularWeightRatio.size() - 2) i = kMolecularWeightRatio.size() - 2;
  const double fraction = at - static_cast<double>(i);
  return (1.0 - fraction) * kMolecularWeightRatio[i] + fraction * kMolecularWeightRatio[i + 1];
}

AirState LowerAir(const std::array<Layer, 7>& layers, double z) {
  const double h = GeopotentialAltitude(z);
  std::size_t i = 0;
  while (i + 1 < layers.size() && h >= layers[i + 1].base) ++i;
  const Layer& layer = layers[i];
  const double molecular_scale_temperature = layer.temperature + layer.gradient * (h - layer.base);
  AirState air = FromPressure(molecular_scale_temperature, kMolecularWeight,
                              LayerPressure(layer, molecular_scale_temperature, h));
  air.temperature_k *= MolecularWeightRatio(z);
  return air;
}

// Equations 25, 27, 29 and 31, kinetic temperature (K) at z >= 86 km. The standard rounds the constants of
// its ellipse (263.1905, 76.3232, 19.9429), which leaves a step of 0.3 mK at 110 km. From the conditions
// that define them, values and slopes at 91 km and 110 km, there is none.
double UpperTemperature(double z) {
  constexpr double kBase = 186.8673;
  constexpr double kTop = 240.0;
  constexpr double kGradient = 0.012;
  if (z <= 91000.0) return kBase;
  if (z <= 110000.0) {
    constexpr double kHeight = 19000.0;
    constexpr double kRise = kTop - kBase;
    constexpr double kRoot = kRise / (kGradient * kHeight - kRise);  // of the ellipse at its top
    constexpr double kDepth = kRise / (1.0 - kRoot);
    return kBase + kDepth * (1.0 - Sqrt(1.0 - (1.0 - kRoot * kRoot) * Square((z - 91000.0) / kHeight)));
  }
  if (z <= 120000.0) return kTop + kGradient * (z - 110000.0);
  const double xi = (z - 120000.0) * (kEarthRadius + 120000.0) / (kEarthRadius + z);
  return 1000.0 - 640.0 * Exp(-1.875e-5 * xi);
}

// Nodes of the standard's tables: geometric altitude (m), mean molecular weight (kg/kmol), pressure (Pa).
struct Node {
  double z;
  double molecular_weight;
  double pressure;
};
constexpr std::array kNodes = std::to_array<Node>({
    {86e3, 28.9522, 0.37338},    {91e3, 28.889, 0.15381},     {94e3, 28.783, 0.09056},
    {97e3, 28.620, 0.053571},    {100e3, 28.395, 0.032011},   {103e3, 28.104, 0.019742},
    {106e3, 27.765, 0.012454},   {108e3, 27.521, 0.0093188},  {110e3, 27.268, 0.0071042},
    {112e3, 27.020, 0.0055547},  {115e3, 26.680, 0.0040096},  {120e3, 26.205, 0.0025382},
    {125e3, 25.803, 0.0017354},  {130e3, 25.436, 0.0012505},  {135e3, 25.087, 0.00093568},
    {140e3, 24.749, 0.00072028}, {145e3, 24.422, 0.00056691}, {150e3, 24.103, 0.00045422},
    {155e3, 23.792, 0.0003693},  {160e3, 23.488, 0.00030395}, {165e3, 23.192, 0.00025278},
    {170e3, 22.902, 0.0002121},  {180e3, 22.342, 0.00015271}, {190e3, 21.809, 0.00011266},
    {210e3, 20.825, 6.4756e-05}, {230e3, 19.952, 3.9276e-05}, {265e3, 18.688, 1.7874e-05},
    {300e3, 17.726, 8.7704e-06}, {350e3, 16.735, 3.4498e-06}, {400e3, 15.984, 1.4518e-06},
    {450e3, 15.247, 6.4468e-07}, {500e3, 14.330, 3.0236e-07}, {550e3, 13.092, 1.5137e-07},
    {600e3, 11.505, 8.213e-08},  {650e3, 9.718, 4.8865e-08},  {700e3, 7.998, 3.1908e-08},
    {750e3, 6.579, 2.2599e-08},  {800e3, 5.543, 1.7036e-08},  {850e3, 4.849, 1.3415e-08},
    {900e3, 4.404, 1.0873e-08},  {950e3, 4.122, 8.9816e-09},  {1000e3, 3.940, 7.5138e-09},
});

// Value and slope at the ends of the interval above a node, for a cubic Hermite polynomial.
struct Cubic {
  double value;
  double slope;
};

double Hermite(const Cubic& low, const Cubic& high, double width, double t) {
  const double rise = high.value - low.value;
  const double a = width * low.slope - rise;
  const double b = rise - width * high.slope;
  return low.value + t * (rise + (1.0 - t) * ((1.0 - t) * a + t * b));
}

struct UpperNode {
  double z;
  Cubic log_pressure;
  Cubic molecular_weight;
};
using UpperNodes = std::array<UpperNode, kNodes.size()>;

// Slopes after Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 1984): the weighted harmonic mean of the
// neighbouring differences keeps the molecular weight monotone.
double MonotoneSlope(const Node& low, const Node& middle, const Node& high) {
  const double h0 = middle.z - low.z;
  const double h1 = high.z - middle.z;
  const double d0 = (middle.molecular_weight - low.molecular_weight) / h0;
  const double d1 = (high.molecular_weight - middle.molecular_weight) / h1;
  const double w0 = 2.0 * h1 + h0;
  const double w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

UpperNodes MakeUpperNodes(const std::array<Layer, 7>& layers) {
  UpperNodes nodes{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = kNodes[i];
    UpperNode& upper = nodes[i];
    upper.z = node.z;
    // The lower part's own values at 86 km, of which the table prints the rounding, keep the air continuous.
    const double pressure = i == 0 ? LowerAir(layers, kUpperBase).pressure_pa : node.pressure;
    const double molecular_weight =
        i == 0 ? kMolecularWeight * kMolecularWeightRatio.back() : node.molecular_weight;
    const double gravity = kGravity * Square(kEarthRadius / (kEarthRadius + node.z));
    upper.log_pressure = {Log(pressure),
                          -gravity * molecular_weight / (kGasConstant * UpperTemperature(node.z))};
    upper.molecular_weight = {molecular_weight, 0.0};
  }
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i)
    nodes[i].molecular_weight.slope = MonotoneSlope(kNodes[i - 1], kNodes[i], kNodes[i + 1]);
  // At the ends: Table 8's last step, and the parabola through the last three nodes, evenly spaced.
  nodes.front().molecular_weight.slope =
      kMolecularWeight * (kMolecularWeightRatio[12] - kMolecularWeightRatio[11]) / kMolecularWeightStep;
  const Node* last = &kNodes.back();
  nodes.back().molecular_weight.slope =
      (3.0 * last[0].molecular_weight - 4.0 * last[-1].molecular_weight + last[-2].molecular_weight) /
      (last[0].z - last[-2].z);
  return nodes;
}

AirState UpperAir(const UpperNodes& nodes, double z) {
  std::size_t i = 0;
  while (i + 2 < nodes.size() && z >= nodes[i + 1].z) ++i;
  const UpperNode& low = nodes[i];
  const UpperNode& high = nodes[i + 1];
  const double width = high.z - low.z;
  const double t = (z - low.z) / width;
  return FromPressure(UpperTemperature(z), Hermite(low.molecular_weight, high.molecular_weight, width, t),
                      Exp(Hermite(low.log_pressure, high.log_pressure, width, t)));
}

struct Constants {
  std::array<Layer, 7> layers = MakeLayers();
  UpperNodes upper = MakeUpperNodes(layers);
};

}  // namespace

AirState StandardAtmosphere1976(double geometric_altitude_m) {
  static const Constants constants;
  const double z = geometric_altitude_m < kAtmosphereBottom_m ? kAtmosphereBottom_m : geometric_altitude_m;
  if (z < kUpperBase) return LowerAir(constants.layers, z);
  if (z <= kAtmosphereTop_m) return UpperAir(constants.upper, z);
  AirState air = UpperAir(constants.upper, kAtmosphereTop_m);
  air.temperature_k = 1000.0;
  air.pressure_pa = 0.0;
  air.density_kg_m3 = 0.0;
  return air;
}

std::vector<double> AtmosphereKinks() {
  std::vector<double> kinks;
  // Layers by geopotential altitude; the first begins at sea level and goes on below it.
  for (const Layer& layer : MakeLayers())
    if (layer.base > 0.0) kinks.push_back(kEarthRadius * layer.base / (kEarthRadius - layer.base));
  for (std::size_t i = 0; i < kMolecularWeightRatio.size(); ++i)
    kinks.push_back(kMixedTop + kMolecularWeightStep * static_cast<double>(i));
  // The nodes include 86 km and the ends of the temperature's pieces.
  for (std::size_t i = 1; i < kNodes.size(); ++i) kinks.push_back(kNodes[i].z);
  return kinks;
}

}  // namespace dispersa
