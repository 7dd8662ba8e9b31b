// Finds the same mode again when the beam has changed.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dispersa {

/// The continuation of a mode at the next level.
struct ModeMatch {
  Eigen::Index index = 0;  ///< column of the later shapes
  double sign = 1.0;       ///< by which that column is multiplied to point the same way
  double mac = 0.0;        ///< modal assurance criterion, 0 to 1
};

/// For each column of `earlier` one of `later`, which has at least as many columns. No two are the same.
/// Pairs are taken by falling modal assurance criterion (a' M b)² / (a' M a  b' M b) of R. J. Allemang and D.
/// L. Brown (1982), with the mass as weight, so that orthogonal modes have exactly 0. `mass` is that of
/// either level or, better, the mean of both.
std::vector<ModeMatch> MatchModes(const Eigen::MatrixXd& earlier, const Eigen::MatrixXd& later,
                                  const Eigen::MatrixXd& mass);

/// The same pairs, from the criterion of each row with each column, and from products whose signs count.
std::vector<ModeMatch> PairByFallingMac(Eigen::MatrixXd mac, const Eigen::MatrixXd& product);

}  // namespace dispersa
