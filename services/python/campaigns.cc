// Campaigns from files and texts, their draws and flights.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/campaign/dispersion_table.h"
#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_campaign.h"
#include "core/campaign_yaml/describe_file.h"
#include "core/campaign_yaml/load.h"
#include "core/campaign_yaml/named_files.h"
#include "core/cases/campaign_flights.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/flight_model.h"
#include "core/flight/history.h"
#include "core/flight/metrics.h"
#include "core/input/number_text.h"
#include "services/program/threads.h"
#include "services/python/arrays.h"
#include "services/python/errors.h"
#include "services/python/growing_rows.h"
#include "services/python/parts.h"
#include "services/python/python_law.h"
#include "services/python/python_observer.h"
#include "services/python/result_columns.h"

namespace py = pybind11;

namespace dispersa {
namespace {

/// A campaign, and what its flights share once one is asked for.
class LoadedCampaign {
 public:
  LoadedCampaign(const InputSource& source, const CampaignOverrides& overrides)
      : campaign_(LoadCampaign(source, overrides, &warnings_)) {}
  explicit LoadedCampaign(Campaign campaign) : campaign_(std::move(campaign)) {}

  const Campaign& campaign() const { return campaign_; }
  const std::vector<InputProblem>& warnings() const { return warnings_; }
  std::size_t column_class() const { return ColumnClass(campaign_.vehicle); }
  /// Positions in InputColumns() of the vehicle's inputs.
  std::vector<std::size_t> inputs() const {
    const std::vector<int> inputs = InputsOf(campaign_.vehicle);
    return {inputs.begin(), inputs.end()};
  }
  /// Without the interpreter's lock: building takes a while.
  const CampaignFlights& flights() const {
    std::call_once(once_, [this] { flights_ = std::make_unique<const CampaignFlights>(campaign_); });
    return *flights_;
  }

 private:
  std::vector<InputProblem> warnings_;
  Campaign campaign_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const CampaignFlights> flights_;
};

std::unique_ptr<LoadedCampaign> Load(const std::string& name, const std::optional<std::string>& text,
                                     std::optional<std::uint64_t> cases, std::optional<std::uint64_t> seed,
                                     const std::optional<std::string>& autopilot) {
  const py::gil_scoped_release free;
  return std::make_unique<LoadedCampaign>(SourceOf(name, text), CampaignOverrides{cases, seed, autopilot});
}

/// From a canonical text. The control law need not be available here.
std::unique_ptr<LoadedCampaign> FromCanonical(const std::string& name, const std::string& text) {
  const py::gil_scoped_release free;
  return std::make_unique<LoadedCampaign>(ReadFlownCampaign(InputSource(name, text)));
}

std::unique_ptr<LoadedCampaign> UnderLaw(const LoadedCampaign& campaign, unsigned axes,
                                         const std::string& name, const std::string& sha256) {
  return FromCanonical(campaign.campaign().name, WithPythonLaw(campaign.campaign(), axes, name, sha256));
}

/// (name, SHA-256), or None.
py::object PythonLawOf(const LoadedCampaign& loaded) {
  const auto& plugin = loaded.campaign().autopilot.plugin;
  if (!plugin || !plugin->in_python) return py::none();
  return py::make_tuple(plugin->name, plugin->sha256);
}

py::tuple Check(const std::string& name, const std::optional<std::string>& text) {
  const FileCheck check = CheckFile(SourceOf(name, text));
  return py::make_tuple(ProblemsOf(check.errors), ProblemsOf(check.warnings));
}

// The value of a scalar, by the rule of the canonical text: a plain scalar that is a number is a number.
py::object ScalarValue(const InputNode& node) {
  if (!node.quoted) {
    if (const auto integer = ParseInteger(node.text)) return py::int_(*integer);
    if (const auto number = ParseNumber(node.text)) return py::float_(*number);
    if (node.text == "true" || node.text == "false") return py::bool_(node.text == "true");
  }
  return py::str(node.text);
}

py::object ValueOf(const InputNode& node) {
  switch (node.kind) {
    case InputNode::Kind::kScalar:
      return ScalarValue(node);
    case InputNode::Kind::kList: {
      py::list list;
      for (const InputNode& item : node.items) list.append(ValueOf(item));
      return list;
    }
    case InputNode::Kind::kMap: {
      py::dict map;
      for (const InputMember& member : node.members) map[py::str(member.key)] = ValueOf(member.value);
      return map;
    }
    default:
      return py::none();
  }
}

/// Keeps the problems of files as texts apart from those of their values.
class FilesAlone : public NamedFiles {
 public:
  std::vector<InputProblem> own;

