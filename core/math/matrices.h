// Operations on matrices of any size: Eigen's decompositions, compiled once. In each source that used them
// their templates would take the compiler longer than all the rest.
#pragma once

#include <Eigen/Core>

namespace dispersa {

/// The eigenvalues of a square matrix, with their multiplicity, in no order.
Eigen::VectorXcd Eigenvalues(const Eigen::MatrixXd& m);

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< rising
  Eigen::MatrixXd vectors;  ///< columns of length 1, in the order of the values
};
/// Eigenvalues and eigenvectors of a symmetric matrix. Only the lower triangle is read.
SymmetricEigen EigenOfSymmetric(const Eigen::MatrixXd& m);

struct Hessenberg {
  Eigen::MatrixXd form;  ///< zero below the first subdiagonal
  Eigen::MatrixXd turn;  ///< orthogonal; m = turn form turn'
};
/// The Hessenberg form of a square matrix.
Hessenberg HessenbergOf(const Eigen::MatrixXd& m);

/// exp(m) by a Taylor series with scaling and squaring, to rounding.
Eigen::MatrixXd MatrixExponential(const Eigen::MatrixXd& m);

/// Inverse of a square matrix. Its values are not finite if the matrix is singular.
Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& m);
double DeterminantOf(const Eigen::MatrixXd& m);

/// The x with the least |m x - right|, by a QR decomposition with column pivoting.
Eigen::VectorXd LeastSquaresOf(const Eigen::MatrixXd& m, const Eigen::VectorXd& right);
/// Columns that are independent: pivots above the tolerance times the greatest.
Eigen::Index RankOf(const Eigen::MatrixXd& m, double tolerance);

}  // namespace dispersa
