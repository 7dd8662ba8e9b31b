// Free beams against exact solutions: uniform, stepped, conical, with shear, with lumped bodies;
// orthogonality, rigid modes, order of convergence. Characteristic equations are derived and solved here,
// independently of the elements.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/math/special_functions/bessel.hpp>

#include "core/math/constants.h"
#include "core/structure/beam_elements.h"
#include "core/structure/beam_mesh.h"
#include "core/structure/free_free_modes.h"
#include "tests/test.h"

namespace dispersa::structure_beams_test {
namespace {

/// The first roots of cos x cosh x = 1, beta L of the uniform beam.
constexpr double kUniformRoots[] = {4.730040744862704, 7.853204624095838, 10.995607838001671,
                                    14.137165491257464, 17.278759657399481};

BeamSection Section(double top_m, double bottom_m, double bending_n_m2, double shear_n = 0.0) {
  BeamSection section;
  section.top_station_m = top_m;
  section.bottom_station_m = bottom_m;
  section.bending_stiffness_n_m2 = {bending_n_m2, bending_n_m2};
  section.shear_stiffness_n = {shear_n, shear_n};
  return section;
}

SpreadMass Mass(double top_m, double bottom_m, double kg_m, double gyration2_m2 = 0.0) {
  return {top_m, bottom_m, {kg_m, kg_m}, {gyration2_m2, gyration2_m2}};
}

struct Solved {
  std::vector<double> stations;
  std::vector<BeamElement> elements;
  Eigen::MatrixXd mass;
  FreeFreeModes modes;
};

Solved Solve(const Beam& beam, int elements, int modes, BeamPlane plane = BeamPlane::kY) {
  Solved s;
  s.stations = MeshStations(beam.sections, beam.masses, elements);
  s.elements = BuildElements(beam, plane, s.stations);
  s.mass = MassMatrix(beam, s.stations, s.elements);
  s.modes = SolveFreeFree(s.stations, s.elements, s.mass, modes);
  return s;
}

/// Roots of a function between two arguments: changes of sign over a fine scan, then bisected to rounding.
std::vector<double> Roots(const std::function<double(double)>& f, double from, double to, std::size_t count) {
  std::vector<double> roots;
  constexpr int kScan = 4000;
  double left = from, at_left = f(from);
  for (int i = 1; i <= kScan && roots.size() < count; ++i) {
    const double right = from + (to - from) * i / kScan, at_right = f(right);
    if ((at_left < 0.0) != (at_right < 0.0)) {
      double a = left, b = right;
      for (int k = 0; k < 80; ++k) {
        const double middle = 0.5 * (a + b);
        ((f(middle) < 0.0) == (at_left < 0.0) ? a : b) = middle;
      }
      roots.push_back(0.5 * (a + b));
    }
    left = right, at_left = at_right;
  }
  return roots;
}

/// The determinant by rows of their own size, so that its sign is right whatever the exponentials in it.
double ScaledDeterminant(Eigen::MatrixXd matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) matrix.row(row) /= matrix.row(row).norm();
  for (Eigen::Index column = 0; column < matrix.cols(); ++column)
    matrix.col(column) /= matrix.col(column).norm();
  return matrix.fullPivLu().determinant();
}

Beam UniformBeam(double length_m = 20.0, double bending_n_m2 = 3e8, double kg_m = 700.0) {
  return {{Section(0.0, length_m, bending_n_m2)}, {{Mass(0.0, length_m, kg_m)}, {}}};
}

TEST(FreeBeams, UniformFrequenciesAreTheTextbooks) {
  const Solved s = Solve(UniformBeam(), 120, 5);
  for (int i = 0; i < 5; ++i) {
    const double exact = kUniformRoots[i] * kUniformRoots[i] * std::sqrt(3e8 / (700.0 * std::pow(20.0, 4)));
    EXPECT_NEAR(s.modes.frequency_rad_s[i] / exact, 1.0, 1e-6) << i;
  }
}

// A Ritz method with cubics and the element's bow, a function of the fourth power: the error of omega² falls
// with the sixth power of the element, from above.
TEST(FreeBeams, ConvergeWithTheSixthPowerFromAbove) {
  for (int mode = 0; mode < 3; ++mode) {
    const double exact =
        kUniformRoots[mode] * kUniformRoots[mode] * std::sqrt(3e8 / (700.0 * std::pow(20.0, 4)));
    double before = 0.0;
    for (const int elements : {10, 20, 40}) {
      const double error = Solve(UniformBeam(), elements, 3).modes.frequency_rad_s[mode] / exact - 1.0;
      EXPECT_GT(error, 0.0);
      if (before > 0.0) {
        EXPECT_NEAR(std::log2(before / error), 6.0, 0.1) << "mode " << mode << ", " << elements;
      }
      before = error;
    }
  }
}

// However fine or uneven the mesh: an element of a millimetre costs no digits. (K and M given to a
// generalised solver lose all of them here: the highest mode is 1e16 times the first in omega².)
TEST(FreeBeams, KeepTheirDigitsOnAnUnevenMesh) {
  Beam beam = UniformBeam();
  beam.sections = {Section(0.0, 7.0, 3e8), Section(7.0, 7.001, 3e8), Section(7.001, 20.0, 3e8)};
  const Solved s = Solve(beam, 100, 3);
  for (int i = 0; i < 3; ++i) {
    const double exact = kUniformRoots[i] * kUniformRoots[i] * std::sqrt(3e8 / (700.0 * std::pow(20.0, 4)));
    EXPECT_NEAR(s.modes.frequency_rad_s[i] / exact, 1.0, 2e-7) << i;
  }
}

// The same from the assembled matrices by Eigen's generalised solver, where it keeps its digits.
TEST(FreeBeams, AgreeWithTheGeneralisedEigenproblem) {
  Beam beam = UniformBeam();
  beam.sections[0].bending_stiffness_n_m2 = {1e8, 6e8};
  beam.masses.fixed = {{20.0, 3000.0, 21.0, 400.0}};
  const Solved s = Solve(beam, 20, 4);
  const Eigen::MatrixXd stiffness = StiffnessMatrix(s.elements);
  const Eigen::Index rows = s.mass.rows() - 1;  // no bow behind the last node
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> direct(stiffness.topLeftCorner(rows, rows),
                                                                         s.mass.topLeftCorner(rows, rows));
  const double first = direct.eigenvalues()[2];
  for (const int rigid : {0, 1}) EXPECT_LT(std::fabs(direct.eigenvalues()[rigid]), 1e-9 * first);
  for (int i = 0; i < 4; ++i) {
    const double omega2 = s.modes.frequency_rad_s[i] * s.modes.frequency_rad_s[i];
    EXPECT_NEAR(direct.eigenvalues()[i + 2] / omega2, 1.0, 1e-9) << i;
  }
}

TEST(FreeBeams, RigidMotionCostsNoEnergyAndModesHaveNoMomentum) {
  Beam beam = UniformBeam();
  beam.sections[0].bending_stiffness_n_m2 = {1e8, 6e8};
  beam.masses.fixed = {{0.0, 3000.0, 1.0, 400.0}};
  const Solved s = Solve(beam, 40, 4);
  const Eigen::MatrixXd stiffness = StiffnessMatrix(s.elements);
  const BeamMassProperties whole = PropertiesOf(s.mass, s.stations);
  const Eigen::MatrixXd rigid = RigidShapes(s.stations, whole.cg_station_m);
  // Forces of a rigid motion, against those of a mode of like size.
  const double forces = (stiffness * s.modes.shape.col(0)).norm() / s.modes.shape.col(0).norm();
  for (const int column : {0, 1})
    EXPECT_LT((stiffness * rigid.col(column)).norm() / rigid.col(column).norm(), 1e-6 * forces);
  const Eigen::MatrixXd momenta = rigid.transpose() * s.mass * s.modes.shape;
  // Linear and angular momentum, over those of the whole beam moving with the mode's generalised speed.
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(std::fabs(momenta(0, i)), 1e-12 * std::sqrt(whole.mass_kg));
    EXPECT_LT(std::fabs(momenta(1, i)), 1e-12 * std::sqrt(whole.transverse_inertia_kg_m2));
  }
}

