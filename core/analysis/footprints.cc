#include "core/analysis/footprints.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/analysis/campaign_summary.h"
#include "core/environment/earth.h"
#include "core/flight/engine_version.h"
#include "core/input/input_error.h"
#include "core/math/circle.h"
#include "core/math/constants.h"
#include "core/results/result_error.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kOutlinePoints = 72;

/// 7 decimals of a degree are 1 cm on the ground.
double Rounded(double degrees) { return std::round(degrees * 1e7) / 1e7 + 0.0; }

double LatitudeDeg(const Geodetic& place) { return Rounded(place.latitude_rad * kDegPerRad); }
double LongitudeDeg(const Geodetic& place) {
  return Rounded(NearTo(0.0, place.longitude_rad * kDegPerRad, kCutAt180Deg));
}

using Ring = std::vector<std::array<double, 2>>;  // longitude and latitude in degrees, closed

/// The part of a ring between two meridians (I. E. Sutherland and G. W. Hodgman, Commun. ACM 17 (1974) 32).
/// Its points on the meridians are exactly there.
Ring Between(const Ring& ring, double west_deg, double east_deg) {
  Ring part = ring;
  for (const auto& [edge_deg, side] : {std::pair{west_deg, 1.0}, std::pair{east_deg, -1.0}}) {
    const Ring whole = std::move(part);
    part.clear();
    for (std::size_t i = 0; i + 1 < whole.size(); ++i) {
      const auto& from = whole[i];
      const auto& to = whole[i + 1];
      const double inside_from = side * (from[0] - edge_deg), inside_to = side * (to[0] - edge_deg);
      if (inside_from >= 0.0) part.push_back(from);
      if (inside_from * inside_to < 0.0)
        part.push_back({edge_deg, std::lerp(from[1], to[1], inside_from / (inside_from - inside_to))});
    }
    if (!part.empty()) part.push_back(part.front());
  }
  return part;
}

