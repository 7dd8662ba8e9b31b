// The integration step of W launch vehicles side by side (core/math/lanes.h), and the state that it moves.
//
// Over a step of length h from a state with position p, velocity v, attitude q and angular velocity w:
//
//   actuators   depend on nothing else between two commands. They are propagated first, exactly.
//   a0, alpha0  accelerations at the start: those at the end of the last step.
//   middle      p + h/2 v + h²/8 a0, v + h/2 a0 + h²/8 a0', q turned by h/2 w + h²/8 alpha0,
//               w + h/2 alpha0 + h²/8 alpha0'. There a1, alpha1 are evaluated.
//   end         p + h v + h²/6 (a0 + 2 a1), q turned by h w + h²/6 (alpha0 + 2 alpha1) + h³/12 w1 x alpha1.
//               Both are final. The velocities v + h a1 and w + h alpha1 are a guess for the last
//               evaluation, which gives a2, alpha2.
//   CG          moves through the body at u, which follows from masses and attitude. p takes the integral
//               of u: by the trapezium rule to the middle, by Simpson's rule to the end.
//   bending     each mode swings exactly (bending.h) under its drive. For the middle the drive starts at its
//               value and rises as in the last step. For the last evaluation it is the line through start
//               and middle. In the end it is the parabola through all three. Frequencies: the middle's.
//   velocities  v + h/6 (a0 + 4 a1 + a2), w + h/6 (alpha0 + 4 alpha1 + alpha2).
//
// a0' is the slope, at its end, of the parabola through the last step's three accelerations; 0 after an
// event. A step has two evaluations. The last one also serves the metrics of the tick at which the step ends.
//
// Order. Three parts leave O(h⁵) a step: Simpson's rule, its double integral (exact to the third power of
// time), and the Magnus expansion with the middle's w1 x alpha1. The guesses of v and w and the middle's q
// err by O(h³). So a1 and a2 err by that times their sensitivity, and the velocities by O(h⁴) a step:
// order 3. The constant is small, since accelerations hardly depend on velocities. Where they do not depend
// on them and the attitude turns steadily, the order is 4. tests/verification/ checks both.
#pragma once

#include "core/dynamics/booster_push.h"
#include "core/dynamics/launcher_lanes.h"