TEST(FreeBeams, ModesAreOrthogonalByMassAndStiffness) {
  Beam beam = UniformBeam();
  beam.sections = {Section(0.0, 6.0, 2e7), Section(6.0, 20.0, 5e8)};
  beam.masses = {{Mass(0.0, 6.0, 90.0, 0.05), Mass(5.0, 20.0, 900.0, 0.2)}, {{6.0, 800.0, 5.0, 90.0}}};
  const Solved s = Solve(beam, 60, 6);
  const Eigen::MatrixXd by_mass = s.modes.shape.transpose() * s.mass * s.modes.shape;
  const Eigen::MatrixXd by_stiffness =
      s.modes.shape.transpose() * StiffnessMatrix(s.elements) * s.modes.shape;
  EXPECT_LT((by_mass - Eigen::MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), 1e-11);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double scale = s.modes.frequency_rad_s[i] * s.modes.frequency_rad_s[j];
      // The assembled stiffness rounds at the highest mode, here 1e7 times the first in omega².
      EXPECT_NEAR(by_stiffness(i, j) / scale, i == j ? 1.0 : 0.0, 1e-8) << i << ", " << j;
    }
  }
}

// Two uniform pieces: w = A cos + B sin + C cosh + D sinh of beta x in each, no moment and no shear force at
// the free ends, deflection, slope, moment and shear force continuous at the step. The determinant of the
// eight conditions.
double SteppedDeterminant(double omega, const double (&length)[2], const double (&bending)[2],
                          const double (&kg_m)[2]) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(8, 8);
  // The derivatives 0 to 3 of the four functions at x.
  const auto derivatives = [](double beta, double x) {
    const double c = std::cos(beta * x), s = std::sin(beta * x), ch = std::cosh(beta * x),
                 sh = std::sinh(beta * x);
    Eigen::Matrix4d d;
    d << c, s, ch, sh,                              //
        -beta * s, beta * c, beta * sh, beta * ch,  //
        beta * beta * -c, beta * beta * -s, beta * beta * ch, beta * beta * sh, std::pow(beta, 3) * s,
        -std::pow(beta, 3) * c, std::pow(beta, 3) * sh, std::pow(beta, 3) * ch;
    return d;
  };
  double beta[2];
  for (const int i : {0, 1}) beta[i] = std::sqrt(omega) * std::pow(kg_m[i] / bending[i], 0.25);
  const Eigen::Matrix4d begin = derivatives(beta[0], 0.0), left = derivatives(beta[0], length[0]);
  const Eigen::Matrix4d right = derivatives(beta[1], 0.0), end = derivatives(beta[1], length[1]);
  m.block<2, 4>(0, 0) = begin.bottomRows<2>();
  for (int row = 0; row < 4; ++row) {
    m.block<1, 4>(2 + row, 0) = (row < 2 ? 1.0 : bending[0]) * left.row(row);
    m.block<1, 4>(2 + row, 4) = -(row < 2 ? 1.0 : bending[1]) * right.row(row);
  }
  m.block<2, 4>(6, 4) = end.bottomRows<2>();
  return ScaledDeterminant(m);
}

