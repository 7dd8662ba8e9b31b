#include "core/campaign_yaml/decode_campaign.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/campaign/case_result.h"
#include "core/campaign/dispersion_fields.h"
#include "core/campaign/dispersion_table.h"
#include "core/campaign/flight_definition.h"
#include "core/campaign/free_flight.h"
#include "core/campaign/plausible_dispersions.h"
#include "core/campaign_yaml/campaign_ids.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/describe_file.h"
#include "core/campaign_yaml/named_files.h"
#include "core/flight/metrics.h"
#include "core/flight/sensor_model.h"
#include "core/flight/step_limits.h"
#include "core/flight/structural_limits.h"
#include "core/input/base_file.h"
#include "core/input/number_text.h"
#include "core/input/read_value.h"
#include "core/input/struct_problems.h"
#include "core/math/constants.h"

namespace dispersa {
namespace {

using ProblemList = std::vector<InputProblem>;

// A hint for a word that is no input. A key of `dispersions` stands for the first column that it draws.
std::string MeantInput(const std::string& word, const std::vector<std::string>& names) {
  for (const DispersionRow& row : DispersionRows())
    if (row.key == word && !row.columns.empty())
      return " (did you mean its column '" + ExpandColumn(row.columns.front()).front() + "'?)";
  return DidYouMean(word, names);
}

// A cases.csv serves as it is: its inputs have a prefix, and its other columns are results.
bool KeepInputs(InputNode& table) {
  constexpr std::string_view kPrefix = "input_";
  const auto is_input = [&](const InputMember& member) { return member.key.starts_with(kPrefix); };
  if (std::none_of(table.members.begin(), table.members.end(), is_input)) return false;
  std::erase_if(table.members, [&](const InputMember& member) { return !is_input(member); });
  for (InputMember& member : table.members) member.key.erase(0, kPrefix.size());
  return true;
}

// Of a cases.csv: columns that neither differ from the nominal flight nor replace another draw say nothing.
void LeaveOutNominal(InputNode& table, const std::vector<Dispersion>& dispersions) {
  static FlightInputs nominal;
  const std::vector<InputMember> all = table.members;
  std::erase_if(table.members, [&](const InputMember& member) {
    const int input = FindInput(member.key);
    if (input < 0 || member.value.items.empty()) return false;
    const bool is_drawn = std::any_of(dispersions.begin(), dispersions.end(), [&](const Dispersion& one) {
      return std::find(one.inputs.begin(), one.inputs.end(), input) != one.inputs.end();
    });
    const double value = InputValue(nominal, input) / InputColumns()[static_cast<std::size_t>(input)].unit;
    return !is_drawn && std::all_of(member.value.items.begin(), member.value.items.end(),
                                    [&](const InputNode& item) { return ParseNumber(item.text) == value; });
  });
  if (table.members.empty()) table.members = {all.front()};
}

// A column's numbers, where the vehicle can have them. The nominal value is one of them: nothing may read it.
void ReadListed(Fields& fields, const char* key, int input, const Vehicle& vehicle,
                std::vector<double>& values) {
  static FlightInputs nominal;
  const double unit = InputColumns()[static_cast<std::size_t>(input)].unit;
  const double usual = InputValue(nominal, input);
  Range range = RangeOf(vehicle, input);
  if (!range.Contains(usual)) {
    if (usual <= range.low) range.low = usual, range.low_open = false;
    if (usual >= range.high) range.high = usual, range.high_open = false;
  }
  fields.Numbers(key, {range.low / unit, range.high / unit, range.low_open, range.high_open}, 1, SIZE_MAX,
                 values, "in the unit of its name");
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] *= unit;
    if (values[i] == usual || !range.Contains(values[i]) || IsAllowed(vehicle, input, values[i])) continue;
    fields.Refuse(std::string(key) + "[" + std::to_string(i) + "]",
                  FormatNumber(values[i] / unit) + " is no whole number", RangeText(vehicle, input));
  }
}

