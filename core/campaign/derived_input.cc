#include "core/campaign/derived_input.h"

#include <algorithm>
#include <cmath>

#include "core/campaign/campaign.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"

namespace dispersa {
namespace {

constexpr char kNames[] = "a column of cases.csv without 'input_', such as thrust_factor_stage1";

const DerivedInput* Find(const std::vector<DerivedInput>& derived, const std::string& input) {
  const auto found = std::find_if(derived.begin(), derived.end(),
                                  [&](const DerivedInput& one) { return one.input == input; });
  return found == derived.end() ? nullptr : &*found;
}

std::string UnknownText(const std::string& name, const Vehicle& vehicle) {
  return "'" + name + "' is not an input of this vehicle's flights" + DidYouMean(name, InputNamesOf(vehicle));
}

bool IsKnown(const std::string& name, const Vehicle& vehicle) {
  const int column = FindInput(name);
  return column >= 0 && HasInput(vehicle, column);
}

double Value(const DerivedInput& derived, const FlightInputs& inputs) {
  return derived.expression.Evaluate(InputValues(inputs, kMaxStages + kFurtherNozzles).data());
}

}  // namespace

void Describe(Fields& fields, DerivedInput& derived, const std::vector<DerivedInput>& before,
              const std::vector<Dispersion>& dispersions, const Vehicle& vehicle) {
  fields.Text("input", derived.input, "a column of cases.csv without its prefix");
  fields.Text("expression", derived.text, "from drawn columns, in their units");
  if (derived.input.empty() || derived.text.empty()) return;
  if (!IsKnown(derived.input, vehicle))
    return fields.Refuse("input", UnknownText(derived.input, vehicle), kNames);
  derived.column = FindInput(derived.input);
  for (const Dispersion& dispersion : dispersions)
    if (!dispersion.replaces && std::find(dispersion.inputs.begin(), dispersion.inputs.end(),
                                          derived.column) != dispersion.inputs.end())
      return fields.Refuse("input",
                           "'" + derived.input + "' is drawn by the dispersion '" + dispersion.name + "'",
                           "an input that no dispersion draws");
  if (Find(before, derived.input) != nullptr)
    return fields.Refuse("input", "'" + derived.input + "' is derived twice", "each input once");
  for (const DerivedInput& other : before)
    for (const int column : other.expression.Positions())
      if (column == derived.column)
        return fields.Refuse("input", "the expression of '" + other.input + "' takes '" + derived.input + "'",
                             "an input that no expression takes");
  try {
    derived.expression = ParseExpression(derived.text, [&](const std::string& name) {
      if (!IsKnown(name, vehicle)) throw UnknownName{UnknownText(name, vehicle), kNames};
      if (name == derived.input || Find(before, name) != nullptr)
        throw UnknownName{"'" + name + "' is derived itself", "drawn inputs"};
      return NamedValue{FindInput(name), false};
    });
  } catch (const ExpressionError& error) {
    return fields.Refuse("expression", error.what(), error.allowed);
  }
  const double nominal = Value(derived, FlightInputs{});
  const double unit = InputColumns()[static_cast<std::size_t>(derived.column)].unit;
  if (!std::isfinite(nominal))
    fields.Refuse("expression", "it has no value for the nominal flight's inputs",
                  "an expression that is finite there");
  else if (!IsAllowed(vehicle, derived.column, nominal * unit))
    fields.Refuse("expression", "it is " + FormatRounded(nominal) + " for the nominal flight's inputs",
                  RangeText(vehicle, derived.column));
}

void Derive(const std::vector<DerivedInput>& derived, FlightInputs& inputs) {
  for (const DerivedInput& one : derived)
    InputValue(inputs, one.column) =
        (Value(one, inputs) + 0.0) * InputColumns()[static_cast<std::size_t>(one.column)].unit;
}

}  // namespace dispersa