TEST(FreeBeams, SteppedFrequenciesAreThoseOfTheirDeterminant) {
  const double length[2] = {8.0, 12.0}, bending[2] = {4e7, 6e8}, kg_m[2] = {250.0, 1100.0};
  const std::vector<double> exact =
      Roots([&](double omega) { return SteppedDeterminant(omega, length, bending, kg_m); }, 2.0, 400.0, 4);
  ASSERT_EQ(exact.size(), 4u);
  const Beam beam{{Section(0.0, 8.0, 4e7), Section(8.0, 20.0, 6e8)},
                  {{Mass(0.0, 8.0, 250.0), Mass(8.0, 20.0, 1100.0)}, {}}};
  const Solved s = Solve(beam, 120, 4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s.modes.frequency_rad_s[i] / exact[i], 1.0, 1e-6) << i;
  // The determinant itself, where it is a textbook's: no step at all.
  const double even_bending[2] = {3e8, 3e8}, even_kg_m[2] = {700.0, 700.0};
  const std::vector<double> even =
      Roots([&](double omega) { return SteppedDeterminant(omega, length, even_bending, even_kg_m); }, 2.0,
            400.0, 1);
  EXPECT_NEAR(even[0], std::pow(kUniformRoots[0] / 20.0, 2) * std::sqrt(3e8 / 700.0), 1e-9 * even[0]);
}

