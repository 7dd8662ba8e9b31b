// Equations of motion of W launch vehicles side by side (core/math/lanes.h): the one source of LauncherModel
// in launcher.h. They are split into parts that depend on time, on position, and on the rest. So an
// integration step evaluates each part only as often as it must.
#pragma once

#include "core/dynamics/apart_boosters.h"
#include "core/dynamics/bending.h"
#include "core/dynamics/body_flow.h"
#include "core/dynamics/launcher.h"
#include "core/dynamics/off_axis.h"
#include "core/environment/surroundings.h"
#include "core/math/lane_vector.h"
#include "core/vehicle/burning_stack.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// Place of a nozzle of a list, and the directions across the body in which its hinges turn its thrust.
template <class T>
struct ListedNozzle {
  T share, y_m, z_m;
  T first_y, first_z, second_y, second_z;
};

/// Differences of one nozzle's thrust from a nominal nozzle's (NozzleDeparture).
template <class T>
struct NozzleDepartureOf {
  Matrix<T> extra;  ///< its factor times its tilt, less 1
  T offset_y_m, offset_z_m;
};

/// A bank of nozzles (core/vehicle/nozzle_layout.h).
template <class T>
struct NozzleBank {
  MaskOf<T> there;                   ///< lanes whose stage has nozzles in it: of the first bank all
  MaskOf<T> driven;                  ///< or whose boosters have (apart_boosters.h)
  ListedNozzle<T> listed[kNozzles];  ///< unset unless nozzles are listed
  NozzleDepartureOf<T> departs[kNozzles];
};

/// A stack's numbers, its flight's factors applied (LauncherPlant, LauncherStack).
template <class T>
struct StackNumbers {
  T cg_factor, inertia_factor;
  T product_xy_kg_m2, product_xz_kg_m2, product_yz_kg_m2;
  T pivot_station_m, nozzle_radius_m;
  T nozzle_moment_kg_m;    ///< mass of a nozzle times the distance of its centre of gravity aft of the pivot
  T nozzle_inertia_kg_m2;  ///< about the hinge
  Matrix<T> thrust_tilt;
  T thrust_offset_y_m, thrust_offset_z_m;
  T nozzles_thrust;  ///< of all nozzles together, over that of the burn
  T lateral_moment_y_kg_m, lateral_moment_z_kg_m;
};
/// Each lane's current stack.
template <class T>
struct FlyingPlant : StackNumbers<T> {
  FlownWeather<T> weather;
  BurningStack<T> stack;
  BurningMotor<T> burn;
  BodyInFlow<T> aero;
  Sections<T> sections;
  bool nozzles_have_mass;  ///< of any stage: the same in all lanes, as
  bool jet_damping, flow_coriolis;
  bool any_departs;  ///< some lane's nozzles are not all the same
  MaskOf<T> departs;
  bool nozzles_listed;  ///< of any stage: the same in all lanes. The cross is one of the lists then
  bool any_products;    ///< some lane has products of inertia
  MaskOf<T> has_products;
  ApartBoosters<T>* apart;  ///< null: the vehicle has no boosters
  SideMasses<T>* sides;     ///< null: no table of a stage knows masses off the axis
  int banks;                ///< that any lane's stage has
  NozzleBank<T> bank[kBanks];
};

/// Values that stay constant between two events of each lane (LauncherPhase).
template <class T>
struct BurnPhase {
  MaskOf<T> burning, burnt, boosting;
  T ignition_s;
  T expelled_kg;
  Vector<T> control_torque_n_m;
};

/// Position and velocity of the centre of gravity C, attitude, angular velocity (RigidBodyState).
template <class T>
struct RigidMotion {
  Vector<T> p, v;
  Turn<T> q;
  Vector<T> w;
};

