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
Digest InputsDigest(std::vector<double> all);

/// The values at these positions.
std::vector<double> ValuesAt(const std::vector<std::size_t>& positions, const std::vector<double>& values);

class RowInputs {
 public:
  RowInputs() = default;
  /// Rows with DispersedInputs(). The others are what the flight without dispersions applies.
  explicit RowInputs(const Campaign& campaign);
  /// Rows with the inputs at these positions in InputColumns(), in this order, beside these constants by
  /// position and value. The class is that of the vehicle (ColumnClass). Every other input is nominal.
  RowInputs(std::size_t column_class, std::vector<std::size_t> positions,
            const std::vector<std::pair<std::size_t, double>>& constants);

  std::size_t column_class() const { return column_class_; }
  const std::vector<std::size_t>& positions() const { return positions_; }
  /// Positions of the constants that the vehicle has, ascending.
  const std::vector<std::size_t>& constants() const { return constants_; }
  double constant(std::size_t position) const { return all_[position]; }
  /// Where a row has the input at this position.
  std::optional<std::size_t> PlaceOf(std::size_t position) const;

  std::vector<double> RowOf(const std::vector<double>& all) const { return ValuesAt(positions_, all); }
  /// A row with the constants: a value for each input of the vehicle.
  std::vector<double> AllOf(const std::vector<double>& row) const;

 private:
  std::size_t column_class_ = kUsualStages;
  std::vector<std::size_t> positions_, constants_;
  std::vector<double> all_;
};

}  // namespace dispersa
