#include "core/pages/ground_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/math/constants.h"
#include "core/pages/html_parts.h"
#include "core/pages/map_plane.h"
#include "core/results/text.h"

namespace dispersa {
namespace {

constexpr double kWidth_px = 1060.0, kMostHeight_px = 640.0;
/// Of the track and of the envelope: a part of a line of this many is shorter than the eye sees bent.
constexpr std::size_t kParts = 160;

MapPlace PlaceOf(const Geodetic& place) {
  return {place.latitude_rad * kDegPerRad, place.longitude_rad * kDegPerRad};
}

std::vector<MapPlace> NominalTrack(const History& nominal) {
  const int latitude = FindHistoryColumn("latitude_deg"), longitude = FindHistoryColumn("longitude_deg");
  std::vector<MapPlace> track;
  const std::size_t step = std::max<std::size_t>(1, nominal.rows() / kParts);
  for (std::size_t row = 0; row < nominal.rows(); ++row)
    if (row % step == 0 || row + 1 == nominal.rows())
      if (std::isfinite(nominal.at(row, latitude)))
        track.push_back({nominal.at(row, latitude), nominal.at(row, longitude)});
  return track;
}

/// At a time: the corners of least and largest latitude and longitude over the flights.
std::vector<std::array<MapPlace, 4>> Boxes(const FlightBands& bands) {
  const auto band = [&](const char* name) {
    return std::find_if(bands.bands.begin(), bands.bands.end(),
                        [&](const Band& one) { return one.column == name; });
  };
  const auto latitude = band("latitude_deg"), longitude = band("longitude_deg");
  std::vector<std::array<MapPlace, 4>> boxes;
  if (latitude == bands.bands.end() || longitude == bands.bands.end()) return boxes;
  const std::size_t steps = bands.time_s.size(), stride = std::max<std::size_t>(1, steps / kParts);
  for (std::size_t k = 0; k < steps; ++k) {
    if (k % stride != 0 && k + 1 != steps) continue;
    const double south = latitude->min[k], north = latitude->max[k];
    const double west = longitude->min[k], east = longitude->max[k];
    // Flights on both sides of a pole have all longitudes: a box would be the whole cap.
    if (!std::isfinite(south) || !std::isfinite(west) || east - west > 90.0) continue;
    boxes.push_back({MapPlace{south, west}, {south, east}, {north, east}, {north, west}});
  }
  return boxes;
}

class Map {
 public:
  Map(const FlightHistories& histories, const std::vector<Footprint>& footprints)
      : footprints_(footprints),
        track_(NominalTrack(histories.nominal_history)),
        boxes_(Boxes(histories.bands)),
        plane_(Shown()),
        window_(Points(), kWidth_px, kMostHeight_px) {}

  std::string Svg(const std::string& description) const {
    std::string svg =
        fmt::format("<svg class=\"map\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">",
                    window_.width_px(), window_.height_px(), HtmlText(description));
    svg += Graticule() + Coast() + Envelope();
    svg += Path("line-1", track_);
    for (const Footprint& footprint : footprints_) svg += Fallen(footprint);
    if (const auto px = Site())
      svg += fmt::format("<path class=\"dot-nominal\" d=\"M{:.1f} {:.1f}h0\"/>", (*px)[0], (*px)[1]);
    svg += Labels() + Scale();
    return svg + fmt::format("<rect class=\"frame\" width=\"{:.0f}\" height=\"{:.0f}\"/></svg>",
                             window_.width_px(), window_.height_px());
  }

