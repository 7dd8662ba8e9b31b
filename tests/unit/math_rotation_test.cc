// Quaternions, matrices, rotation vectors and Euler angles: each of them from the others, and at their singular places.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/constants.h"
#include "core/math/rotation.h"
#include "core/random/draws.h"

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

// With the middle angle anywhere, the ends among it: there the outer two angles are one turn, all of it the last.
constexpr double kMiddle[] = {-0.5 * kPi, -1.2, -0.3, 0.0, 0.7, 1.5, 0.5 * kPi};

TEST(Rotation, YawPitchRollAreTurnsAboutZYX) {
  for (const double middle : kMiddle) {
    for (std::uint64_t draw = 0; draw < 20; ++draw) {
      Stream random(3, draw, "angles");
      const double yaw = kPi * (2.0 * random.Uniform() - 1.0), roll = kPi * (2.0 * random.Uniform() - 1.0);
      const Matrix3 exact = AboutZ(yaw) * AboutY(middle) * AboutX(roll);
      const Quaternion q = FromYawPitchRoll({.yaw = yaw, .pitch = middle, .roll = roll});
      EXPECT_LT(Difference(RotationMatrix(q), exact), 1e-14);
      const YawPitchRoll back = ToYawPitchRoll(q);
      // At the ends the sine is flat: 1e-15 of it are 3e-8 of the angle.
      EXPECT_LT(Difference(AboutZ(back.yaw) * AboutY(back.pitch) * AboutX(back.roll), exact), 1e-7) << middle;
      if (std::fabs(middle) < 1.55) {
        EXPECT_NEAR(back.yaw, yaw, 1e-12);
        EXPECT_NEAR(back.pitch, middle, 1e-12);
        EXPECT_NEAR(back.roll, roll, 1e-12);
      } else {
        EXPECT_EQ(back.yaw, 0.0);
      }
    }
  }
}

TEST(Rotation, PitchYawRollAreTurnsAboutYZX) {
  for (const double middle : kMiddle) {
    for (std::uint64_t draw = 0; draw < 20; ++draw) {
      Stream random(4, draw, "angles");
      const double pitch = kPi * (2.0 * random.Uniform() - 1.0), roll = kPi * (2.0 * random.Uniform() - 1.0);
      const Matrix3 exact = AboutY(pitch) * AboutZ(middle) * AboutX(roll);
      const Quaternion q = FromPitchYawRoll({.pitch = pitch, .yaw = middle, .roll = roll});
      EXPECT_LT(Difference(RotationMatrix(q), exact), 1e-14);
      const PitchYawRoll back = ToPitchYawRoll(q);
      EXPECT_LT(Difference(AboutY(back.pitch) * AboutZ(back.yaw) * AboutX(back.roll), exact), 1e-7) << middle;
      if (std::fabs(middle) < 1.55) {
        EXPECT_NEAR(back.pitch, pitch, 1e-12);
        EXPECT_NEAR(back.yaw, middle, 1e-12);
        EXPECT_NEAR(back.roll, roll, 1e-12);
      } else {
        EXPECT_EQ(back.pitch, 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace dispersa::math_rotation_test
