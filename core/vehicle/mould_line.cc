#include "core/vehicle/mould_line.h"

#include <algorithm>
#include <string>

#include "core/math/assertion.h"
#include "core/math/constants.h"
#include "core/math/functions.h"

namespace dispersa {
namespace {

// Panels of Simpson's rule on a section: exact on straight sections (all integrands are cubic at most),
// and 1e-6 relative on an ogive, whose slope is smooth.
constexpr int kSectionPanels = 64;

MouldSection Section(ProfileShape shape, double start_m, double length_m, double fore_radius_m,
                     double aft_radius_m) {
  MouldSection section{start_m, start_m + length_m, fore_radius_m, aft_radius_m, 0.0, 0.0};
  if (shape == ProfileShape::kTangentOgive) {
    const double rise_m = aft_radius_m - fore_radius_m;
    section.arc_radius_m = (Square(rise_m) + Square(length_m)) / (2.0 * rise_m);
    section.arc_centre_m = section.end_m;
  }
  return section;
}

}  // namespace

double MouldSection::Radius(double station_m) const {
  if (!IsCurved()) return fore_radius_m + Slope(station_m) * (station_m - start_m);
  const auto height_m = [this](double x) { return Sqrt(Square(arc_radius_m) - Square(arc_centre_m - x)); };
  return fore_radius_m + height_m(station_m) - height_m(start_m);
}

double MouldSection::Slope(double station_m) const {
  if (!IsCurved()) return (aft_radius_m - fore_radius_m) / (end_m - start_m);
  const double ahead_m = arc_centre_m - station_m;
  return ahead_m / Sqrt(Square(arc_radius_m) - Square(ahead_m));
}

std::vector<StructProblem> ProfileProblems(const std::vector<ProfileSection>& profile) {
  std::vector<StructProblem> problems;
  double fore_diameter_m = 0.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ProfileSection& section = profile[i];
    const std::string path = "profile[" + std::to_string(i) + "].";
    const auto require = [&](bool ok, const char* key, const char* message, const char* allowed) {
      if (!ok) problems.push_back({path + key, message, allowed});
    };
    if (i == 0) {
      require(section.shape == ProfileShape::kTangentOgive || section.shape == ProfileShape::kCone, "shape",
              "has no tip", "tangent_ogive or cone for the first section");
    } else if (section.shape == ProfileShape::kTangentOgive) {
      require(section.aft_diameter_m > fore_diameter_m, "aft_diameter_m",
              "is not larger than the section's before", "a tangent ogive that widens");
    } else if (section.shape == ProfileShape::kCylinder) {
      require(section.aft_diameter_m == fore_diameter_m, "aft_diameter_m",
              "is not the diameter of the section before", "a cylinder that keeps it; a frustum changes it");
    }
    fore_diameter_m = section.aft_diameter_m;
  }
  return problems;
}

std::vector<MouldSection> CutMouldLine(const std::vector<ProfileSection>& profile, double end_station_m) {
  // A remainder shorter than this is rounding in the file's sums of lengths, not a section.
  constexpr double kSliver_m = 1e-6;
  DISPERSA_ASSERT(end_station_m > 0.0 && ProfileProblems(profile).empty(), end_station_m);
  std::vector<MouldSection> body;
  double start_m = 0.0;
  double radius_m = 0.0;
  for (const ProfileSection& piece : profile) {
    if (end_station_m - start_m < kSliver_m) break;
    MouldSection section =
        Section(piece.shape, start_m, piece.length_m, radius_m, 0.5 * piece.aft_diameter_m);
    start_m = section.end_m;
    radius_m = section.aft_radius_m;
    if (section.end_m > end_station_m) {
      section.aft_radius_m = section.Radius(end_station_m);
      section.end_m = end_station_m;
    }
    body.push_back(section);
  }
  DISPERSA_ASSERT(!body.empty() && body.front().fore_radius_m == 0.0);
  return body;
}

BodyIntegrals Integrate(const std::vector<MouldSection>& body) {
  BodyIntegrals sum;
  for (const MouldSection& section : body) {
    const double panel_m = (section.end_m - section.start_m) / kSectionPanels;
    for (int i = 0; i <= kSectionPanels; ++i) {
      const double x = section.start_m + i * panel_m;
      const double r = section.Radius(x);
      const double weight = (i == 0 || i == kSectionPanels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * panel_m / 3.0;
      const double area = kPi * Square(r);
      sum.volume_m3 += weight * area;
      sum.volume_moment_m4 += weight * area * x;
      sum.wetted_area_m2 += weight * kTwoPi * r * Sqrt(1.0 + Square(section.Slope(x)));
      sum.planform_area_m2 += weight * 2.0 * r;
      sum.planform_moment_m3 += weight * 2.0 * r * x;
      sum.roll_moment_m4 += weight * kTwoPi * r * r * r;
    }
    sum.largest_radius_m = std::max({sum.largest_radius_m, section.fore_radius_m, section.aft_radius_m});
  }
  sum.length_m = body.back().end_m;
  sum.base_radius_m = body.back().aft_radius_m;
  return sum;
}

}  // namespace dispersa
