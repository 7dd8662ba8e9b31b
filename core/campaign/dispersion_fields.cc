#include "core/campaign/dispersion_fields.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "core/campaign/dispersion_table.h"
#include "core/environment/turbulence.h"
#include "core/math/assertion.h"
#include "core/math/functions.h"
#include "core/vehicle/mass.h"

namespace dispersa {
namespace {

std::string StageName(int stage) { return "stage" + std::to_string(stage); }

class DispersionFields {
 public:
  DispersionFields(bool is_sound, Campaign& campaign)
      : vehicle_(campaign.vehicle),
        is_sound_(is_sound && !vehicle_.stages.empty()),
        stages_(vehicle_.stages.empty() ? kMaxStages : static_cast<int>(vehicle_.stages.size())),
        campaign_(campaign) {}

  void Describe(Fields& fields, const DispersionRow& row, const std::string& name) {
    switch (row.draws) {
      case Draws::kOnce:
      case Draws::kEachAxis:
      case Draws::kEachMode:
        return Plain(fields, row, name);
      case Draws::kEachStage:
      case Draws::kStages:
      case Draws::kVehicleOrStages:
      case Draws::kOffAxis:
      case Draws::kThrust:
      case Draws::kPropellantTemperature:
        return OfStages(fields, row, name);
      case Draws::kBoosters:
      case Draws::kBoostersTemperature:
      case Draws::kBoostersAside:
        return OfBoosters(fields, row, name);
      case Draws::kFixed:
      case Draws::kFixedOrAbsent: {
        ScalarDistribution distribution;
        if (DescribeFixedOrDrawn(fields, row.key, row.scalar, row.draws == Draws::kFixed, distribution,
                                 row.meaning))
          Add(name, distribution, row.columns);
        return;
      }
      case Draws::kDirection: {
        ScalarDistribution direction;
        DescribeDirection(fields, row.key, direction, row.meaning);
        return Add(name, direction, row.columns);
      }
      case Draws::kParts:
      case Draws::kPayloadMass:
      case Draws::kWind:
      case Draws::kGust:
      case Draws::kWindProfile:
      case Draws::kWeather:
      case Draws::kTurbulence:
      case Draws::kStuckNozzle:
      case Draws::kAeroUncertainty:
        break;
    }
    bool is_there = false;
    fields.OptionalMap(row.key, is_there, row.meaning, [&](Fields& map) {
      if (row.draws == Draws::kPayloadMass) PayloadMass(map, row);
      if (row.draws == Draws::kWind) WindSpeed(map, row);
      if (row.draws == Draws::kWindProfile) WindProfile(map, row);
      if (row.draws == Draws::kWeather) Weather(map, row);
      if (row.draws == Draws::kTurbulence) Turbulence(map, row);
      if (row.draws == Draws::kStuckNozzle) StuckNozzle(map, row);
      if (row.draws == Draws::kAeroUncertainty) AeroUncertainties(map, row);
      const int before = maps_;
      for (const DispersionRow& part : row.parts) Describe(map, part, name + "/" + part.key);
      if (row.draws == Draws::kParts) OneOrMoreParts(map, row, maps_ > before);
    });
  }

 private:
  void Add(const std::string& name, const ScalarDistribution& distribution,
           const std::vector<std::string>& columns, bool absolute = false) {
    std::vector<int> inputs;
    for (const std::string& column : columns) {
      inputs.push_back(FindInput(column));
      DISPERSA_ASSERT(inputs.back() >= 0);
    }
    campaign_.dispersions.push_back({name, distribution, std::move(inputs), absolute});
  }
  static ScalarDistribution ReadScalar(Fields& fields, const DispersedScalar& scalar) {
    ScalarDistribution distribution;
    DescribeDistribution(fields, scalar, distribution);
    return distribution;
  }

  static void OneOrMoreParts(Fields& map, const DispersionRow& row, bool are_there) {
    std::vector<std::string> keys;
    std::string words;
    for (const DispersionRow& part : row.parts) {
      keys.emplace_back(part.key);
      words += (words.empty() ? "" : ", ") + keys.back();
    }
    map.OneOrMore(keys);
    if (are_there) return;
    map.Check([&map, words, are_axes = keys.front() == "roll"] {
      map.Refuse("", are_axes ? "no axis is given" : "no product is given", "one or more of " + words);
    });
  }