// The columns of a list's table, each an input by its name in cases.csv.
void DescribeListTable(Fields& fields, const InputNode& table, bool is_sound, Campaign& campaign) {
  const Vehicle vehicle = is_sound ? campaign.vehicle : Vehicle{};
  for (const InputMember& member : table.members) {
    const char* key = member.key.c_str();
    const int input = FindInput(member.key);
    if (input < 0 || (is_sound && !HasInput(vehicle, input))) {
      const std::string meant = MeantInput(member.key, InputNamesOf(campaign.vehicle));
      fields.Misplaced(key, {}, ("'{}' is not an input of this vehicle" + meant).c_str(),
                       "a column of cases.csv");
      continue;
    }
    ScalarDistribution values;
    values.kind = Distribution::kValues;
    ReadListed(fields, key, input, vehicle, values.values);
    for (std::size_t i = 0; member.key == "weather_sounding" && i < values.values.size(); ++i)
      if (values.values[i] > static_cast<double>(campaign.soundings.size()))
        fields.Refuse(member.key + "[" + std::to_string(i) + "]",
                      "the campaign has no sounding " + FormatNumber(values.values[i]),
                      "0, their mean, to " + std::to_string(campaign.soundings.size()));
    campaign.dispersions.push_back({"list/" + member.key, std::move(values), {input}, false, {}, true});
  }
}

// The vehicle has the stages that are steered. The first one is steered after its boosters have left.
template <class T>
void CheckSteering(const Vehicle& vehicle, const std::array<T, kMaxStages>& steering, const InputNode& node,
                   const std::string& path, ProblemList& problems) {
  for (std::size_t stage = vehicle.stages.size(); stage < kMaxStages; ++stage)
    if (!steering[stage].empty())
      AddProblem(problems, node, path,
                 "stage" + std::to_string(stage + 1) + "_incidence_* is given, and the vehicle has " +
                     std::to_string(vehicle.stages.size()) + " stages",
                 "stage1_incidence_* to the last stage of the vehicle");
  if (!steering[0].empty() && vehicle.boosters.count == 0)
    AddProblem(
        problems, node, path,
        "stage1_incidence_* is given, and the first stage has no boosters: in the air it flies without "
        "incidence",
        "stage1_incidence_* of a vehicle with boosters, after which the stage burns on");
}

// Stages before the last that a timer ignites, and only they, have a coast of their own.
void CheckTimers(const Vehicle& vehicle, const InputNode& node, const std::string& path,
                 const std::string& key, const std::function<bool(std::size_t)>& has, ProblemList& problems) {
  for (std::size_t stage = 1; stage < kMaxStages; ++stage) {
    const bool wants =
        stage + 1 < vehicle.stages.size() && vehicle.stages[stage].ignition == IgnitionTrigger::kTimer;
    if (wants == has(stage)) continue;
    const std::string name = "stage" + std::to_string(stage + 1);
    const std::string number = "stage " + std::to_string(stage + 1);
    AddProblem(problems, node, path,
               wants ? number + " of the vehicle ignites on a timer, and " + name + "_" + key + " is missing"
                     : name + "_" + key + " is given, and " + number +
                           " of the vehicle is not one before the last that ignites on a timer",
               wants ? name + "_" + key : "no coast of that stage");
  }
}

// The name becomes part of a folder's name.
void CheckName(Fields& fields, const std::string& name) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() ||
      (std::all_of(name.begin(), name.end(), is_allowed) && name[0] != '.' && name.size() <= 64))
    return;
  fields.Refuse("name", "'" + name + "' cannot name a folder",
                "up to 64 letters, digits, '_', '-' and '.', the first not '.'");
}

