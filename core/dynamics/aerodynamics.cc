#include "core/dynamics/aerodynamics.h"

#include "core/math/functions.h"

namespace dispersa {

namespace {

double Evaluate(const Coefficient& c, double mach, double incidence) {
  return c.empty() ? 0.0 : c.factor * c.table(mach, incidence);
}

}  // namespace

double TotalIncidence(const Vector3& v) {
  const double across = Sqrt(v.y() * v.y() + v.z() * v.z());
  return across == 0.0 && v.x() == 0.0 ? 0.0 : Atan2(across, v.x());
}

ForceAndMoment AerodynamicForce(const BodyAerodynamics& body, const Vector3& v, const Vector3& w,
                                double mach, double qbar_pa, double cg_station_m) {
  ForceAndMoment result;
  const double airspeed = v.norm();
  if (airspeed == 0.0) return result;
  const double across = Sqrt(v.y() * v.y() + v.z() * v.z());
  const double incidence = Atan2(across, v.x());
  // Unit cross-flow; any direction will do at zero incidence, where the coefficients vanish.
  const double ny = across > 0.0 ? v.y() / across : 0.0;
  const double nz = across > 0.0 ? v.z() / across : 0.0;
  const double qs = qbar_pa * body.area_m2;

  GridPosition at_mach{}, at_incidence{};
  const auto coefficient = [&](const Coefficient& c) {
    return c.empty() ? 0.0 : c.factor * c.table(at_mach, at_incidence);
  };
  if (!body.ca.empty()) {
    // The shipped tables share one grid, so it is searched once.
    at_mach = Locate(body.ca.table.x, mach);
    at_incidence = Locate(body.ca.table.y, incidence);
    const double axial = qs * coefficient(body.ca);
    const double normal = qs * coefficient(body.cn);
    const double arm = cg_station_m - coefficient(body.xcp_station_m);
    result.force_n = Vector3(-axial, -normal * ny, -normal * nz);
    result.moment_n_m = Vector3(0.0, arm * normal * nz, -arm * normal * ny);
  }
  if (!body.cd.empty() || !body.cl.empty() || !body.cm.empty()) {
    const Vector3 along = v / airspeed;
    const double cosine = along.x();
    const double sine = across / airspeed;
    // l: normal to v, towards the side from which the nose meets the flow.
    const Vector3 lift_direction(sine, -cosine * ny, -cosine * nz);
    const Vector3 force = qs * (Evaluate(body.cl, mach, incidence) * lift_direction -
                                Evaluate(body.cd, mach, incidence) * along);
    const Vector3 arm(cg_station_m - body.moment_reference_station_m, 0.0, 0.0);
    const double pitching = qs * body.length_m * Evaluate(body.cm, mach, incidence);
    result.force_n += force;
    result.moment_n_m += arm.cross(force) + Vector3(0.0, pitching * nz, -pitching * ny);
  }
  if (!body.cmq.empty() || !body.clp.empty() || !body.cnr.empty()) {
    const double twice_v =
        2.0 * (airspeed > body.minimum_airspeed_m_s ? airspeed : body.minimum_airspeed_m_s);
    result.moment_n_m += Vector3(
        qs * body.span_m * Evaluate(body.clp, mach, 0.0) * w.x() * body.span_m / twice_v,
        qs * body.length_m * Evaluate(body.cmq, mach, 0.0) * w.y() * body.length_m / twice_v,
        qs * body.span_m * Evaluate(body.cnr, mach, 0.0) * w.z() * body.span_m / twice_v);
  }
  return result;
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
  return body;
}

}  // namespace dispersa