 private:
  void Read(InputNode& name, const std::string& path, Holds holds, std::vector<InputProblem>&) override {
    NamedFiles::Read(name, path, holds, own);
  }
};

/// The content of a file as dicts, lists and scalars. `inlined`: file contents replace their names. The
/// values are not checked.
py::object ReadTree(const std::string& path, bool inlined) {
  FilesAlone files;
  InputNode root = ReadYamlFile(path, files.own);
  if (inlined) {
    std::vector<InputProblem> ignored;
    const InputNode* schema = root.Find("schema");
    const std::string kind = schema == nullptr ? "" : schema->text;
    if (kind == kCampaignSchema) DecodeCampaign(root, CampaignUse::kRead, ignored, &files, nullptr);
    if (kind == kVehicleSchema) DecodeVehicle(root, "", ignored, &files);
    if (kind == kScenarioSchema) DecodeFile<Scenario>(root, "", ignored, &files, DescribeScenarioFile);
  }
  if (!files.own.empty()) throw InputError(std::move(files.own));
  return ValueOf(root);
}

/// The rows' inputs of the first `count` cases; shape (count, inputs), in the units of the columns.
py::array Plan(const LoadedCampaign& campaign, std::uint64_t count) {
  std::vector<double> rows;
  const RowInputs in_rows(campaign.campaign());
  {
    const py::gil_scoped_release free;
    const CaseDesign design(campaign.campaign());
    rows.reserve(count * in_rows.positions().size());
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::vector<double> inputs = in_rows.RowOf(InputValues(design.Draw(i), campaign.column_class()));
      rows.insert(rows.end(), inputs.begin(), inputs.end());
    }
  }
  return ArrayOf(std::move(rows),
                 {static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(in_rows.positions().size())});
}

Scheme SchemeOf(const std::string& name) {
  Scheme scheme = Scheme::kSimpson;
  if (!ParseScheme(name, &scheme))
    throw InputError("integrator: '" + name + "' is not an integrator", "simpson, erk4 or cvode");
  return scheme;
}

// A case's draws, or the nominal's, with some of them replaced by values in the units of their columns.
FlightInputs InputsOf(const LoadedCampaign& campaign, const CampaignFlights& flights,
                      std::optional<std::uint64_t> case_index,
                      const std::map<std::string, double>& replaced) {
  FlightInputs inputs = case_index ? flights.Draw(*case_index) : FlightInputs{};
  for (const auto& [name, value] : replaced) {
    const int column = FindInput(name);
    if (column < 0 || !HasInput(campaign.campaign().vehicle, column))
      throw InputError("inputs: '" + name + "' is not an input of this vehicle",
                       "a name of Campaign.input_names");
    const double applied = value * InputColumns()[static_cast<std::size_t>(column)].unit;
    if (!IsAllowed(campaign.campaign().vehicle, column, applied) && applied != InputValue(inputs, column))
      throw InputError("inputs: " + name + " is " + FormatNumber(value),
                       RangeText(campaign.campaign().vehicle, column));
    InputValue(inputs, column) = applied;
  }
  return inputs;
}

py::array HistoryArray(const History& history, const std::vector<int>& columns) {
  std::vector<double> values;
  values.reserve(history.rows() * columns.size());
  for (std::size_t row = 0; row < history.rows(); ++row)
    for (const int column : columns) values.push_back(history.at(row, column));
  return ArrayOf(std::move(values),
                 {static_cast<py::ssize_t>(history.rows()), static_cast<py::ssize_t>(columns.size())});
}

std::vector<std::string> HistoryNames(const std::vector<int>& columns) {
  std::vector<std::string> names;
  for (const int column : columns) names.push_back(HistoryColumns()[static_cast<std::size_t>(column)]);
  return names;
}

/// Positions of the columns with these names, or of all that flights under the autopilot have.
std::vector<int> ColumnsNamed(const std::optional<std::vector<std::string>>& names,
                              const AutopilotConfig& autopilot) {
  const std::vector<int> known = HistoryColumnsUnder(autopilot);
  if (!names) return known;
  std::vector<int> columns;
  for (const std::string& name : *names) {
    columns.push_back(FindHistoryColumn(name));
    if (std::find(known.begin(), known.end(), columns.back()) != known.end()) continue;
    std::string allowed;
    for (const std::string& each : HistoryNames(known)) allowed += (allowed.empty() ? "" : ", ") + each;
    throw InputError("columns: '" + name + "' is not a column of histories", allowed);
  }
  return columns;
}

/// `inputs`: all, as applied.
py::dict FlightValues(const CaseResult& result, std::vector<double> inputs, const MetricList& list,
                      const std::vector<std::size_t>& metrics) {
  std::vector<double> values;
  for (const std::size_t i : metrics) values.push_back(result.metrics[i]);
  py::dict flight;
  flight["outcome"] = OutcomeName(result.outcome);
  flight["end_time_s"] = result.end_time_s;
  flight["end_stage"] = result.end_stage;
  flight["reason"] = result.reason;
  flight["digest"] = result.digest.Hex();
  flight["inputs"] = ArrayOf(std::move(inputs));
  flight["metrics"] = ArrayOf(std::move(values));
  flight["metric_names"] = NamesOf(list, metrics);
  return flight;
}

/// The flights of a campaign, with a law in Python on some axes if one is given.
class FlownWith {
 public:
  /// `axes`: bits 1 << Axis.
  FlownWith(const LoadedCampaign& campaign, const py::object& law, unsigned axes, PythonObserver& observer)
      : campaign_(campaign) {
    if (law.is_none()) return;
    law_ = std::make_unique<PythonLaw>(law, observer);
    flights_ = std::make_unique<const CampaignFlights>(law_->OnAxes(campaign.campaign(), axes));
  }

