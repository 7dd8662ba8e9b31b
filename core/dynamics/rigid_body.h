// Newton and Euler for a body of changing mass, in an inertial frame.
#pragma once

#include "core/dynamics/air_data.h"
#include "core/math/rotation.h"

namespace dispersa {

/// Position and velocity of the centre of gravity C, attitude, and inertial angular velocity.
struct RigidBodyState {
  Vector3 p_EoC_I = Vector3::Zero();
  Vector3 v_IC_I = Vector3::Zero();
  Quaternion q_IB;
  Vector3 w_IB_B = Vector3::Zero();
};
inline constexpr int kRigidBodySize = 13;

/// Layout of a state in a flat array: p, v, q (w, x, y, z), w.
RigidBodyState ReadState(const double* y);
void WriteState(const RigidBodyState& state, double* y);

/// The state of the body's point P, at r_CP_B from C: the turning body moves there with v + w x r.
RigidBodyState AtPoint(RigidBodyState state, const Vector3& r_CP_B);

/// Forces and moments on the body at one instant, in body axes about C.
struct BodyLoads {
  Vector3 force_n = Vector3::Zero();  ///< all but gravitation
  Vector3 moment_n_m = Vector3::Zero();
  double mass_kg = 0.0;
  Matrix3 inertia_kg_m2 = Matrix3::Zero();
  Matrix3 inertia_rate_kg_m2_s = Matrix3::Zero();  ///< of a body that burns: dI/dt
};

/// dp/dt = v, dv/dt = gravitation + R_IB F / m, dq/dt from w, and I dw/dt = M - w x I w - (dI/dt) w, with I
/// and dI/dt about the moving C. M holds the jet damping -m_dot r x (w x r), r from C to the nozzle, so I w
/// is the angular momentum of the mass on board. launcher_body.h adds the force of the flow through a turning
/// body and the motion of C through the body. q is used as it is. Its norm drifts by the integrator's error
/// and is restored between steps.
void RigidBodyDerivative(const Earth& earth, const RigidBodyState& state, const BodyLoads& loads,
                         double* dydt);

}  // namespace dispersa
