#include "core/math/matrices.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace dispersa {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::VectorXcd Eigenvalues(const MatrixXd& m) {
  return Eigen::EigenSolver<MatrixXd>(m, false).eigenvalues();
}

SymmetricEigen EigenOfSymmetric(const MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Hessenberg HessenbergOf(const MatrixXd& m) {
  const Eigen::HessenbergDecomposition<MatrixXd> form(m);
  return {form.matrixH(), form.matrixQ()};
}

MatrixXd MatrixExponential(const MatrixXd& m) {
  int halvings = 0;
  for (double norm = m.cwiseAbs().rowwise().sum().maxCoeff(); norm > 0.5; norm *= 0.5) ++halvings;
  MatrixXd scaled = m;
  for (int i = 0; i < halvings; ++i) scaled *= 0.5;
  // 0.5^16 / 16! is below rounding.
  MatrixXd term = MatrixXd::Identity(m.rows(), m.cols());
  MatrixXd sum = term;
  for (int k = 1; k <= 16; ++k) {
    term = term * scaled / k;
    sum += term;
  }
  for (int i = 0; i < halvings; ++i) sum = (sum * sum).eval();
  return sum;
}

MatrixXd InverseOf(const MatrixXd& m) { return m.inverse(); }

double DeterminantOf(const MatrixXd& m) { return m.determinant(); }

VectorXd LeastSquaresOf(const MatrixXd& m, const VectorXd& right) {
  return m.colPivHouseholderQr().solve(right);
}

Eigen::Index RankOf(const MatrixXd& m, double tolerance) {
  Eigen::ColPivHouseholderQR<MatrixXd> factors(m);
  factors.setThreshold(tolerance);
  return factors.rank();
}

}  // namespace dispersa