/// An outline in pieces from -180 to 180 degrees, cut at the antimeridian as RFC 7946 (section 3.1.9) asks
/// for. One around a pole runs along the antimeridian to the pole and back.
std::vector<Ring> Pieces(const std::vector<Geodetic>& outline) {
  Ring ring;
  for (const Geodetic& place : outline) {
    const double longitude_deg = place.longitude_rad * kDegPerRad;
    ring.push_back({ring.empty() ? NearTo(0.0, longitude_deg, kCutAt180Deg)
                                 : NearTo(ring.back()[0], longitude_deg, kCutAt180Deg),
                    place.latitude_rad * kDegPerRad});
  }
  const double around_deg = ring.back()[0] - ring.front()[0];
  if (std::fabs(around_deg) > 180.0) {
    const double pole_deg = std::copysign(90.0, ring.front()[1]);
    ring.insert(ring.end(), {{ring.back()[0], pole_deg}, {ring.front()[0], pole_deg}, ring.front()});
  }
  std::vector<Ring> pieces;
  for (const double turn_deg : {-360.0, 0.0, 360.0}) {
    Ring piece = Between(ring, turn_deg - 180.0, turn_deg + 180.0);
    if (piece.size() < 4) continue;  // a ring that only touches the meridian
    for (auto& [longitude_deg, latitude_deg] : piece) {
      longitude_deg = Rounded(longitude_deg - turn_deg);
      latitude_deg = Rounded(latitude_deg);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// A polygon, or one for each piece.
Json Area(const std::vector<Geodetic>& outline) {
  Json rings = Json::array();
  for (const Ring& piece : Pieces(outline)) rings.push_back(Json::array({Json(piece)}));
  if (rings.size() == 1) return {{"type", "Polygon"}, {"coordinates", rings[0]}};
  return {{"type", "MultiPolygon"}, {"coordinates", rings}};
}

void Shape(Footprint& footprint) {
  if (footprint.points.empty()) return;
  const Earth earth = Wgs84();
  Vector3 sum = Vector3::Zero();
  for (const ImpactPoint& point : footprint.points) {
    Geodetic ground = point.impact->place;
    ground.altitude_m = 0.0;
    sum += FromGeodetic(earth, ground);
  }
  footprint.mean = ToGeodetic(earth, sum / static_cast<double>(footprint.points.size()));
  footprint.mean.altitude_m = 0.0;
  const Vector3 origin = FromGeodetic(earth, footprint.mean);
  const Matrix3 R_EN = NedAxes(footprint.mean.latitude_rad, footprint.mean.longitude_rad);
  std::vector<std::vector<double>> plane;
  for (const ImpactPoint& point : footprint.points) {
    const Vector3 away = FromGeodetic(earth, point.impact->place) - origin;
    plane.push_back({away.dot(R_EN.col(1)), away.dot(R_EN.col(0))});
  }
  footprint.scatter = PointScatterOf(plane);
  footprint.containment =
      ContainmentOf(plane, footprint.scatter, {kFootprintContainment.begin(), kFootprintContainment.end()});
  for (const Containment& containment : footprint.containment) {
    footprint.ellipses.push_back(EllipseOf(footprint.scatter.covariance, containment.scale));
    std::vector<Geodetic>& outline = footprint.outlines.emplace_back();
    for (const auto& [east_m, north_m] :
         OutlineOf(footprint.ellipses.back(), {footprint.scatter.mean[0], footprint.scatter.mean[1]},
                   kOutlinePoints)) {
      Geodetic place = ToGeodetic(earth, origin + east_m * R_EN.col(1) + north_m * R_EN.col(0));
      place.altitude_m = 0.0;
      outline.push_back(place);
    }
  }
}

std::string ContainmentTitle(const Footprint& footprint, const Containment& containment) {
  return fmt::format("{}: {} ellipse, holds {} of {}", FootprintTitle(footprint),
                     PercentText(containment.stated), containment.inside, footprint.points.size());
}

/// Clockwise from north.
double AzimuthDeg(const ScatterEllipse& ellipse) {
  const double azimuth_deg = 90.0 - ellipse.angle_rad * kDegPerRad;
  return azimuth_deg >= 180.0 ? azimuth_deg - 180.0 : azimuth_deg;
}

}  // namespace

std::vector<Footprint> GatherFootprints(const std::vector<ImpactPoint>& points) {
  std::map<std::pair<bool, int>, Footprint> gathered;
  for (const ImpactPoint& point : points) {
    Footprint& footprint = gathered[{point.lost, point.stage}];
    footprint.stage = point.stage;
    footprint.lost = point.lost;
    if (point.impact) {
      footprint.points.push_back(point);
    } else {
      ++footprint.aloft;
    }
  }
  std::vector<Footprint> footprints;
  for (auto& [key, footprint] : gathered) {
    Shape(footprint);
    footprints.push_back(std::move(footprint));
  }
  return footprints;
}

std::vector<Footprint> FootprintsOf(const ResultFolder& folder, const Campaign& campaign, int threads,
                                    const std::function<void(std::size_t, std::size_t)>& progress) {
  if (folder.Provenance("engine") != EngineVersion()) {
    throw InputError(fmt::format("{}: flown by engine {}, this one is {}: its flights cannot be flown again",
                                 folder.directory().string(), folder.Provenance("engine"), EngineVersion()),
                     "the engine that flew it");
  }
  const std::vector<std::uint64_t> cases = folder.PresentCases();
  std::size_t flown = 0;
  const auto points = FlyToImpact(CampaignFlights(campaign), cases, threads, [&](const CaseResult& result) {
    const Digest stored = folder.Load(result.case_index).digest;
    if (stored != result.digest) {
      throw ResultError(
          ResultError::Kind::kConflict,
          fmt::format("case {} does not reproduce its stored result: digest {} is stored, {} was flown now",
                      result.case_index, stored.Hex(), result.digest.Hex()));
    }
    if (progress) progress(++flown, cases.size());
  });
  return GatherFootprints(points);
}

std::string FootprintTitle(const Footprint& footprint) {
  return footprint.lost         ? fmt::format("stack from stage {}, lost", footprint.stage)
         : footprint.stage == 0 ? "boosters, spent"
                                : fmt::format("stage {}, spent", footprint.stage);
}

std::string GeoJson(const Campaign& campaign, const std::vector<Footprint>& footprints,
                    const std::string& incomplete) {
  Json features = Json::array();
  for (const Footprint& footprint : footprints) {
    const char* body = footprint.lost         ? "lost_flight"
                       : footprint.stage == 0 ? "spent_booster"
                                              : "spent_stage";
    for (std::size_t i = 0; i < footprint.containment.size(); ++i) {
      const Containment& containment = footprint.containment[i];
      const ScatterEllipse& ellipse = footprint.ellipses[i];
      features.push_back({{"type", "Feature"},
                          {"properties",
                           {{"kind", "footprint"},
                            {"body", body},
                            {"stage", footprint.stage},
                            {"name", ContainmentTitle(footprint, containment)},
                            {"stated_containment", containment.stated},
                            {"empirical_containment", containment.empirical},
                            {"empirical_limits", {containment.limits.lower, containment.limits.upper}},
                            {"inside", containment.inside},
                            {"points", footprint.points.size()},
                            {"aloft", footprint.aloft},
                            {"semi_major_km", ellipse.semi_major * 1e-3},
                            {"semi_minor_km", ellipse.semi_minor * 1e-3},
                            {"azimuth_deg", AzimuthDeg(ellipse)},
                            {"mean", {LongitudeDeg(footprint.mean), LatitudeDeg(footprint.mean)}}}},
                          {"geometry", Area(footprint.outlines[i])}});
    }
    for (const ImpactPoint& point : footprint.points) {
      features.push_back(
          {{"type", "Feature"},
           {"properties",
            {{"kind", "impact"},
             {"body", body},
             {"stage", footprint.stage},
             {"case_index", point.case_index},
             {"from_time_s", point.from_time_s},
             {"from_altitude_km", point.from_altitude_m * 1e-3},
             {"time_s", point.impact->time_s},
             {"speed_m_s", point.impact->speed_m_s},
             {"peak_altitude_km", point.impact->peak_altitude_m * 1e-3},
             {"replay", ReplayCommand(point.case_index)}}},
           {"geometry",
            {{"type", "Point"},
             {"coordinates", {LongitudeDeg(point.impact->place), LatitudeDeg(point.impact->place)}}}}});
    }
  }
  Json json = {{"type", "FeatureCollection"},
               {"name", campaign.name},
               {"campaign_id", campaign.id},
               {"flight_id", campaign.flight_id}};
  if (!incomplete.empty()) json["incomplete"] = incomplete;
  json["features"] = std::move(features);
  return json.dump(1) + "\n";
}

std::string Kml(const Campaign& campaign, const std::vector<Footprint>& footprints,
                const std::string& incomplete) {
  std::string kml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml "
      "xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n"
      "<name>{}: impact points</name>\n<description>campaign {}{}</description>\n"
      "<Style id=\"spent\"><IconStyle><color>ffa85f1f</color><scale>0.4</scale></IconStyle></Style>\n"
      "<Style id=\"lost\"><IconStyle><color>ff2d27c0</color><scale>0.6</scale></IconStyle></Style>\n"
      "<Style "
      "id=\"ellipse\"><LineStyle><color>ff1b62c8</color><width>2</width></LineStyle><PolyStyle><fill>0</fill>"
      "</PolyStyle></Style>\n",
      HtmlText(campaign.name), campaign.id, incomplete.empty() ? "" : "; " + HtmlText(incomplete));
  for (const Footprint& footprint : footprints) {
    kml += fmt::format("<Folder><name>{}</name>\n", FootprintTitle(footprint));
    for (std::size_t i = 0; i < footprint.containment.size(); ++i) {
      const std::vector<Ring> pieces = Pieces(footprint.outlines[i]);
      kml += fmt::format("<Placemark><name>{}</name><styleUrl>#ellipse</styleUrl>{}",
                         ContainmentTitle(footprint, footprint.containment[i]),
                         pieces.size() > 1 ? "<MultiGeometry>" : "");
      for (const Ring& piece : pieces) {
        kml += "<Polygon><outerBoundaryIs><LinearRing><coordinates>";
        for (const auto& [longitude_deg, latitude_deg] : piece)
          kml += fmt::format("{:.7f},{:.7f} ", longitude_deg, latitude_deg);
        kml += "</coordinates></LinearRing></outerBoundaryIs></Polygon>";
      }
      kml += fmt::format("{}</Placemark>\n", pieces.size() > 1 ? "</MultiGeometry>" : "");
    }
    for (const ImpactPoint& point : footprint.points) {
      kml += fmt::format(
          "<Placemark><name>case {}</name><description>{}; from {:.1f} km at {:.2f} s, down at {:.1f} s with "
          "{:.0f} "
          "m/s</description><styleUrl>#{}</styleUrl><Point><coordinates>{:.7f},{:.7f}</coordinates></Point></"
          "Placemark>\n",
          point.case_index, ReplayCommand(point.case_index), point.from_altitude_m * 1e-3, point.from_time_s,
          point.impact->time_s, point.impact->speed_m_s, footprint.lost ? "lost" : "spent",
          LongitudeDeg(point.impact->place), LatitudeDeg(point.impact->place));
    }
    kml += "</Folder>\n";
  }
  return kml + "</Document>\n</kml>\n";
}

}  // namespace dispersa