  /// To be asked without the interpreter's lock.
  const CampaignFlights& flights() const { return flights_ ? *flights_ : campaign_.flights(); }
  /// A law in Python runs under the interpreter's lock: more threads would wait for it.
  int Threads(int asked) const { return law_ ? 1 : ThreadsOrAll(asked); }
  /// The autopilot that flies.
  const AutopilotConfig& autopilot() const {
    return flights_ ? flights_->model().definition().autopilot : campaign_.campaign().autopilot;
  }
  /// Positions of the metrics that the flights have.
  std::vector<std::size_t> metrics() const {
    Campaign flown = campaign_.campaign();
    flown.autopilot = autopilot();
    return MeasuredMetrics(flown);
  }
  void FliesTheNominal() const {
    if (law_) law_->FliesTheNominal();
  }

 private:
  const LoadedCampaign& campaign_;
  std::unique_ptr<PythonLaw> law_;
  std::unique_ptr<const CampaignFlights> flights_;
};

/// One flight. `step_s` of its history; 0: none.
py::dict FlyOne(const LoadedCampaign& campaign, std::optional<std::uint64_t> case_index,
                const std::map<std::string, double>& replaced, double step_s, const std::string& integrator,
                const py::object& law, unsigned axes) {
  const Scheme scheme = SchemeOf(integrator);
  PythonObserver observer{py::none()};
  const FlownWith with(campaign, law, axes, observer);
  if (!case_index) with.FliesTheNominal();
  History history;
  history.step_s = step_s;
  std::vector<double> applied;
  const CaseResult result = observer.Watch([&] {
    const CampaignFlights& flights = with.flights();
    const FlightInputs inputs = InputsOf(campaign, flights, case_index, replaced);
    applied =
        ValuesAt(campaign.inputs(), InputValues(flights.model().AsApplied(inputs), campaign.column_class()));
    return flights.Fly(inputs, case_index.value_or(0), step_s > 0.0 ? &history : nullptr, scheme);
  });
  py::dict flight = FlightValues(result, std::move(applied), MetricsOf(campaign.campaign()), with.metrics());
  const std::vector<int> columns = HistoryColumnsUnder(with.autopilot());
  flight["history"] = step_s > 0.0 ? py::object(HistoryArray(history, columns)) : py::none();
  flight["history_columns"] = HistoryNames(columns);
  return flight;
}

/// The results of many flights by column and their histories in one buffer, in the order of their list.
/// Flights end in nearly that order: the few that end before an earlier one wait for it.
class Gathering {
 public:
  /// `inputs`, `metrics`, `columns`: positions of those that are kept, of results and histories.
  Gathering(const Campaign& campaign, std::vector<std::size_t> inputs, std::vector<std::size_t> metrics,
            std::vector<int> columns, std::size_t flights)
      : in_rows_(campaign),
        inputs_(std::move(inputs)),
        table_(inputs_, MetricsOf(campaign), std::move(metrics)),
        columns_(std::move(columns)) {
    offsets_.reserve(flights + 1);
    offsets_.push_back(0);
  }

