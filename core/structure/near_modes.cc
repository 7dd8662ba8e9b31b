#include "core/structure/near_modes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/constants.h"
#include "core/math/functions.h"
#include "core/math/matrices.h"

namespace dispersa {

namespace {

/// Shapes beyond those that are sought: they carry the error of these.
constexpr int kFurtherShapes = 3;
constexpr int kMostTurns = 10, kMostWholeTurns = 40;

// The motion of a free beam as a rigid body: by 1 m, and about its centre of gravity by 1 rad.
struct RigidMotion {
  std::vector<double> push, turn;  // inertia of both at the rows
  std::vector<double> turn_m;      // deflection of the turn at the nodes
  double mass_kg = 0.0, inertia_kg_m2 = 0.0;

  RigidMotion(const NodeMasses& masses, const std::vector<double>& arms_m)
      : push(masses.Times(std::vector<double>(arms_m.size(), 1.0), 0.0)),
        turn(masses.Times(arms_m, 1.0)),
        turn_m(arms_m) {
    // About the middle of the beam first, so that nothing cancels.
    double first = 0.0;
    for (std::size_t i = 0; i < arms_m.size(); ++i) {
      const double* const turned = &turn[kNodeRows * i];
      mass_kg += push[kNodeRows * i];
      first += turned[0];
      inertia_kg_m2 += turned[0] * arms_m[i] + turned[1];
    }
    const double arm = first / mass_kg;
    inertia_kg_m2 -= first * arm;
    for (double& m : turn_m) m -= arm;
    for (std::size_t row = 0; row < turn.size(); ++row) turn[row] -= arm * push[row];
  }

  // Adds the inertia of a rigid motion, such that no force and no moment is left.
  void Balance(ShapeColumns& loads) const {
    for (std::size_t k = 0; k < loads.fours; ++k) {
      FourShapes* const f = loads.Four(k);
      FourShapes force = 0.0, moment = 0.0;
      for (std::size_t i = 0; i < turn_m.size(); ++i) {
        const FourShapes* const of_node = f + kNodeRows * i;
        force = force + of_node[0];
        moment = Fma(FourShapes(turn_m[i]), of_node[0], moment + of_node[1]);
      }
      const FourShapes pushed = force / FourShapes(-mass_kg), turned = moment / FourShapes(-inertia_kg_m2);
      for (std::size_t row = 0; row < loads.rows; ++row)
        f[row] = Fma(FourShapes(push[row]), pushed, Fma(FourShapes(turn[row]), turned, f[row]));
    }
  }

