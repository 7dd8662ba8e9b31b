// Distances on the ground from a place, along an azimuth and across it.
#pragma once

#include "core/environment/earth.h"

namespace dispersa {

struct GroundTrack {
  double along_m = 0.0;
  double across_m = 0.0;  ///< to the right
};

/// Of a place, from `from` along the great circle that starts at an azimuth (clockwise from north). On a
/// sphere of the Earth's mean radius (6371008.8 m, IUGG) with geodetic latitudes: within 0.6 % of the
/// distance on the ellipsoid.
GroundTrack TrackOf(const Geodetic& from, double azimuth_rad, const Geodetic& place);

}  // namespace dispersa