  // One map, whose draws no stage decides.
  void Plain(Fields& fields, const DispersionRow& row, const std::string& name) {
    bool is_there = false;
    fields.OptionalMap(row.key, is_there, row.meaning, [&](Fields& map) {
      ++maps_;
      const ScalarDistribution distribution = ReadScalar(map, row.scalar);
      const std::vector<std::string> all = ExpandColumn(row.columns.front());
      if (row.draws == Draws::kOnce) return Add(name, distribution, row.columns);
      bool each = true;
      if (row.draws == Draws::kEachMode)
        map.Choice<bool>("per", {{"mode", true}, {"vehicle", false}}, each,
                         "one draw per mode, or one for all");
      if (!each) return Add(name, distribution, all);
      for (std::size_t i = 0; i < all.size(); ++i) {
        constexpr const char* kLaunchAxes[] = {"downrange", "right", "down"};
        Add(name + "/" + (row.draws == Draws::kEachMode ? "mode" + std::to_string(i + 1) : kLaunchAxes[i]),
            distribution, {all[i]});
      }
    });
    if (!is_there && row.absent) Add(name, Constant(*row.absent), row.columns);
  }

  // ---- stages ----

  enum class Per { kStage, kVehicle, kNozzle };
  struct Selection {
    std::vector<int> stages;
    bool all = true;  // `stage` is not given
    Per per = Per::kStage;
  };

  // A map, or a list of them of which each is about stages of its own.
  void OfStages(Fields& fields, const DispersionRow& row, const std::string& name) {
    const int first = row.first_stage, last = stages_ - row.last_stages_without;
    if (first > last && row.draws == Draws::kStages)
      return fields.Misplaced(row.key, {}, "the vehicle has one stage", "a vehicle of two or more");
    std::set<int> taken;
    fields.MapOrMaps(row.key, "a map, or a list of maps with stage", row.meaning, [&](Fields& map) {
      ++maps_;
      Selection of;
      map.Group("choice_of_stages", std::to_string(first) + "_to_" + std::to_string(last),
                [&](Fields& group) {
                  group.Several("stage", first, last, "stage", "that this disperses", of.stages,
                                "only these stages; default: all");
                });
      of.all = of.stages.empty();
      for (int stage = first; of.all && stage <= last; ++stage) of.stages.push_back(stage);
      for (const int stage : of.stages) {
        if (taken.insert(stage).second) continue;
        map.Refuse(of.all ? "" : "stage", "stage " + std::to_string(stage) + " is given twice",
                   "each stage in one of the list");
        break;
      }
      for (const int stage : of.stages)
        if (const std::optional<Unfit> unfit =
                is_sound_ && row.unfit != nullptr ? row.unfit(vehicle_, stage) : std::nullopt)
          map.Refuse("", unfit->what, unfit->allowed);
      const ScalarDistribution distribution = ReadScalar(map, Limited(row, "stage", StageNames(of.stages)));
      if (row.draws == Draws::kOffAxis) return OffAxis(map, row, name, of, distribution);
      if (row.draws == Draws::kThrust) return Thrust(map, row, name, of, distribution);
      if (row.draws == Draws::kPropellantTemperature)
        return PropellantTemperature(map, row, name, of, distribution);
      if (row.draws == Draws::kStages) of.per = PerWhat(map, row);
      if (row.draws == Draws::kVehicleOrStages) {
        of.per = PerVehicle(map);
        if (of.all && of.per == Per::kVehicle) return Add(name, distribution, {row.columns.front()});
        return AddStages(name, of, distribution, {row.columns.back()});
      }
      AddStages(name, of, distribution, row.columns);
    });
  }