  void Add(std::size_t order, CaseResult result, const History& history) {
    if (order + 1 != offsets_.size()) {
      waiting_.emplace(order, std::pair(std::move(result), history));
      return;
    }
    Append(std::move(result), history);
    while (!waiting_.empty() && waiting_.begin()->first + 1 == offsets_.size()) {
      auto [next, of_it] = waiting_.extract(waiting_.begin()).mapped();
      Append(std::move(next), of_it);
    }
  }
  py::dict TakeTable() { return table_.Take(); }
  /// (rows, where each flight begins and the last ends).
  std::pair<py::array, py::array> TakeHistories() {
    double* const values = rows_->data();
    const std::vector<py::ssize_t> shape = {offsets_.back(), static_cast<py::ssize_t>(columns_.size())};
    return {ArrayOver(values, shape, std::move(rows_)), ArrayOf(std::move(offsets_))};
  }

 private:
  void Append(CaseResult result, const History& history) {
    result.inputs = ValuesAt(inputs_, in_rows_.AllOf(result.inputs));
    table_.Add(result);
    double* value = rows_->Extend(history.rows() * columns_.size());
    for (std::size_t row = 0; row < history.rows(); ++row)
      for (const int column : columns_) *value++ = history.at(row, column);
    offsets_.push_back(offsets_.back() + static_cast<std::int64_t>(history.rows()));
  }