// A solid cone cut off at a fifth of its length: area a x², second moment b x⁴ about the apex, so
// (b E x⁴ w'')'' = omega² rho a x² w, whose solutions are w = F_2(z) / x with z = 2 sqrt(k x), k² = omega²
// rho a / (b E) and F one of J, Y, I, K. Free ends: w'' = 0 and, with that, w''' = 0.
double ConeDeterminant(double k, double tip_m, double base_m) {
  // d/dx of x^-n/2 F_n(2 sqrt(k x)) is s sqrt(k) x^-(n+1)/2 F_{n+1}, with s = -1 for J, Y, K and +1 for I.
  const auto bessel = [](int kind, int order, double z) {
    switch (kind) {
      case 0:
        return boost::math::cyl_bessel_j(order, z);
      case 1:
        return boost::math::cyl_neumann(order, z);
      case 2:
        return boost::math::cyl_bessel_i(order, z);
      default:
        return boost::math::cyl_bessel_k(order, z);
    }
  };
  Eigen::MatrixXd m(4, 4);
  for (int kind = 0; kind < 4; ++kind) {
    int row = 0;
    for (const double x : {tip_m, base_m}) {
      for (const int derivative : {2, 3}) {
        const int order = 2 + derivative;
        const double sign = kind != 2 && derivative == 3 ? -1.0 : 1.0;
        m(row++, kind) =
            sign * std::pow(std::sqrt(k / x), derivative) / x * bessel(kind, order, 2.0 * std::sqrt(k * x));
      }
    }
  }
  return ScaledDeterminant(m);
}

TEST(FreeBeams, ConicalFrequenciesAreThoseOfBesselsFunctions) {
  const double tip_m = 2.0, base_m = 10.0, half_angle = 0.05, modulus = 70e9, density = 2700.0;
  // Radius r = half_angle x: a = pi half_angle², b = pi half_angle⁴ / 4.
  const double k_over_omega = std::sqrt(density * 4.0 / (modulus * half_angle * half_angle));
  const std::vector<double> exact = Roots(
      [&](double omega) { return ConeDeterminant(omega * k_over_omega, tip_m, base_m); }, 20.0, 4000.0, 3);
  ASSERT_EQ(exact.size(), 3u);
  BeamSection section;
  section.top_station_m = tip_m;
  section.bottom_station_m = base_m;
  section.outer_diameter_m = {2.0 * half_angle * tip_m, 2.0 * half_angle * base_m};
  section.thickness_m = {half_angle * tip_m, half_angle * base_m};
  section.modulus_pa = modulus;
  SpreadMass mass = Mass(tip_m, base_m, density * kPi * half_angle * half_angle);
  mass.scale = {0.0, 0.0, 1.0};  // times x²
  const Solved coarse = Solve({{section}, {{mass}, {}}}, 50, 3),
               fine = Solve({{section}, {{mass}, {}}}, 100, 3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(fine.modes.frequency_rad_s[i] / exact[i], 1.0, 1e-6) << i;
    // Also a section that changes within the element keeps the sixth order.
    const double order = std::log2((coarse.modes.frequency_rad_s[i] / exact[i] - 1.0) /
                                   (fine.modes.frequency_rad_s[i] / exact[i] - 1.0));
    EXPECT_NEAR(order, 6.0, 0.15) << i;
  }
}