// What guidance of this vehicle cannot do; `fields` are those of the guidance.
void CheckGuidance(Fields& fields, const GuidanceConfig& guidance, const Vehicle& vehicle) {
  if (!guidance.closed_loop || vehicle.stages.empty()) return;
  const std::string name = "'" + vehicle.name + "'";
  const Stage& last = vehicle.stages.back();
  const bool is_cut_off = IsCutOffByGuidance(last), is_timed = last.ignition == IgnitionTrigger::kTimer;
  if (vehicle.stages.size() < 2)
    fields.Refuse("mode",
                  "the only burn of " + name +
                      " begins in the air, where the attitude must follow the wind and not the orbit",
                  "open_loop, or a vehicle of two burns or more");
  else if (!is_cut_off && !is_timed)
    fields.Refuse(
        "mode",
        "the last burn of " + name +
            " follows the one before at once and ends by itself: guidance can change neither its "
            "beginning nor its end",
        "open_loop, or a last stage with ignition: {trigger: timer} or with a liquid engine that has "
        "cut_off: {at: inertial_velocity}, {at: target} or {at: time}");
  else if (!is_cut_off && last.restarts)
    fields.Refuse("mode",
                  "the last burn of " + name +
                      " uses up what the burns before leave: its energy is not known before they end",
                  "open_loop, or cut_off: {at: inertial_velocity}, {at: target} or {at: time} of the last "
                  "burn");
  else if (!last.is_controlled() && guidance.steers_last_burn)
    fields.Refuse("last_burn", "the last stage of " + name + " has no gimbal by which it could be steered",
                  "as_planned: it is pointed before its ignition");
  else if (is_cut_off && !is_timed && !guidance.steers_last_burn && !PlansBelow(vehicle, guidance))
    fields.Refuse(
        "last_burn",
        "no coast precedes the last burn of " + name + ", so nothing can be planned before its ignition",
        "steered");
  else if (static_cast<std::size_t>(guidance.burns) > vehicle.stages.size())
    fields.Refuse("burns", name + " has " + std::to_string(vehicle.stages.size()) + " burns",
                  "up to " + std::to_string(vehicle.stages.size()));
}

// A value of the campaign that may be a file of its own.
struct Part {
  InputNode* node = nullptr;
  std::string path;
};

// The campaign's keys, in the order in which each needs those before. Without a tree (a schema is made)
// nothing is read.
class CampaignDescription {
 public:
  CampaignDescription(InputNode* root, CampaignUse use, DecodedCampaign& decoded, ProblemList& problems,
                      FileSource* files, ProblemList* warnings)
      : root_(root),
        use_(use),
        decoded_(decoded),
        campaign_(decoded.campaign),
        problems_(problems),
        files_(files),
        warnings_(warnings) {}

  void Describe(Fields& fields) {
    fields.Deciding(Decides::kNothing, [&] {
      fields.File(kCampaignSchema, &CampaignBase());
      fields.Text("name", campaign_.name, "of the campaign, and of its folder");
      CheckName(fields, campaign_.name);
      std::string description;
      fields.Text("description", description, "purpose", "");
    });
    fields.Document("vehicle", kVehicleSchema, true, "a vehicle file", "the vehicle",
                    [this](InputNode& node, const std::string& path) {
                      vehicle_ = {&node, path};
                      campaign_.vehicle = DecodeVehicle(node, path, problems_, files_, warnings_);
                    });
    DescribeCourse(fields);
    fields.Either({{Is("flight.control", {"none"}), [&] { DescribeFreeFlights(fields); }},
                   {Else(), [&] {
                      DescribeTrajectory(fields);
                      fields.Either(
                          {{Has("optimize"), [&] { DescribeFlights(fields, false); }},
                           {Else(), [&] { DescribeFlights(fields, use_ != CampaignUse::kOptimize); }}});
                    }}});
    DescribeDispersions(fields);
    fields.Deciding(Decides::kVerdict, [&] { DescribeJudgement(fields); });
  }

