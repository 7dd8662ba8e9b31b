// A lane of a pack has the same bits as the same operation on one double, for every operation and any
// argument.
#include "core/math/lanes.h"

#include "core/math/lane_vector.h"
#include "core/math/rotation.h"
#include "core/random/draws.h"
#include "tests/test.h"

namespace dispersa::math_lanes_test {
namespace {

using lanes::Lane;
using lanes::Pack;
using lanes::ToBits;

// Ordinary numbers of all sizes, and what is not ordinary.
std::vector<double> Arguments() {
  std::vector<double> all = {0.0,
                             -0.0,
                             1.0,
                             -1.0,
                             0.5,
                             1e300,
                             -1e300,
                             5e-324,
                             1e-310,
                             0.125,
                             3.0,
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  Stream draws(7, 0, "lanes");
  while (all.size() % 64 != 0 || all.size() < 512)
    all.push_back(draws.Normal() * std::pow(10.0, 6.0 * draws.Normal()));
  return all;
}

// Not a number stands for any of them: which one is no value.
bool IsSame(double a, double b) { return ToBits(a) == ToBits(b) || (std::isnan(a) && std::isnan(b)); }

template <class T>
class Lanes : public testing::Test {
 protected:
  static constexpr int kWidth = lanes::kWidth<T>;

  // f of packs against f of doubles; arguments b and c are the list turned by some places.
  template <class F>
  void ExpectSame(const char* name, F f) {
    const std::vector<double> a = Arguments();
    for (std::size_t k = 0; k < a.size(); k += kWidth) {
      T pa, pb, pc;
      for (int i = 0; i < kWidth; ++i) {
        Lane(pa, i) = a[k + i];
        Lane(pb, i) = a[(k + i + 5) % a.size()];
        Lane(pc, i) = a[(k + i + 111) % a.size()];
      }
      const T packed = f(pa, pb, pc);
      for (int i = 0; i < kWidth; ++i) {
        const double one = f(Lane(pa, i), Lane(pb, i), Lane(pc, i));
        ASSERT_TRUE(IsSame(Lane(packed, i), one))
            << name << "(" << Lane(pa, i) << ", " << Lane(pb, i) << ", " << Lane(pc, i)
            << "): " << Lane(packed, i) << ", not " << one;
      }
    }
  }
};
using Widths = testing::Types<Pack<4>, Pack<8>>;
TYPED_TEST_SUITE(Lanes, Widths);

TYPED_TEST(Lanes, ArithmeticIsThatOfDoubles) {
  this->ExpectSame("+", [](auto a, auto b, auto) { return a + b; });
  this->ExpectSame("-", [](auto a, auto b, auto) { return a - b; });
  this->ExpectSame("*", [](auto a, auto b, auto) { return a * b; });
  this->ExpectSame("/", [](auto a, auto b, auto) { return a / b; });
  this->ExpectSame("negation", [](auto a, auto, auto) { return -a; });
  this->ExpectSame("Fma", [](auto a, auto b, auto c) { return lanes::Fma(a, b, c); });
  this->ExpectSame("Sqrt", [](auto a, auto, auto) { return lanes::Sqrt(a); });
  this->ExpectSame("Abs", [](auto a, auto, auto) { return lanes::Abs(a); });
}

TYPED_TEST(Lanes, ComparisonsSelectAsThoseOfDoubles) {
  this->ExpectSame("Min", [](auto a, auto b, auto) { return lanes::Min(a, b); });
  this->ExpectSame("Max", [](auto a, auto b, auto) { return lanes::Max(a, b); });
  this->ExpectSame("Clamp", [](auto a, auto b, auto c) { return lanes::Clamp(a, b, c); });
  this->ExpectSame("<", [](auto a, auto b, auto c) { return lanes::Select(a < b, a, c); });
  this->ExpectSame(">", [](auto a, auto b, auto c) { return lanes::Select(a > b, a, c); });
  this->ExpectSame("<=", [](auto a, auto b, auto c) { return lanes::Select(a <= b, a, c); });
  this->ExpectSame(">=", [](auto a, auto b, auto c) { return lanes::Select(a >= b, a, c); });
  this->ExpectSame(
      "&, |, !", [](auto a, auto b, auto c) { return lanes::Select(((a < b) & (b < c)) | !(a < c), a, b); });
}

TYPED_TEST(Lanes, TranscendentalFunctionsAreThoseOfDoubles) {
  this->ExpectSame("Sin", [](auto a, auto, auto) { return lanes::Sin(a); });
  this->ExpectSame("Cos", [](auto a, auto, auto) { return lanes::Cos(a); });
  this->ExpectSame("Exp", [](auto a, auto, auto) { return lanes::Exp(a); });
  this->ExpectSame("Atan2", [](auto a, auto b, auto) { return lanes::Atan2(a, b); });
}

TYPED_TEST(Lanes, BitsAndLanesOfMasks) {
  constexpr int kCount = lanes::kWidth<TypeParam>;
  auto mask = lanes::NoLane<TypeParam>();
  EXPECT_FALSE(lanes::Any(mask));
  unsigned expected = 0;
  for (const int lane : {2, 0, kCount - 1}) {
    lanes::SetLane(mask, lane, true);
    expected |= 1u << lane;
    EXPECT_EQ(lanes::Bits(mask), expected);
    EXPECT_TRUE(lanes::Any(mask));
    EXPECT_FALSE(lanes::All(mask));
  }
  lanes::SetLane(mask, 2, false);
  EXPECT_EQ(lanes::Bits(mask), expected & ~4u);
  for (int lane = 0; lane < kCount; ++lane) lanes::SetLane(mask, lane, true);
  EXPECT_TRUE(lanes::All(mask));
}

TYPED_TEST(Lanes, LoadsARowALane) {
  constexpr int kCount = lanes::kWidth<TypeParam>;
  alignas(32) double rows[8][8];
  const double* row[kCount];
  for (int lane = 0; lane < kCount; ++lane) {
    row[lane] = rows[(3 * lane) % 8];
    for (int i = 0; i < 8; ++i) rows[(3 * lane) % 8][i] = 100.0 * lane + i;
  }
  TypeParam out[8];
  lanes::LoadRow(row, 2, out);
  for (int lane = 0; lane < kCount; ++lane)
    for (int i = 0; i < 8; ++i) EXPECT_EQ(Lane(out[i], lane), 100.0 * lane + i);
}

// The rotation vector takes the short way round whatever the quaternion's sign, near zero and near half a
// turn.
TEST(LaneVector, RotationVectorIsTheShortWayRound) {
  Stream draws(8, 0, "turns");
  for (const double angle : {0.0, 1e-12, 1e-4, 0.1, 0.25, 1.0, 3.0, 3.141592}) {
    for (int k = 0; k < 50; ++k) {
      const Vector3 phi = angle * Vector3(draws.Normal(), draws.Normal(), draws.Normal()).normalized();
      const Quaternion q = FromRotationVector(phi);
      for (const double sign : {1.0, -1.0}) {
        const auto back = lanes::RotationVector<double>({sign * q.w, sign * q.x, sign * q.y, sign * q.z});
        // Rounding of a unit quaternion, up to half a turn: a few units in its last place.
        EXPECT_NEAR(back.x, phi.x(), 4e-15);
        EXPECT_NEAR(back.y, phi.y(), 4e-15);
        EXPECT_NEAR(back.z, phi.z(), 4e-15);
      }
    }
  }
}

TEST(LaneVector, TurnsAndMatricesAgreeWithThoseOfOneFlight) {
  Stream draws(9, 0, "turns");
  for (int k = 0; k < 200; ++k) {
    const Quaternion q = FromRotationVector(Vector3(draws.Normal(), draws.Normal(), draws.Normal()));
    const Vector3 phi = 0.1 * Vector3(draws.Normal(), draws.Normal(), draws.Normal());
    const Vector3 v(draws.Normal(), draws.Normal(), draws.Normal());
    const lanes::Turn<double> turn{q.w, q.x, q.y, q.z};
    const auto rotated = lanes::Rotate<double>(turn, {v.x(), v.y(), v.z()});
    const auto multiplied = lanes::RotationMatrix(turn) * lanes::Vector<double>{v.x(), v.y(), v.z()};
    const Vector3 expected = Rotate(q, v);
    EXPECT_NEAR((Vector3(rotated.x, rotated.y, rotated.z) - expected).norm(), 0.0, 4e-15);
    EXPECT_NEAR((Vector3(multiplied.x, multiplied.y, multiplied.z) - expected).norm(), 0.0, 4e-15);
    const Quaternion turned = q * FromRotationVector(phi);
    const auto by = lanes::TurnedBy<double>(turn, {phi.x(), phi.y(), phi.z()});
    EXPECT_NEAR(by.w, turned.w, 1e-15);
    EXPECT_NEAR(by.x, turned.x, 1e-15);
    EXPECT_NEAR(by.y, turned.y, 1e-15);
    EXPECT_NEAR(by.z, turned.z, 1e-15);
  }
}

}  // namespace
}  // namespace dispersa::math_lanes_test