/// Values that depend on time alone.
template <class T>
struct TimedMasses {
  T propellant_kg;
  T mass_kg, inverse_mass_1_kg, cg_station_m, axial_kg_m2, transverse_kg_m2;
  T cg_y_m, cg_z_m;  ///< off the axis
  T cg_speed_m_s;    ///< of C forward through the body: the flow takes propellant away at
  T source_station_m;
  T axial_per_kg_m2, transverse_per_kg_m2;
  T thrust_fraction, flow_fraction;  ///< of full thrust and flow, 0 when not burning
  T beside_flow_kg_s;                ///< of the boosters, if the vehicle has any
};
template <class T>
DISPERSA_INLINE TimedMasses<T> MassesAt(const FlyingPlant<T>& plant, const BurnPhase<T>& phase, T time_s) {
  // BurnAt holds the time within the burn, so that the ends of a step, which rounding may put outside, count.
  const BurnState<T> burn = BurnAt(plant.burn, time_s - phase.ignition_s);
  const T unlit = Select(phase.burnt, plant.burn.left_kg, plant.burn.propellant_mass_kg);
  TimedMasses<T> o;
  o.propellant_kg = Select(phase.burning, burn.propellant_kg, unlit);
  MassPropertiesOf<T> m = MassesAt(plant.stack, o.propellant_kg);
  o.thrust_fraction = Select(phase.burning, burn.fraction, T(0.0));
  o.flow_fraction = Select(phase.burning, burn.flow_fraction, T(0.0));
  T flow_kg_s = plant.burn.full_flow_kg_s * o.flow_fraction;
  T lateral_y_kg_m = plant.lateral_moment_y_kg_m, lateral_z_kg_m = plant.lateral_moment_z_kg_m;
  if (plant.apart) {
    m = WithApart(*plant.apart, time_s - phase.ignition_s, flow_kg_s, m);
    lateral_y_kg_m = lateral_y_kg_m + plant.apart->off.y_kg_m;
    lateral_z_kg_m = lateral_z_kg_m + plant.apart->off.z_kg_m;
    o.beside_flow_kg_s = plant.apart->flow_kg_s;
    flow_kg_s = flow_kg_s + o.beside_flow_kg_s;
  }
  if (plant.sides) {
    m = WithSides(*plant.sides, o.propellant_kg, m);
    lateral_y_kg_m = lateral_y_kg_m + plant.sides->now.y_kg_m;
    lateral_z_kg_m = lateral_z_kg_m + plant.sides->now.z_kg_m;
  }
  o.mass_kg = m.mass_kg - phase.expelled_kg;
  o.inverse_mass_1_kg = T(1.0) / o.mass_kg;
  o.cg_station_m = m.cg_station_m * plant.cg_factor;
  o.cg_y_m = lateral_y_kg_m * o.inverse_mass_1_kg;
  o.cg_z_m = lateral_z_kg_m * o.inverse_mass_1_kg;
  o.axial_kg_m2 = m.axial_inertia_kg_m2 * plant.inertia_factor;
  o.transverse_kg_m2 = m.transverse_inertia_kg_m2 * plant.inertia_factor;
  o.axial_per_kg_m2 = m.axial_inertia_per_kg * plant.inertia_factor;
  o.transverse_per_kg_m2 = m.transverse_inertia_per_kg * plant.inertia_factor;
  o.cg_speed_m_s = flow_kg_s * o.inverse_mass_1_kg * plant.cg_factor * (m.source_station_m - m.cg_station_m);
  o.source_station_m = m.source_station_m;
  return o;
}

/// Sines and cosines of the nozzles' deflections (below 0.7 rad: remainder of the series below 1e-15).
template <class T>
struct Nozzles {
  T sine[kNozzles], cosine[kNozzles];
  T acceleration_rad_s2[kNozzles];  ///< of the deflection, if nozzles have mass
};
template <class T>
DISPERSA_INLINE Nozzles<T> NozzlesAt(const T* angle_rad) {
  Nozzles<T> n;
  for (int i = 0; i < kNozzles; ++i) {
    n.acceleration_rad_s2[i] = T(0.0);
    const T x = angle_rad[i], q = x * x;
    n.sine[i] =
        Fma(x * q,
            Horner(q, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800), x);
    n.cosine[i] = Fma(q,
                      Horner(q, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600,
                             -1.0 / 87178291200),
                      T(1.0));
  }
  return n;
}

/// Both drives of each nozzle of a bank.
template <class T>
struct BankNozzles {
  Nozzles<T> first, second;
};
/// Those of a list, of the plant's banks.
template <class T>
struct ListedNozzles {
  const BankNozzles<T>* bank;
};

/// Values of one instant for metrics and histories.
template <class T>
struct Instant {
  T altitude_m, qbar_pa, mach, incidence_rad, mass_kg, thrust_n;
  Vector<T> force_n;  ///< all but gravitation, body axes
  NormalForce<T> normal;
  SideForce<T> side;  ///< unset unless the plant's lanes have a yaw plane
  /// Of the boosters, about C; unset unless the vehicle has any.
  Vector<T> boosters_n, boosters_n_m;
};

/// Accelerations of a body: of C in I, and of the rotation in B.
template <class T>
struct Rates {
  Vector<T> dv, dw;
};

/// The velocity of C through the body, in I.
template <class T>
DISPERSA_INLINE Vector<T> CgVelocityOf(const TimedMasses<T>& masses, const Turn<T>& q) {
  const Matrix<T> R_IB = RotationMatrix(q);
  return masses.cg_speed_m_s * Vector<T>{R_IB.row[0].x, R_IB.row[1].x, R_IB.row[2].x};
}