  // What is legal but looks wrong.
  void Warn() {
    if (warnings_ == nullptr || !problems_.empty()) return;
    const double on_time_s = campaign_.vehicle.reaction_control.minimum_on_time_s;
    if (flies() && on_time_s > 0.0 && campaign_.autopilot.tick_s > on_time_s * (1.0 + 1e-9))
      WarnOf(vehicle_, "reaction_control.minimum_on_time_s",
             "thrusters fire for whole ticks of " + FormatRounded(campaign_.autopilot.tick_s) +
                 " s, which is longer than they have to",
             "at least a tick of the autopilot");
    WarnOfGround();
    const Part whole{root_, ""};
    for (const UnusualDispersion& unusual : UnusualDispersions(campaign_)) {
      WarnOf(whole, unusual.key, unusual.message, unusual.allowed);
      warnings_->back().unusual = true;
    }
    WarnOfGuidance();
    if (decoded_.optimize)
      WarnOfInclination(decoded_.optimize->target_inclination_rad, optimize_, "target.inclination_deg");
    if (reference_.node == nullptr) return;
    WarnOfShortWeather(whole);
    WarnOfInclination(campaign_.reference.orbit.inclination_rad, reference_, "orbit.inclination_deg");
    if (!campaign_.reference.target_missed.empty())
      WarnOf(reference_, "target_missed",
             "the reference misses its own target: " + campaign_.reference.target_missed,
             "a reference that reaches it");
    if (campaign_.reference.vehicle_sha256 != VehicleSha256(*vehicle_.node))
      WarnOf(reference_, "", "the reference was found for another vehicle; flights will miss its orbit",
             "a reference that `dispersa optimize` wrote for this vehicle");
  }

 private:
  bool flies() const { return use_ != CampaignUse::kOptimize && !decoded_.optimize; }

  void WarnOf(const Part& part, const std::string& key, const std::string& message,
              const std::string& allowed) {
    std::string path;
    const InputNode& at = FindField(*part.node, key, &path);
    AddProblem(*warnings_, at, part.path.empty() || path.empty() ? part.path + path : part.path + "." + path,
               message, allowed);
  }

  // The default of the ground is the ellipsoid.
  void WarnOfGround() {
    constexpr double kSame_m = 200.0;
    const double site_m = campaign_.vehicle.site.altitude_m;
    std::string path;
    FindField(*vehicle_.node, "descent.ground_altitude_m", &path);
    if (campaign_.course.ends != FlightEnd::kImpact || path.find("ground_altitude") != std::string::npos ||
        std::fabs(site_m) < kSame_m)
      return;
    WarnOf(vehicle_, "site.altitude_m",
           "the site is at " + FormatRounded(site_m) +
               " m, and flights end at 0 m: descent.ground_altitude_m is not given",
           "descent: {ground_altitude_m: x}, also where it is 0");
  }

  void WarnOfGuidance() {
    if (!flies() || !campaign_.guidance.closed_loop) return;
    const GuidedAuthority authority = AuthorityOf(campaign_.vehicle, campaign_.autopilot, campaign_.guidance);
    // The place along the orbit is a fourth condition in its plane, beside energy and path.
    const TrajectoryProblem& problem = campaign_.reference.problem;
    const bool is_timed = campaign_.vehicle.stages.back().ignition == IgnitionTrigger::kTimer;
    if (problem.target_argument_of_perigee_rad && !problem.is_entered_anywhere && !is_timed &&
        !PlansBelow(campaign_.vehicle, campaign_.guidance))
      WarnOf(reference_, "problem.target.argument_of_perigee_deg",
             "with a true anomaly (at the perigee: 0) it is a place along the orbit, which only a coast of "
             "another duration can move, and no timer ignites the last burn of '" +
                 campaign_.vehicle.name + "'",
             "entered_at: anywhere, or a last burn with ignition: {trigger: timer}");
    for (const GuidanceExcess& one : ExcessesOf(campaign_.guidance, authority))
      WarnOf({root_, ""}, "guidance." + one.key, one.message, one.allowed);
  }

