// Which mode is which when the beam changes.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dispersa {

/// What continues a mode.
struct ModeMatch {
  Eigen::Index index = 0;  ///< column of the later shapes
  double sign = 1.0;       ///< by which that column is multiplied to point the same way
  double mac = 0.0;        ///< modal assurance criterion, 0 to 1
};

/// For each column of `earlier` one of `later`, which has as many columns or more, no two the same: pairs by
/// falling modal assurance criterion (a' M b)² / (a' M a  b' M b), R. J. Allemang and D. L. Brown's (1982)
/// with the mass as its weight, so that orthogonal modes have 0 exactly. `mass` is that of either or, better,
/// the mean of both.
std::vector<ModeMatch> MatchModes(const Eigen::MatrixXd& earlier, const Eigen::MatrixXd& later,
                                  const Eigen::MatrixXd& mass);

}  // namespace dispersa