template <class T>
struct Thrust {
  T thrust_n, flow_kg_s;
  Vector<T> force_n, moment_n_m;
  Vector<T> couple_n_m;  ///< the part of the moment that acts as a couple at the pivots
};
/// Adds the deviations of nozzles from a quarter of the thrust each: force, and couple about the pivots'
/// centre.
template <class T>
DISPERSA_INLINE void AddDepartures(const FlyingPlant<T>& plant, const Nozzles<T>& nozzles, T quarter_n,
                                   Thrust<T>& o) {
  const T none(0.0), r = plant.nozzle_radius_m;
  const Vector<T> place[kNozzles] = {{none, r, none}, {none, -r, none}, {none, none, r}, {none, none, -r}};
  Vector<T> force = Zero<T>(), couple = Zero<T>();
  for (int i = 0; i < kNozzles; ++i) {
    const NozzleDepartureOf<T>& nozzle = plant.bank[0].departs[i];
    const bool pitches = i < 2;
    const Vector<T> nominal = quarter_n * Vector<T>{nozzles.cosine[i], pitches ? none : -nozzles.sine[i],
                                                    pitches ? nozzles.sine[i] : none};
    const Vector<T> extra = plant.thrust_tilt * (nozzle.extra * nominal);
    const Vector<T> moved{none, nozzle.offset_y_m, nozzle.offset_z_m};
    force = force + extra;
    couple = couple + Cross(place[i], extra) + Cross(moved, plant.thrust_tilt * nominal + extra);
  }
  o.force_n = Select(plant.departs, o.force_n + force, o.force_n);
  o.couple_n_m = Select(plant.departs, o.couple_n_m + couple, o.couple_n_m);
}

/// Each nozzle carries a quarter of the thrust and deflects it in its hinge plane. Right (+y) and left (-y)
/// turn the force towards +z, bottom (+z) and top (-z) towards -y. P = P_vac - p A_e. Thrust is 0 if the
/// ambient pressure would make it negative.
template <class T>
DISPERSA_INLINE Thrust<T> ThrustOf(const FlyingPlant<T>& plant, const TimedMasses<T>& masses,
                                   const Nozzles<T>& nozzles, T pressure_pa) {
  Thrust<T> o;
  // Not Max, which would turn a thrust that is no number into none.
  const T net_n =
      Fma(plant.burn.vacuum_thrust_n, masses.thrust_fraction, -(pressure_pa * plant.burn.exit_area_m2));
  o.thrust_n = Select(net_n < T(0.0), T(0.0), net_n);
  o.flow_kg_s = plant.burn.full_flow_kg_s * masses.flow_fraction;
  const T* sine = nozzles.sine;
  const T* cosine = nozzles.cosine;
  const T quarter = T(0.25) * o.thrust_n;
  o.force_n = plant.thrust_tilt * Vector<T>{quarter * ((cosine[0] + cosine[1]) + (cosine[2] + cosine[3])),
                                            -(quarter * (sine[2] + sine[3])), quarter * (sine[0] + sine[1])};
  const T couple = quarter * plant.nozzle_radius_m;
  const Vector<T> across_y =
      plant.thrust_tilt * Vector<T>{couple * (cosine[0] - cosine[1]), T(0.0), couple * (sine[0] - sine[1])};
  const Vector<T> across_z = plant.thrust_tilt * Vector<T>{couple * (cosine[2] - cosine[3]),
                                                           -(couple * (sine[2] - sine[3])), T(0.0)};
  const Vector<T> arm{masses.cg_station_m - plant.pivot_station_m, plant.thrust_offset_y_m - masses.cg_y_m,
                      plant.thrust_offset_z_m - masses.cg_z_m};
  o.couple_n_m = {across_y.z - across_z.y, across_z.x, -across_y.x};
  if (plant.any_departs) AddDepartures(plant, nozzles, quarter, o);
  o.moment_n_m = Cross(arm, o.force_n) + o.couple_n_m;
  return o;
}

