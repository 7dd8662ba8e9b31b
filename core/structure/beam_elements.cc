#include "core/structure/beam_elements.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "core/structure/element_masses.h"

namespace dispersa {

namespace {

struct Stiffness {
  double bending_n_m2 = 0.0;
  double shear_n = 0.0;  // 0: does not shear
};

Stiffness StiffnessAt(const Beam& beam, BeamPlane plane, double station_m) {
  Stiffness sum;
  bool shears = beam.timoshenko;
  for (const BeamSection& s : beam.sections) {
    if (station_m < s.top_station_m || station_m > s.bottom_station_m) continue;
    sum.bending_n_m2 += s.BendingStiffness(plane, station_m);
    const double shear_n = s.ShearStiffness(plane, station_m);
    shears = shears && shear_n > 0.0;
    sum.shear_n += shear_n;
  }
  if (!shears) sum.shear_n = 0.0;
  return sum;
}

}  // namespace

BeamShape ShapeAt(double fraction, double length_m, double shear_ratio) {
  const double x = fraction, x2 = x * x, x3 = x2 * x, phi = shear_ratio, h = length_m;
  const double scale = 1.0 / (1.0 + phi);
  BeamShape shape;
  const double bump = x - x2;
  shape.deflection = {scale * (1.0 - 3.0 * x2 + 2.0 * x3 + phi * (1.0 - x)),
                      scale * h * (x - 2.0 * x2 + x3 + 0.5 * phi * bump), scale * bump * (bump + phi),
                      scale * (3.0 * x2 - 2.0 * x3 + phi * x), scale * h * (x3 - x2 - 0.5 * phi * bump)};
  const double turning = 6.0 * scale / h * (x2 - x);
  shape.rotation = {turning, scale * (1.0 - 4.0 * x + 3.0 * x2 + phi * (1.0 - x)),
                    2.0 * scale / h * bump * (1.0 - 2.0 * x), -turning,
                    scale * (3.0 * x2 - 2.0 * x + phi * x)};
  return shape;
}

std::size_t NearestNode(const std::vector<double>& stations, double station_m) {
  const auto nearest = std::min_element(stations.begin(), stations.end(), [&](double a, double b) {
    return std::fabs(a - station_m) < std::fabs(b - station_m);
  });
  return static_cast<std::size_t>(nearest - stations.begin());
}

std::vector<BeamElement> BuildElements(const Beam& beam, BeamPlane plane,
                                       const std::vector<double>& stations) {
  std::vector<BeamElement> elements;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const double h = stations[i + 1] - stations[i];
    BeamElement element;
    element.length_m = h;
    // The shapes are those of a uniform element: its moments and shear forces, for a moment on either end and
    // for an even load, act on the real one (a flexibility method: exact for loads at the nodes).
    const Stiffness middle = StiffnessAt(beam, plane, stations[i] + 0.5 * h);
    element.shear_ratio = middle.shear_n > 0.0 ? 12.0 * middle.bending_n_m2 / (middle.shear_n * h * h) : 0.0;
    const double phi = element.shear_ratio;
    const double bow = 4.0 / 5.0 + 4.0 * phi;  // stiffness against the bow, over EI / ((1 + phi)² h³)
    Eigen::Matrix3d flexibility = Eigen::Matrix3d::Zero();
    GaussFive([&](double weight, double x) {
      const Stiffness at = StiffnessAt(beam, plane, stations[i] + x * h);
      const double by_bow = (1.0 + phi) * h / bow;
      const Eigen::Vector3d moment(x - 1.0, x, by_bow * (2.0 - 12.0 * (x - x * x)));
      flexibility += weight * h / at.bending_n_m2 * moment * moment.transpose();
      if (!(at.shear_n > 0.0)) return;
      const Eigen::Vector3d shear(-1.0 / h, -1.0 / h, by_bow / h * 12.0 * (1.0 - 2.0 * x));
      flexibility += weight * h / at.shear_n * shear * shear.transpose();
    });
    element.flexural_stiffness = flexibility.inverse();
    elements.push_back(element);
  }
  return elements;
}