 private:
  std::vector<MapPlace> Shown() const {
    std::vector<MapPlace> shown = track_;
    for (const auto& box : boxes_) shown.insert(shown.end(), box.begin(), box.end());
    for (const Footprint& footprint : footprints_) {
      for (const ImpactPoint& point : footprint.points) shown.push_back(PlaceOf(point.impact->place));
    }
    return shown;
  }
  std::vector<MapPoint> Points() const {
    std::vector<MapPoint> points;
    for (const MapPlace& place : Shown())
      if (const auto point = plane_.At(place)) points.push_back(*point);
    return points;
  }
  std::string Path(const char* style, const std::vector<MapPlace>& line) const {
    const std::string path = MapPath(plane_, window_, line);
    return path.empty() ? "" : fmt::format("<path class=\"{}\" d=\"{}\"/>", style, path);
  }
  std::string Coast() const {
    std::string path;
    for (const auto& line : CoastLines()) path += MapPath(plane_, window_, line);
    return path.empty() ? "" : "<path class=\"coast\" d=\"" + path + "\"/>";
  }
  std::string Envelope() const {
    std::string path;
    for (std::size_t i = 1; i < boxes_.size(); ++i) {
      std::vector<MapPoint> corners;
      for (const auto* box : {&boxes_[i - 1], &boxes_[i]})
        for (const MapPlace& place : *box)
          if (const auto point = plane_.At(place)) corners.push_back(window_.Pixel(*point));
      const std::vector<MapPoint> hull = ConvexHull(std::move(corners));
      for (std::size_t k = 0; k < hull.size(); ++k)
        path += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", hull[k][0], hull[k][1]);
      path += hull.empty() ? "" : "Z";
    }
    return path.empty() ? "" : "<path class=\"cover\" d=\"" + path + "\"/>";
  }
  std::string Fallen(const Footprint& footprint) const {
    std::string dots;
    for (const ImpactPoint& point : footprint.points)
      if (const auto at = plane_.At(PlaceOf(point.impact->place))) {
        const MapPoint px = window_.Pixel(*at);
        dots += fmt::format("M{:.1f} {:.1f}h0", px[0], px[1]);
      }
    if (dots.empty()) return "";
    std::string svg = "<path class=\"dots\" d=\"" + dots + "\"/>";
    for (const auto& outline : footprint.outlines) {
      std::vector<MapPlace> line;
      for (const Geodetic& place : outline) line.push_back(PlaceOf(place));
      svg += Path("ellipse", line);
    }
    return svg;
  }
  std::optional<MapPoint> Site() const {
    const auto at = track_.empty() ? std::nullopt : plane_.At(track_.front());
    return at ? std::optional(window_.Pixel(*at)) : std::nullopt;
  }
  /// The names of the places, each beside its place where no other stands.
  std::string Labels() const {
    constexpr double kLetter_px = 6.8, kRow_px = 14.0;
    std::vector<std::pair<MapPoint, std::string>> places;
    if (const auto px = Site()) places.emplace_back(*px, "launch");
    for (const Footprint& footprint : footprints_)
      if (const auto mean = plane_.At(PlaceOf(footprint.mean)); mean && !footprint.points.empty())
        places.emplace_back(window_.Pixel(*mean), FootprintTitle(footprint));
    std::string svg;
    std::vector<std::array<double, 3>> taken;  // left, right, and base line
    for (const auto& [px, text] : places) {
      const double width = kLetter_px * static_cast<double>(text.size());
      for (int attempt = 0; attempt < 8; ++attempt) {
        // Above and below, to the right and to the left, then a row farther away.
        const bool left = attempt % 4 >= 2, above = attempt % 2 == 0;
        const double away = 9.0 + (attempt >= 4 ? kRow_px : 0.0);
        const double from = px[0] + (left ? -9.0 - width : 9.0), base = px[1] + (above ? -away : away + 9.0);
        const bool is_free = std::none_of(taken.begin(), taken.end(), [&](const auto& other) {
          return from < other[1] && from + width > other[0] && std::fabs(base - other[2]) < kRow_px;
        });
        const bool is_inside = from > 0.0 && from + width < window_.width_px() && base > kRow_px &&
                               base < window_.height_px() - 4.0;
        if (attempt < 7 && !(is_free && is_inside)) continue;
        taken.push_back({from, from + width, base});
        svg += fmt::format("<text class=\"place\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>", from, base,
                           HtmlText(text));
        break;
      }
    }
    return svg;
  }
  double GridStep_deg() const {
    const double height_deg = window_.height_px() / window_.px_per_km() / 111.2;
    double step_deg = 30.0;
    for (const double one : {15.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1})
      if (height_deg / one <= 6.0) step_deg = one;
    return step_deg;
  }
  /// Meridians and parallels. Their labels stand where they leave the picture: below, and to the left.
  std::string Graticule() const {
    const double step_deg = GridStep_deg();
    std::string path, labels;
    std::vector<MapPoint> labelled;
    const auto add = [&](const std::vector<MapPlace>& line, const std::string& name, bool parallel) {
      path += MapPath(plane_, window_, line);
      bool is_named = false;  // a bent line can leave twice
      for (std::size_t i = 1; i < line.size() && !is_named; ++i) {
        const auto from = plane_.At(line[i - 1]), to = plane_.At(line[i]);
        const auto part = from && to ? window_.Inside(*from, *to) : std::nullopt;
        for (const MapPoint& end :
             part ? std::vector<MapPoint>(part->begin(), part->end()) : std::vector<MapPoint>()) {
          const bool leaves = parallel ? end[0] < 0.01 : end[1] > window_.height_px() - 0.01;
          const bool has_room = std::all_of(labelled.begin(), labelled.end(), [&](const MapPoint& other) {
            return std::fabs(other[0] - end[0]) > 46.0 || std::fabs(other[1] - end[1]) > 16.0;
          });
          const bool is_inside = end[1] > 14.0 && end[0] < window_.width_px() - 50.0;
          if (!leaves || !has_room || !is_inside || is_named) continue;
          is_named = true;
          labelled.push_back(end);
          labels += fmt::format("<text class=\"tick\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>", end[0] + 4.0,
                                end[1] - 4.0, name);
        }
      }
    };
    // A line that bends more than the eye sees has a part for each degree or less.
    const double part_deg = std::min(1.0, step_deg);
    // A map of a short flight has a fine grid, of which nearly all lines are elsewhere.
    const double farthest_km = window_.farthest_km();
    for (int k = static_cast<int>(-90.0 / step_deg) + 1; k * step_deg < 90.0; ++k) {
      const double at_deg = k * step_deg;
      if (!plane_.MeetsParallel(at_deg, farthest_km)) continue;
      std::vector<MapPlace> line;
      for (double lon = -180.0; lon <= 180.0 + 1e-9; lon += part_deg) line.push_back({at_deg, lon});
      add(line, Degrees(at_deg, "N", "S"), true);
    }
    for (int k = static_cast<int>(-180.0 / step_deg) + 1; k * step_deg <= 180.0; ++k) {
      const double at_deg = k * step_deg;
      if (!plane_.MeetsMeridian(at_deg, farthest_km)) continue;
      std::vector<MapPlace> line;
      for (double lat = -90.0; lat <= 90.0 + 1e-9; lat += part_deg) line.push_back({lat, at_deg});
      add(line, Degrees(at_deg, "E", "W"), false);
    }
    return "<path class=\"grid\" d=\"" + path + "\"/>" + labels;
  }
  static std::string Degrees(double value_deg, const char* positive, const char* negative) {
    const double size_deg = std::fabs(value_deg);
    const bool plain = size_deg < 1e-9 || (size_deg == 180.0);
    return ReadableText(size_deg) + "°" +
           (plain ? "" : fmt::format(" {}", value_deg > 0.0 ? positive : negative));
  }
  std::string Scale() const {
    const double about_km = 0.18 * window_.width_px() / window_.px_per_km();
    const double power = std::pow(10.0, std::floor(std::log10(about_km)));
    const double bar_km = power * (about_km >= 5.0 * power ? 5.0 : about_km >= 2.0 * power ? 2.0 : 1.0);
    const double right = window_.width_px() - 16.0, y = window_.height_px() - 14.0;
    const double left = right - bar_km * window_.px_per_km();
    return fmt::format(
        "<path class=\"axis\" d=\"M{0:.1f} {2:.1f}v5H{1:.1f}v-5\"/><text class=\"tick\" x=\"{1:.0f}\" "
        "y=\"{3:.0f}\" "
        "text-anchor=\"end\">{4} km; lines every {5}°</text>",
        left, right, y - 5.0, y - 8.0, ReadableText(bar_km), ReadableText(GridStep_deg()));
  }

