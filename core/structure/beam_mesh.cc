#include "core/structure/beam_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/structure/element_masses.h"
#include "core/structure/near_modes.h"

namespace dispersa {

std::vector<double> MeshStations(const std::vector<BeamSection>& sections, const BeamMasses& masses,
                                 int elements) {
  std::vector<double> ends;
  for (const BeamSection& s : sections) ends.insert(ends.end(), {s.top_station_m, s.bottom_station_m});
  const auto [first, last] = std::minmax_element(ends.begin(), ends.end());
  const double top = *first, bottom = *last;
  for (const SpreadMass& m : masses.spread) ends.insert(ends.end(), {m.top_station_m, m.bottom_station_m});
  for (const FixedMass& m : masses.fixed) ends.push_back(m.station_m);
  std::sort(ends.begin(), ends.end());
  const double longest = (bottom - top) / elements;
  std::vector<double> stations = {top};
  for (const double end : ends) {
    const double begin = stations.back();
    if (end <= begin + kSameStation_m || end > bottom + kSameStation_m) continue;
    const int pieces = static_cast<int>(std::ceil((end - begin) / longest - 1e-9));
    for (int i = 1; i < pieces; ++i) stations.push_back(begin + (end - begin) * i / pieces);
    stations.push_back(end);
  }
  return stations;
}

namespace {

std::vector<double> Halved(const std::vector<double>& stations) {
  std::vector<double> halved = {stations.front()};
  for (std::size_t i = 1; i < stations.size(); ++i) {
    halved.push_back(0.5 * (stations[i - 1] + stations[i]));
    halved.push_back(stations[i]);
  }
  return halved;
}

// Of the modes of a mesh from those of its halved one.
double DifferenceOf(const FreeFreeModes& coarse, const FreeFreeModes& fine) {
  if (coarse.shape.cols() < fine.shape.cols()) return 1.0;
  double largest = 0.0;
  for (Eigen::Index mode = 0; mode < fine.shape.cols(); ++mode) {
    largest = std::max(largest, std::fabs(coarse.frequency_rad_s[mode] / fine.frequency_rad_s[mode] - 1.0));
    const double sign = coarse.shape(0, mode) * fine.shape(0, mode) < 0.0 ? -1.0 : 1.0;
    for (const Eigen::Index row : {0, 1}) {
      double difference = 0.0, most = 0.0;
      for (Eigen::Index node = 0; node < coarse.shape.rows() / kNodeRows; ++node) {
        const double at = fine.shape(2 * kNodeRows * node + row, mode);
        difference = std::max(difference, std::fabs(sign * coarse.shape(kNodeRows * node + row, mode) - at));
        most = std::max(most, std::fabs(at));
      }
      largest = std::max(largest, difference / most);
    }
  }
  return largest;
}

}  // namespace

BeamMesh RefinedMesh(const Beam& beam, BeamPlane plane, const std::vector<BeamMasses>& masses, int elements,
                     int modes) {
  const auto mesh_at = [&](std::vector<double> stations) {
    std::vector<BeamElement> of = BuildElements(beam, plane, stations);
    return BeamMesh{std::move(stations), std::move(of)};
  };
  const auto modes_of = [&](const BeamMesh& mesh) {
    std::vector<FreeFreeModes> solved;
    const NearModes near(mesh.stations, mesh.elements, beam.rotary_inertia);
    for (const BeamMasses& of : masses) solved.push_back(near.Lowest(of, modes));
    return solved;
  };
  BeamMesh mesh = mesh_at(MeshStations(beam.sections, masses.front(), (elements + 1) / 2));
  std::vector<FreeFreeModes> coarse = modes_of(mesh);
  do {
    mesh = mesh_at(Halved(mesh.stations));
    std::vector<FreeFreeModes> fine = modes_of(mesh);
    for (std::size_t i = 0; i < fine.size(); ++i)
      mesh.difference = std::max(mesh.difference, DifferenceOf(coarse[i], fine[i]));
    coarse = std::move(fine);
  } while (mesh.difference > kMeshDifference && 2 * mesh.elements.size() <= kMostElements);
  return mesh;
}

}  // namespace dispersa
