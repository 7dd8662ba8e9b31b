#include "core/structure/node_masses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/structure/element_masses.h"

namespace dispersa {

namespace {

// Products of an element's shares, upper triangle row by row.
std::array<double, 15> ProductsOf(const std::array<double, kElementRows>& share) {
  std::array<double, 15> products;
  std::size_t k = 0;
  for (std::size_t i = 0; i < share.size(); ++i)
    for (std::size_t j = i; j < share.size(); ++j) products[k++] = share[i] * share[j];
  return products;
}

}  // namespace

ShapeColumns NodeMasses::Times(const ShapeColumns& shapes) const {
  ShapeColumns product(shapes.rows, shapes.fours);
  for (std::size_t k = 0; k < shapes.fours; ++k) {
    const FourShapes* x = shapes.Four(k);
    FourShapes* y = product.Four(k);
    FourShapes from_before_w = 0.0, from_before_theta = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i, x += kNodeRows, y += kNodeRows) {
      const std::array<double, 6>& own = at[i];
      y[0] = Fma(FourShapes(own[0]), x[0], Fma(FourShapes(own[1]), x[1], from_before_w));
      y[1] = Fma(FourShapes(own[1]), x[0], Fma(FourShapes(own[2]), x[1], from_before_theta));
      y[2] = 0.0;
      if (i == to_next.size()) break;
      const std::array<double, 6>& next = to_next[i];
      const auto with_next = [&](std::size_t from, FourShapes sum) {
        return Fma(FourShapes(next[from]), x[3], Fma(FourShapes(next[from + 1]), x[4], sum));
      };
      y[0] = with_next(0, Fma(FourShapes(own[3]), x[2], y[0]));
      y[1] = with_next(2, Fma(FourShapes(own[4]), x[2], y[1]));
      y[2] = with_next(
          4, Fma(FourShapes(own[3]), x[0], Fma(FourShapes(own[4]), x[1], FourShapes(own[5]) * x[2])));
      const auto to = [&](std::size_t from) {
        return Fma(FourShapes(next[from]), x[0],
                   Fma(FourShapes(next[from + 2]), x[1], FourShapes(next[from + 4]) * x[2]));
      };
      from_before_w = to(0);
      from_before_theta = to(1);
    }
  }
  return product;
}

std::vector<double> NodeMasses::Times(const std::vector<double>& deflection, double rotation) const {
  std::vector<double> product(kNodeRows * at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    double* const y = &product[kNodeRows * i];
    y[0] += at[i][0] * deflection[i] + at[i][1] * rotation;
    y[1] += at[i][1] * deflection[i] + at[i][2] * rotation;
    if (i == to_next.size()) break;
    const std::array<double, 6>& next = to_next[i];
    y[0] += next[0] * deflection[i + 1] + next[1] * rotation;
    y[1] += next[2] * deflection[i + 1] + next[3] * rotation;
    y[2] += at[i][3] * deflection[i] + at[i][4] * rotation + next[4] * deflection[i + 1] + next[5] * rotation;
    y[3] += next[0] * deflection[i] + next[2] * rotation;
    y[4] += next[1] * deflection[i] + next[3] * rotation;
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
  std::array<double, 6>&top = masses.at[element], &bottom = masses.at[element + 1];
  std::array<double, 6>& next = masses.to_next[element];
  double* const sums[15] = {&top[0],  &top[1],  &top[3],    &next[0],   &next[1],
                            &top[2],  &top[4],  &next[2],   &next[3],   &top[5],
                            &next[4], &next[5], &bottom[0], &bottom[1], &bottom[2]};
  for (std::size_t k = 0; k < part.size(); ++k) *sums[k] += factor * part[k];
}

NodeMasses NodeMassMaker::Of(const BeamMasses& masses) const {
  NodeMasses sum{std::vector<std::array<double, 6>>(stations_.size()),
                 std::vector<std::array<double, 6>>(elements_.size())};
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
    std::array<double, 6>& at = sum.at[node];
    at[0] += m.mass_kg;
    at[1] += m.mass_kg * arm;
    at[2] += m.mass_kg * arm * arm + m.inertia_kg_m2;
  }
  return sum;
}

}  // namespace dispersa