  // Of columns that the draws go to, whose place the vehicle may limit further.
  DispersedScalar Limited(const DispersionRow& row, const char* what,
                          const std::vector<std::string>& names) const {
    DispersedScalar scalar = row.scalar;
    if (!is_sound_ || row.columns.empty() || row.columns.front().find('{') == std::string::npos)
      return scalar;
    for (const std::string& name : names) {
      const int column = FindInput(FillColumn(row.columns.front(), what, name));
      if (column < 0 || InputColumns()[static_cast<std::size_t>(column)].allowed.of == nullptr) continue;
      const Range range = RangeOf(vehicle_, column);
      scalar.range = {std::max(scalar.range.low, range.low), std::min(scalar.range.high, range.high),
                      range.low_open, range.high_open};
    }
    return scalar;
  }

  static std::vector<std::string> StageNames(const std::vector<int>& stages) {
    std::vector<std::string> names;
    for (const int stage : stages) names.push_back(StageName(stage));
    return names;
  }
  std::vector<std::string> BoosterNames() const {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < vehicle_.boosters.angles_rad.size(); ++k)
      names.push_back(BoosterInColumns(vehicle_, k));
    return names;
  }

  static Per PerWhat(Fields& map, const DispersionRow& row) {
    std::vector<std::pair<std::string, Per>> choices = {{"stage", Per::kStage}, {"vehicle", Per::kVehicle}};
    if (!row.nozzle_columns.empty()) choices.emplace_back("nozzle", Per::kNozzle);
    Per per = Per::kStage;
    map.Choice<Per>("per", choices, per, "one draw for each");
    return per;
  }
  static Per PerVehicle(Fields& map) {
    Per per = Per::kVehicle;
    const auto choice = [&](Per absent) {
      map.Choice<Per>("per", {{"stage", Per::kStage}, {"vehicle", Per::kVehicle}}, per, "one draw for each",
                      absent);
    };
    map.Either({{Has("stage"), [&] { choice(Per::kStage); }}, {Else(), [&] { choice(Per::kVehicle); }}});
    return per;
  }

  static std::vector<std::string> FillColumns(const std::vector<std::string>& patterns,
                                              const std::string& what, const std::string& name) {
    std::vector<std::string> columns;
    for (const std::string& pattern : patterns) columns.push_back(FillColumn(pattern, what, name));
    return columns;
  }

  // One draw a stage, or one for all of them, as `per` says. A draw for some of the stages has their numbers
  // in its name: of two of a list each is a draw of its own.
  void AddStages(const std::string& name, const Selection& of, const ScalarDistribution& distribution,
                 const std::vector<std::string>& patterns, bool absolute = false) {
    std::vector<std::string> all;
    std::string numbers;
    for (const int stage : of.stages) {
      const std::vector<std::string> columns = FillColumns(patterns, "stage", StageName(stage));
      all.insert(all.end(), columns.begin(), columns.end());
      numbers += "_" + std::to_string(stage);
      if (of.per == Per::kStage) Add(name + "/" + StageName(stage), distribution, columns, absolute);
    }
    if (of.per == Per::kVehicle && !all.empty())
      Add(of.all ? name : name + "/stages" + numbers, distribution, all, absolute);
  }
  // One draw a nozzle.
  void AddNozzles(const std::string& name, const Selection& of, const ScalarDistribution& distribution,
                  const std::vector<std::string>& patterns, bool absolute = false) {
    for (const int stage : of.stages) {
      const std::vector<std::string> names = NozzleNames(stage);
      for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string nozzle =
            NozzleInColumns(vehicle_, static_cast<std::size_t>(stage) - 1, static_cast<int>(i));
        std::vector<std::string> columns;
        for (const std::string& pattern : patterns)
          columns.push_back(FillColumn(pattern, "stage}_{nozzle", nozzle));
        Add(name + "/" + StageName(stage) + "_" + names[i], distribution, columns, absolute);
      }
    }
  }
  bool KnowsStage(int stage) const {
    return stage >= 1 && static_cast<std::size_t>(stage) <= vehicle_.stages.size();
  }
  // Of the stage's list, else of the cross.
  std::vector<std::string> NozzleNames(int stage) const {
    std::vector<std::string> names;
    if (KnowsStage(stage))
      for (const Nozzle& nozzle : NozzlesOf(vehicle_.stages[static_cast<std::size_t>(stage) - 1].gimbal))
        names.push_back(nozzle.name);
    if (names.empty()) names.assign(std::begin(kNozzleNames), std::end(kNozzleNames));
    return names;
  }

