// Inputs of a case that follow from drawn ones by an expression.
#pragma once

#include <string>
#include <vector>

#include "core/expressions/expression.h"
#include "core/flight/flight_inputs.h"
#include "core/input/fields.h"

namespace dispersa {

struct Dispersion;

/// `input` = `text`, both by names and units of the columns of cases.csv without their prefix.
struct DerivedInput {
  std::string input;
  std::string text;
  int column = -1;             ///< of `input` (FindInput)
  Expression expression = {};  ///< of the values of all columns
};

/// The keys of one derived input. `before` are the derived ones ahead of it.
void Describe(Fields& fields, DerivedInput& derived, const std::vector<DerivedInput>& before,
              const std::vector<Dispersion>& dispersions, const Vehicle& vehicle);

/// Sets derived inputs from the drawn ones. Not finite where an expression is undefined.
void Derive(const std::vector<DerivedInput>& derived, FlightInputs& inputs);

}  // namespace dispersa
