// Full texts of errors about input files: place, value, mistake, and what is allowed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/campaign_yaml/load.h"
#include "tests/unit/input_files.h"

namespace dispersa::campaign_yaml_errors_test {
namespace {

using testing::HasSubstr;

// One edit of the valid files, and what `validate` then says about a file.
struct BadInput {
  const char* name;
  const char* edited;
  const char* from;
  const char* to;
  const char* validated;
  const char* texts;
};

void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, IsReportedInFull) {
  const InputFiles files;
  files.Edit(GetParam().edited, GetParam().from, GetParam().to);
  EXPECT_EQ(files.Texts(CheckFile(files.Path(GetParam().validated)).errors), GetParam().texts);
}

constexpr BadInput kBadInputs[] = {
    {"UnknownKey", "campaign.yaml", "dispersions:\n", "dispersion:\n", "campaign.yaml",
     "campaign.yaml:7:1: dispersion: unknown key 'dispersion' (did you mean 'dispersions'?), "
     "allowed: autopilot, based_on, correlations, derived, description, dispersions, flight, guidance, "
     "metrics, name, optimize, reference, requirements, sampling, schema, vehicle, verdicts, without\n"},
    {"UnknownKeyLikeNoOther", "campaign.yaml", "name: trial", "name: trial\nzebra: 1", "campaign.yaml",
     "campaign.yaml:3:1: zebra: unknown key 'zebra', allowed: autopilot, based_on, correlations, "
     "derived, description, dispersions, flight, guidance, metrics, name, optimize, reference, requirements, "
     "sampling, schema, vehicle, verdicts, without\n"},
    {"JettisonWithoutTrigger", "vehicle.yaml", "    gimbal:",
     "    jettisoned:\n      - {name: skirt, mass_kg: 10, top_station_m: 1, bottom_station_m: 2, "
     "outer_diameter_m: 1, at: {}}\n    gimbal:",
     "vehicle.yaml",
     "vehicle.yaml:17:100: stages[0].jettisoned[0].at: missing key 'time_s' or 'altitude_m' or "
     "'heat_flux_w_m2', allowed: one of them\n"},
    {"JettisonWithTwo", "vehicle.yaml", "    gimbal:",
     "    jettisoned:\n      - {name: skirt, mass_kg: 10, top_station_m: 1, bottom_station_m: 2, "
     "outer_diameter_m: 1, at: {time_s: 5, altitude_km: 50}}\n    gimbal:",
     "vehicle.yaml",
     "vehicle.yaml:17:125: stages[0].jettisoned[0].at.altitude_km: 'time_s' and 'altitude_km' are both "
     "given, allowed: "
     "one of time_s, altitude_m, heat_flux_w_m2\n"},
    {"JettisonOutsideTheStage", "vehicle.yaml", "    gimbal:",
     "    jettisoned:\n      - {name: skirt, mass_kg: 10, top_station_m: 1, bottom_station_m: 200, "
     "outer_diameter_m: 1, at: {time_s: 5}}\n    gimbal:",
     "vehicle.yaml",
     "vehicle.yaml:17:72: stages[0].jettisoned[0].bottom_station_m: lies aft of the stage's "
     "bottom_station_m, "
     "allowed: at most bottom_station_m of the stage\n"},
    {"UnknownSeverity", "campaign.yaml", "dispersions:\n", "dispersions:\n  turbulence: {severity: rough}\n",
     "campaign.yaml",
     "campaign.yaml:8:26: dispersions.turbulence.severity: 'rough' is not a choice, allowed: one of light, "
     "moderate, severe\n"},
    {"ExceedanceOffTheFigure", "campaign.yaml", "dispersions:\n",
     "dispersions:\n  turbulence: {exceedance: 0.5, wind_20ft_m_s: 10}\n", "campaign.yaml",
     "campaign.yaml:8:28: dispersions.turbulence.exceedance: 0.5 is out of range, allowed: a number from "
     "1e-06 to 0.2\n"},
    {"ActuatorTooFastForTheTick", "vehicle.yaml", "bandwidth_rad_s: 25", "bandwidth_hz: 200", "campaign.yaml",
     "vehicle.yaml:16:101: stages[0].gimbal.bandwidth_hz: is too fast for the autopilot's ticks of 10 ms, "
     "which are "
     "the integration's steps, allowed: at most 1000 rad/s (159.2 Hz), or shorter ticks\n"},
    {"GuidanceOfNoKind", "campaign.yaml", "name: trial", "name: trial\nguidance: {mode: closed}",
     "campaign.yaml",
     "campaign.yaml:3:18: guidance.mode: 'closed' is not a choice, allowed: one of open_loop, closed_loop\n"},
    {"GuidanceTooFast", "campaign.yaml", "name: trial",
     "name: trial\nguidance: {mode: closed_loop, period_s: 0.01}", "campaign.yaml",
     "campaign.yaml:3:41: guidance.period_s: 0.01 is out of range, allowed: a number from 0.1 to 10\n"},
    {"WordForCount", "campaign.yaml", "cases: 100", "cases: many", "campaign.yaml",
     "campaign.yaml:6:40: sampling.cases: 'many' is not a number, allowed: a whole number "
     "from 1 to 4294967295\n"},
    {"FractionForCount", "campaign.yaml", "cases: 100", "cases: 1.5", "campaign.yaml",
     "campaign.yaml:6:40: sampling.cases: '1.5' is not a whole number, allowed: a whole "
     "number from 1 to 4294967295\n"},
    {"NoCases", "campaign.yaml", "cases: 100", "cases: 0", "campaign.yaml",
     "campaign.yaml:6:40: sampling.cases: 0 is out of range, allowed: a whole number from 1 "
     "to 4294967295\n"},
    {"WordForMap", "campaign.yaml", "sampling: {method: monte_carlo, cases: 100, seed: 20260101}",
     "sampling: monte_carlo", "campaign.yaml",
     "campaign.yaml:6:11: sampling: 'monte_carlo' is not a map, allowed: a map of keys and "
     "values\n"},
    {"ListForNumber", "vehicle.yaml", "thrust_kn: 60", "thrust_kn: [60]", "campaign.yaml",
     "vehicle.yaml:11:24: stages[0].motor.thrust_kn: a list is not a number, allowed: a "
     "number above 0\n"},
    {"MissingUnit", "vehicle.yaml", "longitude_deg: 66.75, altitude_m: 0",
     "longitude_deg: 66.75, altitude: 0", "vehicle.yaml",
     "vehicle.yaml:3:50: site.altitude: missing unit (did you mean 'altitude_m'?), allowed: "
     "altitude_m, altitude_km, altitude_mm, altitude_um\n"},
    {"WrongUnit", "vehicle.yaml", "longitude_deg: 66.75, altitude_m: 0",
     "longitude_deg: 66.75, altitude_ft: 0", "vehicle.yaml",
     "vehicle.yaml:3:50: site.altitude_ft: the unit of 'altitude_ft' is not known here, "
     "allowed: altitude_m, altitude_km, altitude_mm, altitude_um\n"},
    {"TwoUnits", "vehicle.yaml", "altitude_m: 0", "altitude_m: 0, altitude_km: 0", "vehicle.yaml",
     "vehicle.yaml:3:78: site.altitude_km: 'altitude_m' is given too, allowed: one of the "
     "two\n"},
    {"NegativeMass", "vehicle.yaml", "propellant_mass_kg: 500", "propellant_mass_kg: -500", "campaign.yaml",
     "vehicle.yaml:21:25: stages[1].propellant_mass_kg: -500 is out of range, allowed: a "
     "number above 0\n"},
    {"NotANumber", "vehicle.yaml", "burning_time_s: 60, ignition_rise_s: 0.2, tail_off_s: 0.4, pub",
     "burning_time_s: .nan, ignition_rise_s: 0.2, tail_off_s: 0.4, pub", "vehicle.yaml",
     "vehicle.yaml:11:44: stages[0].motor.burning_time_s: '.nan' is not finite, allowed: a "
     "number above 0\n"},
    {"Infinite", "vehicle.yaml", "hold_down_s: 0.5", "hold_down_s: .inf", "vehicle.yaml",
     "vehicle.yaml:4:14: hold_down_s: '.inf' is not finite, allowed: a number not below 0\n"},
    {"Overflow", "vehicle.yaml", "hold_down_s: 0.5", "hold_down_s: 1e999", "vehicle.yaml",
     "vehicle.yaml:4:14: hold_down_s: '1e999' is not finite, allowed: a number not below 0\n"},
    {"QuotedNumber", "vehicle.yaml", "hold_down_s: 0.5", "hold_down_s: \"0.5\"", "vehicle.yaml",
     "vehicle.yaml:4:14: hold_down_s: '0.5' is not a number, allowed: a number not below 0\n"},
    {"OutOfRange", "vehicle.yaml", "latitude_deg: 25.2", "latitude_deg: 125.2", "vehicle.yaml",
     "vehicle.yaml:3:22: site.latitude_deg: 125.2 is out of range, allowed: a number from -90 "
     "to 90\n"},
    {"StageOrder", "vehicle.yaml", "liftoff_mass_ton: 3", "liftoff_mass_ton: 0.5", "campaign.yaml",
     "vehicle.yaml:8:25: stages[0].propellant_mass_kg: leaves the stage no dry mass: lift-off "
     "mass less what is above it and its propellant is -2000.000000 kg, allowed: less "
     "propellant than the stage's own mass\nvehicle.yaml:20:23: stages[1].liftoff_mass_ton: "
     "is not below that of the stage underneath: lift-off mass counts everything above, and "
     "stages are listed in the order of flight, allowed: less than 500.000000\n"},
    {"SecondLiftOff", "vehicle.yaml", "trigger: timer", "trigger: lift_off", "campaign.yaml",
     "vehicle.yaml:29:25: stages[1].ignition.trigger: only the first stage ignites at "
     "lift-off, allowed: burnout_detection or timer\n"},
    {"UnknownChoice", "vehicle.yaml", "trigger: timer", "trigger: tiemr", "campaign.yaml",
     "vehicle.yaml:29:25: stages[1].ignition.trigger: 'tiemr' is not a choice (did you mean "
     "'timer'?), allowed: one of lift_off, burnout_detection, timer\n"},
    {"CgBehindNozzle", "vehicle.yaml", "pivot_station_m: 3.9", "pivot_station_m: 1.9", "vehicle.yaml",
     "vehicle.yaml:28:31: stages[1].gimbal.pivot_station_m: is not aft of the centre of "
     "gravity, which reaches station 2.500000 m, allowed: a station aft of the centre of "
     "gravity\n"},
    {"NozzlesWithoutYaw", "vehicle.yaml", "pivot_station_m: 3.9, radius_m: 0.3,",
     "pivot_station_m: 3.9, nozzles: [{name: main, turns_towards_deg: [90]}],", "vehicle.yaml",
     "vehicle.yaml:28:45: stages[1].gimbal.nozzles: do not turn the vehicle in yaw, allowed: hinges by which "
     "pitch and "
     "yaw are commanded, as turns_towards_deg: [90, 180] of one nozzle\n"},
    {"NozzleOfSkewHinges", "vehicle.yaml", "pivot_station_m: 3.9, radius_m: 0.3,",
     "pivot_station_m: 3.9, nozzles: [{name: main, turns_towards_deg: [90, 150]}],", "vehicle.yaml",
     "vehicle.yaml:28:78: stages[1].gimbal.nozzles[0].turns_towards_deg: has hinges that are not at right "
     "angles, but "
     "60.000000 deg apart, allowed: one direction, or two that are 90 deg apart\n"},
    {"ListAndCross", "vehicle.yaml", "pivot_station_m: 3.9, radius_m: 0.3,",
     "pivot_station_m: 3.9, radius_m: 0.3, nozzles: [{name: main, turns_towards_deg: [90, 180]}],",
     "vehicle.yaml",
     "vehicle.yaml:28:36: stages[1].gimbal.radius_m: unknown key 'radius_m', allowed: bandwidth_hz, "
     "bandwidth_rad_s, "
     "damping_ratio, dead_zone_deg, dead_zone_rad, delay_ticks, friction_deg, friction_rad, limit_deg, "
     "limit_rad, "
     "nozzles, pivot_station_km, pivot_station_m, pivot_station_mm, pivot_station_um, rate_limit_deg_s, "
     "rate_limit_rad_s, resolution_deg, resolution_rad\n"},
    {"TimerOfNoStage", "reference.yaml", "  last_ignition_s: 420.5\n",
     "  last_ignition_s: 420.5\n  stage2_coast_s: 5\n  stage2_ignition_s: 90\n", "campaign.yaml",
     "reference.yaml:1:1: stage2_ignition_s is given, and stage 2 of the vehicle is not one before the last "
     "that "
     "ignites on a timer, allowed: no coast of that stage\n"},
    {"AzimuthOfMoreThanATurn", "reference.yaml", "launch_azimuth_deg: [90, 170]",
     "launch_azimuth_deg: [10, 375]", "reference.yaml",
     "reference.yaml:11:25: problem.bounds.launch_azimuth_deg: is more than a turn, allowed: [low, high], "
     "low "
     "from 0 to "
     "below 360; [350, 10] goes through north\n"},
    {"MissingKey", "vehicle.yaml", "radius_m: 0.3, limit_deg: 6, rate_limit_deg_s: 30, bandwidth_rad_s: 40",
     "radius_m: 0.3, rate_limit_deg_s: 30, bandwidth_rad_s: 40", "vehicle.yaml",
     "vehicle.yaml:28:13: stages[1].gimbal: missing key 'limit_deg' or 'limit_rad', allowed: "
     "a number above 0 and below 90\n"},
    {"UnreachableFile", "campaign.yaml", "vehicle: vehicle.yaml", "vehicle: vehicles/none.yaml",
     "campaign.yaml",
     "campaign.yaml:3:10: vehicle: file 'vehicles/none.yaml' not found, allowed: a file, named relative to "
     "this one\n"},
    {"FolderForFile", "campaign.yaml", "vehicle: vehicle.yaml", "vehicle: .", "campaign.yaml",
     "campaign.yaml:3:10: vehicle: cannot read '': Is a directory, allowed: a readable file, "
     "named relative to this one\n"},
    {"OtherSchemaVersion", "campaign.yaml", "campaign/1", "campaign/2", "campaign.yaml",
     "campaign.yaml:1:9: schema: 'dispersa/campaign/2' is not a schema, allowed: one of "
     "dispersa/campaign/1, dispersa/vehicle/1, dispersa/autopilot/1, dispersa/reference/1, "
     "dispersa/scenario/1\n"},
    {"FilesSwapped", "campaign.yaml", "vehicle: vehicle.yaml", "vehicle: autopilot.yaml", "campaign.yaml",
     "autopilot.yaml:1:9: schema: 'dispersa/autopilot/1' is not the schema of this kind of "
     "file, allowed: schema: dispersa/vehicle/1\n"},
    {"NoSchema", "autopilot.yaml", "schema: dispersa/autopilot/1\n", "", "campaign.yaml",
     "autopilot.yaml:1:1: missing key 'schema', allowed: schema: dispersa/autopilot/1\n"},
    {"NoSchemaOnItsOwn", "autopilot.yaml", "schema: dispersa/autopilot/1\n", "", "autopilot.yaml",
     "autopilot.yaml:1:1: missing key 'schema', allowed: one of dispersa/campaign/1, "
     "dispersa/vehicle/1, dispersa/autopilot/1, dispersa/reference/1, "
     "dispersa/scenario/1\n"},
    {"Duplicate", "campaign.yaml", "name: trial", "name: trial\nname: other", "campaign.yaml",
     "campaign.yaml:3:1: the key 'name' is given twice, allowed: each key once in a map\n"},
    {"NotYaml", "campaign.yaml", "sampling: {", "sampling: [", "campaign.yaml",
     "campaign.yaml:6:59: not YAML: illegal flow end\n"},
    {"TabForIndent", "campaign.yaml", "  wind:", "\twind:", "campaign.yaml",
     "campaign.yaml:9:1: a tab indents the line, allowed: spaces\n"},
    {"Alias", "autopilot.yaml", "name: plain", "name: &n plain", "autopilot.yaml",
     "autopilot.yaml:2:7: an anchor ('&name') is not supported, allowed: the value itself\n"},
    {"BarePercentBesideDistribution", "campaign.yaml", "three_sigma_percent: 6.7", "percent: 20",
     "campaign.yaml",
     "campaign.yaml:10:44: dispersions.drag_coefficient.percent: 'percent' alone does not say "
     "what it means (3 sigma, bound, corner, ...), allowed: distribution: normal with "
     "three_sigma_percent or sigma_percent; uniform with bound_percent; two_point with "
     "plus_minus_percent; values with values_percent or values_factor; constant with "
     "value_percent or value_factor; truncated_normal, triangular, lognormal, rayleigh or empirical with "
     "theirs\n"},
    {"BarePercent", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7", "percent: 20",
     "campaign.yaml",
     "campaign.yaml:10:22: dispersions.drag_coefficient.percent: 'percent' alone does not say "
     "what it means (3 sigma, bound, corner, ...), allowed: distribution: normal with "
     "three_sigma_percent or sigma_percent; uniform with bound_percent; two_point with "
     "plus_minus_percent; values with values_percent or values_factor; constant with "
     "value_percent or value_factor; truncated_normal, triangular, lognormal, rayleigh or empirical with "
     "theirs\n"},
    {"BareDegrees", "campaign.yaml", "distribution: normal, three_sigma_deg: 0.25", "deg: 20",
     "campaign.yaml",
     "campaign.yaml:8:25: dispersions.thrust_misalignment.deg: 'deg' alone does not say what "
     "it means (3 sigma, bound, corner, ...), allowed: distribution: normal with "
     "three_sigma_deg or three_sigma_rad or sigma_deg or sigma_rad; uniform with bound_deg or "
     "bound_rad; two_point with plus_minus_deg or plus_minus_rad; values with values_deg or "
     "values_rad; constant with value_deg or value_rad; truncated_normal, triangular, lognormal, rayleigh or "
     "empirical with theirs\n"},
    {"NoDistribution", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "three_sigma_percent: 6.7", "campaign.yaml",
     "campaign.yaml:10:21: dispersions.drag_coefficient: missing key 'distribution', allowed: "
     "one of normal, uniform, two_point, values, constant, truncated_normal, triangular, lognormal, "
     "empirical\n"},
    {"UnknownDistribution", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: gaussian, three_sigma_percent: 6.7", "campaign.yaml",
     "campaign.yaml:10:36: dispersions.drag_coefficient.distribution: 'gaussian' is not a "
     "choice, allowed: one of normal, uniform, two_point, values, constant, truncated_normal, triangular, "
     "lognormal, empirical\n"},
    {"ParameterOfAnotherDistribution", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: uniform, three_sigma_percent: 6.7", "campaign.yaml",
     "campaign.yaml:10:21: dispersions.drag_coefficient: missing key 'bound_percent', "
     "allowed: bound_percent, or both low_percent or low_factor and high_percent or "
     "high_factor\ncampaign.yaml:10:45: dispersions.drag_coefficient.three_sigma_percent: "
     "unknown key 'three_sigma_percent', allowed: bound_percent, distribution, high_factor, "
     "high_percent, low_factor, low_percent, per, stage\n"},
    {"DistributionWithoutUnit", "campaign.yaml", "three_sigma_percent: 6.7", "three_sigma: 6.7",
     "campaign.yaml",
     "campaign.yaml:10:44: dispersions.drag_coefficient.three_sigma: missing unit (did you "
     "mean 'three_sigma_percent'?), allowed: three_sigma_percent\n"},
    {"TwoSigmas", "campaign.yaml", "three_sigma_percent: 6.7", "three_sigma_percent: 6.7, sigma_percent: 2",
     "campaign.yaml",
     "campaign.yaml:10:85: dispersions.drag_coefficient.sigma_percent: 'three_sigma_percent' and "
     "'sigma_percent' are "
     "both given, allowed: one of three_sigma_percent, sigma_percent\n"},
    {"TwoRanges", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: uniform, bound_percent: 5, low_percent: -5, high_percent: 5", "campaign.yaml",
     "campaign.yaml:10:60: dispersions.drag_coefficient.bound_percent: the distribution is given twice, "
     "allowed: "
     "bound_percent, or both low_percent or low_factor and high_percent or high_factor\n"},
    {"MedianOfNothing", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: lognormal, median_percent: -100, sigma_log: 0.1", "campaign.yaml",
     "campaign.yaml:10:63: dispersions.drag_coefficient.median_percent: -100 is out of range, allowed: a "
     "number above "
     "-100\n"},
    {"FactorCanBeNegative", "campaign.yaml", "three_sigma_percent: 6.7", "three_sigma_percent: 67",
     "campaign.yaml",
     "campaign.yaml:10:21: dispersions.drag_coefficient: a draw at 6 sigma is -0.34 (factor), "
     "allowed: a number above 0\n"},
    {"FactorCanBeZero", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: uniform, bound_percent: 100", "campaign.yaml",
     "campaign.yaml:10:21: dispersions.drag_coefficient: a draw can be 0 (factor), allowed: a "
     "number above 0\n"},
    {"NothingConserved", "campaign.yaml", ", conserve: total_impulse", "", "campaign.yaml",
     "campaign.yaml:11:11: dispersions.thrust: missing key 'conserve', allowed: one of "
     "total_impulse, propellant\n"},
    {"PerWhat", "campaign.yaml", "conserve: total_impulse, per: stage", "conserve: total_impulse",
     "campaign.yaml",
     "campaign.yaml:11:11: dispersions.thrust: missing key 'per', allowed: one of stage, "
     "vehicle, nozzle\n"},
    {"FlowOfANozzle", "campaign.yaml", "conserve: total_impulse, per: stage",
     "conserve: total_impulse, per: nozzle", "campaign.yaml",
     "campaign.yaml:11:68: dispersions.thrust.conserve: the flow is the whole motor's, not a nozzle's, in "
     "stage 1, allowed: "
     "conserve: propellant with per: nozzle, or stages with liquid engines\n"},
    {"BareAzimuth", "campaign.yaml", "azimuth: uniform", "azimuth: 270", "campaign.yaml",
     "campaign.yaml:9:41: dispersions.wind.azimuth: '270' is not a direction, allowed: "
     "uniform, {fixed_deg: x} or a distribution\n"},
    {"TwoLimits", "campaign.yaml", "below: 0.5", "below: 0.5, above: 0.1", "campaign.yaml",
     "campaign.yaml:13:5: requirements[0]: 'below' and 'above' are both given, allowed: "
     "either below: x, above: x or within: [low, high]\n"},
    {"NoLimit", "campaign.yaml", "below: 0.5, ", "", "campaign.yaml",
     "campaign.yaml:13:5: requirements[0]: the limit is missing, allowed: either below: x, "
     "above: x or within: [low, high]\n"},
    {"ProbabilityInPercent", "campaign.yaml", "probability: 0.9973", "probability: 99.73", "campaign.yaml",
     "campaign.yaml:13:61: requirements[0].probability: 99.73 is out of range, it is in percent (did "
     "you mean 0.9973?), allowed: a number above 0 and below 1\n"},
    {"CertainRisk", "campaign.yaml", "consumer_risk: 0.10", "consumer_risk: 1", "campaign.yaml",
     "campaign.yaml:13:84: requirements[0].consumer_risk: 1 is out of range, allowed: a "
     "number above 0 and below 0.5\n"},
    {"ThreeLimits", "campaign.yaml", "below: 0.5", "below: 0.5, within: [0, 1]", "campaign.yaml",
     "campaign.yaml:13:5: requirements[0]: more than one limit is given, allowed: either below: x, above: x "
     "or "
     "within: [low, high]\n"},
    {"LimitsTheWrongWayRound", "campaign.yaml", "below: 0.5", "within: [1, 0]", "campaign.yaml",
     "campaign.yaml:13:44: requirements[0].within: the first limit is not below the second, allowed: [low, "
     "high]\n"},
    {"TwoPlans", "campaign.yaml", "below: 0.5", "below: 0.5, looks: 3, anytime: true", "campaign.yaml",
     "campaign.yaml:13:67: requirements[0].anytime: 'looks' and 'anytime' are both given, allowed: either "
     "looks: "
     "K or anytime: true\n"},
    {"SpendingOfOneLook", "campaign.yaml", "below: 0.5", "below: 0.5, spending: pocock", "campaign.yaml",
     "campaign.yaml:13:58: requirements[0].spending: one look has nothing to share, allowed: looks: 2 or "
     "more\n"},
    {"NoLooks", "campaign.yaml", "below: 0.5", "below: 0.5, looks: 0", "campaign.yaml",
     "campaign.yaml:13:55: requirements[0].looks: 0 is out of range, allowed: a whole number from 1 to "
     "100\n"},
    {"MaxCasesWithoutStop", "campaign.yaml",
     "requirements:", "verdicts: {max_cases: 500}\nrequirements:", "campaign.yaml",
     "campaign.yaml:12:23: verdicts.max_cases: every case is flown, allowed: stop: when_decided\n"},
    {"StudyThatStops", "campaign.yaml", "sampling: {method: monte_carlo",
     "verdicts: {stop: when_decided}\nsampling: {method: sobol", "campaign.yaml",
     "campaign.yaml:6:18: verdicts.stop: a design study decides nothing, allowed: method: monte_carlo\n"},
    {"ReplicatesOfDraws", "campaign.yaml", "seed: 20260101", "seed: 20260101, replicates: 4", "campaign.yaml",
     "campaign.yaml:6:73: sampling.replicates: only a Latin hypercube or Sobol design has replicates, "
     "allowed: "
     "method: latin_hypercube or sobol\n"},
    {"UnevenReplicates", "campaign.yaml", "sampling: {method: monte_carlo, cases: 100, seed: 20260101}",
     "sampling: {method: sobol, cases: 100, seed: 1, replicates: 3}", "campaign.yaml",
     "campaign.yaml:6:60: sampling.replicates: 100 cases are not divisible into 3 designs of one size, "
     "allowed: a "
     "divisor of the number of cases\n"},
    {"NotPositiveDefinite", "campaign.yaml", "requirements:",
     "correlations:\n  - {of: [drag_coefficient, thrust/stage1], matrix: [[1, 1], [1, 1]]}\nrequirements:",
     "campaign.yaml",
     "campaign.yaml:13:53: correlations[0].matrix: the matrix is not positive definite, allowed: "
     "correlations "
     "that can hold together\n"},
    {"CorrelationOfAUniform", "campaign.yaml", "requirements:",
     "correlations:\n  - {of: [drag_coefficient, wind/azimuth], matrix: [[1, 0.5], [0.5, 1]]}\nrequirements:",
     "campaign.yaml",
     "campaign.yaml:13:29: correlations[0].of[1]: 'wind/azimuth' is not normal, allowed: distribution: "
     "normal\n"},
    {"CrookedMatrix", "campaign.yaml", "requirements:",
     "correlations:\n  - {of: [drag_coefficient, thrust/stage1], matrix: [[1, 0.5], [0.4, "
     "1]]}\nrequirements:",
     "campaign.yaml",
     "campaign.yaml:13:53: correlations[0].matrix: the matrix is not symmetric, allowed: equal numbers "
     "across the "
     "diagonal\n"},
    {"ModeOutside", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: triangular, low_percent: -5, mode_percent: 6, high_percent: 5", "campaign.yaml",
     "campaign.yaml:10:21: dispersions.drag_coefficient: the mode is not between the low and the high value, "
     "allowed: low <= mode <= high\n"},
    {"WeightsAndValues", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: values, values_percent: [1, 2], weights: [1]", "campaign.yaml",
     "campaign.yaml:10:77: dispersions.drag_coefficient.weights: there are 1 weights for 2 values, allowed: "
     "one "
     "weight a value\n"},
    {"FactorAsMagnitude", "campaign.yaml", "distribution: normal, three_sigma_percent: 6.7",
     "distribution: rayleigh, sigma_percent: 2", "campaign.yaml",
     "campaign.yaml:10:36: dispersions.drag_coefficient.distribution: a factor is no magnitude, allowed: "
     "rayleigh for an angle, a length, a speed or a rate\n"},
    {"EmptyList", "campaign.yaml",
     "requirements:\n  - {metric: pitch_error_peak_deg, below: 0.5, probability: 0.9973, "
     "consumer_risk: 0.10}",
     "requirements: []", "campaign.yaml",
     "campaign.yaml:12:15: requirements: the list is empty, allowed: a list of 1 or more\n"},
    {"CornersOfNothing", "campaign.yaml", "method: monte_carlo", "method: corners", "campaign.yaml",
     "campaign.yaml:6:20: sampling.method: the design has nothing to vary, allowed: one "
     "dispersion or more with distribution: two_point\n"},
    {"NameWithSlash", "campaign.yaml", "name: trial", "name: a/b", "campaign.yaml",
     "campaign.yaml:2:7: name: 'a/b' cannot name a folder, allowed: up to 64 letters, digits, "
     "'_', '-' and '.', the first not '.'\n"},
    {"NumberForName", "campaign.yaml", "name: trial", "name: 007", "campaign.yaml",
     "campaign.yaml:2:7: name: '007' is not text, allowed: text; in quotes if it looks like a "
     "number\n"},
    {"NothingToFly", "campaign.yaml", "reference: reference.yaml\n", "", "campaign.yaml",
     "campaign.yaml:1:1: there is neither 'reference' nor 'optimize', allowed: one of the "
     "two\n"},
    {"TimesNotIncreasing", "reference.yaml", "- [10, 85.5", "- [0, 85.5", "reference.yaml",
     "reference.yaml:39:8: attitude.rows[1][0]: the time is not after the row before, "
     "allowed: strictly increasing times\n"},
    {"ShortRow", "reference.yaml", "- [10, 85.5, ", "- [10, ", "reference.yaml",
     "reference.yaml:39:7: attitude.rows[1]: a list is not a row of 7 numbers, allowed: a list of 7 "
     "numbers: time_s, pitch_deg, yaw_deg, roll_deg, pitch_rate_deg_s, yaw_rate_deg_s, "
     "roll_rate_deg_s\n"},
    {"UnknownColumn", "reference.yaml", "[time_s, pitch_deg,", "[time_s, pitch_rad,", "reference.yaml",
     "reference.yaml:36:21: attitude.columns[1]: 'pitch_rad' is not the column, allowed: "
     "pitch_deg\n"},
    {"ProgramOutOfOrder", "reference.yaml", "t3_s: 7.5", "t3_s: 19", "reference.yaml",
     "reference.yaml:23:3: flight_program: the times are out of order, allowed: t1 < t3 < t2\n"},
    {"BoundsOutOfOrder", "reference.yaml", "t3_s: [6, 9]", "t3_s: [9, 6]", "reference.yaml",
     "reference.yaml:8:11: problem.bounds.t3_s: the lower bound is above the upper one, "
     "allowed: [low, high]\n"},
    {"GainsForOneStage", "autopilot.yaml",
     "  gains: [{kp_1_s2: 9, kd_1_s: 4}, {kp_1_s2: 16, kd_1_s: 6}]\n  rules",
     "  gains: [{kp_1_s2: 9, kd_1_s: 4}]\n  rules", "campaign.yaml",
     "autopilot.yaml:6:10: pitch.gains: has 1 entries, allowed: one entry for each of the "
     "vehicle's 2 stages\n"},
    {"NegativePn", "autopilot.yaml", "gamma: [10, 20]", "gamma: [10, 20]\n    p_n: [-1, 1]", "campaign.yaml",
     "autopilot.yaml:10:10: pitch.adaptation.p_n: is not positive: no positive definite P has "
     "this last column and gives a stable law, allowed: two positive numbers, or "
     "allow_unproven: true to study it\n"},
    {"ShortMatrix", "autopilot.yaml", "q: [[10, 0], [0, 10]]", "q: [[10, 0], [0]]", "campaign.yaml",
     "autopilot.yaml:10:18: pitch.adaptation.q[1]: a list is not a row of 2 numbers, "
     "allowed: [[q11, q12], [q12, q22]]\n"},
    {"AsymmetricMatrix", "autopilot.yaml", "q: [[10, 0], [0, 10]]", "q: [[10, 3], [0, 10]]", "campaign.yaml",
     "autopilot.yaml:10:8: pitch.adaptation.q: is not symmetric positive definite, allowed: a "
     "symmetric matrix with positive diagonal and determinant\n"},
    {"LawWithoutRules", "autopilot.yaml", "  rules: {error_range_deg: 5, rate_range_deg_s: 1.5}\n", "",
     "campaign.yaml",
     "autopilot.yaml:5:3: pitch: missing key 'rules', allowed: a map, which this law needs\n"},
    {"NoForFalse", "vehicle.yaml", "terminate: false", "terminate: no", "vehicle.yaml",
     "vehicle.yaml:35:60: limits.terminate: 'no' is not a truth value, allowed: true or "
     "false\n"},
};

INSTANTIATE_TEST_SUITE_P(CampaignYamlErrors, BadInputTest, testing::ValuesIn(kBadInputs),
                         [](const auto& instance) { return instance.param.name; });

TEST(CampaignYamlErrors, ValidFilesHaveNone) {
  const InputFiles files;
  for (const char* file : {"campaign.yaml", "vehicle.yaml", "autopilot.yaml", "reference.yaml"}) {
    EXPECT_EQ(files.Texts(CheckFile(files.Path(file)).errors), "") << file;
  }
}

TEST(CampaignYamlErrors, AllProblemsOfAllFilesAreReportedInOrder) {
  const InputFiles files;
  files.Edit("vehicle.yaml", "hold_down_s: 0.5", "hold_down_s: -1");
  files.Edit("vehicle.yaml", "fraction: 0.75", "fraction: 7.5");
  files.Edit("autopilot.yaml", "tick_s: 0.01", "tick_s: soon");
  files.Edit("campaign.yaml", "reference.yaml", "nowhere.yaml");
  files.Edit("campaign.yaml", "seed: 20260101", "seed: -1");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      "campaign.yaml:4:12: reference: file 'nowhere.yaml' not found, allowed: a file, named relative to this "
      "one\n"
      "campaign.yaml:6:51: sampling.seed: '-1' is not a whole number, allowed: a whole number from 0 to "
      "18446744073709551615\n"
      "vehicle.yaml:4:14: hold_down_s: -1 is out of range, allowed: a number not below 0\n"
      "vehicle.yaml:14:32: stages[0].structure[0].fraction: 7.5 is out of range, allowed: a number above 0 "
      "and not above 1\n"
      "autopilot.yaml:3:9: tick_s: 'soon' is not a number, allowed: a number from 1e-04 to 0.1\n");
}