  // A magnitude and the direction of it around the axis, or its two components.
  void OffAxis(Fields& map, const DispersionRow& row, const std::string& name, Selection of,
               const ScalarDistribution& distribution) {
    bool by_axis = false;
    map.Choice<bool>("draw", {{"magnitude", false}, {"per_axis", true}}, by_axis,
                     "the distance from the axis, or its components towards body y and z", false);
    ScalarDistribution direction;
    map.Either(
        {{Is("draw", {"per_axis"}),
          [&] {
            map.Misplaced("clock_angle", {}, "components have no direction besides",
                          "draw: magnitude with clock_angle");
          }},
         {Else(), [&] { DescribeDirection(map, "clock_angle", direction, "from body y towards body z"); }}});
    of.per = PerWhat(map, row);
    const auto add = [&](const std::string& part, std::size_t column, const ScalarDistribution& drawn,
                         bool absolute) {
      if (of.per == Per::kNozzle)
        AddNozzles(name + part, of, drawn, {row.nozzle_columns[column]}, absolute);
      else
        AddStages(name + part, of, drawn, {row.columns[column]}, absolute);
    };
    add(by_axis ? "/y" : "", by_axis ? 2 : 0, distribution, !by_axis);
    add(by_axis ? "/z" : "/clock", by_axis ? 3 : 1, by_axis ? distribution : direction, false);
  }

  void Thrust(Fields& map, const DispersionRow& row, const std::string& name, Selection of,
              const ScalarDistribution& distribution) {
    bool flow_follows = true;
    map.Choice<bool>("conserve", {{"total_impulse", true}, {"propellant", false}}, flow_follows,
                     "the flow changes with the thrust and the burn shortens, or flow and burning time stay");
    of.per = PerWhat(map, row);
    for (const int stage : of.stages)
      if (of.per == Per::kNozzle && flow_follows &&
          (!KnowsStage(stage) || !vehicle_.stages[static_cast<std::size_t>(stage) - 1].is_liquid())) {
        map.Refuse("conserve",
                   "the flow is the whole motor's, not a nozzle's, in stage " + std::to_string(stage),
                   "conserve: propellant with per: nozzle, or stages with liquid engines");
        break;
      }
    std::vector<std::string> columns = of.per == Per::kNozzle ? row.nozzle_columns : row.columns;
    if (of.per == Per::kNozzle) {
      if (!flow_follows) columns.pop_back();
      return AddNozzles(name, of, distribution, columns);
    }
    if (!flow_follows) columns.pop_back();
    AddStages(name, of, distribution, columns);
  }

  // A grain burns the faster the warmer it is: at constant burning surface pressure, thrust and flow grow as
  // exp(pi_K dT), and the total impulse stays (Sutton and Biblarz, Rocket Propulsion Elements, 7th ed.,
  // sect. 11.1).
  void PropellantTemperature(Fields& map, const DispersionRow& row, const std::string& name, Selection of,
                             ScalarDistribution rate) {
    double sensitivity_1_k = 0.0;
    map.Quantity("sensitivity", kPerTemperature, UpTo(0.02), sensitivity_1_k,
                 "growth of the burn rate, pi_K");
    of.per = PerWhat(map, row);
    AddStages(name, of, RateOf(rate, sensitivity_1_k), row.columns);
  }
  static ScalarDistribution RateOf(ScalarDistribution rate, double sensitivity_1_k) {
    const auto rate_at = [&](double warmer_k) { return Exp(sensitivity_1_k * warmer_k); };
    if (rate.kind == Distribution::kNormal) {  // of the temperature, hence lognormal of the rate
      rate.kind = Distribution::kLogNormal;
      rate.sigma *= sensitivity_1_k;
    } else {
      rate.low = rate_at(rate.low);
      rate.high = rate_at(rate.high);
      for (double& value : rate.values) value = rate_at(value);
    }
    rate.nominal = rate_at(rate.nominal);
    return rate;
  }