/// Adds force and couple of a bank of listed nozzles under a stage's thrust, with deviations of each nozzle
/// from its nominal share.
template <class T>
DISPERSA_INLINE void AddBank(const FlyingPlant<T>& plant, const NozzleBank<T>& bank,
                             const BankNozzles<T>& nozzles, T thrust_n, Vector<T>& force_n,
                             Vector<T>& couple_n_m) {
  const Nozzles<T>&first = nozzles.first, &second = nozzles.second;
  for (int i = 0; i < kNozzles; ++i) {
    const ListedNozzle<T>& nozzle = bank.listed[i];
    const NozzleDepartureOf<T>& departs = bank.departs[i];
    const T across = first.sine[i] * second.cosine[i], second_sine = second.sine[i];
    const Vector<T> turned{first.cosine[i] * second.cosine[i],
                           Fma(across, nozzle.first_y, second_sine * nozzle.second_y),
                           Fma(across, nozzle.first_z, second_sine * nozzle.second_z)};
    const Vector<T> nominal = (nozzle.share * thrust_n) * turned;
    const Vector<T> force = plant.thrust_tilt * (nominal + departs.extra * nominal);
    const Vector<T> place{T(0.0), nozzle.y_m + departs.offset_y_m, nozzle.z_m + departs.offset_z_m};
    force_n = force_n + force;
    couple_n_m = couple_n_m + Cross(place, force);
  }
}
/// Adds the banks after the first of the lanes that have them. A function of its own: it is long, and few
/// vehicles need it.
template <class T>
DISPERSA_OUT_OF_LINE void AddFurtherBanks(const FlyingPlant<T>& plant, const BankNozzles<T>* nozzles,
                                          T thrust_n, Vector<T>& force_n, Vector<T>& couple_n_m) {
  for (int i = 1; i < plant.banks; ++i) {
    const NozzleBank<T>& bank = plant.bank[i];
    Vector<T> force = force_n, couple = couple_n_m;
    AddBank(plant, bank, nozzles[i], thrust_n, force, couple);
    force_n = Select(bank.there, force, force_n);
    couple_n_m = Select(bank.there, couple, couple_n_m);
  }
}

/// The same as above for a list of nozzles (core/vehicle/nozzle_layout.h).
template <class T>
DISPERSA_INLINE Thrust<T> ThrustOf(const FlyingPlant<T>& plant, const TimedMasses<T>& masses,
                                   const ListedNozzles<T>& nozzles, T pressure_pa) {
  Thrust<T> o;
  const T none(0.0);
  const T net_n =
      Fma(plant.burn.vacuum_thrust_n, masses.thrust_fraction, -(pressure_pa * plant.burn.exit_area_m2));
  o.thrust_n = Select(net_n < none, none, net_n);
  o.flow_kg_s = plant.burn.full_flow_kg_s * masses.flow_fraction;
  o.force_n = o.couple_n_m = Zero<T>();
  AddBank(plant, plant.bank[0], nozzles.bank[0], o.thrust_n, o.force_n, o.couple_n_m);
  if (plant.banks > 1) AddFurtherBanks(plant, nozzles.bank, o.thrust_n, o.force_n, o.couple_n_m);
  const Vector<T> arm{masses.cg_station_m - plant.pivot_station_m, plant.thrust_offset_y_m - masses.cg_y_m,
                      plant.thrust_offset_z_m - masses.cg_z_m};
  o.moment_n_m = Cross(arm, o.force_n) + o.couple_n_m;
  return o;
}

/// "Tail wags dog": the forces of accelerating nozzles on the body. A nozzle whose deflection accelerates
/// pushes its pivot in the direction in which it turns the thrust. Its inertia about the hinge turns the body
/// against its own rotation. (A. L. Greensite, "Analysis and Design of Space Vehicle Flight Control Systems",
/// NASA CR-820 to CR-835, 1967-69.) The body's own acceleration does not move a nozzle: actuators are stiff.
template <class T>
struct NozzleReaction {
  Vector<T> force_n, couple_n_m;  ///< at the pivots
};
template <class T>
DISPERSA_INLINE NozzleReaction<T> ReactionOf(const FlyingPlant<T>& plant, const Nozzles<T>& nozzles) {
  const T* a = nozzles.acceleration_rad_s2;
  const T pitch = a[0] + a[1], yaw = a[2] + a[3];
  const T roll = (a[0] - a[1]) + (a[2] - a[3]);
  return {{T(0.0), -(plant.nozzle_moment_kg_m * yaw), plant.nozzle_moment_kg_m * pitch},
          {plant.nozzle_moment_kg_m * plant.nozzle_radius_m * roll, plant.nozzle_inertia_kg_m2 * pitch,
           plant.nozzle_inertia_kg_m2 * yaw}};
}