TEST(CampaignYamlErrors, UnreadableFileOnTheCommandLine) {
  const InputFiles files;
  EXPECT_EQ(files.Texts(CheckFile(files.Path("nothing.yaml")).errors),
            "nothing.yaml:1:1: file not found, allowed: a file that exists\n");
}

TEST(CampaignYamlErrors, EmptyFileAndFileWithoutMap) {
  const InputFiles files;
  files.Write("empty.yaml", "# nothing\n");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("empty.yaml")).errors),
            "empty.yaml:1:1: the file is empty, allowed: a map with a 'schema' key\n");
  files.Write("word.yaml", "hello\n");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("word.yaml")).errors),
            "word.yaml:1:1: missing key 'schema', allowed: one of dispersa/campaign/1, dispersa/vehicle/1, "
            "dispersa/autopilot/1, dispersa/reference/1, "
            "dispersa/scenario/1\n");
}

TEST(CampaignYamlErrors, UnknownMetricNamesTheNearest) {
  const InputFiles files;
  files.Edit("campaign.yaml", "pitch_error_peak_deg", "pitch_error_peek_deg");
  EXPECT_THAT(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      HasSubstr(
          "campaign.yaml:13:14: requirements[0].metric: 'pitch_error_peek_deg' is not a metric (did you "
          "mean 'pitch_error_peak_deg'?), allowed: one of pitch_error_rms_deg, "));
}

