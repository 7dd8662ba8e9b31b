#include "core/tuning/regulator.h"

#include <Eigen/LU>

namespace dispersa {

namespace {

// P of A'P + PA = -Q, element by element.
Eigen::Matrix3d SolveLyapunov3(const Eigen::Matrix3d& a, const Eigen::Matrix3d& q) {
  Eigen::Matrix<double, 9, 9> m = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Matrix<double, 9, 1> right;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int equation = 3 * i + j;
      right[equation] = -q(i, j);
      for (int k = 0; k < 3; ++k) {
        m(equation, 3 * k + j) += a(k, i);
        m(equation, 3 * i + k) += a(k, j);
      }
    }
  }
  const Eigen::Matrix<double, 9, 1> p = m.fullPivLu().solve(right);
  Eigen::Matrix3d solved;
  for (int i = 0; i < 9; ++i) solved(i / 3, i % 3) = p[i];
  return solved;
}

}  // namespace

RegulatorGains SolveRegulator(const RegulatorWeights& weights) {
  Eigen::Matrix3d q = Eigen::Matrix3d::Zero();
  q.diagonal() << weights.integral_1_s6, weights.angle_1_s4, weights.rate_1_s2;
  // Stabilising start: poles at -1 and two at ±60° from it. Newton's iteration converges from any stabilising
  // start, at the end quadratically. It starts a few powers of ten away at most, and each step at least
  // halves the distance.
  Eigen::RowVector3d k(1.0, 2.0, 2.0);
  for (int i = 0; i < 60; ++i) {
    Eigen::Matrix3d closed = Eigen::Matrix3d::Zero();
    closed(0, 1) = closed(1, 2) = 1.0;
    closed.row(2) = -k;
    const Eigen::Matrix3d p = SolveLyapunov3(closed, q + k.transpose() * k);
    const Eigen::RowVector3d next = p.row(2);  // B = (0, 0, -1) and u = k x
    const bool settled = (next - k).norm() <= 1e-14 * k.norm();
    k = next;
    if (settled) break;
  }
  return {k[0], k[1], k[2]};
}

RegulatorWeights WeightsOf(const RegulatorGains& gains) {
  return {gains.ki_1_s3 * gains.ki_1_s3, gains.kp_1_s2 * gains.kp_1_s2 - 2.0 * gains.ki_1_s3 * gains.kd_1_s,
          gains.kd_1_s * gains.kd_1_s - 2.0 * gains.kp_1_s2};
}

}  // namespace dispersa