template <class T>
DISPERSA_INLINE void AddReactions(const FlyingPlant<T>& plant, const NozzleBank<T>& bank,
                                  const BankNozzles<T>& nozzles, NozzleReaction<T>& o) {
  const T none(0.0);
  for (int i = 0; i < kNozzles; ++i) {
    const ListedNozzle<T>& nozzle = bank.listed[i];
    const T a = nozzles.first.acceleration_rad_s2[i], b = nozzles.second.acceleration_rad_s2[i];
    const Vector<T> towards{none, Fma(a, nozzle.first_y, b * nozzle.second_y),
                            Fma(a, nozzle.first_z, b * nozzle.second_z)};
    const Vector<T> force = plant.nozzle_moment_kg_m * towards;
    o.force_n = o.force_n + force;
    o.couple_n_m = o.couple_n_m + Cross({none, nozzle.y_m, nozzle.z_m}, force) +
                   plant.nozzle_inertia_kg_m2 * Vector<T>{none, towards.z, -towards.y};
  }
}
template <class T>
DISPERSA_INLINE NozzleReaction<T> ReactionOf(const FlyingPlant<T>& plant, const ListedNozzles<T>& nozzles) {
  NozzleReaction<T> o{Zero<T>(), Zero<T>()};
  for (int i = 0; i < plant.banks; ++i) {
    NozzleReaction<T> with = o;
    AddReactions(plant, plant.bank[i], nozzles.bank[i], with);
    o.force_n = Select(plant.bank[i].there, with.force_n, o.force_n);
    o.couple_n_m = Select(plant.bank[i].there, with.couple_n_m, o.couple_n_m);
  }
  return o;
}

/// A bending body at an instant, or a rigid one. The rigid one has its own code: if bending could follow, the
/// compiler would keep forces in memory for it.
template <class T>
struct BentBody {
  static constexpr bool kBends = true;
  const StackBending<T>* bending;
  const BendingState<T>* state;
  ModalForce<T>* modal;  ///< receives Q / m
};
struct StraightBody {
  static constexpr bool kBends = false;
};

/// Everything that acts on a lane's body, body axes, moments about C.
template <class T>
struct LoadsOf {
  Matrix<T> R_IB;
  Vector<T> v_air;   ///< velocity through the air, in I
  Vector<T> v_AB_B;  ///< the same in B
  FlowForce<T> flow;
  Vector<T> force_n;     ///< all but gravitation
  Vector<T> moment_n_m;  ///< without the jet damping
  T thrust_n, flow_kg_s;
  T jet_axial, jet_transverse;         ///< jet damping, per rad/s
  Vector<T> boosters_n, boosters_n_m;  ///< unset unless any burns
};
/// What bending makes of a force and a couple (about the axis at the place): the place has moved and turned,
/// and they drive the modes. `arm`: from C to the place on the axis. Adds to the moment about C, and turns
/// the force.
template <class T>
DISPERSA_INLINE void Bend(const BentBody<T>& bent, const ForcePlace& place, MaskOf<T> acts,
                          const Vector<T>& arm, Vector<T> couple_n_m, Vector<T>& force_n,
                          Vector<T>& moment_n_m) {
  const StackBending<T>& b = *bent.bending;
  const PlaceShapes<T> shapes = ShapesOf(b, place);
  const Bent<T> at = BentAt(b, *bent.state, place, shapes, force_n, couple_n_m);
  const Vector<T> turn{T(0.0), at.about_y_rad, at.about_z_rad}, moved{T(0.0), at.y_m, at.z_m};
  const Vector<T> turned_n = Cross(turn, force_n), turned_n_m = Cross(turn, couple_n_m);
  moment_n_m = moment_n_m + Cross(arm, turned_n) + Cross(moved, force_n) + turned_n_m;
  force_n = force_n + turned_n;
  couple_n_m = couple_n_m + turned_n_m;
  ModalForce<T> driven = *bent.modal;
  DriveAt(b, *bent.state, place, shapes, force_n, couple_n_m, driven);
  Blend<T>(acts, driven, *bent.modal);
}

