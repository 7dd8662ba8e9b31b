#include "core/dynamics/aerodynamics.h"

#include "core/dynamics/launcher_lanes.h"
#include "core/math/functions.h"

namespace dispersa {

double TotalIncidence(const Vector3& v) {
  const double across = Sqrt(v.y() * v.y() + v.z() * v.z());
  return across == 0.0 && v.x() == 0.0 ? 0.0 : Atan2(across, v.x());
}

ForceAndMoment AerodynamicForce(const BodyAerodynamics& body, const AeroGrid& grid, const Vector3& v,
                                const Vector3& w, double density_kg_m3, double speed_of_sound_m_s,
                                double cg_station_m) {
  lanes::BodyInFlow<double> one;
  lanes::SetBody(one, 0, body, grid);
  const double inverse_sound = speed_of_sound_m_s > 0.0 ? 1.0 / speed_of_sound_m_s : 0.0;
  const auto flow = lanes::ForceOfFlow<double>(one, {v.x(), v.y(), v.z()}, {w.x(), w.y(), w.z()},
                                               density_kg_m3, inverse_sound, cg_station_m);
  return {Vector3(flow.force_n.x, flow.force_n.y, flow.force_n.z),
          Vector3(flow.moment_n_m.x, flow.moment_n_m.y, flow.moment_n_m.z)};
}

BodyAerodynamics FromTable(const AeroTable& table) {
  BodyAerodynamics body;
  body.area_m2 = table.reference_area_m2;
  body.length_m = table.reference_length_m;
  body.span_m = table.reference_length_m;
  body.ca.table = {table.mach, table.incidence_rad, table.ca};
  body.cn.table = {table.mach, table.incidence_rad, table.cn};
  body.xcp_station_m.table = {table.mach, table.incidence_rad, table.xcp_station_m};
  // Damping does not depend on incidence: two equal columns.
  const std::vector<double> any_incidence = {0.0, 1.0};
  const auto doubled = [](const std::vector<double>& values) {
    std::vector<double> z;
    for (double value : values) z.insert(z.end(), {value, value});
    return z;
  };
  body.cmq.table = {table.mach, any_incidence, doubled(table.cmq_per_rad)};
  body.cnr = body.cmq;
  body.clp.table = {table.mach, any_incidence, doubled(table.clp_per_rad)};
  if (table.yaw_plane.empty()) return body;
  const AeroTable& yaw = table.yaw_plane.front();
  body.ca_yaw.table = {yaw.mach, yaw.incidence_rad, yaw.ca};
  body.cn_yaw.table = {yaw.mach, yaw.incidence_rad, yaw.cn};
  body.xcp_yaw_station_m.table = {yaw.mach, yaw.incidence_rad, yaw.xcp_station_m};
  body.cnr.table = {yaw.mach, any_incidence, doubled(yaw.cmq_per_rad)};
  return body;
}

}  // namespace dispersa