  // Takes the rigid motion from shapes, in the sense of the masses.
  void TakeFrom(ShapeColumns& shapes) const {
    for (std::size_t k = 0; k < shapes.fours; ++k) {
      FourShapes* const x = shapes.Four(k);
      FourShapes force = 0.0, moment = 0.0;
      for (std::size_t row = 0; row < shapes.rows; ++row) {
        force = Fma(FourShapes(push[row]), x[row], force);
        moment = Fma(FourShapes(turn[row]), x[row], moment);
      }
      const FourShapes pushed = force / FourShapes(-mass_kg), turned = moment / FourShapes(-inertia_kg_m2);
      for (std::size_t i = 0; i < turn_m.size(); ++i) {
        FourShapes* const of_node = x + kNodeRows * i;
        of_node[0] = Fma(FourShapes(turn_m[i]), turned, of_node[0] + pushed);
        of_node[1] = of_node[1] + turned;
      }
    }
  }
};

// a' b. Both have as many columns. Of a product that is symmetric a half is computed.
Eigen::MatrixXd ProductOf(const ShapeColumns& a, const ShapeColumns& b, bool is_symmetric) {
  const std::size_t fours = a.fours;
  Eigen::MatrixXd product(4 * fours, 4 * fours);
  for (std::size_t p = 0; p < fours; ++p)
    for (std::size_t q = is_symmetric ? p : 0; q < fours; ++q) {
      const FourShapes* x = a.Four(p);
      const FourShapes* y = b.Four(q);
      FourShapes sum[4] = {0.0, 0.0, 0.0, 0.0};
      for (std::size_t row = 0; row < a.rows; ++row) {
        const double* const of_row = Values(x + row);
        for (std::size_t lane = 0; lane < 4; ++lane)
          sum[lane] = Fma(FourShapes(of_row[lane]), y[row], sum[lane]);
      }
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
          const Eigen::Index row = static_cast<Eigen::Index>(4 * p + i),
                             column = static_cast<Eigen::Index>(4 * q + j);
          product(row, column) = Values(sum)[4 * i + j];
          if (is_symmetric) product(column, row) = product(row, column);
        }
    }
  return product;
}

void ScaleColumns(const double* factor, ShapeColumns& columns) {
  for (std::size_t k = 0; k < columns.fours; ++k) {
    FourShapes* const x = columns.Four(k);
    const FourShapes by = _mm256_loadu_pd(factor + 4 * k);
    for (std::size_t row = 0; row < columns.rows; ++row) x[row] = x[row] * by;
  }
}

// Modes among shapes of these stiffnesses and masses.
std::optional<RitzModes> FindAmong(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::Index size = stiffness.rows();
  Eigen::MatrixXd root = stiffness;  // L of stiffness = L L'
  for (Eigen::Index j = 0; j < size; ++j) {
    for (Eigen::Index k = 0; k < j; ++k)
      for (Eigen::Index i = j; i < size; ++i) root(i, j) -= root(i, k) * root(j, k);
    if (!(root(j, j) > 0.0)) return {};
    const double inverse = 1.0 / std::sqrt(root(j, j));
    for (Eigen::Index i = j; i < size; ++i) root(i, j) *= inverse;
  }
  // L^-1 mass L'^-1: masses of shapes of unit stiffness. The greatest are those of the lowest modes.
  const auto solve = [&](Eigen::MatrixXd& right) {
    for (Eigen::Index column = 0; column < size; ++column)
      for (Eigen::Index j = 0; j < size; ++j) {
        right(j, column) /= root(j, j);
        for (Eigen::Index i = j + 1; i < size; ++i) right(i, column) -= root(i, j) * right(j, column);
      }
  };
  Eigen::MatrixXd by_stiffness = mass;
  solve(by_stiffness);
  by_stiffness.transposeInPlace();
  solve(by_stiffness);
  const auto [values, vectors] = EigenOfSymmetric(by_stiffness);
  RitzModes modes{Eigen::VectorXd(size), Eigen::MatrixXd(size, size)};
  for (Eigen::Index mode = 0; mode < size; ++mode) {
    const Eigen::Index from = size - 1 - mode;
    if (!(values[from] > 0.0)) return {};
    modes.stiffness[mode] = 1.0 / values[from];
    const double scale = std::sqrt(modes.stiffness[mode]);
    for (Eigen::Index j = size; j-- > 0;) {
      double rest = vectors(j, from) * scale;
      for (Eigen::Index i = j + 1; i < size; ++i) rest -= root(i, j) * modes.share(i, mode);
      modes.share(j, mode) = rest / root(j, j);
    }
  }
  return modes;
}

// By how much a turn has changed a mode: the root of the mass of the difference. `before` are the masses of
// the shapes that the turn began with, times the stiffness of both.
double ChangeOf(const RitzModes& modes, Eigen::Index mode, const Eigen::MatrixXd& before) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < before.cols(); ++j)
    for (Eigen::Index i = 0; i < before.rows(); ++i)
      sum += modes.share(i, mode) * before(i, j) * modes.share(j, mode);
  return std::sqrt(std::max(sum / Square(modes.stiffness[mode]) - 1.0, 0.0));
}

// Sums of columns with the shares of each mode.
ShapeColumns Combined(const ShapeColumns& columns, const Eigen::MatrixXd& share, std::size_t fours) {
  ShapeColumns combined(columns.rows, fours);
  for (std::size_t to = 0; to < fours; ++to)
    for (std::size_t from = 0; from < columns.fours; ++from) {
      FourShapes by[4];
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const auto at = [&](std::size_t j) {
          return share(static_cast<Eigen::Index>(4 * from + lane), static_cast<Eigen::Index>(4 * to + j));
        };
        by[lane] = _mm256_set_pd(at(3), at(2), at(1), at(0));
      }
      const FourShapes* const x = columns.Four(from);
      FourShapes* const y = combined.Four(to);
      for (std::size_t row = 0; row < columns.rows; ++row) {
        const double* const of_row = Values(x + row);
        FourShapes sum = from == 0 ? FourShapes(0.0) : y[row];
        for (std::size_t lane = 0; lane < 4; ++lane) sum = Fma(FourShapes(of_row[lane]), by[lane], sum);
        y[row] = sum;
      }
    }
  return combined;
}