  // A launch due east has the inclination of its latitude.
  // A balloon that burst too early.
  void WarnOfShortWeather(const Part& whole) {
    if (!flies() || (!campaign_.wind_table && campaign_.soundings.empty())) return;
    const double of_max_q_m = AltitudeOfMaxQ(campaign_);
    if (campaign_.wind_table && WindTop(*campaign_.wind_table) < of_max_q_m)
      WarnOfShort(whole, "wind_profile", WindTop(*campaign_.wind_table), of_max_q_m);
    for (std::size_t i = 0; i < campaign_.soundings.size(); ++i)
      if (const double top_m = WindTop(campaign_.soundings[i].table); top_m < of_max_q_m)
        WarnOfShort(whole, "weather.ensemble[" + std::to_string(i) + "]", top_m, of_max_q_m);
  }
  void WarnOfShort(const Part& whole, const std::string& key, double top_m, double of_max_q_m) {
    WarnOf(whole, "dispersions." + key,
           "ends at " + FormatRounded(top_m) + " m, below the reference's greatest dynamic pressure",
           FormatRounded(of_max_q_m) + " m or more; above its end the wind fades within " +
               FormatRounded(kWindFade_m) + " m");
    warnings_->back().unusual = true;
  }
  void WarnOfInclination(std::optional<double> inclination_rad, const Part& part, const std::string& key) {
    const double latitude_rad = std::fabs(campaign_.vehicle.site.latitude_rad);
    if (!inclination_rad) return;
    const double least_rad = std::min(*inclination_rad, kPi - *inclination_rad);
    constexpr double kTurned_rad = 0.5 * kRadPerDeg;
    if (least_rad >= latitude_rad - kTurned_rad) return;
    WarnOf(part, key,
           "no launch from a latitude of " + FormatRounded(latitude_rad * kDegPerRad) +
               " deg comes to this inclination without turning its plane",
           "from " + FormatRounded(latitude_rad * kDegPerRad) + " to " +
               FormatRounded((kPi - latitude_rad) * kDegPerRad) + " deg");
  }

  void DescribeTrajectory(Fields& fields) {
    fields.Document("reference", kReferenceSchema, false, "a reference file", "the trajectory that is flown",
                    [this](InputNode& node, const std::string& path) {
                      reference_ = {&node, path};
                      campaign_.reference =
                          DecodeFile<Reference>(node, path, problems_, files_, DescribeReferenceFile);
                    });
    TrajectoryProblem problem;
    bool is_sought = false;
    fields.OptionalMap("optimize", is_sought, "the trajectory to be found, in place of reference",
                       [&](Fields& optimize) { dispersa::Describe(optimize, problem); });
    if (is_sought && root_ != nullptr) {
      optimize_ = {root_->Find("optimize"), "optimize"};
      decoded_.optimize = problem;
    }
    fields.ExactlyOne({"reference", "optimize"});
    // Also one whose file could not be read.
    const auto has = [this](const char* key) { return root_ != nullptr && root_->Find(key) != nullptr; };
    const bool has_reference = has("reference"), has_problem = has("optimize");
    if (has_reference == has_problem)
      fields.Refuse("",
                    has_reference ? "'reference' and 'optimize' are both given"
                                  : "there is neither 'reference' nor 'optimize'",
                    "one of the two");
    else if (has_problem && (use_ == CampaignUse::kFly || use_ == CampaignUse::kRead))
      fields.Refuse(
          "optimize", "the campaign has no trajectory to fly yet",
          "run `dispersa optimize " + (root_->file ? *root_->file : std::string("CAMPAIGN")) +
              " -o REFERENCE.yaml`, then write `reference: REFERENCE.yaml` in place of `optimize:`");
    CheckTrajectory();
  }