/// Adds the boosters' forces. Returns the mean place at which the flow of stage and boosters leaves.
template <class T, class Turned, class Body>
DISPERSA_INLINE T AddBoosters(const FlyingPlant<T>& plant, const BurnPhase<T>& phase,
                              const TimedMasses<T>& masses, T pressure_pa, const Turned& nozzles,
                              const Vector<T>& w, const Body& body, Thrust<T>& thrust, LoadsOf<T>& o) {
  const BankNozzles<T>* banks = nullptr;
  if constexpr (requires { nozzles.bank; }) banks = nozzles.bank;
  const ApartLoads<T> beside = LoadsOfApart(*plant.apart, banks, pressure_pa, masses.cg_station_m,
                                            masses.cg_y_m, masses.cg_z_m, plant.jet_damping, w);
  const T none(0.0);
  Vector<T> force_n = beside.force_n, moment_n_m = beside.moment_n_m;
  if constexpr (Body::kBends) {
    const Vector<T> arm{masses.cg_station_m - plant.apart->nozzle_station_m, -masses.cg_y_m, -masses.cg_z_m};
    Bend(body, kAtBoosters, phase.boosting, arm, moment_n_m - Cross(arm, force_n), force_n, moment_n_m);
  }
  o.boosters_n = Select(phase.boosting, force_n, Zero<T>());
  o.boosters_n_m = Select(phase.boosting, moment_n_m, Zero<T>());
  o.thrust_n = Select(phase.boosting, o.thrust_n + beside.thrust_n, o.thrust_n);
  o.force_n = Select(phase.boosting, o.force_n + force_n, o.force_n);
  thrust.moment_n_m = Select(phase.boosting, thrust.moment_n_m + moment_n_m, thrust.moment_n_m);
  o.flow_kg_s = o.flow_kg_s + masses.beside_flow_kg_s;
  const T share = Select(o.flow_kg_s > none,
                         masses.beside_flow_kg_s / Select(o.flow_kg_s > none, o.flow_kg_s, T(1.0)), none);
  return plant.pivot_station_m + share * (plant.apart->nozzle_station_m - plant.pivot_station_m);
}

/// Through the air, which turns with the Earth and its wind, in I.
template <class T>
DISPERSA_INLINE Vector<T> AirVelocity(double earth_rate_rad_s, const Surroundings<T>& around,
                                      const RigidMotion<T>& s) {
  const T omega(earth_rate_rad_s);
  return {Fma(omega, s.p.y, s.v.x) - around.wind_m_s.x, Fma(-omega, s.p.x, s.v.y) - around.wind_m_s.y,
          s.v.z - around.wind_m_s.z};
}

/// Sum of all loads. `any_burns`: at least one lane has thrust. `body`: bent or straight. `nozzles`: the
/// cross's, or ListedNozzles. With jet damping the flow leaves with the velocity of the nozzle about the CG:
/// -m_dot r x (w x r), r on the axis; for roll r is the nozzle circle's radius. The flow runs aft by s, from
/// the grain's middle or the liquids' surfaces to the pivots. A turning body pushes it aside: Coriolis's
/// force 2 m_dot s w x e_x on the body.
template <class T, class Turned, class Body>
DISPERSA_INLINE LoadsOf<T> LoadsAt(double earth_rate_rad_s, const FlyingPlant<T>& plant,
                                   const BurnPhase<T>& phase, bool any_burns, const Surroundings<T>& around,
                                   const TimedMasses<T>& masses, const Turned& nozzles,
                                   const RigidMotion<T>& s, const Body& body) {
  LoadsOf<T> o;
  o.R_IB = RotationMatrix(s.q);
  const T omega(earth_rate_rad_s), none(0.0);
  o.v_air = AirVelocity(earth_rate_rad_s, around, s);
  o.v_AB_B = TransposeTimes(o.R_IB, o.v_air);
  const Vector<T> w_EB_B = Along(s.w, -omega, o.R_IB.row[2]);
  o.flow = ForceOfFlow(plant.aero, o.v_AB_B, w_EB_B, around.density_kg_m3, around.inverse_sound_s_m,
                       masses.cg_station_m);
  if constexpr (Body::kBends) {
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < kModes; ++mode) body.modal->drive_m_s2[plane][mode] = none;
    BendFlow(*body.bending, *body.state, plant.sections, masses.cg_station_m,
             plant.aero.has_yaw_plane ? &o.flow.side : nullptr, o.flow, *body.modal);
  }
  o.force_n = o.flow.force_n;
  // The flow acts about the axis, from which C may be off.
  const Vector<T>& f = o.flow.force_n;
  const Vector<T> off_axis{Fma(masses.cg_z_m, f.y, -(masses.cg_y_m * f.z)), -(masses.cg_z_m * f.x),
                           masses.cg_y_m * f.x};
  o.moment_n_m = o.flow.moment_n_m + off_axis + phase.control_torque_n_m;
  o.thrust_n = o.flow_kg_s = o.jet_axial = o.jet_transverse = none;
  if (!any_burns) {
    if constexpr (Body::kBends) FinishDrive(*body.bending, *body.state, o.force_n.x, *body.modal);
    return o;
  }
  Thrust<T> thrust = ThrustOf<T>(plant, masses, nozzles, around.pressure_pa);
  const Vector<T> arm{masses.cg_station_m - plant.pivot_station_m, -masses.cg_y_m, -masses.cg_z_m};
  if (plant.nozzles_have_mass) {
    const NozzleReaction<T> reaction = ReactionOf<T>(plant, nozzles);
    thrust.force_n = thrust.force_n + reaction.force_n;
    thrust.couple_n_m = thrust.couple_n_m + reaction.couple_n_m;
    thrust.moment_n_m = thrust.moment_n_m + Cross(arm, reaction.force_n) + reaction.couple_n_m;
  }
  if constexpr (Body::kBends) {
    const Vector<T> offset{none, plant.thrust_offset_y_m, plant.thrust_offset_z_m};
    Bend(body, kAtPivot, phase.burning, arm, thrust.couple_n_m + Cross(offset, thrust.force_n),
         thrust.force_n, thrust.moment_n_m);
  }
  o.thrust_n = Select(phase.burning, thrust.thrust_n * plant.nozzles_thrust, none);
  o.flow_kg_s = Select(phase.burning, thrust.flow_kg_s, none);
  o.force_n = Select(phase.burning, o.force_n + thrust.force_n, o.force_n);
  T exit_station_m = plant.pivot_station_m;  // of what flows
  if (plant.apart)
    exit_station_m = AddBoosters(plant, phase, masses, around.pressure_pa, nozzles, s.w, body, thrust, o);
  if (plant.flow_coriolis) {
    const T turned = T(2.0) * o.flow_kg_s * (exit_station_m - masses.source_station_m);
    o.force_n.y = Fma(turned, s.w.z, o.force_n.y);
    o.force_n.z = Fma(-turned, s.w.y, o.force_n.z);
  }
  o.moment_n_m = Select(phase.burning, o.moment_n_m + thrust.moment_n_m, o.moment_n_m);
  if (plant.jet_damping) {
    const T lever = plant.pivot_station_m - masses.cg_station_m;
    o.jet_axial = o.flow_kg_s * plant.nozzle_radius_m * plant.nozzle_radius_m;
    o.jet_transverse = o.flow_kg_s * lever * lever;
    if (plant.apart) {  // theirs is among their moments
      const T own_kg_s = o.flow_kg_s - masses.beside_flow_kg_s;
      o.jet_axial = own_kg_s * plant.nozzle_radius_m * plant.nozzle_radius_m;
      o.jet_transverse = own_kg_s * lever * lever;
    }
  }
  if constexpr (Body::kBends) FinishDrive(*body.bending, *body.state, o.force_n.x, *body.modal);
  return o;
}