namespace dispersa::lanes {
inline namespace DISPERSA_ISA {

/// A bank of nozzles with its drives, about first and second hinges. Of a cross, the first bank alone, second
/// hinges stay at 0 and nothing reads them.
template <class T>
struct BankState {
  DriveState<T> first, second;
};
template <class T>
struct DriveBank {
  BankState<T> state;
  Actuators<T> gimbal;
  Transition<T> over_half;  ///< over half a tick
  T command_rad[kDrives];   ///< at the actuators
};

/// Values written through a setter are marked: the next evaluation reads them again.
template <class T>
class StepState {
 public:
  // ---- what moves ----
  const RigidMotion<T>& motion() const { return motion_; }
  const BankState<T>& drives(int bank) const { return banks_[bank].state; }
  const BendingState<T>& bending_state() const { return bending_state_; }
  // ---- what it moves under ----
  const FlyingPlant<T>& plant() const { return plant_; }
  const BurnPhase<T>& phase() const { return phase_; }
  const StackBending<T>& bending() const { return bending_; }
  const T* command_rad(int bank) const { return banks_[bank].command_rad; }  ///< at the actuators, kDrives

  /// Of an object of zeros. No lane flies. Each computes with finite numbers that nothing reads.
  void Configure(const LauncherPlant& nominal, double tick_s) {
    earth_ = nominal.environment.earth;
    tick_s_ = tick_s;
    most_banks_ = nominal.nozzle_banks();
    if (nominal.boosters.get() != nullptr) plant_.apart = &apart_;
    if (nominal.has_side_masses()) plant_.sides = &sides_;
    start_ = &points_[0];
    middle_ = &points_[1];
    end_ = &points_[2];
    for (int lane = 0; lane < kWidth<T>; ++lane) SetStack(lane, nominal, 0);
    has_plain_sections_ = bending_.modes == 0 && !plant_.apart;
    motion_.p.x = T(earth_.equatorial_radius_m);
    motion_.q.w = T(1.0);
  }

  // ---- a lane's flight ----
  /// At y before lift-off, where nothing burns. `weather` must outlive the flight.
  void StartFlight(int lane, const FlightWeather& weather, const double* y) {
    SetLane(phase_.burning, lane, false);
    SetLane(phase_.boosting, lane, false);
    Lane(phase_.ignition_s, lane) = Lane(phase_.expelled_kg, lane) = 0.0;
    SetLane(phase_.control_torque_n_m, lane, Zero<double>());
    SetWeather(plant_.weather, lane, weather);
    WriteLane(lane, y);
  }
  /// A stack that has not burnt and is not commanded. `plant` must outlive the flight.
  void SetStack(int lane, const LauncherPlant& plant, int stack) {
    SetPlant(plant_, lane, plant, stack);
    SetModes(bending_, lane, plant, stack);
    SetDrives(lane, plant.stacks.data()[stack].gimbal, -1);
    if (stack == 0 && plant.boosters_steer())
      for (int bank = apart_.first_bank; bank < most_banks_; ++bank)
        SetDrives(bank, lane, plant.boosters.get()->gimbal, -1);
    SetLane(phase_.burnt, lane, false);
    ClearCommands(lane);
    MarkMoved(lane);
  }
  /// Of the stack without what it has jettisoned: its masses and its modes (null: it is rigid).
  void SetMass(int lane, const StackMass& mass, const ModeTable* bending) {
    lanes::SetStack(plant_.stack, lane, mass);
    SetTable(bending_, lane, bending);
    MarkMoved(lane);
  }
  void SetShape(int lane, const LauncherStack& stack, const AeroVariant* variant) {
    lanes::SetShape(plant_.aero, lane, stack, variant);
    MarkMoved(lane);
  }
  void Ignite(int lane, double time_s, bool lights_boosters) {
    Lane(phase_.ignition_s, lane) = time_s;
    SetLane(phase_.burning, lane, true);
    SetLane(phase_.boosting, lane, lights_boosters && plant_.apart);
    for (int k = 0; plant_.apart && k < apart_.count; ++k)
      SetLane(apart_.each[k].burning, lane, lights_boosters);
    SetLane(phase_.control_torque_n_m, lane, Zero<double>());
    ClearCommands(lane);
    MarkMoved(lane);
  }
  /// Returns whether no other burns on.
  bool BurnOutBooster(int lane, int booster) {
    SetLane(apart_.each[booster].burning, lane, false);
    MarkMoved(lane);
    if (BoostersBurning(lane) != 0) return false;
    SetLane(phase_.boosting, lane, false);
    return true;
  }
  /// Bits of the boosters.
  unsigned BoostersBurning(int lane) const {
    unsigned burning = 0;
    for (int k = 0; plant_.apart && k < apart_.count; ++k)
      burning |= (Bits(apart_.each[k].burning) >> lane & 1u) << k;
    return burning;
  }
  void DropBoosters(int lane) {
    SetLane(apart_.attached, lane, false);
    MarkDriven(plant_, most_banks_);
    MarkMoved(lane);
  }
  void StickNozzle(int lane, const Gimbal& gimbal, int nozzle, double angle_rad) {
    Lane(banks_[nozzle / kNozzles].state.first.angle_rad[nozzle % kNozzles], lane) = angle_rad;
    SetDrives(lane, gimbal, nozzle);
    MarkMoved(lane);
  }
  /// The same burn until an end in the future: what holds now goes on to hold.
  void ShortenBurn(int lane, const MotorBurn& burn) { SetBurn(plant_.burn, lane, burn); }
  /// The thrust bends here, or its slope jumps.
  void PassKink(int lane) { MarkMoved(lane); }
  void BurnOut(int lane) {
    SetLane(phase_.burning, lane, false);
    SetLane(phase_.burnt, lane, true);
    SetLane(phase_.control_torque_n_m, lane, Zero<double>());
    MarkMoved(lane);
  }
  /// Lets go of what belongs to the flight. The lane computes on, and nothing reads its values.
  void EndFlight(int lane) {
    plant_.weather.profile[lane] = nullptr;
    plant_.weather.air.of[lane] = nullptr;
    plant_.burn.curve[lane] = nullptr;
    for (ApartBooster<T>& one : apart_.each) one.burn.curve[lane] = nullptr;
    SetTable(bending_, lane, nullptr);
    SetLane(phase_.burning, lane, false);
    SetLane(phase_.boosting, lane, false);
  }

  void ReadLane(int lane, double* y) const {
    for (unsigned i = 0; i < kValues<T, RigidMotion<T>>; ++i) y[i] = LaneAt<T>(motion_, i, lane);
    for (unsigned i = 0; i < kValues<T, BendingState<T>>; ++i)
      y[kModalState + i] = LaneAt<T>(bending_state_, i, lane);
    for (int drive = 0; drive < most_banks_ * kDrives; ++drive) {
      const DriveState<T>& of = HingeOf(banks_[drive / kDrives].state, drive);
      y[AngleOf(drive)] = Lane(of.angle_rad[drive % kNozzles], lane);
      y[RateOf(drive)] = Lane(of.rate_rad_s[drive % kNozzles], lane);
    }
  }
  void WriteLane(int lane, const double* y) {
    for (unsigned i = 0; i < kValues<T, RigidMotion<T>>; ++i) SetLaneAt<T>(motion_, i, lane, y[i]);
    for (unsigned i = 0; i < kValues<T, BendingState<T>>; ++i)
      SetLaneAt<T>(bending_state_, i, lane, y[kModalState + i]);
    for (int drive = 0; drive < most_banks_ * kDrives; ++drive) {
      DriveState<T>& of = HingeOf(banks_[drive / kDrives].state, drive);
      Lane(of.angle_rad[drive % kNozzles], lane) = y[AngleOf(drive)];
      Lane(of.rate_rad_s[drive % kNozzles], lane) = y[RateOf(drive)];
    }
    MarkMoved(lane);
  }

  // ---- commands ----
  /// `angle_rad`: of kNozzles, and of kDrives where nozzles are listed.
  void Command(MaskOf<T> lanes, int bank, const T* angle_rad) {
    T* const command_rad = banks_[bank].command_rad;
    for (int i = 0; i < kNozzles; ++i) command_rad[i] = Select(lanes, angle_rad[i], command_rad[i]);
    for (int i = kNozzles; plant_.nozzles_listed && i < kDrives; ++i)
      command_rad[i] = Select(lanes, angle_rad[i], command_rad[i]);
    MarkCommanded(lanes);
  }
  void CommandLane(int lane, int bank, const T* angle_rad) {
    for (int i = 0; i < (plant_.nozzles_listed ? kDrives : kNozzles); ++i)
      Lane(banks_[bank].command_rad[i], lane) = Lane(angle_rad[i], lane);
    MaskOf<T> commanded = NoLane<T>();
    SetLane(commanded, lane, true);
    MarkCommanded(commanded);
  }
  /// The reaction control's, body axes.
  void SetControlTorque(MaskOf<T> lanes, Vector<T> torque_n_m) {
    Vector<T>& now = phase_.control_torque_n_m;
    const auto differs = [](T a, T b) { return (a < b) | (a > b); };
    MarkStale(lanes &
              (differs(torque_n_m.x, now.x) | differs(torque_n_m.y, now.y) | differs(torque_n_m.z, now.z)));
    now = Select(lanes, torque_n_m, now);
  }
  /// Of spin motors, until it is set again.
  void SetRollTorque(int lane, double torque_n_m) {
    SetLane(phase_.control_torque_n_m, lane, {torque_n_m, 0.0, 0.0});
    MarkMoved(lane);
  }
  /// So many times so much leaves through thrusters.
  void Expel(MaskOf<T> lanes, T kg_each, T times) {
    phase_.expelled_kg = Select(lanes, Fma(kg_each, times, phase_.expelled_kg), phase_.expelled_kg);
    MarkStale(lanes);
  }

  /// Environment of the lanes at their present times. Valid after EvaluateStart.
  const Instant<T>& now() const { return start_->instant; }
  const Vector<T>& acceleration_m_s2() const { return start_->rates.dv; }
  Vector<T> VelocityThroughAir() const {  ///< body axes
    return TransposeTimes(RotationMatrix(motion_.q),
                          AirVelocity(earth_.rotation_rate_rad_s, start_->around, motion_));
  }
  const T& density_kg_m3() const { return start_->around.density_kg_m3; }
  const T& cg_station_m() const { return start_->masses.cg_station_m; }
  /// Of the lanes' lowest stages.
  const T& propellant_kg() const { return start_->masses.propellant_kg; }
  /// The largest bending moment of the lanes' bodies now; what is below `seen_n_m` may be a smaller one.
  LargestMoment<T> LargestMomentNow(T seen_n_m) const {
    const Point& now = *start_;
    const Vector<T>&w = motion_.w, &dw = now.rates.dw;
    const T per_kg = now.masses.inverse_mass_1_kg;
    const BodyMotion<T> moved{now.masses.propellant_kg,       now.masses.cg_station_m,
                              per_kg * now.instant.force_n.y, per_kg * now.instant.force_n.z,
                              Fma(-w.x, w.z, dw.y),           Fma(w.x, w.y, dw.z)};
    const NormalForce<T>& air = now.instant.normal;
    const SideForce<T>* const side = plant_.aero.has_yaw_plane ? &now.instant.side : nullptr;
    if (has_plain_sections_) return LargestOf(plant_.sections, air, side, moved, seen_n_m);
    if (plant_.apart && Any(apart_.attached)) return LargestBesideBoosters(air, side, moved, seen_n_m);
    return LargestOfBent(air, side, moved, seen_n_m, NoFurtherLoads{});
  }

  /// Of one lane at its time, evaluated anew.
  Instant<double> InstantOf(int lane, T time_s) const {
    Point p;
    SetAir(motion_.p, p.around);
    SetMasses(time_s, p.masses);
    SetNozzles(plant_.nozzles_listed);
    if (plant_.nozzles_listed) {
      bending_.modes > 0 ? SetRates<true, true>(motion_, bending_state_, p, p.rates, &p.instant)
                         : SetRates<false, true>(motion_, bending_state_, p, p.rates, &p.instant);
    } else {
      bending_.modes > 0 ? SetRates<true, false>(motion_, bending_state_, p, p.rates, &p.instant)
                         : SetRates<false, false>(motion_, bending_state_, p, p.rates, &p.instant);
    }
    return lanes::LaneOf(p.instant, lane);
  }

  /// Shapes of the modes at the lanes' propellant, where bending is looked at between steps.
  void UpdateShapes(T time_s) {
    if (!any_stale_) return;
    TimedMasses<T> masses;
    SetMasses(time_s, masses);
    SetShapes(masses);
  }

  /// Evaluates the lanes at which the last step's end does not hold any more.
  void EvaluateStart(T time_s) {
    if (plant_.nozzles_listed)
      bending_.modes > 0 ? EvaluateStartOf<true, true>(time_s) : EvaluateStartOf<false, true>(time_s);
    else
      bending_.modes > 0 ? EvaluateStartOf<true, false>(time_s) : EvaluateStartOf<false, false>(time_s);
  }

  /// Moves lanes from their times to other times. `all` says that the remaining lanes do not fly. Returns the
  /// lanes whose state is finite. The others stay as they were.
  MaskOf<T> Step(MaskOf<T> moving, bool all, T from_s, T to_s) {
    if (plant_.nozzles_listed)
      return bending_.modes > 0 ? StepOf<true, true>(moving, all, from_s, to_s)
                                : StepOf<false, true>(moving, all, from_s, to_s);
    return bending_.modes > 0 ? StepOf<true, false>(moving, all, from_s, to_s)
                              : StepOf<false, false>(moving, all, from_s, to_s);
  }

 private:
  /// Code of its own for each kind of vehicle: whether it bends, whether its nozzles are listed.
  template <bool kBends, bool kListed>
  MaskOf<T> StepOf(MaskOf<T> moving, bool all, T from_s, T to_s);
  /// A step on its way.
  template <bool kListed>
  struct Trial {
    T length_s, half_s;
    int banks;  ///< whose drives may move
    BankState<T> drives_half[kListed ? kBanks : 1], drives_end[kListed ? kBanks : 1];
    BendingState<T> bent_middle, bent_end;
    Swing<T> over_half, over_step;
    RigidMotion<T> middle, end;
  };
  template <bool kListed>
  void DriveToEnd(MaskOf<T> moving, Trial<kListed>& trial) const;
  template <bool kBends, bool kListed>
  void GoToMiddle(T from_s, Trial<kListed>& trial);
  template <bool kBends, bool kListed>
  void GoToEnd(T to_s, Trial<kListed>& trial);
  template <bool kBends, bool kListed>
  void Correct(Trial<kListed>& trial);
  template <bool kBends, bool kListed>
  MaskOf<T> IsFinite(const Trial<kListed>& trial) const;
  template <bool kBends, bool kListed>
  void Take(MaskOf<T> accepted, bool all, const Trial<kListed>& trial);

  /// Everything of an instant that a step uses.
  struct Point {
    Surroundings<T> around;
    TimedMasses<T> masses;
    Vector<T> cg_velocity;   ///< of C through the body, in I
    Rates<T> rates, slopes;  ///< slopes: of the rates, at the end of a step
    ModalForce<T> modal, modal_slopes;
    Instant<T> instant;
  };

  template <bool kBends, bool kListed>
  void EvaluateStartOf(T time_s) {
    if (!any_stale_) return;
    Point p;
    if (any_moved_) {
      SetAir(motion_.p, p.around);
      Blend<T>(moved_, p.around, start_->around);
      any_moved_ = false;
    }
    SetMasses(time_s, p.masses);
    Blend<T>(stale_, p.masses, start_->masses);
    SetNozzles(kListed);
    Blend<T>(stale_, CgVelocityAt(start_->masses, motion_.q), start_->cg_velocity);
    const ModalForce<T> modal = start_->modal;
    if constexpr (kBends) SetShapes(start_->masses);
    SetRates<kBends, kListed>(motion_, bending_state_, *start_, p.rates, &p.instant);
    Blend<T>(stale_, p.rates, start_->rates);
    Blend<T>(stale_, p.instant, start_->instant);
    const Rates<T> none{Zero<T>(), Zero<T>()};
    Blend<T>(jumped_, none, start_->slopes);
    if constexpr (kBends) {
      const ModalForce<T> no_modal{};
      Blend<T>(!stale_, modal, start_->modal);
      Blend<T>(jumped_, no_modal, start_->modal_slopes);
    }
    stale_ = moved_ = jumped_ = NoLane<T>();
    any_stale_ = false;
  }

  // The parts of an evaluation. Each is a function of its own, shared by a step's two evaluations and the
  // start's. Inlined into each of them and each kind of vehicle, they would take three quarters of the
  // compile time and run no faster.
  DISPERSA_OUT_OF_LINE void SetAir(const Vector<T>& position_m, Surroundings<T>& around) const {
    around = SurroundingsAt(earth_, plant_.weather, position_m);
  }
  DISPERSA_OUT_OF_LINE void SetMasses(T time_s, TimedMasses<T>& masses) const {
    masses = MassesAt(plant_, phase_, time_s);
  }
  DISPERSA_OUT_OF_LINE void SetNozzles(const DriveState<T>& s, const Actuators<T>& gimbal,
                                       const T* commands_rad, Nozzles<T>& nozzles) const {
    nozzles = NozzlesAt(s.angle_rad);
    if (plant_.nozzles_have_mass) SetAccelerations(gimbal, commands_rad, s, nozzles);
  }
  DISPERSA_INLINE void SetNozzles(int bank, bool listed, const BankState<T>& s) const {
    const DriveBank<T>& of = banks_[bank];
    SetNozzles(s.first, of.gimbal, of.command_rad, nozzles_[bank].first);
    if (listed) SetNozzles(s.second, of.gimbal, of.command_rad + kNozzles, nozzles_[bank].second);
  }
  // As the drives stand now.
  DISPERSA_INLINE void SetNozzles(bool listed) const {
    for (int bank = 0; bank < (listed ? plant_.banks : 1); ++bank)
      SetNozzles(bank, listed, banks_[bank].state);
  }
  DISPERSA_OUT_OF_LINE void SetShapes(const TimedMasses<T>& masses) {
    ShapesAt(bending_, masses.propellant_kg);
  }
  template <bool kBends, bool kListed>
  DISPERSA_OUT_OF_LINE void SetRates(const RigidMotion<T>& s, const BendingState<T>& bent_by, Point& at,
                                     Rates<T>& rates, Instant<T>* instant) const {
    rates = RatesOf(earth_.rotation_rate_rad_s, plant_, phase_, Any(phase_.burning), at.around, at.masses,
                    TurnedAs<kListed>(), s, BodyAs<kBends>(bent_by, at.modal), instant);
  }
  DISPERSA_OUT_OF_LINE static void SetDriven(const DriveState<T>& from, const Actuators<T>& gimbal,
                                             const T* commands_rad, const Transition<T>& over, T step_s,
                                             DriveState<T>& to) {
    to = Propagate(gimbal, commands_rad, over, step_s, from);
  }
  /// Over two halves of a step. Banks that a lane's stage does not have stay as they are.
  template <bool kListed>
  DISPERSA_INLINE void Drive(int bank, MaskOf<T> odd, T half_s, BankState<T>& middle,
                             BankState<T>& end) const {
    const DriveBank<T>& of = banks_[bank];
    Transition<T> over = of.over_half;
    if (Any(odd))
      for (int lane = 0; lane < kWidth<T>; ++lane)
        if (Bits(odd) >> lane & 1u) SetTransition(of.gimbal, over, lane, Lane(half_s, lane));
    SetDriven(of.state.first, of.gimbal, of.command_rad, over, half_s, middle.first);
    SetDriven(middle.first, of.gimbal, of.command_rad, over, half_s, end.first);
    if constexpr (kListed) {
      const T* const commands = of.command_rad + kNozzles;
      SetDriven(of.state.second, of.gimbal, commands, over, half_s, middle.second);
      SetDriven(middle.second, of.gimbal, commands, over, half_s, end.second);
      if (bank == 0) return;
      const auto absent = !plant_.bank[bank].driven;
      Blend<T>(absent, of.state, middle);
      Blend<T>(absent, of.state, end);
    }
  }
  DISPERSA_OUT_OF_LINE void SetSwung(const Swing<T>& over, const ModalForce<T>& from,
                                     const ModalForce<T>& rise, const ModalForce<T>& curve,
                                     BendingState<T>& bent) const {
    bent = Swung(bending_, over, bending_state_, from, rise, curve);
  }

  template <bool kListed>
  DISPERSA_INLINE decltype(auto) TurnedAs() const {
    if constexpr (kListed)
      return ListedNozzles<T>{nozzles_};
    else
      return (nozzles_[0].first);
  }
  template <bool kBends>
  DISPERSA_INLINE auto BodyAs(const BendingState<T>& bent_by, ModalForce<T>& modal) const {
    if constexpr (kBends)
      return BentBody<T>{&bending_, &bent_by, &modal};
    else
      return StraightBody{};
  }
  // How C moves through the body where the lanes are turned by q, in I.
  DISPERSA_INLINE Vector<T> CgVelocityAt(const TimedMasses<T>& masses, const Turn<T>& q) const {
    return plant_.flow_coriolis ? CgVelocityOf(masses, q) : Zero<T>();
  }
  // Where some lane carries boosters: without them a lane has the loads that it would have alone.
  DISPERSA_OUT_OF_LINE LargestMoment<T> LargestBesideBoosters(const NormalForce<T>& air,
                                                              const SideForce<T>* side, BodyMotion<T> moved,
                                                              T seen_n_m) const {
    const Point& now = *start_;
    const MotionAbout<T> about{now.masses.cg_station_m,
                               now.masses.cg_y_m,
                               now.masses.cg_z_m,
                               now.masses.inverse_mass_1_kg * now.instant.force_n,
                               motion_.w,
                               now.rates.dw};
    const FlowBeside<T> flow =
        FlowOf(apart_, about, now.instant.mach, now.instant.incidence_rad, now.instant.qbar_pa, air, side);
    const Push<T> push = PushOf(apart_, about,
                                {now.instant.boosters_n + flow.boosters.force_n,
                                 now.instant.boosters_n_m + flow.boosters.moment_n_m});
    const Vector<T> beside = BesideCg(about);
    moved.lateral_y_m_s2 = Select(apart_.attached, beside.y, moved.lateral_y_m_s2);
    moved.lateral_z_m_s2 = Select(apart_.attached, beside.z, moved.lateral_z_m_s2);
    return LargestOfBent(flow.stage, side ? &flow.stage_side : nullptr, moved, seen_n_m,
                         PushLoads<T>{apart_, plant_.sections, about, push});
  }
  template <class Beside>
  DISPERSA_INLINE LargestMoment<T> LargestOfBent(const NormalForce<T>& air, const SideForce<T>* side,
                                                 const BodyMotion<T>& moved, T seen_n_m,
                                                 const Beside& beside) const {
    const Sections<T>& body = plant_.sections;
    if (bending_.modes == 0) return LargestOf(body, air, side, moved, seen_n_m, NoFurtherLoads{}, beside);
    const BendingLoads<T> bending(bending_, bending_state_, start_->modal, body, air, side);
    return LargestOf(body, air, side, moved, seen_n_m, bending, beside);
  }
  static void SetTransition(const Actuators<T>& drives, Transition<T>& over, int lane, double time_s) {
    SetLane(over, lane,
            TransitionOver(Lane(drives.bandwidth2_1_s2, lane), Lane(drives.twice_damping_1_s, lane), time_s));
  }

  // The lane's state or plant has jumped: nothing of the last step's end holds.
  void MarkMoved(int lane) {
    SetLane(moved_, lane, true);
    SetLane(stale_, lane, true);
    SetLane(jumped_, lane, true);
    any_stale_ = any_moved_ = true;
  }
  // The lanes' mass or torque has changed in place.
  void MarkStale(MaskOf<T> lanes) {
    if (!Any(lanes)) return;
    stale_ = stale_ | lanes;
    jumped_ = jumped_ | lanes;
    any_stale_ = true;
  }
  // The lanes' commands have changed, which counts at once where nozzles have mass.
  void MarkCommanded(MaskOf<T> lanes) {
    if (!plant_.nozzles_have_mass) return;
    stale_ = stale_ | lanes;
    any_stale_ = true;
  }
  void ClearCommands(int lane) {
    for (int bank = 0; bank < most_banks_; ++bank)
      for (T& command : banks_[bank].command_rad) Lane(command, lane) = 0.0;
  }
  void SetDrives(int lane, const Gimbal& gimbal, int stuck_nozzle) {
    for (int bank = 0; bank < most_banks_; ++bank) {
      // Those of boosters have drives of their own.
      if (plant_.apart && apart_.turn_nozzles && bank >= apart_.first_bank &&
          (Bits(apart_.attached) >> lane & 1u))
        continue;
      SetDrives(bank, lane, gimbal, stuck_nozzle - bank * kNozzles);
    }
  }
  void SetDrives(int bank, int lane, const Gimbal& gimbal, int stuck_nozzle) {
    SetActuators(banks_[bank].gimbal, lane, gimbal, stuck_nozzle, 0.5 * tick_s_);
    SetTransition(banks_[bank].gimbal, banks_[bank].over_half, lane, 0.5 * tick_s_);
  }
  template <class State>
  static auto& HingeOf(State& bank, int drive) {
    return drive % kDrives < kNozzles ? bank.first : bank.second;
  }

  RigidMotion<T> motion_;
  BendingState<T> bending_state_;
  FlyingPlant<T> plant_;
  BurnPhase<T> phase_;
  StackBending<T> bending_;
  static_assert(kValues<T, RigidMotion<T>> == kRigidBodySize);
  static_assert(kModalState + kValues<T, BendingState<T>> == kBentLauncherSize);

  Earth earth_;
  double tick_s_;
  Point points_[3];
  Point *start_, *middle_, *end_;
  MaskOf<T> stale_, moved_, jumped_;
  bool any_stale_, any_moved_;
  bool has_plain_sections_;                 ///< which neither bend nor carry boosters
  int most_banks_;                          ///< of any stage
  DriveBank<T> banks_[kBanks];              ///< those after the first take no time unless some stage has them
  mutable BankNozzles<T> nozzles_[kBanks];  ///< of the present evaluation
  ApartBoosters<T> apart_;                  ///< unset unless the vehicle has boosters
  SideMasses<T> sides_;                     ///< unset unless the vehicle has masses off the axis
};

/// Steps within this of a tick take the tick's transition of the actuators: it moves a deflection by less
/// than a rounding.
inline constexpr double kSameStep_s = 1e-10;

template <class T>
template <bool kBends, bool kListed>
MaskOf<T> StepState<T>::StepOf(MaskOf<T> moving, bool all, T from_s, T to_s) {
  EvaluateStartOf<kBends, kListed>(from_s);
  Trial<kListed> trial;
  trial.length_s = to_s - from_s;
  trial.half_s = T(0.5) * trial.length_s;
  DriveToEnd(moving, trial);
  GoToMiddle<kBends>(from_s, trial);
  GoToEnd<kBends>(to_s, trial);
  Correct<kBends>(trial);
  const MaskOf<T> accepted = moving & IsFinite<kBends>(trial);
  Take<kBends>(accepted, all && !Any(moving & !accepted), trial);
  return accepted;
}

template <class T>
template <bool kListed>
DISPERSA_INLINE void StepState<T>::DriveToEnd(MaskOf<T> moving, Trial<kListed>& trial) const {
  // In the coast angles, rates and commands are zero, and stay so: nothing reads the nozzles.
  const auto driven = phase_.burning | phase_.burnt;
  trial.banks = !Any(driven) ? 0 : kListed ? plant_.banks : 1;
  const auto odd = moving & driven & (Abs(trial.length_s - T(tick_s_)) > T(kSameStep_s));
  for (int bank = 0; bank < trial.banks; ++bank) {
    Drive<kListed>(bank, odd, trial.half_s, trial.drives_half[bank], trial.drives_end[bank]);
    SetNozzles(bank, kListed, trial.drives_half[bank]);
  }
}

template <class T>
template <bool kBends, bool kListed>
DISPERSA_INLINE void StepState<T>::GoToMiddle(T from_s, Trial<kListed>& trial) {
  const T half = trial.half_s, h2_8 = T(0.125) * (trial.length_s * trial.length_s);
  const Point& a = *start_;
  Point& b = *middle_;
  SetMasses(from_s + half, b.masses);
  if constexpr (kBends) {
    SetShapes(b.masses);
    trial.over_half = SwingOver(bending_, half);
    trial.over_step = Twice(bending_, trial.over_half);
    SetSwung(trial.over_half, a.modal, a.modal_slopes, ModalForce<T>{}, trial.bent_middle);
  }
  RigidMotion<T>& middle = trial.middle;
  middle.p = Along(Along(motion_.p, half, motion_.v), h2_8, a.rates.dv);
  middle.v = Along(Along(motion_.v, half, a.rates.dv), h2_8, a.slopes.dv);
  middle.q = TurnedBy(motion_.q, Along(half * motion_.w, h2_8, a.rates.dw));
  middle.w = Along(Along(motion_.w, half, a.rates.dw), h2_8, a.slopes.dw);
  b.cg_velocity = CgVelocityAt(b.masses, middle.q);
  if (plant_.flow_coriolis) middle.p = Along(middle.p, T(0.5) * half, a.cg_velocity + b.cg_velocity);
  SetAir(middle.p, b.around);
  SetRates<kBends, kListed>(middle, kBends ? trial.bent_middle : bending_state_, b, b.rates, nullptr);
}

/// Position and attitude are final there. The velocities are a guess.
template <class T>
template <bool kBends, bool kListed>
DISPERSA_INLINE void StepState<T>::GoToEnd(T to_s, Trial<kListed>& trial) {
  const T h = trial.length_s, sixth = h * T(1.0 / 6.0), two(2.0);
  const T h2 = h * h, h2_6 = T(1.0 / 6.0) * h2;
  const Point &a = *start_, &b = *middle_;
  Point& c = *end_;
  RigidMotion<T>& end = trial.end;
  end.p = Along(Along(motion_.p, h, motion_.v), h2_6, Along(a.rates.dv, two, b.rates.dv));
  const Vector<T> turn = Along(h * motion_.w, h2_6, Along(a.rates.dw, two, b.rates.dw));
  end.q = TurnedBy(motion_.q, Along(turn, h2 * h * T(1.0 / 12.0), Cross(trial.middle.w, b.rates.dw)));
  end.v = Along(motion_.v, h, b.rates.dv);
  end.w = Along(motion_.w, h, b.rates.dw);
  SetMasses(to_s, c.masses);
  c.cg_velocity = CgVelocityAt(c.masses, end.q);
  if (plant_.flow_coriolis)
    end.p = Along(end.p, sixth, Along(a.cg_velocity + c.cg_velocity, T(4.0), b.cg_velocity));
  SetAir(end.p, c.around);
  if constexpr (kBends) {
    const T per_s = T(1.0) / h;
    ModalForce<T> rising;
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < kModes; ++mode)
        rising.drive_m_s2[plane][mode] =
            two * per_s * (b.modal.drive_m_s2[plane][mode] - a.modal.drive_m_s2[plane][mode]);
    SetSwung(trial.over_step, a.modal, rising, ModalForce<T>{}, trial.bent_end);
    SetShapes(c.masses);
  }
  for (int bank = 0; bank < trial.banks; ++bank) SetNozzles(bank, kListed, trial.drives_end[bank]);
  SetRates<kBends, kListed>(end, kBends ? trial.bent_end : bending_state_, c, c.rates, &c.instant);
}

/// Velocities and bending by all three evaluations, and the slopes at the end.
template <class T>
template <bool kBends, bool kListed>
DISPERSA_INLINE void StepState<T>::Correct(Trial<kListed>& trial) {
  const T h = trial.length_s, sixth = h * T(1.0 / 6.0), per_s = T(1.0) / h;
  const T two(2.0), three(3.0), four(4.0);
  const Point &a = *start_, &b = *middle_;
  Point& c = *end_;
  trial.end.v = Along(motion_.v, sixth, Along(a.rates.dv + c.rates.dv, four, b.rates.dv));
  trial.end.w = Along(motion_.w, sixth, Along(a.rates.dw + c.rates.dw, four, b.rates.dw));
  c.slopes.dv = per_s * Along(Along(a.rates.dv, three, c.rates.dv), -four, b.rates.dv);
  c.slopes.dw = per_s * Along(Along(a.rates.dw, three, c.rates.dw), -four, b.rates.dw);
  if constexpr (kBends) {
    // The parabola a + rise t + curve t² through the three.
    ModalForce<T> rise, curve;
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int mode = 0; mode < kModes; ++mode) {
        const T from = a.modal.drive_m_s2[plane][mode], at = b.modal.drive_m_s2[plane][mode];
        const T to = c.modal.drive_m_s2[plane][mode];
        rise.drive_m_s2[plane][mode] = per_s * (four * at - three * from - to);
        curve.drive_m_s2[plane][mode] = two * per_s * per_s * ((from + to) - two * at);
        c.modal_slopes.drive_m_s2[plane][mode] = per_s * (from + three * to - four * at);
      }
    SetSwung(trial.over_step, a.modal, rise, curve, trial.bent_end);
  }
}

