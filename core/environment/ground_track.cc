#include "core/environment/ground_track.h"

#include "core/math/functions.h"

namespace dispersa {

GroundTrack TrackOf(const Geodetic& from, double azimuth_rad, const Geodetic& place) {
  constexpr double kMeanRadius_m = 6371008.8;
  const auto outwards = [](const Geodetic& at) {
    const SinCos latitude = SineCosine(at.latitude_rad), longitude = SineCosine(at.longitude_rad);
    return Vector3(latitude.cos * longitude.cos, latitude.cos * longitude.sin, latitude.sin);
  };
  const Matrix3 axes = NedAxes(from.latitude_rad, from.longitude_rad);
  const SinCos azimuth = SineCosine(azimuth_rad);
  const Vector3 ahead = azimuth.cos * axes.col(0) + azimuth.sin * axes.col(1);
  const Vector3 right = azimuth.cos * axes.col(1) - azimuth.sin * axes.col(0);
  const Vector3 to = outwards(place);
  return {kMeanRadius_m * Atan2(to.dot(ahead), to.dot(outwards(from))),
          kMeanRadius_m * Asin(Clamp(to.dot(right), -1.0, 1.0))};
}

}  // namespace dispersa