TEST(CampaignYamlErrors, UnknownDispersionNamesTheNearest) {
  const InputFiles files;
  files.Edit("campaign.yaml", "  drag_coefficient:", "  drag_coeficient:");
  EXPECT_THAT(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      HasSubstr(
          "campaign.yaml:10:3: dispersions.drag_coeficient: unknown key 'drag_coeficient' (did you mean "
          "'drag_coefficient'?), allowed: accelerometer_scale, actuator_bandwidth, "));
}

TEST(CampaignYamlErrors, BadCellsOfATableAreFoundByLineAndColumn) {
  const InputFiles files;
  files.Edit(
      "campaign.yaml", "requirements:",
      "  wind_profile: {statistics: wind_statistics.csv, correlation_ne: 0.1, correlation_length_km: 3}\n"
      "requirements:");
  ASSERT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  files.Edit("wind_statistics.csv", "10000,5,25,9,12", "10000, 5,much,-9,12");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      "wind_statistics.csv:4:10: mean_east_m_s[1]: 'much' is not a number, allowed: a number from -500 to "
      "500\n"
      "wind_statistics.csv:4:15: sigma_north_m_s[1]: -9 is out of range, allowed: a number from 0 to 500\n");
  files.Edit("wind_statistics.csv", "10000, 5,much,-9,12", "10000,5,25,9");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
            "wind_statistics.csv:4:1: the row has 4 cells, allowed: 5, as the header\n");
}

