// Quaternions, matrices, rotation vectors and Euler angles: conversion of each to the others, also at
// singularities.
#include "core/math/constants.h"
#include "core/math/rotation.h"
#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::math_rotation_test {
namespace {

// About a unit axis, by Rodrigues' formula: none of the code that is tested.
Matrix3 Turned(const Vector3& axis, double angle) {
  Matrix3 k;
  k << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return Matrix3::Identity() + std::sin(angle) * k + (1.0 - std::cos(angle)) * k * k;
}
Matrix3 AboutX(double angle) { return Turned(Vector3::UnitX(), angle); }
Matrix3 AboutY(double angle) { return Turned(Vector3::UnitY(), angle); }
Matrix3 AboutZ(double angle) { return Turned(Vector3::UnitZ(), angle); }

Vector3 RandomAxis(Stream& random) {
  return Vector3(random.Normal(), random.Normal(), random.Normal()).normalized();
}
double Difference(const Matrix3& a, const Matrix3& b) { return (a - b).cwiseAbs().maxCoeff(); }

// Up to half a turn about any axis: every element of the quaternion is the largest for some of them.
TEST(Rotation, QuaternionsMatricesAndVectorsAreTheSameTurn) {
  int largest[4] = {};
  for (std::uint64_t draw = 0; draw < 500; ++draw) {
    Stream random(1, draw, "turns");
    const Vector3 axis = RandomAxis(random);
    const double angle = (draw % 2 == 0 ? 0.9999 : random.Uniform()) * kPi;
    const Matrix3 exact = Turned(axis, angle);
    const Quaternion q = FromRotationVector(angle * axis);
    EXPECT_LT(Difference(RotationMatrix(q), exact), 1e-14);
    const Quaternion back = QuaternionOf(exact);
    EXPECT_GE(back.w, 0.0);
    EXPECT_LT(Difference(RotationMatrix(back), exact), 1e-14);
    EXPECT_LT((RotationVector(q) - angle * axis).norm(), 1e-13);
    // The same turn by the other quaternion that stands for it.
    EXPECT_LT((RotationVector({-q.w, -q.x, -q.y, -q.z}) - angle * axis).norm(), 1e-13);
    const Vector3 v(1.0, -2.0, 0.5);
    EXPECT_LT((Rotate(q, v) - exact * v).norm(), 1e-14);
    const double size[] = {q.w, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)};
    ++largest[std::max_element(size, size + 4) - size];
  }
  for (const int count : largest) EXPECT_GT(count, 10) << "each branch of QuaternionOf is taken";
}

TEST(Rotation, SmallVectorsAreTurnsToo) {
  for (const double size : {1e-12, 1e-10, 1e-8, 1e-6}) {
    const Vector3 phi = size * Vector3(0.6, -0.48, 0.64);
    const Quaternion q = FromRotationVector(phi);
    EXPECT_NEAR(q.x / phi.x(), 0.5, 1e-12);
    EXPECT_NEAR(q.y / phi.y(), 0.5, 1e-12);
    EXPECT_NEAR(q.z / phi.z(), 0.5, 1e-12);
    EXPECT_LT((RotationVector(q) - phi).norm(), 1e-12 * size);
  }
}

TEST(Rotation, TheProductOfTurnsIsTheProductOfTheirMatrices) {
  for (std::uint64_t draw = 0; draw < 50; ++draw) {
    Stream random(2, draw, "turns");
    const Quaternion a = FromRotationVector(2.0 * RandomAxis(random));
    const Quaternion b = FromRotationVector(1.5 * RandomAxis(random));
    EXPECT_LT(Difference(RotationMatrix(a * b), RotationMatrix(a) * RotationMatrix(b)), 1e-14);
    EXPECT_LT(Difference(RotationMatrix(Inverse(a)), RotationMatrix(a).transpose()), 1e-15);
  }
}

TEST(Rotation, TheDerivativeIsThatOfATurningBody) {
  const Quaternion q = FromRotationVector({0.4, -0.7, 1.1});
  const Vector3 w_B(0.3, 0.2, -0.5);
  const double h = 1e-5;
  const Quaternion before = q * FromRotationVector(-h * w_B), after = q * FromRotationVector(h * w_B);
  const Quaternion rate = Derivative(q, w_B);
  EXPECT_NEAR(rate.w, (after.w - before.w) / (2.0 * h), 1e-10);
  EXPECT_NEAR(rate.x, (after.x - before.x) / (2.0 * h), 1e-10);
  EXPECT_NEAR(rate.y, (after.y - before.y) / (2.0 * h), 1e-10);
  EXPECT_NEAR(rate.z, (after.z - before.z) / (2.0 * h), 1e-10);
}

// With the middle angle anywhere, the ends among it: there the outer two angles are one turn, all of it the
// last.
constexpr double kMiddle[] = {-0.5 * kPi, -1.2, -0.3, 0.0, 0.7, 1.5, 0.5 * kPi};

using Angles = std::array<double, 3>;

// `from` makes a quaternion of a turn about one axis, then another, then x; `to` takes the three angles from
// it.
template <typename From, typename To>
void ExpectTurnsAbout(Matrix3 (*first)(double), Matrix3 (*second)(double), std::uint64_t seed, From from,
                      To to) {
  for (const double middle : kMiddle) {
    for (std::uint64_t draw = 0; draw < 20; ++draw) {
      Stream random(seed, draw, "angles");
      const double outer = kPi * (2.0 * random.Uniform() - 1.0), roll = kPi * (2.0 * random.Uniform() - 1.0);
      const Matrix3 exact = first(outer) * second(middle) * AboutX(roll);
      const Quaternion q = from(outer, middle, roll);
      EXPECT_LT(Difference(RotationMatrix(q), exact), 1e-14);
      const Angles back = to(q);
      // At the ends the sine is flat: 1e-15 of it are 3e-8 of the angle.
      EXPECT_LT(Difference(first(back[0]) * second(back[1]) * AboutX(back[2]), exact), 1e-7) << middle;
      if (std::fabs(middle) < 1.55) {
        EXPECT_NEAR(back[0], outer, 1e-12);
        EXPECT_NEAR(back[1], middle, 1e-12);
        EXPECT_NEAR(back[2], roll, 1e-12);
      } else {
        EXPECT_EQ(back[0], 0.0);
      }
    }
  }
}

TEST(Rotation, YawPitchRollAreTurnsAboutZYX) {
  ExpectTurnsAbout(
      AboutZ, AboutY, 3,
      [](double yaw, double pitch, double roll) {
        return FromYawPitchRoll({.yaw = yaw, .pitch = pitch, .roll = roll});
      },
      [](const Quaternion& q) {
        const YawPitchRoll angles = ToYawPitchRoll(q);
        return Angles{angles.yaw, angles.pitch, angles.roll};
      });
}

TEST(Rotation, PitchYawRollAreTurnsAboutYZX) {
  ExpectTurnsAbout(
      AboutY, AboutZ, 4,
      [](double pitch, double yaw, double roll) {
        return FromPitchYawRoll({.pitch = pitch, .yaw = yaw, .roll = roll});
      },
      [](const Quaternion& q) {
        const PitchYawRoll angles = ToPitchYawRoll(q);
        return Angles{angles.pitch, angles.yaw, angles.roll};
      });
}

}  // namespace
}  // namespace dispersa::math_rotation_test