Eigen::MatrixXd MassMatrix(const Beam& beam, const std::vector<double>& stations,
                           const std::vector<BeamElement>& elements) {
  const Eigen::Index size = kNodeRows * static_cast<Eigen::Index>(stations.size());
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const double h = elements[i].length_m;
    const Eigen::Index row = kNodeRows * static_cast<Eigen::Index>(i);
    auto block = mass.block<kElementRows, kElementRows>(row, row);
    for (const SpreadMass& m : beam.masses.spread) {
      const CoveredPart part = PartCovered(m, stations[i], h);
      if (part.to == 0.0) continue;
      ForEachMassOf(m, part, stations[i], elements[i],
                    [&](double mass_kg, double gyration2_m2, const BeamShape& shape) {
                      using Shares = Eigen::Vector<double, kElementRows>;
                      const Eigen::Map<const Shares> deflection(shape.deflection.data()),
                          rotation(shape.rotation.data());
                      block += mass_kg * deflection * deflection.transpose();
                      if (beam.rotary_inertia)
                        block += mass_kg * gyration2_m2 * rotation * rotation.transpose();
                    });
    }
  }
  for (const FixedMass& m : beam.masses.fixed) {
    const std::size_t nearest = NearestNode(stations, m.station_m);
    const Eigen::Index row = kNodeRows * static_cast<Eigen::Index>(nearest);
    const double arm = m.cg_station_m - stations[nearest];  // its centre of gravity moves by w + arm theta
    mass(row, row) += m.mass_kg;
    mass(row, row + 1) += m.mass_kg * arm;
    mass(row + 1, row) += m.mass_kg * arm;
    mass(row + 1, row + 1) += m.mass_kg * arm * arm + m.inertia_kg_m2;
  }
  return mass;
}

Eigen::MatrixXd StiffnessMatrix(const std::vector<BeamElement>& elements) {
  const Eigen::Index size = kNodeRows * static_cast<Eigen::Index>(elements.size() + 1);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const double chord = 1.0 / elements[i].length_m;
    Eigen::Matrix<double, 3, kElementRows> relative;
    relative << chord, 1.0, 0.0, -chord, 0.0,  //
        chord, 0.0, 0.0, -chord, 1.0,          //
        0.0, 0.0, 1.0, 0.0, 0.0;
    const Eigen::Index row = kNodeRows * static_cast<Eigen::Index>(i);
    stiffness.block<kElementRows, kElementRows>(row, row) +=
        relative.transpose() * elements[i].flexural_stiffness * relative;
  }
  return stiffness;
}

Eigen::MatrixXd MassTimes(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& shapes) {
  Eigen::MatrixXd product(shapes.rows(), shapes.cols());
  for (Eigen::Index column = 0; column < shapes.cols(); ++column)
    for (Eigen::Index row = 0; row < shapes.rows(); ++row) {
      const Eigen::Index node = row - row % kNodeRows;
      const Eigen::Index first = std::max<Eigen::Index>(node - kNodeRows, 0),
                         last = std::min(node + 2 * kNodeRows, shapes.rows());
      double sum = 0.0;
      for (Eigen::Index k = first; k < last; ++k) sum += mass(k, row) * shapes(k, column);  // symmetric
      product(row, column) = sum;
    }
  return product;
}

Eigen::MatrixXd RigidShapes(const std::vector<double>& stations, double station_m) {
  Eigen::MatrixXd shapes(kNodeRows * static_cast<Eigen::Index>(stations.size()), 2);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Eigen::Index row = kNodeRows * static_cast<Eigen::Index>(i);
    shapes.row(row) << 1.0, stations[i] - station_m;
    shapes.row(row + 1) << 0.0, 1.0;
    shapes.row(row + 2).setZero();
  }
  return shapes;
}

}  // namespace dispersa
