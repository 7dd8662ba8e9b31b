#include "core/campaign/row_inputs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/flight/flight_inputs.h"

namespace dispersa {
namespace {

std::vector<double> NominalInputs(std::size_t column_class) {
  FlightInputs nominal;
  TakeColumns(nominal);
  return InputValues(nominal, column_class);
}

}  // namespace

std::vector<int> DispersedInputs(const Campaign& campaign) {
  std::vector<int> inputs;
  for (const Dispersion& dispersion : campaign.dispersions)
    inputs.insert(inputs.end(), dispersion.inputs.begin(), dispersion.inputs.end());
  for (const DerivedInput& derived : campaign.derived) inputs.push_back(derived.column);
  std::sort(inputs.begin(), inputs.end());
  inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
  return inputs;
}

Digest InputsDigest(std::vector<double> all) {
  for (double& value : all)
    value = std::isfinite(value) ? value + 0.0 : std::numeric_limits<double>::quiet_NaN();
  Digester digester;
  digester.Add(all.data(), all.size());
  return digester.Finish();
}

std::vector<double> ValuesAt(const std::vector<std::size_t>& positions, const std::vector<double>& values) {
  std::vector<double> at;
  for (const std::size_t position : positions) at.push_back(values[position]);
  return at;
}

RowInputs::RowInputs(const Campaign& campaign)
    : column_class_(ColumnClass(campaign.vehicle)), all_(NominalInputs(column_class_)) {
  for (const int input : DispersedInputs(campaign)) positions_.push_back(static_cast<std::size_t>(input));
  for (const int input : InputsOf(campaign.vehicle))
    if (!PlaceOf(static_cast<std::size_t>(input))) constants_.push_back(static_cast<std::size_t>(input));
}

RowInputs::RowInputs(std::size_t column_class, std::vector<std::size_t> positions,
                     const std::vector<std::pair<std::size_t, double>>& constants)
    : column_class_(column_class), positions_(std::move(positions)), all_(NominalInputs(column_class)) {
  for (const auto& [position, value] : constants) {
    if (position >= all_.size()) continue;
    constants_.push_back(position);
    all_[position] = value;
  }
  std::sort(constants_.begin(), constants_.end());
}

std::optional<std::size_t> RowInputs::PlaceOf(std::size_t position) const {
  const auto found = std::find(positions_.begin(), positions_.end(), position);
  if (found == positions_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - positions_.begin());
}

std::vector<double> RowInputs::AllOf(const std::vector<double>& row) const {
  std::vector<double> all = all_;
  for (std::size_t i = 0; i < row.size(); ++i) all[positions_[i]] = row[i];
  return all;
}

}  // namespace dispersa
