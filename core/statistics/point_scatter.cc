#include "core/statistics/point_scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>

#include "core/math/assertion.h"

namespace dispersa {

PointScatter PointScatterOf(const std::vector<std::vector<double>>& points) {
  PointScatter scatter;
  scatter.n = points.size();
  if (points.empty()) return scatter;
  const std::size_t d = points[0].size();
  const auto n = static_cast<double>(points.size());
  scatter.mean.assign(d, 0.0);
  scatter.covariance.assign(d, std::vector<double>(d, 0.0));
  for (const auto& point : points)
    for (std::size_t i = 0; i < d; ++i) scatter.mean[i] += point[i];
  for (double& mean : scatter.mean) mean /= n;
  for (const auto& point : points)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j)
        scatter.covariance[i][j] += (point[i] - scatter.mean[i]) * (point[j] - scatter.mean[j]);
  for (auto& row : scatter.covariance)
    for (double& value : row) value = points.size() > 1 ? value / (n - 1.0) : 0.0;
  return scatter;
}

std::vector<Containment> ContainmentOf(const std::vector<std::vector<double>>& points,
                                       const PointScatter& scatter, const std::vector<double>& stated) {
  const auto d = static_cast<Eigen::Index>(scatter.mean.size());
  if (static_cast<Eigen::Index>(points.size()) < d + 2) return {};
  // In units of each coordinate's spread. Otherwise metres beside radians would make the matrix look
  // singular.
  Eigen::VectorXd unit(d);
  for (Eigen::Index i = 0; i < d; ++i) {
    unit[i] = std::sqrt(scatter.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(i)]);
    if (!(unit[i] > 0.0)) return {};
  }
  Eigen::MatrixXd correlation(d, d);
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index j = 0; j < d; ++j)
      correlation(i, j) =
          scatter.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] / (unit[i] * unit[j]);
  const Eigen::LDLT<Eigen::MatrixXd> factor(correlation);
  if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() < 1e-10) return {};

  std::vector<double> squared;
  for (const auto& point : points) {
    Eigen::VectorXd x(d);
    for (Eigen::Index i = 0; i < d; ++i)
      x[i] = (point[static_cast<std::size_t>(i)] - scatter.mean[static_cast<std::size_t>(i)]) / unit[i];
    squared.push_back(x.dot(factor.solve(x)));
  }
  std::vector<Containment> result;
  for (const double share : stated) {
    Containment one;
    one.stated = share;
    one.scale = boost::math::quantile(boost::math::chi_squared(static_cast<double>(d)), share);
    for (const double value : squared) one.inside += value <= one.scale;
    one.empirical = static_cast<double>(one.inside) / static_cast<double>(points.size());
    one.limits = ClopperPearson(one.inside, std::ssize(points), 0.95);
    result.push_back(one);
  }
  return result;
}

ScatterEllipse EllipseOf(const std::vector<std::vector<double>>& covariance, double scale) {
  DISPERSA_ASSERT(covariance.size() == 2, covariance.size());
  const double a = covariance[0][0], b = covariance[0][1], c = covariance[1][1];
  const double middle = 0.5 * (a + c);
  const double half = std::hypot(0.5 * (a - c), b);
  ScatterEllipse ellipse;
  ellipse.semi_major = std::sqrt(scale * (middle + half));
  // The product of the roots is the determinant. This way a slender ellipse loses no digits.
  ellipse.semi_minor =
      std::sqrt(scale * std::max(0.0, middle + half > 0.0 ? (a * c - b * b) / (middle + half) : 0.0));
  ellipse.angle_rad = 0.5 * std::atan2(2.0 * b, a - c);
  return ellipse;
}

std::vector<std::array<double, 2>> OutlineOf(const ScatterEllipse& ellipse,
                                             const std::array<double, 2>& centre, int points) {
  std::vector<std::array<double, 2>> outline;
  const double c = std::cos(ellipse.angle_rad), s = std::sin(ellipse.angle_rad);
  for (int i = 0; i < points; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / points;
    const double x = ellipse.semi_major * std::cos(turn), y = ellipse.semi_minor * std::sin(turn);
    outline.push_back({centre[0] + c * x - s * y, centre[1] + s * x + c * y});
  }
  outline.push_back(outline.front());
  return outline;
}

}  // namespace dispersa
