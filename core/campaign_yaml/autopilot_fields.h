// The keys of an autopilot's blocks, declared once: whoever reads, writes or lists them visits them here.
//
// A visitor `f` has a function for each kind of key; `A` is const where it only reads:
//   f.Quantity(stem, dimension, range, value)         a number with a unit
//   f.Number(key, range, value)                       a number without one
//   f.Guard, f.NumberGuard                            the same; 0, which is off, where absent
//   f.Flag(key, value)                                false where absent
//   f.EachStage(key, range, values)                   a list of one number a stage
//   f.Stage(key, stage)                               1-based; 0, all of them, where absent
//   f.Sections(key, sections)                         a list of filter sections; as before where absent
//   f.OfOtherLaws(key)                                read by laws that this one is compared with
//   f.Matrix(key, value), f.OptionalPair(key, value)  [[a, b], [b, c]]; [a, b] or nothing
#pragma once

#include "core/input/units.h"
#include "core/input/map_reader.h"
#include "core/control/autopilot_config.h"

namespace dispersa {

/// Of actuators and delays: a second would be another program.
inline constexpr Range kLead = {0.0, 1.0, false, false};

template <class F, class A>
void VisitGains(F& f, A& gains) {
  f.Quantity("kp", kPerTimeSquared, kPositive, gains.kp_1_s2);
  f.Quantity("kd", kPerTime, kPositive, gains.kd_1_s);
}

template <class F, class A>
void VisitRules(F& f, A& rules) {
  f.Quantity("error_range", kAngle, kPositive, rules.error_range_rad);
  f.Quantity("rate_range", kAngularRate, kPositive, rules.rate_range_rad_s);
}

template <class F, class A>
void VisitAdaptation(F& f, A& adaptation) {
  f.EachStage("gamma", kNonNegative, adaptation.gamma);
  f.Matrix("q", adaptation.q);
  f.OptionalPair("p_n", adaptation.p_n);
  f.Flag("allow_unproven", adaptation.allow_unproven);
  f.Guard("projection_bound", kAngularAcceleration, kNonNegative, adaptation.projection_bound_rad_s2);
  f.Guard("leakage", kPerTime, kNonNegative, adaptation.leakage_1_s);
  f.Guard("spread", kPerTime, kNonNegative, adaptation.spread_1_s);
  f.Guard("dead_zone", kAngle, kNonNegative, adaptation.dead_zone_rad);
  f.Flag("normalized", adaptation.normalized);
  f.NumberGuard("composite", kNonNegative, adaptation.composite);
  f.Guard("predictor", kPerTime, kNonNegative, adaptation.predictor_1_s);
  f.Flag("freeze_when_saturated", adaptation.freeze_when_saturated);
  f.Flag("reset_at_ignition", adaptation.reset_at_ignition);
  f.NumberGuard("supervisory_bound", kNonNegative, adaptation.supervisory_bound);
}

template <class F, class A>
void VisitIntegral(F& f, A& integral) {
  f.EachStage("ki_1_s3", kNonNegative, integral.ki_1_s3);
  f.Guard("bound", kAngularAcceleration, kNonNegative, integral.bound_rad_s2);
  f.Flag("reset_at_ignition", integral.reset_at_ignition);
}

template <class F, class A>
void VisitAugmentation(F& f, A& augmentation) {
  f.Quantity("adaptive_gain", kPerTime, kNonNegative, augmentation.adaptive_gain_1_s);
  f.Quantity("leakage", kPerTime, kNonNegative, augmentation.leakage_1_s);
  f.Quantity("spectral_gain", kPerTime, kNonNegative, augmentation.spectral_gain_1_s);
  f.Quantity("high_pass", kFrequency, kPositive, augmentation.high_pass_rad_s);
  f.Quantity("low_pass", kFrequency, kPositive, augmentation.low_pass_rad_s);
  f.Number("minimum_total_gain", kPositive, augmentation.minimum_total_gain);
  f.Number("maximum_total_gain", kPositive, augmentation.maximum_total_gain);
}

template <class F, class A>
void VisitFeedForward(F& f, A& feed_forward) {
  f.Quantity("lead", kTime, kLead, feed_forward.lead_s);
}

template <class F, class A>
void VisitSection(F& f, A& section) {
  f.Guard("zeros", kFrequency, kPositive, section.zeros_rad_s);
  f.NumberGuard("zeros_damping", kNonNegative, section.zeros_damping);
  f.Quantity("poles", kFrequency, kPositive, section.poles_rad_s);
  f.Number("poles_damping", kPositive, section.poles_damping);
}

template <class F, class A>
void VisitFilter(F& f, A& section) {
  VisitSection(f, section);
  f.Stage("stage", section.stage);
}

template <class F, class A>
void VisitScheduleEntry(F& f, const LawInfo& law, A& entry) {
  f.Stage("stage", entry.stage);
  f.Quantity("at", kTime, kPositive, entry.at_s);
  VisitGains(f, entry.gains);
  if (law.integral)
    f.Number("ki_1_s3", kNonNegative, entry.ki_1_s3);
  else
    f.OfOtherLaws("ki_1_s3");
  f.Sections("filters", entry.filters);
}

/// on(key, whether the axis' law needs it, visit) for each block; `visit` takes a visitor.
template <class A, class On>
void EachBlock(A& axis, On on) {
  const LawInfo& law = InfoOf(axis.law);
  on("rules", law.rules, [&](auto& f) { VisitRules(f, axis.rules); });
  on("adaptation", law.adaptation, [&](auto& f) { VisitAdaptation(f, axis.adaptation); });
  on("integral", law.integral, [&](auto& f) { VisitIntegral(f, axis.integral); });
  on("augmentation", law.augmentation, [&](auto& f) { VisitAugmentation(f, axis.augmentation); });
}

}  // namespace dispersa
