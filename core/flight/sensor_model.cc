#include "core/flight/sensor_model.h"

#include <algorithm>
#include <cmath>

#include "core/math/assertion.h"
#include "core/math/matrices.h"

namespace dispersa {

namespace {

constexpr double kSameWeight = 1e-9;

const RateGyro* FindGyro(const Vehicle& vehicle, const std::string& name, std::size_t* index) {
  const std::vector<RateGyro>& gyros = vehicle.sensors.rate_gyros;
  for (std::size_t i = 0; i < gyros.size(); ++i) {
    if (gyros[i].name != name) continue;
    if (index != nullptr) *index = i;
    return &gyros[i];
  }
  return nullptr;
}

}  // namespace

DigitalSection RampInvariant(double w, double zeta, double tick_s) {
  // x' = A x + (0, w²) u, y = x0. The input u = u0 + r t is a third state, its slope a fourth.
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(4, 4);
  m(0, 1) = tick_s;
  m(1, 0) = -w * w * tick_s;
  m(1, 1) = -2.0 * zeta * w * tick_s;
  m(1, 2) = w * w * tick_s;
  m(2, 3) = 1.0;  // the rise over a tick
  const Eigen::MatrixXd e = MatrixExponential(m);
  // x(k+1) = F x + g u(k) + h u(k+1).
  const double f00 = e(0, 0), f01 = e(0, 1), f10 = e(1, 0), f11 = e(1, 1);
  const double h0 = e(0, 3), h1 = e(1, 3);
  const double g0 = e(0, 2) - h0, g1 = e(1, 2) - h1;
  // y = (z I - F)⁻¹ (g + h z) u, first component.
  DigitalSection s;
  s.a1 = -(f00 + f11);
  s.a2 = f00 * f11 - f01 * f10;
  s.b0 = h0;
  s.b1 = g0 - f11 * h0 + f01 * h1;
  s.b2 = -f11 * g0 + f01 * g1;
  return s;
}

SensorModel BuildSensors(const Vehicle& vehicle, const AutopilotConfig& autopilot) {
  SensorModel model;
  for (const RateGyro& gyro : vehicle.sensors.rate_gyros) {
    GyroModel m;
    if (gyro.bandwidth_rad_s > 0.0)
      m.section = RampInvariant(gyro.bandwidth_rad_s, gyro.damping_ratio, autopilot.tick_s);
    m.quantum_rad_s = gyro.quantum_rad_s;
    m.sample_ticks = gyro.sample_ticks;
    model.gyros.push_back(m);
  }
  model.stages.resize(vehicle.stages.size());
  for (const GyroShare& share : autopilot.rate_gyros) {
    std::size_t gyro = 0;
    const bool is_there = FindGyro(vehicle, share.gyro, &gyro) != nullptr;
    DISPERSA_ASSERT(is_there);
    model.uses_gyros = true;
    for (std::size_t stage = 0; stage < model.stages.size(); ++stage) {
      if (share.stage != 0 && share.stage != static_cast<int>(stage) + 1) continue;
      model.stages[stage].gyro[gyro] += share.weight;
      model.stages[stage].unit = 0.0;
    }
  }
  return model;
}

std::vector<StructProblem> GyroProblems(const Vehicle& vehicle, const AutopilotConfig& autopilot) {
  std::vector<StructProblem> problems;
  std::vector<double> sum(vehicle.stages.size());
  for (std::size_t i = 0; i < autopilot.rate_gyros.size(); ++i) {
    const GyroShare& share = autopilot.rate_gyros[i];
    const std::string path = "rate_gyros[" + std::to_string(i) + "]";
    const RateGyro* gyro = FindGyro(vehicle, share.gyro, nullptr);
    if (gyro == nullptr) {
      std::string names;
      for (const RateGyro& each : vehicle.sensors.rate_gyros)
        names += (names.empty() ? "" : ", ") + each.name;
      problems.push_back({path + ".gyro", "'" + share.gyro + "' is no rate gyro of the vehicle",
                          names.empty() ? "none: the vehicle has none" : "one of " + names});
      continue;
    }
    for (std::size_t stage = 0; stage < sum.size(); ++stage) {
      if (share.stage != 0 && share.stage != static_cast<int>(stage) + 1) continue;
      sum[stage] += share.weight;
      if (gyro->station_m <= vehicle.stages[stage].bottom_station_m) continue;
      problems.push_back({path + ".gyro",
                          "'" + share.gyro + "' is not on board any more while stage " +
                              std::to_string(stage + 1) + " burns",
                          "a gyro ahead of station " +
                              std::to_string(vehicle.stages[stage].bottom_station_m) +
                              " m, or 'stage' below " + std::to_string(stage + 1)});
      break;
    }
  }
  for (std::size_t stage = 0; stage < sum.size() && problems.empty(); ++stage) {
    if (sum[stage] == 0.0 || std::fabs(sum[stage] - 1.0) < kSameWeight) continue;
    problems.push_back(
        {"rate_gyros",
         "the weights of stage " + std::to_string(stage + 1) + " sum to " + std::to_string(sum[stage]),
         "weights that sum to 1 in each stage, or none: then the inertial unit gives the rates"});
  }
  return problems;
}

}  // namespace dispersa
