// Made-up results: what a flight without dispersions applies.
#pragma once

#include <vector>

#include "core/campaign/case_result.h"
#include "core/flight/flight_inputs.h"

namespace dispersa {

/// A result of a campaign of four stages without dispersions: its rows hold no input.
inline void ApplyNominal(CaseResult& result) {
  static const RowInputs rows{Campaign{}};
  SetInputs(rows, InputValues({}), result);
}

/// A result of a campaign whose rows hold the inputs of `rows`, each with this value.
inline void ApplyEverywhere(const RowInputs& rows, double value, CaseResult& result) {
  SetInputs(rows, rows.AllOf(std::vector<double>(rows.positions().size(), value)), result);
}

}  // namespace dispersa