// Timoshenko's uniform beam: kGA (w' - theta)' = -mu omega² w, EI theta'' + kGA (w' - theta) = -mu r² omega²
// theta. With exp(p x): p⁴ + p² omega² (mu / kGA + mu r² / EI) - omega² mu / EI (1 - omega² mu r² / kGA) = 0,
// one p² negative and one positive below the cut-off; theta = (p² + omega² mu / kGA) / p w. Free ends: theta'
// = 0, w' = theta.
double TimoshenkoDeterminant(double omega, double length, double bending, double shear, double kg_m,
                             double gyration2) {
  const double a = omega * omega * (kg_m / shear + kg_m * gyration2 / bending);
  const double b = omega * omega * kg_m / bending * (1.0 - omega * omega * kg_m * gyration2 / shear);
  const double root = std::sqrt(0.25 * a * a + b);
  const double p = std::sqrt(root + 0.5 * a), q = std::sqrt(root - 0.5 * a);  // cos p x, cosh q x
  const double s = omega * omega * kg_m / shear;
  const double gp = (p * p - s) / p, gq = (q * q + s) / q;
  // w of cos, sin, cosh, sinh; theta = -gp sin, gp cos, gq sinh, gq cosh; theta' and w' - theta at both ends.
  Eigen::MatrixXd m(4, 4);
  int row = 0;
  for (const double x : {0.0, length}) {
    const double c = std::cos(p * x), sn = std::sin(p * x), ch = std::cosh(q * x), sh = std::sinh(q * x);
    m.row(row++) << -gp * p * c, -gp * p * sn, gq * q * ch, gq * q * sh;
    m.row(row++) << -(p - gp) * sn, (p - gp) * c, (q - gq) * sh, (q - gq) * ch;
  }
  return ScaledDeterminant(m);
}

TEST(FreeBeams, TimoshenkosFrequenciesAreThoseOfTheirCharacteristicEquation) {
  // A tube as short as a stage: length over diameter 5, where shear and rotary inertia take a fifth off.
  const double length = 5.0, bending = 5e7, shear = 9e7, kg_m = 400.0, gyration2 = 0.125;
  const std::vector<double> exact = Roots(
      [&](double omega) { return TimoshenkoDeterminant(omega, length, bending, shear, kg_m, gyration2); },
      5.0, 1300.0, 3);
  ASSERT_EQ(exact.size(), 3u);
  Beam beam{{Section(0.0, length, bending, shear)}, {{Mass(0.0, length, kg_m, gyration2)}, {}}, true};
  const auto errors = [&](double gyration2_m2, const std::vector<double>& of, int elements) {
    beam.masses.spread = {Mass(0.0, length, kg_m, gyration2_m2)};
    const Solved s = Solve(beam, elements, 3);
    std::vector<double> relative;
    for (int i = 0; i < 3; ++i)
      relative.push_back(s.modes.frequency_rad_s[i] / of[static_cast<std::size_t>(i)] - 1.0);
    return relative;
  };
  const std::vector<double> slender =
      Roots([&](double omega) { return TimoshenkoDeterminant(omega, length, bending, shear, kg_m, 1e-12); },
            5.0, 1300.0, 3);
  const std::vector<double> coarse = errors(gyration2, exact, 40), fine = errors(gyration2, exact, 80),
                            coarse_slender = errors(0.0, slender, 10),
                            fine_slender = errors(0.0, slender, 20);
  for (std::size_t i = 0; i < 3; ++i) {
    // Second order, because the couples of rotary inertia only turn an element's ends; so two meshes give the
    // limit.
    EXPECT_GT(fine[i], 0.0);
    EXPECT_LT(fine[i], 1e-4) << i;
    EXPECT_NEAR(std::log2(coarse[i] / fine[i]), 2.0, 0.05) << i;
    EXPECT_NEAR((4.0 * fine[i] - coarse[i]) / 3.0, 0.0, 1e-6) << i;
    // Shear alone: the bow has it.
    EXPECT_NEAR(std::log2(coarse_slender[i] / fine_slender[i]), 4.0, 0.3) << i;
  }
  beam.masses.spread = {Mass(0.0, length, kg_m, gyration2)};
  // Effects that are otherwise neglected: each lowers the frequency.
  beam.timoshenko = false;
  const double stiff = Solve(beam, 80, 1).modes.frequency_rad_s[0];
  beam.rotary_inertia = false;
  const double thin = Solve(beam, 80, 1).modes.frequency_rad_s[0];
  EXPECT_GT(stiff, 1.05 * exact[0]);
  EXPECT_GT(thin, 1.01 * stiff);
  EXPECT_NEAR(thin, std::pow(kUniformRoots[0] / length, 2) * std::sqrt(bending / kg_m), 1e-6 * thin);
}

