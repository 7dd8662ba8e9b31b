// Atmospheric turbulence after Dryden: intensity and length of its gusts over altitude, and a realisation as
// a field at rest in the air, through which the vehicle flies.
//
// Spectra, intensities and scales: MIL-F-8785C, 3.7.1.2 (Dryden form), 3.7.2.1 and figure 7 (medium to high
// altitude), 3.7.3.4 and figures 10, 11 (low altitude). Feet and knots occur only inside turbulence.cc.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace dispersa {

/// How rough the air of one flight is.
struct TurbulenceStrength {
  double exceedance = 0.0;     ///< probability with which the intensity is exceeded: which curve of figure 7
  double wind_20ft_m_s = 0.0;  ///< mean wind 20 ft above the ground: it makes the turbulence below 1000 ft
  double scale = 1.0;          ///< of all intensities
};
inline constexpr double kLeastExceedance = 1e-6, kLargestExceedance = 0.2;  ///< of figure 7's curves

/// Standard deviations (m/s) and lengths (m) of the horizontal components and of the vertical one.
struct TurbulenceScales {
  double sigma_horizontal_m_s, sigma_vertical_m_s;
  double length_horizontal_m, length_vertical_m;
};

/// Figure 7: standard deviation (m/s) at an altitude for a probability of exceedance. It is linear over
/// altitude and over the logarithm of the probability. Outside, the end values hold.
double TurbulenceIntensity(double exceedance, double altitude_m);

/// Scales at an altitude over a ground. Up to 1000 ft above it: the low-altitude model; below 10 ft its
/// values of 10 ft hold. From 2000 ft on: figure 7 with 1750 ft for every length. Between: linear over
/// height. Figure 7 ends at 80 000 ft. Above, intensities fade to zero over kWindFade_m (wind.h).
TurbulenceScales TurbulenceAt(const TurbulenceStrength& strength, double ground_m, double altitude_m);

/// The way up through the air along which a field is laid, in a vertical plane: points of increasing
/// altitude, each with the sine of the path's angle over the horizon. It gives the place of an altitude along
/// the path.
struct ClimbPath {
  std::vector<double> altitude_m;  ///< strictly increasing, at least two, beginning with the ground's
  std::vector<double> sine_angle;
  double azimuth_rad = 0.0;  ///< of the plane, clockwise from north
};

/// The part that all fields along a path share: nodes a fiftieth of the vertical length apart (at least 2 m),
/// and the step from each node to the next.
class TurbulencePath {
 public:
  explicit TurbulencePath(const ClimbPath& path);

  struct Node {
    double altitude_m;
    double sine, cosine;  ///< of the path's angle
    /// of a component along the path: exp(-d / length) from the last node, and the share of new noise
    double along_keeps, along_renews;
    /// The same for a component across the path, with two states: [1 0; ratio 1] times the factor that is
    /// kept, and the lower triangle of the new part.
    double across_keeps, across_ratio, renews_11, renews_21, renews_22;
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  double ground_m() const { return nodes_.front().altitude_m; }
  double azimuth_sine() const { return azimuth_sine_; }
  double azimuth_cosine() const { return azimuth_cosine_; }

 private:
  std::vector<Node> nodes_;
  double azimuth_sine_, azimuth_cosine_;
};

/// Velocity of the air over altitude, linear between points. Below, the first value holds. Above the last
/// point there is none.
struct TurbulenceField {
  std::vector<double> altitude_m, north_m_s, east_m_s, up_m_s;
};
struct TurbulentWind {
  double north_m_s = 0.0, east_m_s = 0.0, up_m_s = 0.0;
};
TurbulentWind Evaluate(const TurbulenceField& field, double altitude_m);

/// Standard normals of the component along the path, of the horizontal one across it and of the third.
struct TurbulenceNormals {
  std::function<double()> along, across, normal;
};
/// One realisation, as functions of the wave number k along the path (rad/m). The component along the path
/// has the longitudinal spectrum 2 L / pi / (1 + (L k)²). The components across it have the lateral spectrum
/// L / pi (1 + 3 (L k)²) / (1 + (L k)²)². The squared deviation multiplies both. Each component is a Markov
/// sequence. Where L is constant, its correlations between nodes d apart are exactly exp(-d/L) and (1 - d /
/// 2L) exp(-d/L). On a vertical path the component along it is vertical.
TurbulenceField DrawTurbulence(const TurbulenceStrength& strength, const TurbulencePath& path,
                               const TurbulenceNormals& draw);

}  // namespace dispersa