/// dw/dt of I dw/dt = `moment` - w x I w with products of inertia, by cofactors of I. `moment` does not
/// include w x I w.
template <class T>
DISPERSA_INLINE Vector<T> TurnedUnderProducts(const FlyingPlant<T>& plant, const TimedMasses<T>& masses,
                                              const Vector<T>& moment, const Vector<T>& w) {
  const T a = masses.axial_kg_m2, t = masses.transverse_kg_m2;
  const T xy = plant.product_xy_kg_m2, xz = plant.product_xz_kg_m2, yz = plant.product_yz_kg_m2;
  const Vector<T> spin{a * w.x - (xy * w.y + xz * w.z), t * w.y - (xy * w.x + yz * w.z),
                       t * w.z - (xz * w.x + yz * w.y)};
  const Vector<T> m = moment - Cross(w, spin);
  const T c_xx = t * t - yz * yz, c_yy = a * t - xz * xz, c_zz = a * t - xy * xy;
  const T c_xy = xy * t + xz * yz, c_xz = xz * t + xy * yz, c_yz = a * yz + xy * xz;
  const T inverse = T(1.0) / (a * c_xx - (xy * c_xy + xz * c_xz));
  return inverse * Vector<T>{c_xx * m.x + c_xy * m.y + c_xz * m.z, c_xy * m.x + c_yy * m.y + c_yz * m.z,
                             c_xz * m.x + c_yz * m.y + c_zz * m.z};
}

/// Of a vehicle with masses off the axis: boosters, or in tables of its stages.
template <class T>
DISPERSA_INLINE Tensor<T> TensorOffAxis(const FlyingPlant<T>& plant, const TimedMasses<T>& masses) {
  OffAxis<T> off = plant.apart ? plant.apart->off : plant.sides->now;
  if (plant.apart && plant.sides) {
    const OffAxis<T>& more = plant.sides->now;
    off = {off.y_kg_m + more.y_kg_m,
           off.z_kg_m + more.z_kg_m,
           off.station_y_kg_m2 + more.station_y_kg_m2,
           off.station_z_kg_m2 + more.station_z_kg_m2,
           off.about_y_kg_m2 + more.about_y_kg_m2,
           off.yz_kg_m2 + more.yz_kg_m2};
  }
  Tensor<T> i = TensorOf(off, masses.axial_kg_m2, masses.transverse_kg_m2, masses.mass_kg,
                         masses.cg_station_m, plant.inertia_factor);
  i.xy = i.xy + plant.product_xy_kg_m2;
  i.xz = i.xz + plant.product_xz_kg_m2;
  i.yz = i.yz + plant.product_yz_kg_m2;
  return i;
}