  const std::vector<Footprint>& footprints_;
  const std::vector<MapPlace> track_;
  const std::vector<std::array<MapPlace, 4>> boxes_;
  const MapPlane plane_;
  const MapWindow window_;
};

std::string FootprintTable(const std::vector<Footprint>& footprints) {
  HtmlTable table("!What falls|#Down|#Aloft|#Mean latitude|#longitude|#99 % ellipse, km|#holds");
  for (const Footprint& one : footprints) {
    const bool has_ellipse = !one.ellipses.empty();
    const bool is_down = !one.points.empty();
    table.Row({FootprintTitle(one), std::to_string(one.points.size()), std::to_string(one.aloft),
               is_down ? FixedText(one.mean.latitude_rad * kDegPerRad, 3) + "°" : "–",
               is_down ? FixedText(one.mean.longitude_rad * kDegPerRad, 3) + "°" : "–",
               has_ellipse ? fmt::format("{} × {}", RoundedText(2e-3 * one.ellipses.back().semi_major),
                                         RoundedText(2e-3 * one.ellipses.back().semi_minor))
                           : "–",
               has_ellipse ? ShareText(one.containment.back().empirical) : "–"});
  }
  return footprints.empty() ? "" : table.Html("narrow");
}

}  // namespace

std::string MapFigure(const Campaign& campaign, const FlightHistories& histories,
                      const std::vector<Footprint>& footprints) {
  if (histories.nominal_history.rows() == 0) return "";
  const bool has_envelope = histories.bands.flights > 0;
  std::string caption = "The ground track of the nominal flight (orange) from the launch site";
  if (has_envelope)
    caption +=
        ", and the area under the flights of the envelope: at each time from the least to the largest "
        "latitude and "
        "longitude, so it is wider than the flights";
  caption += ".";
  if (campaign.course.ends != FlightEnd::kInjection)
    caption += " Both end where the flight goes on as a point mass.";
  if (!footprints.empty())
    caption +=
        " A dot is where a part of a flight comes down; ellipses hold 50, 95 and 99 % of a normal law.";
  caption += " Coast lines: Natural Earth, 1:110 million.";
  const Map map(histories, footprints);
  return "<div class=\"figures\">\n" +
         Figure(map.Svg("Map of the flights of " + campaign.name), HtmlText(caption), "wide") + "</div>\n" +
         FootprintTable(footprints);
}

}  // namespace dispersa