// Turns of subspace iteration from shapes of about these stiffnesses, until `accept(bent, found, change_of)`:
// the bent shapes of a turn, the modes among them, and by how much the turn has changed one. `bend` bends the
// beam by balanced loads.
template <typename Bend, typename Accept>
void Iterate(const NodeMasses& mass, const RigidMotion& rigid, const ShapeColumns& start,
             Eigen::VectorXd stiffness, int most_turns, const Bend& bend, const Accept& accept) {
  ShapeColumns loads = mass.Times(start);
  rigid.Balance(loads);
  Eigen::MatrixXd before = ProductOf(start, loads, true);  // masses of the shapes of a turn
  for (int turn = 1; turn <= most_turns; ++turn) {
    // Scaled to shapes that are about those of the turn before.
    ShapeColumns bent = bend(loads);
    rigid.TakeFrom(bent);
    const Eigen::MatrixXd energy =
        stiffness.asDiagonal() * ProductOf(bent, loads, true) * stiffness.asDiagonal();
    ScaleColumns(stiffness.data(), bent);
    const std::optional<RitzModes> found = FindAmong(energy, ProductOf(bent, mass.Times(bent), true));
    if (!found) return;
    before = stiffness.asDiagonal() * before * stiffness.asDiagonal();
    if (accept(bent, *found, [&](Eigen::Index mode) { return ChangeOf(*found, mode, before); })) return;
    stiffness = found->stiffness;
    const ShapeColumns shapes = Combined(bent, found->share, bent.fours);
    loads = mass.Times(shapes);
    rigid.Balance(loads);
    before = ProductOf(shapes, loads, true);
  }
}

// The found mode of each of the first `count` nominal ones. `product`: inertia of the nominal shapes times
// the shapes that `found` combines.
std::vector<ModeMatch> MatchesOf(const Eigen::MatrixXd& product, const RitzModes& found,
                                 const Eigen::VectorXd& nominal_mass, int count) {
  const Eigen::MatrixXd of_modes = product.topRows(count) * found.share;
  Eigen::MatrixXd mac = of_modes.cwiseAbs2();
  for (Eigen::Index i = 0; i < mac.rows(); ++i) mac.row(i) /= nominal_mass[i];
  return PairByFallingMac(std::move(mac), of_modes);
}

// A column over a unit, at all nodes.
void AppendNodes(const ShapeColumns& columns, std::size_t column, double unit, BentShape& shape) {
  const double* const at = Values(columns.Four(column / 4)) + column % 4;
  for (std::size_t row = 0; row < columns.rows; row += kNodeRows) {
    shape.deflection.push_back(at[4 * row] / unit);
    shape.slope_1_m.push_back(at[4 * (row + 1)] / unit);
    shape.bow.push_back(at[4 * (row + 2)] / unit);
  }
}

// The matched modes, scaled to a largest deflection of 1.
std::optional<std::vector<BendingMode>> ModesOf(const ShapeColumns& bent, const RitzModes& found,
                                                const std::vector<ModeMatch>& matches, double least_mac) {
  const Eigen::Index count = static_cast<Eigen::Index>(matches.size());
  Eigen::MatrixXd share = Eigen::MatrixXd::Zero(found.share.rows(), (count + 3) / 4 * 4);
  for (Eigen::Index mode = 0; mode < count; ++mode) {
    const ModeMatch& match = matches[static_cast<std::size_t>(mode)];
    if (!(match.mac >= least_mac)) return {};
    share.col(mode) = match.sign * found.share.col(match.index);
  }
  const ShapeColumns sought = Combined(bent, share, static_cast<std::size_t>(share.cols() / 4));
  std::vector<BendingMode> modes(matches.size());
  for (std::size_t mode = 0; mode < modes.size(); ++mode) {
    BendingMode& m = modes[mode];
    const double* const at = Values(sought.Four(mode / 4)) + mode % 4;
    double largest = 0.0;
    for (std::size_t row = 0; row < sought.rows; row += kNodeRows)
      largest = std::max(largest, std::fabs(at[4 * row]));
    m.frequency_rad_s = std::sqrt(found.stiffness[matches[mode].index]);
    m.generalized_mass_kg = 1.0 / Square(largest);
    m.mac = matches[mode].mac;
    AppendNodes(sought, mode, largest, m);
  }
  return modes;
}

}  // namespace

