// Which inputs the rows of a campaign's results hold. Every other input is a constant of the campaign.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/flight/digest.h"

namespace dispersa {

/// Positions in InputColumns() of the inputs that an entry of `dispersions` or `derived` sets, ascending.
std::vector<int> DispersedInputs(const Campaign& campaign);

/// The digest of everything that a flight applied: undefined values are all alike, -0 is 0.
Digest InputsDigest(const std::vector<double>& all);

class RowInputs {
 public:
  RowInputs() = default;
  /// Rows with DispersedInputs(). The others are what the flight without dispersions applies.
  explicit RowInputs(const Campaign& campaign);
  /// Rows with the inputs at these positions in InputColumns(), in this order. `all` has a value for each
  /// input of a vehicle of this class (ColumnClass); those of the rows' inputs have no meaning.
  RowInputs(std::size_t column_class, std::vector<std::size_t> positions, std::vector<double> all)
      : column_class_(column_class), positions_(std::move(positions)), all_(std::move(all)) {}

  std::size_t column_class() const { return column_class_; }
  const std::vector<std::size_t>& positions() const { return positions_; }
  /// Positions of the constants, ascending.
  std::vector<std::size_t> constants() const;
  double constant(std::size_t position) const { return all_[position]; }
  /// Where a row has the input at this position.
  std::optional<std::size_t> PlaceOf(std::size_t position) const;

  std::vector<double> RowOf(const std::vector<double>& all) const;
  /// A row with the constants: a value for each input of the vehicle.
  std::vector<double> AllOf(const std::vector<double>& row) const;

 private:
  std::size_t column_class_ = kUsualStages;
  std::vector<std::size_t> positions_;
  std::vector<double> all_;
};

}  // namespace dispersa