/// dv/dt = gravitation + R_IB (F / m + u w x e_x) and I dw/dt = M - w x I w - (dI/dt) w, as rigid_body.h
/// explains: for an axisymmetric body, or one that also has products of inertia. v is the velocity of the
/// body at C. u e_x is the velocity of C through the body: dp/dt = v + R_IB u e_x. The momentum on board is m
/// v plus m_dot times the way of the flow (aft). Gravitation, outer forces and the leaving flow change it. A
/// burn that begins or ends does not change v. The motion of an offset C across the body (mm/s) is left out.
template <class T, class Turned, class Body>
DISPERSA_INLINE Rates<T> RatesOf(double earth_rate_rad_s, const FlyingPlant<T>& plant,
                                 const BurnPhase<T>& phase, bool any_burns, const Surroundings<T>& around,
                                 const TimedMasses<T>& masses, const Turned& nozzles, const RigidMotion<T>& s,
                                 const Body& body, Instant<T>* instant) {
  const LoadsOf<T> loads =
      LoadsAt(earth_rate_rad_s, plant, phase, any_burns, around, masses, nozzles, s, body);
  Rates<T> o;
  Vector<T> specific_n_kg = masses.inverse_mass_1_kg * loads.force_n;
  if (plant.flow_coriolis) {
    specific_n_kg.y = Fma(masses.cg_speed_m_s, s.w.z, specific_n_kg.y);
    specific_n_kg.z = Fma(-masses.cg_speed_m_s, s.w.y, specific_n_kg.z);
  }
  o.dv = around.gravitation_m_s2 + loads.R_IB * specific_n_kg;
  // Angular momentum carried off by the flow, minus the body's loss of inertia.
  const T axial_loss = loads.jet_axial - loads.flow_kg_s * masses.axial_per_kg_m2;
  const T transverse_loss = loads.jet_transverse - loads.flow_kg_s * masses.transverse_per_kg_m2;
  const T inverse = T(1.0) / (masses.axial_kg_m2 * masses.transverse_kg_m2);
  const T inverse_axial = inverse * masses.transverse_kg_m2,
          inverse_transverse = inverse * masses.axial_kg_m2;
  const T gyroscopic = (masses.transverse_kg_m2 - masses.axial_kg_m2) * s.w.x;
  const Vector<T>& moment = loads.moment_n_m;
  o.dw.x = inverse_axial * Fma(-axial_loss, s.w.x, moment.x);
  o.dw.y = inverse_transverse * Fma(-transverse_loss, s.w.y, Fma(gyroscopic, s.w.z, moment.y));
  o.dw.z = inverse_transverse * Fma(-transverse_loss, s.w.z, Fma(-gyroscopic, s.w.y, moment.z));
  if (plant.any_products) {
    const Vector<T> left{Fma(-axial_loss, s.w.x, moment.x), Fma(-transverse_loss, s.w.y, moment.y),
                         Fma(-transverse_loss, s.w.z, moment.z)};
    o.dw = Select(plant.has_products, TurnedUnderProducts(plant, masses, left, s.w), o.dw);
  }
  if (plant.apart || plant.sides) {
    const Vector<T> left{Fma(-axial_loss, s.w.x, moment.x), Fma(-transverse_loss, s.w.y, moment.y),
                         Fma(-transverse_loss, s.w.z, moment.z)};
    o.dw = TurnedUnder(TensorOffAxis(plant, masses), left, s.w);
    if (plant.apart && instant) {
      instant->boosters_n = any_burns ? loads.boosters_n : Zero<T>();
      instant->boosters_n_m = any_burns ? loads.boosters_n_m : Zero<T>();
    }
  }
  if (instant) {
    instant->altitude_m = around.altitude_m;
    instant->qbar_pa = loads.flow.qbar_pa;
    instant->mach = loads.flow.mach;
    instant->incidence_rad = loads.flow.incidence_rad;
    instant->mass_kg = masses.mass_kg;
    instant->thrust_n = loads.thrust_n;
    instant->force_n = loads.force_n;
    instant->normal = loads.flow.normal;
    if (plant.aero.has_yaw_plane) instant->side = loads.flow.side;
  }
  return o;
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
