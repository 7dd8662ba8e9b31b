#include "core/results/sampling_text.h"

namespace dispersa {

const char* SamplingMethodName(SamplingMethod method) {
  switch (method) {
    case SamplingMethod::kMonteCarlo:
      return "monte_carlo";
    case SamplingMethod::kLatinHypercube:
      return "latin_hypercube";
    case SamplingMethod::kSobol:
      return "sobol";
    case SamplingMethod::kCorners:
      return "corners";
    case SamplingMethod::kOneAtATime:
      return "one_at_a_time";
    case SamplingMethod::kGrid:
      return "grid";
    case SamplingMethod::kList:
      return "list";
  }
  return "";
}

const char* SamplingMethodTitle(SamplingMethod method) {
  switch (method) {
    case SamplingMethod::kMonteCarlo:
      return "Monte Carlo";
    case SamplingMethod::kLatinHypercube:
      return "Latin hypercube";
    case SamplingMethod::kSobol:
      return "Sobol sequence";
    case SamplingMethod::kCorners:
      return "corners";
    case SamplingMethod::kOneAtATime:
      return "one at a time";
    case SamplingMethod::kGrid:
      return "grid";
    case SamplingMethod::kList:
      return "list of cases";
  }
  return "";
}

bool IsEnumerated(SamplingMethod method) {
  return method == SamplingMethod::kCorners || method == SamplingMethod::kOneAtATime ||
         method == SamplingMethod::kGrid || method == SamplingMethod::kList;
}

}  // namespace dispersa