TEST(CampaignYamlErrors, TableWithOtherColumns) {
  const InputFiles files;
  files.Edit("campaign.yaml", "requirements:", "  wind_profile: {table: wind.csv}\nrequirements:");
  files.Write("wind.csv", "altitude_m,north_m_s,eest_m_s\n0,0,0\n1000,0,5\n");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      "wind.csv:1:22: unknown column 'eest_m_s' (did you mean 'east_m_s'?), allowed: the columns altitude_m, "
      "north_m_s, east_m_s, and temperature_k, pressure_pa, density_kg_m3 if there is one\n");
}

TEST(CampaignYamlErrors, ColumnThatIsGivenTwice) {
  const InputFiles files;
  files.Edit("campaign.yaml", "requirements:", "  wind_profile: {table: wind.csv}\nrequirements:");
  files.Write("wind.csv", "altitude_m,north_m_s,altitude_m,east_m_s\n0,0,0,0\n1000,0,1000,5\n");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
            "wind.csv:1:22: the column 'altitude_m' is given twice, allowed: the columns altitude_m, "
            "north_m_s, east_m_s, and temperature_k, pressure_pa, density_kg_m3 if there is one\n");
}

// Values without relation to an unreadable table are checked all the same.
TEST(CampaignYamlErrors, RelationsBesideAnUnreadableTable) {
  const InputFiles files;
  const std::string unreadable =
      "vehicle.yaml:35:64: aerodynamics.tables[0].table: file 'none.csv' not found, allowed: a file, named "
      "relative to this one\n";
  files.Edit("vehicle.yaml", "surface_roughness_um: 6",
             "aerodynamics:\n"
             "  tables:\n"
             "    - {reference_area_m2: 0.785, reference_length_m: 1, table: none.csv}\n"
             "    - {reference_area_m2: 0.785, reference_length_m: 1, table: aero.csv}\n");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("vehicle.yaml")).errors), unreadable);
  files.Edit("vehicle.yaml", "name: first\n    liftoff_mass_ton: 3",
             "name: first\n    liftoff_mass_ton: 2.4");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("vehicle.yaml")).errors),
      "vehicle.yaml:8:25: stages[0].propellant_mass_kg: leaves the stage no dry mass: lift-off mass less "
      "what is above it and its propellant is -100.000000 kg, allowed: less propellant than the stage's "
      "own mass\n" +
          unreadable);
}

