// The keys of an autopilot's file, declared once: Describe() reads them and makes their schema,
// WriteAutopilot() writes them.
//
// The blocks of an axis are written in a form of their own, so they are declared to any visitor `f` that has
// a function for each kind of key (AxisFields here, the writer there); `A` is const where it only reads:
//   f.Quantity(stem, dimension, range, value)         a number with a unit
//   f.Number(key, range, value)                       a number without one
//   f.Guard, f.NumberGuard                            the same; 0, which is off, where absent
//   f.Flag(key, value)                                false where absent
//   f.EachStage(key, range, values)                   a list of one number a stage
//   f.Stage(key, stage)                               1-based; 0, all of them, where absent
//   f.Sections(key, sections)                         a list of filter sections; as before where absent
//   f.OfOtherLaws(key)                                read by laws that this one is compared with
//   f.Matrix(key, value), f.OptionalPair(key, value)  [[a, b], [b, c]]; [a, b] or nothing
// Each takes what documentation says of the key last.
#pragma once

#include "core/control/autopilot_config.h"
#include "core/input/fields.h"

namespace dispersa {

/// Of actuators and delays: a second would be another program.
inline constexpr Range kLead = {0.0, 1.0, false, false};

template <class F, class A>
void VisitGains(F& f, A& gains) {
  f.Quantity("kp", kPerTimeSquared, kPositive, gains.kp_1_s2, "of the error dynamics s^2 + kd s + kp");
  f.Quantity("kd", kPerTime, kPositive, gains.kd_1_s, "of those dynamics");
}

template <class F, class A>
void VisitRules(F& f, A& rules) {
  f.Quantity("error_range", kAngle, kPositive, rules.error_range_rad, "outer set centres of the error, +-");
  f.Quantity("rate_range", kAngularRate, kPositive, rules.rate_range_rad_s,
             "outer set centres of its rate, +-");
}

template <class F, class A>
void VisitAdaptation(F& f, A& adaptation) {
  f.EachStage("gamma", kNonNegative, adaptation.gamma, "adaptation gain, one a stage");
  f.Matrix("q", adaptation.q, "Q of the Lyapunov equation, symmetric positive definite");
  f.OptionalPair("p_n", adaptation.p_n,
                 "last column of P; it follows from gains and Q, and must agree with them");
  f.Flag("allow_unproven", adaptation.allow_unproven, "a P_n that does not follow from gains and Q is flown");
  f.Guard("projection_bound", kAngularAcceleration, kNonNegative, adaptation.projection_bound_rad_s2,
          "each consequent stays within this distance of its start; 0: anywhere");
  f.Guard("leakage", kPerTime, kNonNegative, adaptation.leakage_1_s,
          "sigma modification: pulls the consequents to their start");
  f.Guard("spread", kPerTime, kNonNegative, adaptation.spread_1_s,
          "pulls departures from the start to their mean over the rules");
  f.Guard("dead_zone", kAngle, kNonNegative, adaptation.dead_zone_rad,
          "no adaptation while |e' P_n| / p12 is below");
  f.Flag("normalized", adaptation.normalized, "the regressor of (32) over its squared norm");
  f.NumberGuard("composite", kNonNegative, adaptation.composite,
                "so many p22 of the prediction's error drive (32) besides");
  f.Guard("predictor", kPerTime, kNonNegative, adaptation.predictor_1_s,
          "how fast the prediction is drawn to what is measured");
  f.Flag("freeze_when_saturated", adaptation.freeze_when_saturated, "no adaptation into a deflection limit");
  f.Flag("reset_at_ignition", adaptation.reset_at_ignition, "consequents start anew with each stage");
  f.NumberGuard("supervisory_bound", kNonNegative, adaptation.supervisory_bound,
                "the supervisory term acts while V exceeds it; 0: never");
}

template <class F, class A>
void VisitIntegral(F& f, A& integral) {
  f.EachStage("ki_1_s3", kNonNegative, integral.ki_1_s3, "gain of the integral, one a stage");
  f.Guard("bound", kAngularAcceleration, kNonNegative, integral.bound_rad_s2,
          "of the integral's share; 0: none");
  f.Flag("reset_at_ignition", integral.reset_at_ignition, "it starts anew with each stage");
}

template <class F, class A>
void VisitAugmentation(F& f, A& augmentation) {
  f.Quantity("adaptive_gain", kPerTime, kNonNegative, augmentation.adaptive_gain_1_s,
             "on the square of the departure from the reference model, in rad");
  f.Quantity("leakage", kPerTime, kNonNegative, augmentation.leakage_1_s, "draws the total gain to 1");
  f.Quantity("spectral_gain", kPerTime, kNonNegative, augmentation.spectral_gain_1_s,
             "on the square of the command's fast part, in rad/s^2");
  f.Quantity("high_pass", kFrequency, kPositive, augmentation.high_pass_rad_s,
             "of the spectral damper, above the loop's bandwidth");
  f.Quantity("low_pass", kFrequency, kPositive, augmentation.low_pass_rad_s, "of the spectral damper");
  f.Number("minimum_total_gain", kPositive, augmentation.minimum_total_gain, "floor");
  f.Number("maximum_total_gain", kPositive, augmentation.maximum_total_gain, "ceiling");
}

template <class F, class A>
void VisitFeedForward(F& f, A& feed_forward) {
  f.Quantity("lead", kTime, kLead, feed_forward.lead_s,
             "by what the program is read ahead: delay and actuators");
}

template <class F, class A>
void VisitSection(F& f, A& section) {
  f.Guard("zeros", kFrequency, kPositive, section.zeros_rad_s, "of a notch; without, a low pass");
  f.NumberGuard("zeros_damping", kNonNegative, section.zeros_damping, "of them");
  f.Quantity("poles", kFrequency, kPositive, section.poles_rad_s, "of the section");
  f.Number("poles_damping", kPositive, section.poles_damping, "of them");
}

template <class F, class A>
void VisitFilter(F& f, A& section) {
  VisitSection(f, section);
  f.Stage("stage", section.stage, "in whose burn it acts; without, in all");
}

template <class F, class A>
void VisitScheduleEntry(F& f, const LawInfo& law, A& entry) {
  f.Stage("stage", entry.stage, "whose burn it is");
  f.Quantity("at", kTime, kPositive, entry.at_s, "since its ignition");
  VisitGains(f, entry.gains);
  if (law.integral)
    f.Number("ki_1_s3", kNonNegative, entry.ki_1_s3, "gain of the integral, of a law that has one");
  else
    f.OfOtherLaws("ki_1_s3", "gain of the integral, of a law that has one");
  f.Sections("filters", entry.filters, "in place of those before, as many and in their order");
}

/// on(key, LawInfo's word on whether a law needs it, visit, meaning) for each block; `visit` takes a visitor.
template <class A, class On>
void EachBlock(A& axis, On on) {
  on(
      "rules", &LawInfo::rules, [&](auto& f) { VisitRules(f, axis.rules); }, "fuzzy sets");
  on(
      "adaptation", &LawInfo::adaptation, [&](auto& f) { VisitAdaptation(f, axis.adaptation); },
      "equation (32)");
  on(
      "integral", &LawInfo::integral, [&](auto& f) { VisitIntegral(f, axis.integral); }, "of a PID law");
  on(
      "augmentation", &LawInfo::augmentation, [&](auto& f) { VisitAugmentation(f, axis.augmentation); },
      "adaptive augmenting control");
}

/// The keys of an autopilot's file but for its schema. A plug-in is read by `plugin`.
void Describe(Fields& fields, AutopilotConfig& autopilot, const Fields::ReadNode& plugin);

}  // namespace dispersa
