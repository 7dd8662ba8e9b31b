#include "core/dynamics/aero_grid.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace dispersa {

namespace {

constexpr double kMostBuckets = 4096.0;

const Coefficient* Coefficients(const BodyAerodynamics& b, int i) {
  const Coefficient* all[] = {&b.ca, &b.cn, &b.xcp_station_m, &b.cmq,    &b.clp,    &b.cd,
                              &b.cl, &b.cm, &b.cnr,           &b.ca_yaw, &b.cn_yaw, &b.xcp_yaw_station_m};
  return i < static_cast<int>(std::size(all)) ? all[i] : nullptr;
}

// Breakpoints from 0 up: the values below hold there too.
std::vector<double> Breakpoints(const BodyAerodynamics& body, bool of_mach) {
  std::vector<double> points = {0.0};
  for (int i = 0; const Coefficient* c = Coefficients(body, i); ++i) {
    if (c->empty()) continue;
    const std::vector<double>& grid = of_mach ? c->table.x : c->table.y;
    std::copy_if(grid.begin(), grid.end(), std::back_inserter(points), [](double x) { return x > 0.0; });
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() == 1) points.push_back(1.0);
  return points;
}

AeroGrid::Axis MakeAxis(const std::vector<double>& points) {
  AeroGrid::Axis axis;
  axis.cells = static_cast<int>(points.size()) - 1;
  axis.top = points.back();
  double narrowest = axis.top;
  for (std::size_t i = 1; i < points.size(); ++i) narrowest = std::min(narrowest, points[i] - points[i - 1]);
  // A bucket rarely has more than one edge; few are enough for any table.
  axis.scale = std::min(1.0 / (0.9 * narrowest), kMostBuckets / axis.top);
  axis.edges.assign(points.begin() + 1, points.end());
  axis.edges.back() = std::numeric_limits<double>::infinity();
  const auto buckets = static_cast<std::size_t>(axis.top * axis.scale) + 1;
  std::size_t cell = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    while (axis.edges[cell] * axis.scale <= static_cast<double>(b)) ++cell;
    axis.bucket.push_back(static_cast<std::uint16_t>(cell));
  }
  return axis;
}

// One cell of the grid.
class Cell {
 public:
  Cell(double m0, double m1, double i0, double i1) : m0_(m0), m1_(m1), i0_(i0), i1_(i1) {}

  void Bilinear(const Coefficient& c, AlignedRows& row) const {
    if (c.empty()) {
      row.insert(row.end(), 4, 0.0);
      return;
    }
    const double z00 = c.table(m0_, i0_), z01 = c.table(m0_, i1_), z10 = c.table(m1_, i0_),
                 z11 = c.table(m1_, i1_);
    const double width = m1_ - m0_, height = i1_ - i0_;
    const double twist = ((z11 - z10) - (z01 - z00)) / (width * height);
    const double by_i = (z01 - z00) / height - twist * m0_;
    const double by_m = (z10 - z00) / width - twist * i0_;
    row.insert(row.end(), {z00 - by_i * i0_ - by_m * m0_ - twist * m0_ * i0_, by_i, by_m, twist});
  }
  void Linear(const Coefficient& c, AlignedRows& row, const Coefficient* less = nullptr) const {
    const auto at = [&](double m) {
      return (c.empty() ? 0.0 : c.table(m, 0.0)) - (less && !less->empty() ? less->table(m, 0.0) : 0.0);
    };
    const double slope = (at(m1_) - at(m0_)) / (m1_ - m0_);
    row.insert(row.end(), {at(m0_) - slope * m0_, slope});
  }

 private:
  double m0_, m1_, i0_, i1_;
};

bool IsSame(const Coefficient& a, const Coefficient& b) {
  return a.table.x == b.table.x && a.table.z == b.table.z;
}

}  // namespace

AeroGrid BuildAeroGrid(const BodyAerodynamics& body) {
  const std::vector<double> mach = Breakpoints(body, true), incidence = Breakpoints(body, false);
  AeroGrid grid;
  grid.mach = MakeAxis(mach);
  grid.incidence = MakeAxis(incidence);
  const bool in_wind_axes = !body.cd.empty() || !body.cl.empty() || !body.cm.empty() ||
                            (!IsSame(body.cnr, body.cmq) && !body.has_yaw_plane());
  for (std::size_t m = 1; m < mach.size(); ++m) {
    for (std::size_t i = 1; i < incidence.size(); ++i) {
      const Cell cell(mach[m - 1], mach[m], incidence[i - 1], incidence[i]);
      cell.Bilinear(body.ca, grid.body_axes);
      cell.Bilinear(body.cn, grid.body_axes);
      cell.Bilinear(body.xcp_station_m, grid.body_axes);
      cell.Linear(body.cmq, grid.body_axes);
      cell.Linear(body.clp, grid.body_axes);
      if (body.has_yaw_plane()) {
        cell.Bilinear(body.ca_yaw, grid.yaw_plane);
        cell.Bilinear(body.cn_yaw, grid.yaw_plane);
        cell.Bilinear(body.xcp_yaw_station_m, grid.yaw_plane);
        cell.Linear(body.cnr, grid.yaw_plane);
        grid.yaw_plane.insert(grid.yaw_plane.end(), 2, 0.0);
      }
      if (!in_wind_axes) continue;
      cell.Bilinear(body.cd, grid.wind_axes);
      cell.Bilinear(body.cl, grid.wind_axes);
      cell.Bilinear(body.cm, grid.wind_axes);
      cell.Linear(body.cnr, grid.wind_axes, &body.cmq);
      grid.wind_axes.insert(grid.wind_axes.end(), 2, 0.0);
    }
  }
  return grid;
}

}  // namespace dispersa