TEST(CampaignYamlErrors, CampaignToOptimizeCannotBeFlownYet) {
  const InputFiles files;
  const std::string reference = ReadWholeFile(files.Path("reference.yaml"));
  const std::size_t begin = reference.find("  target:");
  const std::string problem = reference.substr(begin, reference.find("flight_program:") - begin);
  files.Edit("campaign.yaml", "reference: reference.yaml\n", "optimize:\n" + problem);
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  EXPECT_EQ(LoadOptimization(files.Path("campaign.yaml"), 7).problem.seed, 7u);
  try {
    LoadCampaign(files.Path("campaign.yaml"));
    FAIL() << "loaded";
  } catch (const InputError& error) {
    EXPECT_EQ(
        files.Texts(error.problems()),
        "campaign.yaml:5:3: optimize: the campaign has no trajectory to fly yet, allowed: run `dispersa "
        "optimize "
        "campaign.yaml -o REFERENCE.yaml`, then write `reference: REFERENCE.yaml` in place of `optimize:`\n");
  }
}

TEST(CampaignYamlErrors, TextWithoutFilesNamesNone) {
  const InputFiles files;
  try {
    ParseCampaign(ReadWholeFile(files.Path("campaign.yaml")), "assignment");
    FAIL() << "loaded";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "assignment:3:10: vehicle: the file 'vehicle.yaml' is named in a text without files, allowed: its "
        "contents in its place\n"
        "assignment:4:12: reference: the file 'reference.yaml' is named in a text without files, allowed: "
        "its "
        "contents in its place\n"
        "assignment:5:12: autopilot: the file 'autopilot.yaml' is named in a text without files, allowed: "
        "its "
        "contents in its place");
  }
}