// A rigid body fixed to the top end, its centre of gravity at x = d: mass, offset and inertia.
TEST(FreeBeams, ALumpedBodyActsByMassOffsetAndInertia) {
  const double length = 20.0, bending = 3e8, kg_m = 700.0, body_kg = 2500.0, offset = -1.4, inertia = 900.0;
  // Virtual work of a variation of w and of w' at that end: EI w''' = omega² m (w + d w') and
  // -EI w'' = omega² (m d (w + d w') + J w'); at the other end w'' = w''' = 0.
  const auto determinant = [&](double omega) {
    const double beta = std::sqrt(omega) * std::pow(kg_m / bending, 0.25), o2 = omega * omega;
    const double w[4] = {1, 0, 1, 0}, dw[4] = {0, beta, 0, beta};
    const double d2w[4] = {-beta * beta, 0, beta * beta, 0},
                 d3w[4] = {0, -std::pow(beta, 3), 0, std::pow(beta, 3)};
    const double c = std::cos(beta * length), s = std::sin(beta * length), ch = std::cosh(beta * length),
                 sh = std::sinh(beta * length);
    Eigen::MatrixXd m(4, 4);
    for (int i = 0; i < 4; ++i) {
      m(0, i) = bending * d3w[i] - o2 * body_kg * (w[i] + offset * dw[i]);
      m(1, i) =
          bending * d2w[i] + o2 * (body_kg * offset * w[i] + (inertia + body_kg * offset * offset) * dw[i]);
    }
    m.row(2) << -c, -s, ch, sh;
    m.row(3) << s, -c, sh, ch;
    return ScaledDeterminant(m);
  };
  const std::vector<double> exact = Roots(determinant, 2.0, 400.0, 3);
  ASSERT_EQ(exact.size(), 3u);
  Beam beam = UniformBeam(length, bending, kg_m);
  beam.masses.fixed = {{0.0, body_kg, offset, inertia}};
  const Solved s = Solve(beam, 120, 3);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.modes.frequency_rad_s[i] / exact[i], 1.0, 1e-6) << i;
}

TEST(FreeBeams, TheOtherPlaneHasItsOwnStiffness) {
  Beam beam = UniformBeam();
  beam.sections[0].z_to_y_stiffness = 1.44;
  const double y = Solve(beam, 30, 1, BeamPlane::kY).modes.frequency_rad_s[0];
  const double z = Solve(beam, 30, 1, BeamPlane::kZ).modes.frequency_rad_s[0];
  EXPECT_NEAR(z / y, 1.2, 1e-12);
}

}  // namespace
}  // namespace dispersa::structure_beams_test
