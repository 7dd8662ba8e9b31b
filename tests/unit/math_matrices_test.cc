#include "core/math/matrices.h"
#include "tests/test.h"

namespace dispersa::math_matrices_test {
namespace {

Eigen::MatrixXd Square(std::initializer_list<std::initializer_list<double>> rows) {
  Eigen::MatrixXd m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.size()));
  Eigen::Index i = 0;
  for (const auto& row : rows) {
    Eigen::Index j = 0;
    for (const double value : row) m(i, j++) = value;
    ++i;
  }
  return m;
}

TEST(Matrices, EigenvaluesAreTheRootsOfTheCharacteristicPolynomial) {
  // Companion of (x - 2)(x² + 2x + 5): 2 and -1 ± 2i.
  const Eigen::VectorXcd found = Eigenvalues(Square({{0.0, 0.0, 10.0}, {1.0, 0.0, -1.0}, {0.0, 1.0, 0.0}}));
  ASSERT_EQ(found.size(), 3);
  for (const std::complex<double> root :
       {std::complex(2.0, 0.0), std::complex(-1.0, 2.0), std::complex(-1.0, -2.0)}) {
    double nearest = HUGE_VAL;
    for (Eigen::Index i = 0; i < 3; ++i) nearest = std::min(nearest, std::abs(found[i] - root));
    EXPECT_LT(nearest, 1e-13) << root;
  }
}

TEST(Matrices, OfASymmetricOneTheValuesRiseAndTheVectorsDiagonaliseIt) {
  const Eigen::MatrixXd m = Square({{4.0, 1.0, -2.0}, {1.0, 2.0, 0.5}, {-2.0, 0.5, 3.0}});
  const auto [values, vectors] = EigenOfSymmetric(m);
  EXPECT_LT(values[0], values[1]);
  EXPECT_LT(values[1], values[2]);
  EXPECT_NEAR((m * vectors - vectors * values.asDiagonal()).norm(), 0.0, 1e-14);
  EXPECT_NEAR((vectors.transpose() * vectors - Eigen::MatrixXd::Identity(3, 3)).norm(), 0.0, 1e-14);
}

TEST(Matrices, HessenbergsFormIsTurnedBack) {
  const Eigen::MatrixXd m =
      Square({{1.0, 2.0, 3.0, 4.0}, {5.0, 6.0, 7.0, 9.0}, {2.0, -1.0, 0.5, 1.0}, {3.0, 1.0, -4.0, 2.0}});
  const auto [form, turn] = HessenbergOf(m);
  EXPECT_NEAR((turn * form * turn.transpose() - m).norm(), 0.0, 1e-13);
  EXPECT_EQ(form(2, 0), 0.0);
  EXPECT_EQ(form(3, 0), 0.0);
  EXPECT_EQ(form(3, 1), 0.0);
}

TEST(Matrices, ExponentialOfARotationAndOfANilpotent) {
  const Eigen::MatrixXd r = MatrixExponential(Square({{0.0, -30.0}, {30.0, 0.0}}));
  // Eight squarings multiply rounding by a few hundred.
  EXPECT_NEAR(r(0, 0), std::cos(30.0), 1e-12);
  EXPECT_NEAR(r(1, 0), std::sin(30.0), 1e-12);
  const Eigen::MatrixXd c = MatrixExponential(Square({{0.0, 2.0, 0.0}, {0.0, 0.0, 2.0}, {0.0, 0.0, 0.0}}));
  EXPECT_NEAR(c(0, 1), 2.0, 1e-15);
  EXPECT_NEAR(c(0, 2), 2.0, 1e-15);
}

TEST(Matrices, InverseAndDeterminant) {
  const Eigen::MatrixXd m = Square({{2.0, 1.0}, {7.0, 5.0}});
  EXPECT_NEAR(DeterminantOf(m), 3.0, 1e-14);
  EXPECT_NEAR((InverseOf(m) * m - Eigen::MatrixXd::Identity(2, 2)).norm(), 0.0, 1e-14);
  EXPECT_EQ(DeterminantOf(Square({{1.0, 2.0}, {2.0, 4.0}})), 0.0);
  EXPECT_FALSE(InverseOf(Square({{1.0, 2.0}, {2.0, 4.0}})).allFinite());
}

TEST(Matrices, LeastSquaresIsTheMeanOfRepeatedMeasurements) {
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(4, 1);
  const Eigen::VectorXd x = LeastSquaresOf(ones, Eigen::Vector4d(1.0, 2.0, 4.0, 5.0));
  ASSERT_EQ(x.size(), 1);
  EXPECT_NEAR(x[0], 3.0, 1e-15);
}

TEST(Matrices, RankCountsPivotsAboveTheTolerance) {
  const Eigen::MatrixXd nearly = Square({{1.0, 1.0}, {1.0, 1.0 + 1e-8}});
  EXPECT_EQ(RankOf(nearly, 1e-6), 1);
  EXPECT_EQ(RankOf(nearly, 1e-10), 2);
  EXPECT_EQ(RankOf(Eigen::MatrixXd::Zero(3, 2), 1e-10), 0);
}

}  // namespace
}  // namespace dispersa::math_matrices_test
