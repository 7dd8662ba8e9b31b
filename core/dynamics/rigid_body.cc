#include "core/dynamics/rigid_body.h"

namespace dispersa {

RigidBodyState ReadState(const double* y) {
  return {Vector3(y[0], y[1], y[2]),
          Vector3(y[3], y[4], y[5]),
          {y[6], y[7], y[8], y[9]},
          Vector3(y[10], y[11], y[12])};
}

void WriteState(const RigidBodyState& s, double* y) {
  for (int i = 0; i < 3; ++i) {
    y[i] = s.p_EoC_I[i];
    y[3 + i] = s.v_IC_I[i];
    y[10 + i] = s.w_IB_B[i];
  }
  y[6] = s.q_IB.w;
  y[7] = s.q_IB.x;
  y[8] = s.q_IB.y;
  y[9] = s.q_IB.z;
}

RigidBodyState AtPoint(RigidBodyState s, const Vector3& r_CP_B) {
  s.p_EoC_I += Rotate(s.q_IB, r_CP_B);
  s.v_IC_I += Rotate(s.q_IB, s.w_IB_B.cross(r_CP_B));
  return s;
}

void RigidBodyDerivative(const Earth& earth, const RigidBodyState& s, const BodyLoads& loads, double* dydt) {
  RigidBodyState rate;
  rate.p_EoC_I = s.v_IC_I;
  rate.v_IC_I = Gravitation(earth, s.p_EoC_I) + RotationMatrix(s.q_IB) * (loads.force_n / loads.mass_kg);
  rate.q_IB = Derivative(s.q_IB, s.w_IB_B);
  const Vector3 h = loads.inertia_kg_m2 * s.w_IB_B;
  const Vector3 torque = loads.moment_n_m - s.w_IB_B.cross(h) - loads.inertia_rate_kg_m2_s * s.w_IB_B;
  rate.w_IB_B = loads.inertia_kg_m2.inverse() * torque;
  WriteState(rate, dydt);
}

}  // namespace dispersa