NearModes::NearModes(std::vector<double> stations, std::vector<BeamElement> elements, bool rotary_inertia)
    : masses_(std::move(stations), std::move(elements), rotary_inertia), rotary_inertia_(rotary_inertia) {
  for (const BeamElement& element : masses_.elements()) {
    const Eigen::Matrix3d f = element.flexural_stiffness.inverse();
    flexibility_.push_back({f(0, 0), f(0, 1), f(0, 2), f(1, 1), f(1, 2), f(2, 2)});
  }
  const double middle_m = 0.5 * (this->stations().front() + this->stations().back());
  for (const double station_m : this->stations()) arms_m_.push_back(station_m - middle_m);
}

int NearModes::ShapesFor(int modes) { return (modes + kFurtherShapes + 3) / 4 * 4; }

void NearModes::AddLevel(const FreeFreeModes& nominal) {
  const std::size_t columns = static_cast<std::size_t>(nominal.shape.cols());
  Level level{ShapeColumns(kNodeRows * arms_m_.size(), columns / 4), nominal.frequency_rad_s.cwiseAbs2()};
  for (std::size_t j = 0; j < columns; ++j) {
    const Eigen::Index from = static_cast<Eigen::Index>(j);
    for (std::size_t row = 0; row < level.shapes.rows; ++row)
      Values(level.shapes.Four(j / 4) + row)[j % 4] = nominal.shape(static_cast<Eigen::Index>(row), from);
  }
  levels_.push_back(std::move(level));
}

// Of the beam held at its first node. Loads that leave neither force nor moment bend it so.
ShapeColumns NearModes::Bent(const ShapeColumns& loads) const {
  ShapeColumns bent(loads.rows, loads.fours);
  std::vector<std::array<FourShapes, 3>> own(flexibility_.size());  // ends' rotations and bow
  for (std::size_t k = 0; k < loads.fours; ++k) {
    const FourShapes* const f = loads.Four(k);
    FourShapes* const x = bent.Four(k);
    // The force and the moment of the loads behind turn the ends of an element against its chord. Its own
    // loads bow it.
    FourShapes force = 0.0, moment = 0.0;
    for (std::size_t i = flexibility_.size(); i-- > 0;) {
      const FourShapes* const of_node = f + kNodeRows * i;
      force = force + of_node[kNodeRows];
      moment = moment + of_node[kNodeRows + 1];
      const FourShapes ahead = Fma(FourShapes(masses_.elements()[i].length_m), force, moment);
      const std::array<double, 6>& by = flexibility_[i];
      const auto by_loads = [&](std::size_t of_ahead, std::size_t of_moment, std::size_t of_bow) {
        return Fma(FourShapes(by[of_moment]), moment,
                   Fma(FourShapes(by[of_bow]), of_node[2], -(FourShapes(by[of_ahead]) * ahead)));
      };
      own[i] = {by_loads(0, 1, 2), by_loads(1, 3, 4), by_loads(2, 4, 5)};
      moment = ahead;
    }
    FourShapes deflection = 0.0, rotation = 0.0;
    for (std::size_t i = 0; i <= flexibility_.size(); ++i) {
      FourShapes* const of_node = x + kNodeRows * i;
      of_node[0] = deflection;
      of_node[1] = rotation;
      of_node[2] = 0.0;
      if (i == flexibility_.size()) break;
      const FourShapes chord = rotation - own[i][0];
      deflection = Fma(FourShapes(masses_.elements()[i].length_m), chord, deflection);
      rotation = chord + own[i][1];
      of_node[2] = own[i][2];
    }
  }
  return bent;
}

