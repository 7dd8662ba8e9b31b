#include "core/structure/mode_tracking.h"

#include <utility>

#include "core/structure/beam_elements.h"

namespace dispersa {

std::vector<ModeMatch> MatchModes(const Eigen::MatrixXd& earlier, const Eigen::MatrixXd& later,
                                  const Eigen::MatrixXd& mass) {
  const Eigen::MatrixXd moved = MassTimes(mass, later);
  const Eigen::MatrixXd product = earlier.transpose() * moved;
  const Eigen::VectorXd earlier_norm =
      earlier.cwiseProduct(MassTimes(mass, earlier)).colwise().sum().transpose();
  const Eigen::VectorXd later_norm = later.cwiseProduct(moved).colwise().sum().transpose();
  Eigen::MatrixXd mac = product.array().square().matrix();
  for (Eigen::Index row = 0; row < mac.rows(); ++row) {
    for (Eigen::Index column = 0; column < mac.cols(); ++column)
      mac(row, column) /= earlier_norm[row] * later_norm[column];
  }
  return PairByFallingMac(std::move(mac), product);
}

std::vector<ModeMatch> PairByFallingMac(Eigen::MatrixXd mac, const Eigen::MatrixXd& product) {
  std::vector<ModeMatch> matches(static_cast<std::size_t>(mac.rows()));
  for (Eigen::Index pair = 0; pair < mac.rows(); ++pair) {
    Eigen::Index row = 0, column = 0;
    const double best = mac.maxCoeff(&row, &column);
    matches[static_cast<std::size_t>(row)] = {column, product(row, column) < 0.0 ? -1.0 : 1.0, best};
    mac.row(row).setConstant(-1.0);
    mac.col(column).setConstant(-1.0);
  }
  return matches;
}

}  // namespace dispersa
