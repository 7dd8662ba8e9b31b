#include "core/margins/dispersed_margins.h"

#include <algorithm>
#include <cmath>

#include "core/optimization/parallel_for.h"

namespace dispersa {
namespace {

// A case's contribution. Whole sets of margins of many cases would fill the memory.
struct CaseMargins {
  bool ended_early = false;
  bool passed = true;
  std::vector<LeastLoopMargins> loops;
};

void Take(double value, std::uint64_t case_index, double time_s, LeastMargin& least) {
  if (value < least.value) least = {value, case_index, time_s};
}

LeastLoopMargins& LoopOf(int stage, Axis axis, std::vector<LeastLoopMargins>& loops) {
  const auto found = std::find_if(loops.begin(), loops.end(), [&](const LeastLoopMargins& loop) {
    return loop.stage == stage && loop.axis == axis;
  });
  if (found != loops.end()) return *found;
  const LeastMargin none{HUGE_VAL, 0, 0.0};
  return loops.emplace_back(LeastLoopMargins{stage, axis, none, none, none, none});
}

void Take(const LeastLoopMargins& from, LeastLoopMargins& least) {
  for (const auto margin : {&LeastLoopMargins::gain_up_db, &LeastLoopMargins::gain_down_db,
                            &LeastLoopMargins::phase_deg, &LeastLoopMargins::delay_s})
    Take((from.*margin).value, (from.*margin).case_index, (from.*margin).time_s, least.*margin);
}

CaseMargins MarginsOf(const CampaignFlights& flights, std::uint64_t case_index, LateralPath path) {
  FlightOrder order{flights.Draw(case_index), {}};
  order.options.case_index = case_index;
  const DispersedMargins flown = ComputeDispersedMargins(flights.model(), order, 5.0, path);
  CaseMargins found;
  found.ended_early = flown.outcome != Outcome::kCompleted;
  for (const ComputedMargins& at : flown.margins) {
    found.passed = found.passed && PassesDispersedGates(at);
    LeastLoopMargins& loop = LoopOf(at.stage, at.axis, found.loops);
    const auto take = [&](const LoopMargins& m) {
      Take(m.gain_up_db, case_index, at.time_s, loop.gain_up_db);
      Take(m.gain_down_db, case_index, at.time_s, loop.gain_down_db);
      Take(m.phase_deg, case_index, at.time_s, loop.phase_deg);
      Take(m.delay_s, case_index, at.time_s, loop.delay_s);
    };
    take(at.frozen);
    take(at.adapting);
    if (at.learnt) take(*at.learnt);
  }
  return found;
}

}  // namespace

CampaignMargins ComputeCampaignMargins(const CampaignFlights& flights, std::uint64_t cases, int threads,
                                       LateralPath path) {
  std::vector<CaseMargins> of_case(cases);
  ParallelFor(cases, static_cast<std::size_t>(threads),
              [&](std::size_t i) { of_case[i] = MarginsOf(flights, i, path); });
  CampaignMargins all;
  all.cases = cases;
  for (std::uint64_t i = 0; i < cases; ++i) {
    all.ended_early += of_case[i].ended_early;
    if (!of_case[i].passed) all.missed.push_back(i);
    for (const LeastLoopMargins& loop : of_case[i].loops)
      Take(loop, LoopOf(loop.stage, loop.axis, all.loops));
  }
  std::stable_sort(all.loops.begin(), all.loops.end(),
                   [](const LeastLoopMargins& a, const LeastLoopMargins& b) { return a.stage < b.stage; });
  return all;
}

}  // namespace dispersa
