// The step of one width for one instruction set. It is compiled once for each set (CMakeLists.txt), by the
// rules of core/flight/fly_lanes.cc.
#include "tests/benchmarks/step_instances.h"

#include "core/flight/simpson_step.h"
#include "core/math/lane_instance.h"

namespace dispersa {
namespace {

using Value = LaneValue<DISPERSA_LANES>;

// Every value and lane set before the first step.
lanes::StepState<Value>* NewStep(const StepSetting& setting) {
  lanes::StepState<Value>* step = new lanes::StepState<Value>();
  step->Configure(*setting.plant, setting.tick_s);
  for (int lane = 0; lane < DISPERSA_LANES; ++lane) {
    step->StartFlight(lane, *setting.weather, setting.y);
    step->SetStack(lane, *setting.plant, 0);
    if (setting.burning) step->Ignite(lane, 0.0, false);
  }
  return step;
}

}  // namespace

void DISPERSA_INSTANCE(Step, DISPERSA_LANES)(const StepSetting& setting, long ticks, double* y) {
  lanes::StepState<Value>* step = NewStep(setting);
  const long ticks_a_second = static_cast<long>(1.0 / setting.tick_s);
  const auto all = !lanes::NoLane<Value>();
  for (long i = 0; i < ticks; ++i) {
    const long since = i % ticks_a_second;
    for (int lane = 0; since == 0 && lane < DISPERSA_LANES; ++lane) step->WriteLane(lane, setting.y);
    const double from_s = setting.from_s + static_cast<double>(since) * setting.tick_s;
    step->Step(all, true, Value(from_s), Value(from_s + setting.tick_s));
  }
  step->ReadLane(0, y);
  delete step;
}

void DISPERSA_INSTANCE(Evaluate, DISPERSA_LANES)(const StepSetting& setting, long evaluations, double* dv) {
  lanes::StepState<Value>* at = NewStep(setting);
  const Earth& earth = setting.plant->environment.earth;
  lanes::Rates<Value> rates;
  for (long i = 0; i < evaluations; ++i) {
    const lanes::Surroundings<Value> around =
        lanes::SurroundingsAt(earth, at->plant().weather, at->motion().p);
    const lanes::TimedMasses<Value> masses = lanes::MassesAt(at->plant(), at->phase(), Value(setting.from_s));
    const lanes::Nozzles<Value> nozzles = lanes::NozzlesAt(at->drives(0).first.angle_rad);
    rates = lanes::RatesOf<Value>(earth.rotation_rate_rad_s, at->plant(), at->phase(), setting.burning,
                                  around, masses, nozzles, at->motion(), lanes::StraightBody{}, nullptr);
    // The compiler may neither keep what the next evaluation reads nor leave out what this one found.
    asm volatile("" : : "r"(at), "r"(&rates) : "memory");
  }
  dv[0] = lanes::Lane(rates.dv.x, 0);
  dv[1] = lanes::Lane(rates.dv.y, 0);
  dv[2] = lanes::Lane(rates.dv.z, 0);
  delete at;
}

}  // namespace dispersa