TEST(GuidanceOfAVehicle, NeedsALastBurnThatItCanChange) {
  const InputFiles files;
  files.Edit("campaign.yaml", "name: trial", "name: trial\nguidance: {mode: closed_loop}");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  files.Edit("vehicle.yaml", "ignition: {trigger: timer}", "ignition: {trigger: burnout_detection}");
  EXPECT_EQ(
      files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
      "campaign.yaml:3:18: guidance.mode: the last burn of 'two-stage' follows the one before at once and "
      "ends "
      "by itself: guidance can change neither its beginning nor its end, allowed: open_loop, or a last stage "
      "with ignition: {trigger: timer} or with a liquid engine that has cut_off: {at: inertial_velocity}, "
      "{at: target} or {at: time}\n");
}

// A metric of one law is required of its flights alone.
TEST(RequiredMetrics, AreOfTheLawThatFlies) {
  const InputFiles files;
  files.Edit("campaign.yaml", "metric: pitch_error_peak_deg", "metric: rules_fired");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors), "");
  files.Edit("autopilot.yaml",
             "pitch:\n  law: adaptive_fuzzy\n  gains: [{kp_1_s2: 9, kd_1_s: 4}, {kp_1_s2: 16, kd_1_s: 6}]\n"
             "  rules: {error_range_deg: 5, rate_range_deg_s: 1.5}\n  adaptation:\n    gamma: [10, 20]\n"
             "    q: [[10, 0], [0, 10]]\n    projection_bound_deg_s2: 40\n    leakage_1_s: 0.1\n"
             "    dead_zone_deg: 0.01\n    freeze_when_saturated: true\n",
             "pitch: {law: pd, gains: [{kp_1_s2: 9, kd_1_s: 4}, {kp_1_s2: 16, kd_1_s: 6}]}\n");
  EXPECT_EQ(files.Texts(CheckFile(files.Path("campaign.yaml")).errors),
            "campaign.yaml:13:14: requirements[0].metric: 'rules_fired' is of flights whose law of pitch is "
            "adaptive_fuzzy or frozen_fuzzy; here it is pd, allowed: a metric that these flights have\n");
}

}  // namespace
}  // namespace dispersa::campaign_yaml_errors_test