  // That it is one of this vehicle's.
  void CheckTrajectory() {
    const Vehicle& vehicle = campaign_.vehicle;
    if (problems_.empty() && optimize_.node != nullptr)
      CheckTimers(
          vehicle, *optimize_.node, optimize_.path + ".bounds", "coast_s: [low, high]",
          [&](std::size_t stage) { return decoded_.optimize->earlier_coast_s[stage].high > 0.0; }, problems_);
    else if (problems_.empty() && reference_.node != nullptr)
      CheckTimers(
          vehicle, *reference_.node, reference_.path, "ignition_s",
          [&](std::size_t stage) { return campaign_.reference.earlier_ignition_s[stage] > 0.0; }, problems_);
    if (problems_.empty() && optimize_.node != nullptr)
      CheckSteering(vehicle, decoded_.optimize->steering, *optimize_.node, optimize_.path + ".bounds",
                    problems_);
    else if (problems_.empty() && reference_.node != nullptr)
      CheckSteering(vehicle, campaign_.reference.program.steering, *reference_.node, reference_.path,
                    problems_);
  }

  void DescribeCourse(Fields& fields) {
    bool has_course = true;
    fields.OptionalMap(
        "flight", has_course, "where flights end, and whether they are controlled", [&](Fields& course) {
          dispersa::Describe(course, campaign_.course);
          if (!problems_.empty()) return;
          for (const StructProblem& problem : ControlProblems(campaign_.vehicle, campaign_.course))
            course.Refuse(problem.path, problem.message, problem.allowed);
        });
    if (has_course || root_ == nullptr || vehicle_.node == nullptr || !problems_.empty()) return;
    for (const StructProblem& problem : ControlProblems(campaign_.vehicle, campaign_.course))
      AddProblem(problems_, *vehicle_.node, vehicle_.path, problem.message, problem.allowed);
  }

  // Flights that nothing controls: neither reference nor autopilot, which the vehicle's rail replaces.
  void DescribeFreeFlights(Fields& fields) {
    for (const char* key : {"reference", "optimize", "autopilot", "guidance"})
      fields.Misplaced(key, {}, "'{}' is given, and nothing controls the flights (flight.control)",
                       "flight: {control: autopilot}, or a campaign without it");
    if (root_ != nullptr && problems_.empty()) {
      SetFreeFlight(campaign_);
      has_autopilot_ = true;
    }
    DescribeSampling(fields, true);
  }

  // A trajectory that is yet to be found needs nothing that flies it.
  void DescribeFlights(Fields& fields, bool needed) {
    fields.Document("autopilot", kAutopilotSchema, needed, "an autopilot file",
                    "autopilot that flies the trajectory",
                    [this](InputNode& node, const std::string& path) { ReadAutopilotOf(node, path); });
    bool is_guided = false;
    fields.OptionalMap("guidance", is_guided,
                       "how a flight is guided; without, it flies the reference as it is",
                       [&](Fields& guidance) {
                         dispersa::Describe(guidance, campaign_.guidance);
                         CheckGuidance(guidance, campaign_.guidance, campaign_.vehicle);
                       });
    DescribeSampling(fields, needed);
  }
  void DescribeSampling(Fields& fields, bool needed) {
    const auto sampling = [&](Fields& map) {
      dispersa::Describe(map, campaign_.sampling);
      map.Either({{Is("method", {"list"}),
                   [&] {
                     map.Columns("table",
                                 "the cases of a list, a column of cases.csv an input; or a CSV file",
                                 [this](InputNode& node, const std::string& path) {
                                   is_cases_csv_ = KeepInputs(node);
                                   list_ = {&node, path};
                                 });
                   }},
                  {Else(),
                   [&] { map.Misplaced("table", {}, "only a list is read from a table", "method: list"); }}});
    };
    has_sampling_ = needed;
    if (needed)
      fields.Map("sampling", "which cases are flown", sampling);
    else
      fields.OptionalMap("sampling", has_sampling_, "which cases are flown", sampling);
  }
  void ReadAutopilotOf(InputNode& node, const std::string& path) {
    campaign_.autopilot =
        DecodeAutopilot(node, path, static_cast<int>(campaign_.vehicle.stages.size()), problems_, files_,
                        use_ == CampaignUse::kRead ? PythonLaws::kMayBeAbsent : PythonLaws::kMustBeHere);
    has_autopilot_ = problems_.empty();
    if (problems_.empty())
      AddStructProblems(GyroProblems(campaign_.vehicle, campaign_.autopilot), node, path, problems_);
    if (problems_.empty())
      AddStructProblems(StepProblems(campaign_.vehicle, campaign_.autopilot.tick_s), *vehicle_.node,
                        vehicle_.path, problems_);
  }

