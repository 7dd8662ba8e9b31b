// The promises of every control law (core/control/law.h): its state is only in the memory that it is given,
// lanes do not affect each other, and a stage begins as its configuration says.
#include "core/control/axis_step.h"
#include "tests/test.h"
#include "tests/unit/sample_vehicle.h"

namespace dispersa::control_laws_test {
namespace {

constexpr double kTick_s = 0.01;
constexpr int kConfigurations = 40;
constexpr int kTicks = 300;

using Random = std::mt19937_64;

double Within(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
bool Chance(Random& random) { return std::bernoulli_distribution(0.5)(random); }

// An axis of this law with anything that a file may set.
AxisConfig AnyAxis(ControlLaw law, Random& random) {
  AxisConfig axis = SampleAxis(law);
  for (AxisGains& gains : axis.gains) gains = {Within(random, 1.0, 60.0), Within(random, 1.0, 15.0)};
  Adaptation& a = axis.adaptation;
  for (double& gamma : a.gamma) gamma = Chance(random) ? Within(random, 0.0, 40000.0) : 0.0;
  if (Chance(random)) a.projection_bound_rad_s2 = Within(random, 0.001, 1.0);
  if (Chance(random)) a.leakage_1_s = Within(random, 0.0, 2.0);
  if (Chance(random)) a.spread_1_s = Within(random, 0.0, 100.0);
  if (Chance(random)) a.dead_zone_rad = Within(random, 0.0, 0.001);
  if (Chance(random)) a.composite = Within(random, 0.0, 20.0);
  if (Chance(random)) a.supervisory_bound = 1e-7;
  a.predictor_1_s = Within(random, 0.0, 10.0);
  a.normalized = Chance(random);
  a.freeze_when_saturated = Chance(random);
  a.reset_at_ignition = Chance(random);
  if (Chance(random)) axis.integral.bound_rad_s2 = Within(random, 0.001, 1.0);
  axis.integral.reset_at_ignition = Chance(random);
  axis.augmentation = {.adaptive_gain_1_s = Within(random, 0.0, 1e5),
                       .leakage_1_s = Within(random, 0.0, 1.0),
                       .spectral_gain_1_s = Within(random, 0.0, 100.0),
                       .high_pass_rad_s = Within(random, 5.0, 20.0),
                       .low_pass_rad_s = Within(random, 1.0, 5.0),
                       .minimum_total_gain = 0.5,
                       .maximum_total_gain = 1.6};
  return axis;
}

// The inputs of an axis at a tick.
struct Tick {
  double error_rad, rate_rad_s, foreign_rad_s2, saturation;
};
std::vector<Tick> AnyTicks(Random& random) {
  std::vector<Tick> ticks(kTicks);
  const double scale = std::pow(10.0, Within(random, -5.0, -0.5));  // up to beyond the outer sets
  for (Tick& tick : ticks) {
    tick = {Within(random, -scale, scale), Within(random, -scale, scale), Within(random, -1.0, 1.0),
            static_cast<double>(static_cast<int>(Within(random, -2.0, 2.0)))};
  }
  return ticks;
}

// One tick of one lane, by the law itself.
double StepAlone(const AxisLaw& law, int stage, const Tick& tick, AxisState& state, bool is_reported = true) {
  const StageLaw& of_stage = law.stages[static_cast<std::size_t>(stage)];
  AxisMemory<double> memory;
  lanes::SetLaneValues<double>(memory, 0, state);
  memory.saturation = tick.saturation;
  const lanes::LawInput<double> input{
      law.config,           kTick_s,    of_stage, true, tick.error_rad, tick.rate_rad_s,
      &tick.foreign_rad_s2, is_reported};
  lanes::AxisOutput<double> output{};
  output.v = 1e-7;
  lanes::WithLaw(law.config.law,
                 [&](auto each) { decltype(each)::template Step<true>(input, output, memory); });
  lanes::ReadLaneValues<double>(memory, 0, state);
  return output.command_rad_s2;
}
void Ignite(const AxisConfig& config, int stage, AxisState& state) {
  lanes::WithLaw(config.law, [&](auto law) { decltype(law)::StartStage(config, stage, state); });
}

bool Same(const AxisState& a, const AxisState& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
std::uint64_t Bits(double x) { return __builtin_bit_cast(std::uint64_t, x); }

class ControlLaws : public testing::TestWithParam<ControlLaw> {
 protected:
  // `check` with this law in many configurations.
  template <class Check>
  void ForMany(Check check) {
    for (int i = 0; i < kConfigurations && !HasFatalFailure(); ++i) {
      SCOPED_TRACE(i);
      Random random(static_cast<std::uint64_t>(i));
      const AxisLaw law = BuildAxisLaw(AnyAxis(GetParam(), random), kTick_s);
      check(law, random);
    }
  }
};

std::vector<ControlLaw> AllLaws() {
  std::vector<ControlLaw> laws;
  for (const LawInfo& info : kLaws) laws.push_back(info.law);
  return laws;
}

INSTANTIATE_TEST_SUITE_P(All, ControlLaws, testing::ValuesIn(AllLaws()),
                         [](const auto& law) { return InfoOf(law.param).name; });

TEST_P(ControlLaws, GoOnFromACopyOfTheirMemory) {
  ForMany([](const AxisLaw& law, Random& random) {
    const std::vector<Tick> ticks = AnyTicks(random), others = AnyTicks(random);
    AxisState state, copy, other;
    for (int i = 0; i < kTicks; ++i) {
      if (i == kTicks / 2) copy = state;
      StepAlone(law, 0, ticks[static_cast<std::size_t>(i)], state);
    }
    for (int i = kTicks / 2; i < kTicks; ++i) {
      StepAlone(law, 1, others[static_cast<std::size_t>(i)], other);  // another flight, in between
      StepAlone(law, 0, ticks[static_cast<std::size_t>(i)], copy);
    }
    ASSERT_TRUE(Same(state, copy));
  });
}

AxisState AfterAFlight(const AxisLaw& law, Random& random) {
  AxisState state;
  for (const Tick& tick : AnyTicks(random)) StepAlone(law, 0, tick, state);
  return state;
}

TEST_P(ControlLaws, KnowNothingOfAFlightBefore) {
  ForMany([](const AxisLaw& law, Random& random) {
    AxisState used = AfterAFlight(law, random);
    Ignite(law.config, 0, used);
    AxisState fresh;
    fresh.rules_fired = used.rules_fired;  // a record of the flight
    ASSERT_TRUE(Same(used, fresh));
  });
}

TEST_P(ControlLaws, KeepAtAnIgnitionAllOrNothing) {
  ForMany([](const AxisLaw& law, Random& random) {
    const AxisState used = AfterAFlight(law, random);
    AxisState next = used, fresh;
    fresh.rules_fired = used.rules_fired;
    Ignite(law.config, 1, next);
    const LawInfo& info = InfoOf(law.config.law);
    const bool anew = info.augmentation || (info.rules && law.config.adaptation.reset_at_ignition) ||
                      (info.integral && law.config.integral.reset_at_ignition);
    ASSERT_TRUE(Same(next, anew ? fresh : used));
  });
}

TEST_P(ControlLaws, CommandNothingOfNoErrorAtFirst) {
  ForMany([](const AxisLaw& law, Random&) {
    AxisState state;
    ASSERT_EQ(StepAlone(law, 0, {}, state), 0.0);
  });
}

// Built-in laws command of what they are given, a plug-in's axis what the plug-in did.
TEST_P(ControlLaws, TakeAForeignCommandOnlyFromAPlugin) {
  ForMany([](const AxisLaw& law, Random& random) {
    std::vector<Tick> ticks = AnyTicks(random);
    AxisState state, other;
    for (Tick tick : ticks) {
      const double command = StepAlone(law, 0, tick, state);
      if (InfoOf(law.config.law).foreign) {
        ASSERT_EQ(command, tick.foreign_rad_s2);
        tick.error_rad = -tick.error_rad;
      } else {
        tick.foreign_rad_s2 = -tick.foreign_rad_s2;
      }
      ASSERT_EQ(Bits(command), Bits(StepAlone(law, 0, tick, other)));
    }
    ASSERT_TRUE(Same(state, other));
  });
}

// Lanes of `T` with flights and stages of their own, of which some do not act: each has the bits of one
// alone.
template <class T>
void FlyBesideOthers(const AxisLaw& law, Random& random) {
  constexpr int kLanes = lanes::kWidth<T>;
  StageLawOf<T> stage;
  AxisMemory<T> memory;
  AxisState alone[kLanes];
  std::vector<Tick> ticks[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    lanes::SetLane(stage, lane, law.stages[static_cast<std::size_t>(lane % 2)]);
    lanes::SetLaneValues<T>(memory, lane, alone[lane]);
    ticks[lane] = AnyTicks(random);
  }
  for (std::size_t i = 0; i < kTicks; ++i) {
    T error, rate, foreign;
    lanes::MaskOf<T> acting = lanes::NoLane<T>();
    bool acts[kLanes], all = true;
    for (int lane = 0; lane < kLanes; ++lane) {
      const Tick& tick = ticks[lane][i];
      lanes::Lane(error, lane) = tick.error_rad;
      lanes::Lane(rate, lane) = tick.rate_rad_s;
      lanes::Lane(foreign, lane) = tick.foreign_rad_s2;
      acts[lane] = i % 3 == 0 || Chance(random);
      all = all && acts[lane];
      lanes::SetLane(acting, lane, acts[lane]);
      if (acts[lane]) lanes::Lane(memory.saturation, lane) = tick.saturation;
    }
    const bool is_reported = i % 2 == 0;
    const lanes::LawInput<T> input{law.config, kTick_s, stage, acting, error, rate, &foreign, is_reported};
    lanes::AxisOutput<T> output{};
    output.v = T(1e-7);
    lanes::WithLaw(law.config.law, [&](auto each) {
      if (all) {
        decltype(each)::template Step<true>(input, output, memory);
      } else {
        decltype(each)::template Step<false>(input, output, memory);
      }
    });
    for (int lane = 0; lane < kLanes; ++lane) {
      AxisState beside;
      if (acts[lane]) {
        AxisState reported = alone[lane];
        const double expected = StepAlone(law, lane % 2, ticks[lane][i], alone[lane], is_reported);
        // A report changes nothing but what it counts.
        ASSERT_EQ(Bits(StepAlone(law, lane % 2, ticks[lane][i], reported)), Bits(expected));
        reported.rules_fired = alone[lane].rules_fired;
        ASSERT_TRUE(Same(reported, alone[lane]));
        ASSERT_EQ(Bits(lanes::Lane(output.command_rad_s2, lane)), Bits(expected))
            << "tick " << i << ", lane " << lane;
      }
      lanes::ReadLaneValues<T>(memory, lane, beside);
      ASSERT_TRUE(Same(beside, alone[lane]))
          << "tick " << i << ", lane " << lane << (acts[lane] ? "" : ", at rest");
    }
  }
}

TEST_P(ControlLaws, FlyBesideOthersAsAlone) {
  ForMany([](const AxisLaw& law, Random& random) {
    FlyBesideOthers<double>(law, random);
    FlyBesideOthers<lanes::Pack<4>>(law, random);
    FlyBesideOthers<lanes::Pack<8>>(law, random);
  });
}

// An axis without filters commands what its law does.
TEST_P(ControlLaws, AreWhatTheirAxisFlies) {
  ForMany([](const AxisLaw& law, Random& random) {
    if (InfoOf(law.config.law).foreign) return;  // StepAxis of one axis has no plug-in
    AxisLaw without_bound = law;
    without_bound.config.adaptation.supervisory_bound = 0.0;  // V is the axis'
    AxisState of_law, of_axis;
    AxisTelemetry telemetry;
    for (const Tick& tick : AnyTicks(random)) {
      of_axis.saturation = tick.saturation;
      const double command =
          StepAxis(without_bound, 0, tick.error_rad, tick.rate_rad_s, 1.0, 1.0, kTick_s, of_axis, telemetry);
      ASSERT_EQ(Bits(command), Bits(StepAlone(without_bound, 0, tick, of_law)));
    }
    of_law.previous_v = of_axis.previous_v;
    ASSERT_TRUE(Same(of_law, of_axis));
  });
}

}  // namespace
}  // namespace dispersa::control_laws_test
