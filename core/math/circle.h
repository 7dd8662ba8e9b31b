// Quantities that repeat after a turn: longitudes, azimuths, clock angles. The mean of 179° and -179° is 180°
// and not 0°. So a sample is unwrapped about its centre before anything linear is done with it.
#pragma once

#include <optional>
#include <vector>

namespace dispersa {

/// Where a quantity repeats, in its own unit. Without a turn the quantity is an ordinary one, and the
/// functions below return its values as they are.
struct Circle {
  double turn = 0.0;
  double cut = 0.0;  ///< values lie from here to cut + turn

  bool is_closed() const { return turn > 0.0; }
};
inline constexpr Circle kCutAt180Deg = {360.0, -180.0}, kCutAt0Deg = {360.0, 0.0};

/// The representation of `value` within half a turn of `centre`. The bits stay if it is there already.
double NearTo(double centre, double value, const Circle& circle);

/// The circular mean of the finite values, between cut and cut + turn. None if the sample has no centre: its
/// values do not lie within half a turn, and their resultant is no longer than chance gives a uniform sample
/// (L. Rayleigh, Phil. Mag. 37 (1919) 321; at 0.1 %). None without values, and of a quantity without a turn.
std::optional<double> CentreOf(const std::vector<double>& values, const Circle& circle);
/// Whether finite values lie all around, without a centre: they have no mean, spread or percentile.
bool LiesAllAround(const std::vector<double>& values, const Circle& circle);

/// Each value near to the sample's centre. Without a centre, and where nothing repeats, the values as they
/// are.
std::vector<double> Unwrapped(std::vector<double> values, const Circle& circle);

}  // namespace dispersa