  // One draw a booster, or one for all of them.
  void OfBoosters(Fields& fields, const DispersionRow& row, const std::string& name) {
    if (is_sound_ && vehicle_.boosters.count == 0)
      return fields.Misplaced(row.key, {}, "the vehicle has no boosters", "a vehicle with boosters");
    if (is_sound_ && row.unfit != nullptr)
      if (const std::optional<Unfit> unfit = row.unfit(vehicle_, 1))
        return fields.Misplaced(row.key, {}, unfit->what.c_str(), unfit->allowed);
    bool is_there = false;
    fields.OptionalMap(row.key, is_there, row.meaning, [&](Fields& map) {
      ScalarDistribution distribution = ReadScalar(map, Limited(row, "further", BoosterNames()));
      if (row.draws == Draws::kBoostersTemperature) {
        double sensitivity_1_k = 0.0;
        map.Quantity("sensitivity", kPerTemperature, UpTo(0.02), sensitivity_1_k,
                     "growth of the burn rate, pi_K");
        distribution = RateOf(distribution, sensitivity_1_k);
      }
      bool each = true;
      if (row.draws != Draws::kBoostersAside)
        map.Choice<bool>("per", {{"booster", true}, {"vehicle", false}}, each, "one draw for each", true);
      std::vector<std::string> all;
      for (std::size_t k = 0; k < vehicle_.boosters.angles_rad.size(); ++k) {
        std::vector<std::string> columns = FillColumns(row.columns, "further", BoosterInColumns(vehicle_, k));
        const std::string booster = "/booster" + std::to_string(k + 1);
        all.insert(all.end(), columns.begin(), columns.end());
        if (row.draws == Draws::kBoostersAside) {
          Add(name + "/y" + booster, distribution, {columns[0]});
          Add(name + "/z" + booster, distribution, {columns[1]});
        } else if (each) {
          Add(name + booster, distribution, columns);
        }
      }
      if (!each && !all.empty()) Add(name, distribution, all);
    });
  }

  // ---- maps with keys of their own ----