std::array<BentShape, 2> NearModes::ByLoadsAt(const BeamPlace& place, const BeamMasses& masses) const {
  const RigidMotion rigid(masses_.Of(masses), arms_m_);
  ShapeColumns loads(kNodeRows * arms_m_.size(), 1);
  std::fill_n(loads.Four(0), loads.rows, FourShapes(0.0));
  for (std::size_t k = 0; k < kElementRows; ++k) {
    double* const of_row = Values(loads.Four(0) + kNodeRows * place.node + k);
    of_row[0] = place.deflection[k];
    of_row[1] = place.rotation[k];
  }
  rigid.Balance(loads);
  ShapeColumns bent = Bent(loads);
  rigid.TakeFrom(bent);
  std::array<BentShape, 2> shapes;
  for (std::size_t load = 0; load < shapes.size(); ++load) AppendNodes(bent, load, 1.0, shapes[load]);
  return shapes;
}

std::optional<std::vector<BendingMode>> NearModes::Find(std::size_t level, const BeamMasses& masses,
                                                        int count, double least_mac) const {
  const NodeMasses mass = masses_.Of(masses);
  const RigidMotion rigid(mass, arms_m_);
  const ShapeColumns& nominal = levels_[level].shapes;
  ShapeColumns nominal_loads = mass.Times(nominal);
  rigid.Balance(nominal_loads);
  const Eigen::VectorXd nominal_mass = ProductOf(nominal, nominal_loads, true).diagonal();
  std::optional<std::vector<BendingMode>> modes;
  Iterate(
      mass, rigid, nominal, levels_[level].stiffness, kMostTurns,
      [&](const ShapeColumns& loads) { return Bent(loads); },
      [&](const ShapeColumns& bent, const RitzModes& found, const auto& change_of) {
        const std::vector<ModeMatch> matches =
            MatchesOf(ProductOf(nominal_loads, bent, false), found, nominal_mass, count);
        double error = 0.0;
        for (const ModeMatch& match : matches)
          error = std::max(error, change_of(match.index) * found.stiffness[match.index] /
                                      found.stiffness[found.stiffness.size() - 1]);
        if (error > kShapeError) return false;
        modes = ModesOf(bent, found, matches, least_mac);
        return true;
      });
  return modes;
}

FreeFreeModes NearModes::Lowest(const BeamMasses& masses, int count) const {
  const NodeMasses mass = masses_.Of(masses);
  const std::size_t shapes = static_cast<std::size_t>(2 * count + 4);
  ShapeColumns cosines(kNodeRows * arms_m_.size(), (shapes + 3) / 4);
  const double top_m = stations().front(), length_m = stations().back() - top_m;
  for (std::size_t k = 0; k < 4 * cosines.fours; ++k)
    for (std::size_t i = 0; i < arms_m_.size(); ++i) {
      FourShapes* const node = cosines.Four(k / 4) + kNodeRows * i;
      const double wave_1_m = kPi * static_cast<double>(k + 2) / length_m;
      const double angle = wave_1_m * (stations()[i] - top_m);
      Values(node)[k % 4] = Cos(angle);
      Values(node + 1)[k % 4] = -wave_1_m * Sin(angle);
      Values(node + 2)[k % 4] = 0.0;
    }
  std::optional<FreeFreeModes> modes;
  Iterate(
      mass, RigidMotion(mass, arms_m_), cosines,
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(4 * cosines.fours)), kMostWholeTurns,
      [&](const ShapeColumns& loads) { return Bent(loads); },
      [&](const ShapeColumns& bent, const RitzModes& found, const auto& change_of) {
        for (Eigen::Index mode = 0; mode < count; ++mode)
          if (!(change_of(mode) <= kWholeChange)) return false;
        const ShapeColumns own = Combined(bent, found.share, bent.fours);
        modes = FreeFreeModes{found.stiffness.head(count).cwiseSqrt(),
                              Eigen::MatrixXd(static_cast<Eigen::Index>(own.rows), count)};
        for (Eigen::Index mode = 0; mode < count; ++mode) {
          const double* const at = Values(own.Four(static_cast<std::size_t>(mode) / 4)) + mode % 4;
          for (Eigen::Index row = 0; row < modes->shape.rows(); ++row) modes->shape(row, mode) = at[4 * row];
        }
        return true;
      });
  if (modes) return *std::move(modes);
  Beam beam;
  beam.masses = masses;
  beam.rotary_inertia = rotary_inertia_;
  return SolveFreeFree(stations(), masses_.elements(), MassMatrix(beam, stations(), masses_.elements()),
                       count);
}

}  // namespace dispersa