  void DescribeDispersions(Fields& fields) {
    const std::size_t before = problems_.size();
    bool has_dispersions = false;
    fields.OptionalMap("dispersions", has_dispersions, "inputs that differ from case to case",
                       [&](Fields& map) { dispersa::DescribeDispersions(map, before == 0, campaign_); });
    if (list_.node != nullptr) {
      if (is_cases_csv_) LeaveOutNominal(*list_.node, campaign_.dispersions);
      const bool is_sound = before == 0 && problems_.size() == before;
      ReadFields(*list_.node, list_.path, problems_, files_,
                 [&](Fields& map) { DescribeListTable(map, *list_.node, is_sound, campaign_); });
    }
    std::vector<Correlation> correlations;
    fields.List(
        "correlations", 0, SIZE_MAX, correlations, "groups of normal dispersions that are drawn together",
        [&](Fields& map, Correlation& group) { dispersa::Describe(map, group, campaign_.dispersions); });
    fields.OptionalList("derived", 1, InputColumns().size(), campaign_.derived,
                        "inputs that follow from drawn ones", [&](Fields& map, DerivedInput& derived) {
                          dispersa::Describe(map, derived, DerivedBefore(derived), campaign_.dispersions,
                                             campaign_.vehicle);
                        });
    std::erase_if(campaign_.derived,
                  [this](const DerivedInput& derived) { return IsListed(derived.column); });
    if (list_.node != nullptr) LeaveOutReplaced();
    if (problems_.size() == before && has_sampling_)
      CheckDesign(fields, campaign_.sampling, campaign_.dispersions);
  }