  // Of one element of the last stage, which cannot weigh less than nothing.
  void PayloadMass(Fields& map, const DispersionRow& row) {
    std::vector<std::string> names;
    if (is_sound_)
      for (const MassElement& element : vehicle_.stages.back().structure) names.push_back(element.name);
    std::string element;
    map.Name("element", names, "an element of the last stage's structure", element,
             "of the last stage's structure");
    const auto position =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), element) - names.begin());
    DispersedScalar scalar = row.scalar;
    if (position < names.size())
      scalar.range = {-vehicle_.stages.back().structure[position].fraction * DryMass(vehicle_, stages_ - 1),
                      std::numeric_limits<double>::infinity(), true, false};
    Add(row.key, ReadScalar(map, scalar), {row.columns[0]});
    Add(row.key + std::string("/element"), Constant(static_cast<double>(position + 1)), {row.columns[1]});
  }

  void WindSpeed(Fields& map, const DispersionRow& row) {
    double most_m_s = 0.0;
    bool is_uniform = false;
    map.Quantity("max_speed", kSpeed, row.scalar.range, most_m_s, "of the jet stream");
    map.Choice<bool>("speed", {{"fixed", false}, {"uniform", true}}, is_uniform,
                     "the largest, or uniform from 0 to it", false);
    Add("wind/speed", is_uniform ? Uniform(0.0, most_m_s) : Constant(most_m_s), row.columns);
  }

  // A severity names a curve of MIL-F-8785C, figure 7, and a wind near the ground (its figure 10); or both
  // are given.
  void Turbulence(Fields& map, const DispersionRow& row) {
    constexpr double kKnot_m_s = 1852.0 / 3600.0;
    struct Severity {
      double exceedance, wind_m_s;
    };
    constexpr Severity kLevels[] = {
        {1e-2, 15.0 * kKnot_m_s}, {1e-3, 30.0 * kKnot_m_s}, {1e-5, 45.0 * kKnot_m_s}};
    Severity severity{kLargestExceedance, 0.0};
    const auto named = [&] {
      std::size_t level = 0;
      map.Choice<std::size_t>("severity", {{"light", 0}, {"moderate", 1}, {"severe", 2}}, level,
                              "sets exceedance aloft and the wind near the ground");
      severity = kLevels[level];
    };
    map.Either({{Has("severity"), named},
                {Has("exceedance"),
                 [&] {
                   map.Number("exceedance", Between(kLeastExceedance, kLargestExceedance),
                              severity.exceedance, "probability that sets the intensity");
                   map.Quantity("wind_20ft", kSpeed, Between(0.0, 50.0), severity.wind_m_s,
                                "mean wind near the ground");
                 }},
                {Else(), named}});
    Add("turbulence/exceedance", Constant(severity.exceedance), {row.columns[0]});
    Add("turbulence/wind_20ft", Constant(severity.wind_m_s), {row.columns[1]});
  }

  // The tables are kept from the start: their checks come when the whole map is read.
  void WindProfile(Fields& map, const DispersionRow& row) {
    bool has_table = false, has_statistics = false;
    map.OptionalTable("table", has_table, "a CSV file of the wind of all flights, and of their air",
                      [&](Fields& columns) { dispersa::Describe(columns, campaign_.wind_table.emplace()); });
    map.When(Has("statistics"), [&] {
      WindStatistics& statistics = campaign_.wind_statistics.emplace();
      dispersa::Describe(map, statistics);
      map.OptionalTable("statistics", has_statistics, "a CSV file of means and standard deviations",
                        [&](Fields& columns) { DescribeLevels(columns, statistics, kWindLevels); });
      DrawProfile(statistics, row);
    });
    map.ExactlyOne({"table", "statistics"});
    if (has_table == has_statistics)
      map.Refuse("", has_table ? "'table' and 'statistics' are both given" : "no profile is given",
                 "either table: FILE.csv or statistics: FILE.csv");
  }

  void Weather(Fields& map, const DispersionRow& row) {
    std::vector<DatedWeather>& soundings = campaign_.soundings;
    map.ListOrFolder("ensemble", 2, kMostSoundings, soundings, "soundings, or the folder of their files");
    bool by_month = false;
    map.Choice<bool>("draw", {{"uniform", false}, {"by_month", true}}, by_month,
                     "each sounding is equally likely, or each month", false);
    bool has_dates = by_month;
    for (std::size_t i = 0; by_month && i < soundings.size(); ++i) {
      if (MonthOf(soundings[i].time) > 0) continue;
      has_dates = false;
      if (soundings[i].time.empty())
        map.Refuse("ensemble[" + std::to_string(i) + "]", "the sounding has no date, which by_month needs",
                   "a date in the file, or in its name as YYYY-MM-DD or YYYYMMDD; or draw: uniform");
    }
    if (has_dates) WeighByMonth(soundings);
    ScalarDistribution number = Constant(0.0);
    number.kind = Distribution::kValues;
    number.values.clear();
    for (const DatedWeather& one : soundings) {
      number.values.push_back(static_cast<double>(number.values.size() + 1));
      if (has_dates) number.weights.push_back(one.weight);
    }
    if (!soundings.empty()) Add("weather", number, row.columns);
  }

  // Correlated normals: the winds of the levels themselves. Their altitudes go with them, so that a row of
  // inputs is a profile.
  void DrawProfile(const WindStatistics& statistics, const DispersionRow& row) {
    const std::vector<std::string> north = ExpandColumn(row.columns[0]), east = ExpandColumn(row.columns[1]),
                                   altitude = ExpandColumn(row.columns[2]);
    std::size_t levels = north.size();
    for (const auto* column : {&statistics.altitude_m, &statistics.mean_north_m_s, &statistics.mean_east_m_s,
                               &statistics.sigma_north_m_s, &statistics.sigma_east_m_s})
      levels = std::min(levels, column->size());
    WindStatistics flown = statistics;
    flown.altitude_m.resize(levels);
    const std::vector<std::vector<double>> weights = WindWeights(flown);
    const std::size_t first = campaign_.dispersions.size();
    const auto add = [&](const std::string& name, double mean, double sigma, const std::string& column) {
      ScalarDistribution wind;
      wind.kind = Distribution::kNormal;
      wind.nominal = mean;
      wind.sigma = sigma;
      const std::size_t component = campaign_.dispersions.size() - first;
      Add(name, wind, {column});
      for (std::size_t i = 0; i <= component; ++i)
        if (weights[component][i] != 0.0)
          campaign_.dispersions.back().mix.emplace_back(first + i, weights[component][i]);
    };
    for (std::size_t k = 0; k < levels; ++k) {
      const std::string level = std::to_string(k + 1);
      add("wind_profile/north" + level, statistics.mean_north_m_s[k], statistics.sigma_north_m_s[k],
          north[k]);
      add("wind_profile/east" + level, statistics.mean_east_m_s[k], statistics.sigma_east_m_s[k], east[k]);
    }
    for (std::size_t k = 0; k < levels; ++k)
      Add("wind_profile/altitude" + std::to_string(k + 1), Constant(statistics.altitude_m[k]), {altitude[k]});
  }

  // Normal draws in standard deviations: one of each coefficient, for all tables.
  void AeroUncertainties(Fields& map, const DispersionRow& row) {
    const std::vector<std::string> names = {"ca", "cn", "xcp", "damping"};
    std::vector<std::string> drawn;
    map.Words("of", names, drawn, "coefficients, each drawn once a flight");
    ScalarDistribution standard_normal;
    standard_normal.kind = Distribution::kNormal;
    standard_normal.sigma = 1.0;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (std::find(drawn.begin(), drawn.end(), names[i]) != drawn.end())
        Add("aerodynamic_uncertainty/" + names[i], standard_normal, {row.columns[i]});
    if (is_sound_ && std::none_of(vehicle_.aerodynamics.begin(), vehicle_.aerodynamics.end(), IsUncertain))
      map.Refuse("", "the vehicle has no aerodynamic table that states an uncertainty",
                 "tables with ca_uncertainty_percent, cn_uncertainty_percent, xcp_uncertainty_m or "
                 "damping_uncertainty_percent");
  }

  void StuckNozzle(Fields& map, const DispersionRow& row) {
    int stage = 1;
    map.Integer("stage", 1, static_cast<std::uint64_t>(stages_), stage, "of the nozzle");
    // Any name may be one of a vehicle that is unknown.
    std::vector<std::string> names = KnowsStage(stage) ? NozzleNames(stage) : std::vector<std::string>{};
    const std::size_t count = names.size();
    if (count > 0) names.emplace_back("any");
    std::string name;
    map.Name("nozzle", names, "a nozzle of the stage", name, "its name in the stage, or any");
    const auto found = std::find(names.begin(), names.end(), name);
    ScalarDistribution nozzle = Constant(static_cast<double>(found - names.begin()) + 1.0);
    if (name == "any") {
      nozzle = Constant(0.0);
      nozzle.kind = Distribution::kValues;
      nozzle.values.resize(count);
      std::iota(nozzle.values.begin(), nozzle.values.end(), 1.0);
    }
    Add("stuck_nozzle/nozzle", nozzle, {row.columns[0]});
    Add("stuck_nozzle/stage", Constant(static_cast<double>(stage)), {row.columns[1]});
  }

  const Vehicle& vehicle_;  ///< without stages if it is unknown
  const bool is_sound_;     ///< else nothing is checked against it
  const int stages_;
  Campaign& campaign_;
  int maps_ = 0;  ///< number of distributions read so far
};

}  // namespace

void DescribeDispersions(Fields& fields, bool is_sound, Campaign& campaign) {
  DispersionFields dispersions(is_sound, campaign);
  for (const DispersionRow& row : DispersionRows()) {
    const auto describe = [&] { dispersions.Describe(fields, row, row.key); };
    // Measured winds have jet streams of their own.
    if (row.draws != Draws::kWind && row.draws != Draws::kWindProfile)
      describe();
    else
      fields.Either({{Has("weather"),
                      [&] {
                        fields.Misplaced(
                            row.key, {}, "'{}' is given beside 'weather', which is the whole wind",
                            "one of them; a gust, turbulence and density may stand beside 'weather'");
                      }},
                     {Else(), describe}});
  }
}

}  // namespace dispersa
