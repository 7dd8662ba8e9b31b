#include "core/structure/node_masses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/structure/element_masses.h"

namespace dispersa {

namespace {

// Products of an element's shares, upper triangle row by row.
std::array<double, 10> ProductsOf(const std::array<double, 4>& share) {
  std::array<double, 10> products;
  std::size_t k = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i; j < 4; ++j) products[k++] = share[i] * share[j];
  return products;
}

}  // namespace

ShapeColumns NodeMasses::Times(const ShapeColumns& shapes) const {
  ShapeColumns product(shapes.rows, shapes.fours);
  for (std::size_t k = 0; k < shapes.fours; ++k) {
    const FourShapes* x = shapes.Four(k);
    FourShapes* y = product.Four(k);
    FourShapes from_before_w = 0.0, from_before_theta = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i, x += 2, y += 2) {
      y[0] = Fma(FourShapes(at[i][0]), x[0], Fma(FourShapes(at[i][1]), x[1], from_before_w));
      y[1] = Fma(FourShapes(at[i][1]), x[0], Fma(FourShapes(at[i][2]), x[1], from_before_theta));
      if (i == to_next.size()) break;
      const std::array<double, 4>& next = to_next[i];
      y[0] = Fma(FourShapes(next[0]), x[2], Fma(FourShapes(next[1]), x[3], y[0]));
      y[1] = Fma(FourShapes(next[2]), x[2], Fma(FourShapes(next[3]), x[3], y[1]));
      from_before_w = Fma(FourShapes(next[0]), x[0], FourShapes(next[2]) * x[1]);
      from_before_theta = Fma(FourShapes(next[1]), x[0], FourShapes(next[3]) * x[1]);
    }
  }
  return product;
}

std::vector<double> NodeMasses::Times(const std::vector<double>& deflection, double rotation) const {
  std::vector<double> product(2 * at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    product[2 * i] += at[i][0] * deflection[i] + at[i][1] * rotation;
    product[2 * i + 1] += at[i][1] * deflection[i] + at[i][2] * rotation;
    if (i == to_next.size()) break;
    const std::array<double, 4>& next = to_next[i];
    product[2 * i] += next[0] * deflection[i + 1] + next[1] * rotation;
    product[2 * i + 1] += next[2] * deflection[i + 1] + next[3] * rotation;
    product[2 * i + 2] += next[0] * deflection[i] + next[2] * rotation;
    product[2 * i + 3] += next[1] * deflection[i] + next[3] * rotation;
  }
  return product;
}

NodeMassMaker::NodeMassMaker(std::vector<double> stations, std::vector<BeamElement> elements,
                             bool rotary_inertia)
    : stations_(std::move(stations)), elements_(std::move(elements)), rotary_inertia_(rotary_inertia) {
  for (const BeamElement& element : elements_) {
    Triangle by_deflection{}, by_rotation{};
    GaussFive([&](double weight, double x) {
      const BeamShape shape = ShapeAt(x, element.length_m, element.shear_ratio);
      const Triangle deflection = ProductsOf(shape.deflection), rotation = ProductsOf(shape.rotation);
      for (std::size_t k = 0; k < by_deflection.size(); ++k) {
        by_deflection[k] += weight * element.length_m * deflection[k];
        by_rotation[k] += weight * element.length_m * rotation[k];
      }
    });
    by_deflection_.push_back(by_deflection);
    by_rotation_.push_back(by_rotation);
  }
}

void NodeMassMaker::Add(double factor, const Triangle& part, std::size_t element, NodeMasses& masses) {
  std::array<double, 3>&top = masses.at[element], &bottom = masses.at[element + 1];
  std::array<double, 4>& next = masses.to_next[element];
  top[0] += factor * part[0];
  top[1] += factor * part[1];
  next[0] += factor * part[2];
  next[1] += factor * part[3];
  top[2] += factor * part[4];
  next[2] += factor * part[5];
  next[3] += factor * part[6];
  bottom[0] += factor * part[7];
  bottom[1] += factor * part[8];
  bottom[2] += factor * part[9];
}

NodeMasses NodeMassMaker::Of(const BeamMasses& masses) const {
  NodeMasses sum{std::vector<std::array<double, 3>>(stations_.size()),
                 std::vector<std::array<double, 4>>(elements_.size())};
  for (const SpreadMass& m : masses.spread) {
    const auto first = std::upper_bound(stations_.begin(), stations_.end(), m.top_station_m);
    std::size_t i = first == stations_.begin() ? 0 : static_cast<std::size_t>(first - stations_.begin()) - 1;
    const bool is_uniform = m.IsUniform();
    for (; i < elements_.size() && stations_[i] < m.bottom_station_m; ++i) {
      const CoveredPart part = PartCovered(m, stations_[i], elements_[i].length_m);
      if (part.to == 0.0) continue;
      if (is_uniform && part.from == 0.0 && part.to == 1.0) {
        Add(m.mass_per_length_kg_m.top, by_deflection_[i], i, sum);
        if (rotary_inertia_) Add(m.mass_per_length_kg_m.top * m.gyration2_m2.top, by_rotation_[i], i, sum);
        continue;
      }
      ForEachMassOf(m, part, stations_[i], elements_[i],
                    [&](double mass_kg, double gyration2_m2, const BeamShape& shape) {
                      Add(mass_kg, ProductsOf(shape.deflection), i, sum);
                      if (rotary_inertia_) Add(mass_kg * gyration2_m2, ProductsOf(shape.rotation), i, sum);
                    });
    }
  }
  for (const FixedMass& m : masses.fixed) {
    const std::size_t node = NearestNode(stations_, m.station_m);
    const double arm = m.cg_station_m - stations_[node];
    std::array<double, 3>& at = sum.at[node];
    at[0] += m.mass_kg;
    at[1] += m.mass_kg * arm;
    at[2] += m.mass_kg * arm * arm + m.inertia_kg_m2;
  }
  return sum;
}

}  // namespace dispersa