  RowInputs in_rows_;
  std::vector<std::size_t> inputs_;
  ResultColumns table_;
  std::vector<int> columns_;  ///< of histories
  std::unique_ptr<GrowingRows> rows_ = std::make_unique<GrowingRows>();
  std::vector<std::int64_t> offsets_;
  std::map<std::size_t, std::pair<CaseResult, History>> waiting_;
};

/// Many cases, side by side. `columns`: names of those that are kept of each history of step `step_s`; None:
/// all that the flights have. 0: no histories.
py::dict FlyMany(const LoadedCampaign& campaign, const std::vector<std::uint64_t>& cases, double step_s,
                 const std::optional<std::vector<std::string>>& names, int threads,
                 const py::object& progress, const py::object& law, unsigned axes) {
  PythonObserver observer(progress);
  const FlownWith with(campaign, law, axes, observer);
  const std::vector<int> columns = ColumnsNamed(names, with.autopilot());
  Gathering gathering(campaign.campaign(), campaign.inputs(), with.metrics(), columns, cases.size());
  observer.Watch([&] {
    std::vector<CaseOrder> orders;
    for (const std::uint64_t case_index : cases) orders.push_back({case_index, step_s});
    std::uint64_t done = 0;
    with.flights().FlyCases(orders, with.Threads(threads),
                            [&](std::size_t order, CaseResult result, const History& history) {
                              gathering.Add(order, std::move(result), history);
                              observer.Show(campaign.campaign().name, ++done, cases.size());
                              if (observer.ShouldStop()) throw Interrupted();
                            });
  });
  py::dict answer = gathering.TakeTable();
  answer["history_columns"] = HistoryNames(columns);
  if (step_s > 0.0) {
    auto [rows, offsets] = gathering.TakeHistories();
    answer["histories"] = rows;
    answer["offsets"] = offsets;
  }
  return answer;
}

}  // namespace

void AddCampaigns(py::module_& module) {
  AddLawTick(module);
  module.def("load", &Load);
  module.def("from_canonical", &FromCanonical);
  module.def("under_law", &UnderLaw);
  module.def("check", &Check);
  module.def("read_tree", &ReadTree);
  module.def("plan", &Plan);
  module.def("fly", &FlyOne);
  module.def("fly_many", &FlyMany);
  const auto text = [](std::string Campaign::*member) {
    return [member](const LoadedCampaign& loaded) { return loaded.campaign().*member; };
  };
  py::class_<LoadedCampaign>(module, "Campaign")
      .def_property_readonly("name", text(&Campaign::name))
      .def_property_readonly("id", text(&Campaign::id))
      .def_property_readonly("flight_id", text(&Campaign::flight_id))
      .def_property_readonly("requirements_id", text(&Campaign::requirements_id))
      .def_property_readonly("canonical_yaml", text(&Campaign::canonical_yaml))
      .def_property_readonly("cases", [](const LoadedCampaign& c) { return c.campaign().sampling.cases; })
      .def_property_readonly("seed", [](const LoadedCampaign& c) { return c.campaign().sampling.seed; })
      .def_property_readonly("stages",
                             [](const LoadedCampaign& c) { return c.campaign().vehicle.stages.size(); })
      .def_property_readonly("metric_names",
                             [](const LoadedCampaign& c) {
                               return NamesOf(MetricsOf(c.campaign()), MeasuredMetrics(c.campaign()));
                             })
      .def_property_readonly("python_law", &PythonLawOf)
      .def_property_readonly("law_axes",
                             [](const LoadedCampaign& c) { return PluginAxes(c.campaign().autopilot); })
      .def_property_readonly("autopilot", [](const LoadedCampaign& c) { return c.campaign().autopilot.name; })
      .def_property_readonly("vehicle", [](const LoadedCampaign& c) { return c.campaign().vehicle.name; })
      .def_property_readonly(
          "dispersed",
          [](const LoadedCampaign& c) { return NamesOfInputs(RowInputs(c.campaign()).positions()); })
      .def_property_readonly("input_names", [](const LoadedCampaign& c) { return NamesOfInputs(c.inputs()); })
      .def_property_readonly("input_keys",
                             [](const LoadedCampaign& c) {
                               std::vector<std::string> keys;
                               for (const std::size_t i : c.inputs())
                                 keys.push_back(InputKey(c.campaign(), static_cast<int>(i)));
                               return keys;
                             })
      .def_property_readonly("warnings", [](const LoadedCampaign& c) { return ProblemsOf(c.warnings()); });
}

}  // namespace dispersa