template <class T>
template <bool kBends, bool kListed>
DISPERSA_INLINE MaskOf<T> StepState<T>::IsFinite(const Trial<kListed>& trial) const {
  T none(0.0);  // or not a number
  const auto take = [&none](const auto&... values) { ((none = Fma(values, T(0.0), none)), ...); };
  const RigidMotion<T>& end = trial.end;
  take(end.p.x, end.p.y, end.p.z, end.v.x, end.v.y, end.v.z);
  take(end.q.w, end.q.x, end.q.y, end.q.z, end.w.x, end.w.y, end.w.z);
  for (int bank = 0; bank < trial.banks; ++bank) {
    for (const T& rate : trial.drives_end[bank].first.rate_rad_s) take(rate);
    if constexpr (kListed)
      for (const T& rate : trial.drives_end[bank].second.rate_rad_s) take(rate);
  }
  if constexpr (kBends)
    for (const auto& of_plane : trial.bent_end.q_m)
      for (const T& q_m : of_plane) take(q_m);
  return none <= T(0.0);
}

/// The accepted lanes go to the step's end. `all`: those are all that fly.
template <class T>
template <bool kBends, bool kListed>
DISPERSA_INLINE void StepState<T>::Take(MaskOf<T> accepted, bool all, const Trial<kListed>& trial) {
  if (all) {
    motion_ = trial.end;
    for (int bank = 0; bank < trial.banks; ++bank) {
      banks_[bank].state.first = trial.drives_end[bank].first;
      if constexpr (kListed) banks_[bank].state.second = trial.drives_end[bank].second;
    }
    if constexpr (kBends) bending_state_ = trial.bent_end;
    Point* const last = start_;
    start_ = end_;
    end_ = last;
    return;
  }
  Blend<T>(accepted, trial.end, motion_);
  for (int bank = 0; bank < trial.banks; ++bank) {
    Blend<T>(accepted, trial.drives_end[bank].first, banks_[bank].state.first);
    if constexpr (kListed) Blend<T>(accepted, trial.drives_end[bank].second, banks_[bank].state.second);
  }
  if constexpr (kBends) Blend<T>(accepted, trial.bent_end, bending_state_);
  Blend<T>(accepted, *end_, *start_);
}

}  // namespace DISPERSA_ISA
}  // namespace dispersa::lanes