  // Draws whose inputs the table gives, all of them, are none. Those that others are correlated with stay.
  void LeaveOutReplaced() {
    std::vector<Dispersion>& all = campaign_.dispersions;
    std::vector<bool> kept(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      kept[i] = all[i].replaces || !std::all_of(all[i].inputs.begin(), all[i].inputs.end(),
                                                [this](int input) { return IsListed(input); });
    for (std::size_t i = 0; i < all.size(); ++i)
      if (kept[i])
        for (const auto& [other, weight] : all[i].mix) kept[other] = true;
    std::vector<std::size_t> now(all.size());
    std::vector<Dispersion> left;
    for (std::size_t i = 0; i < all.size(); ++i) {
      now[i] = left.size();
      if (kept[i]) left.push_back(std::move(all[i]));
    }
    for (Dispersion& dispersion : left)
      for (auto& [other, weight] : dispersion.mix) other = now[other];
    all = std::move(left);
  }
  // The table's value stands in place of a derived one.
  bool IsListed(int column) const {
    return std::any_of(campaign_.dispersions.begin(), campaign_.dispersions.end(),
                       [&](const Dispersion& one) { return one.replaces && one.inputs.front() == column; });
  }

  std::vector<DerivedInput> DerivedBefore(const DerivedInput& derived) const {
    std::vector<DerivedInput> before;
    for (const DerivedInput& other : campaign_.derived) {
      if (&other == &derived) break;
      before.push_back(other);
    }
    return before;
  }

  // Also where another autopilot flies than the file's.
  void CheckMeasured(Fields& requirement, const std::string& metric) {
    if (!has_autopilot_ || metric.empty()) return;
    if (const std::string why = WhyNotMeasured(campaign_, metric); !why.empty())
      requirement.Refuse("metric", "'" + metric + "' " + why, "a metric that these flights have");
  }

  // Names that an own metric may not have again.
  std::vector<std::string> NamesBefore(const OwnMetric& metric) const {
    std::vector<std::string> names = MetricNames();
    for (const OwnMetric& other : campaign_.own_metrics) {
      if (&other == &metric) break;
      names.push_back(other.name);
    }
    return names;
  }
  void ReadExpression(Fields& fields, OwnMetric& metric) const {
    if (!has_autopilot_ || metric.expression.empty()) return;
    try {
      metric.parsed = ParseOwnMetric(metric.expression, static_cast<int>(campaign_.vehicle.stages.size()),
                                     campaign_.autopilot);
    } catch (const ExpressionError& error) {
      fields.Refuse("expression", error.what(), error.allowed);
    }
  }
  std::string ExpressionOf(const std::string& metric) const {
    for (const OwnMetric& own : campaign_.own_metrics)
      if (own.name == metric) return own.expression;
    return "";
  }

  void DescribeJudgement(Fields& fields) {
    VerdictPlan plan;
    bool has_verdicts = false;
    fields.OptionalMap("verdicts", has_verdicts, "how the requirements are judged together",
                       [&](Fields& verdicts) {
                         dispersa::Describe(verdicts, campaign_.verdicts, plan, campaign_.sampling);
                       });
    const std::size_t stages = campaign_.vehicle.stages.size();
    fields.Deciding(Decides::kNothing, [&] {
      fields.OptionalList("metrics", 1, kMaxOwnMetrics, campaign_.own_metrics,
                          "metrics of the campaign's own", [&](Fields& map, OwnMetric& metric) {
                            dispersa::Describe(map, metric, NamesBefore(metric));
                            ReadExpression(map, metric);
                          });
    });
    std::vector<std::string> metrics = MetricNames();
    if (root_ != nullptr) metrics.resize(MetricCount(stages));
    for (const OwnMetric& metric : campaign_.own_metrics) metrics.push_back(metric.name);
    fields.OptionalList("requirements", 1, SIZE_MAX, campaign_.requirements, "requirements on the flights",
                        [&](Fields& map, Requirement& requirement) {
                          requirement.plan = plan;
                          dispersa::Describe(map, requirement, metrics);
                          // Of another name the list of names has said so.
                          if (std::find(metrics.begin(), metrics.end(), requirement.metric) != metrics.end())
                            CheckMeasured(map, requirement.metric);
                          requirement.own_expression = ExpressionOf(requirement.metric);
                          if (!requirement.every_case) return;
                          requirement.plan = {};
                          if (IsIndependent(campaign_.sampling.method))
                            map.Refuse("every_case", "'every_case' is of a design study",
                                       "probability and consumer_risk, or another sampling method");
                        });
    fields.When(Has("assumptions"), [&] {
      fields.Deciding(Decides::kNothing, [&] {
        fields.Texts("assumptions", 1, SIZE_MAX, campaign_.assumptions,
                     "assumptions of the verdicts; on the report's first page");
      });
    });
  }

  InputNode* const root_;  // null: there is none
  const CampaignUse use_;
  DecodedCampaign& decoded_;
  Campaign& campaign_;
  ProblemList& problems_;
  FileSource* const files_;
  ProblemList* const warnings_;
  Part vehicle_, reference_, optimize_, list_;
  bool has_sampling_ = false;
  bool is_cases_csv_ = false;
  bool has_autopilot_ = false;
};

}  // namespace

DecodedCampaign DecodeCampaign(InputNode& root, CampaignUse use, std::vector<InputProblem>& problems,
                               FileSource* files, std::vector<InputProblem>* warnings) {
  WriteOut(root, CampaignBase(), "", problems, files);
  DecodedCampaign decoded;
  CampaignDescription description(&root, use, decoded, problems, files, warnings);
  ReadFields(root, "", problems, files, [&](Fields& fields) { description.Describe(fields); });
  description.Warn();
  return decoded;
}

void DescribeCampaignFile(Fields& fields) {
  DecodedCampaign decoded;
  ProblemList problems;
  CampaignDescription(nullptr, CampaignUse::kCheck, decoded, problems, nullptr, nullptr).Describe(fields);
}

}  // namespace dispersa
