// dispersa._core: what the Python package calls. Plain values in and out; the package gives them names.
#include <pybind11/stl.h>

#include <string>

#include "core/flight/engine_version.h"
#include "core/flight/flight_inputs.h"
#include "core/flight/history.h"
#include "core/flight/lane_engine.h"
#include "core/flight/metrics.h"
#include "core/results/metric_catalogue.h"
#include "core/statistics/intervals.h"
#include "services/log/log.h"
#include "services/python/errors.h"
#include "services/python/parts.h"

namespace py = pybind11;

namespace dispersa {
namespace {

py::tuple MetricTuple(const std::string& name) {
  const MetricInfo info = DescribeMetric(name);
  return py::make_tuple(info.title, info.unit, info.definition, WorseName(info.worse));
}

}  // namespace

}  // namespace dispersa

PYBIND11_MODULE(_core, module) {
  using namespace dispersa;
  LogForPeople(LogColor::kAuto, "dispersa: ");
  SetLogLevel(LogLevel::kWarning);
  ChosenEngine();  // what DISPERSA_LANES and DISPERSA_ISA ask for in vain is said at the import

  py::register_exception_translator(Translate);
  module.def("engine_version", &EngineVersion);
  module.def("describe", &MetricTuple);
  module.def("split_unit", [](const std::string& name) {
    const NameAndUnit split = SplitUnit(name);
    return py::make_tuple(split.stem, split.unit);
  });
  module.def("clopper_pearson", [](std::int64_t events, std::int64_t n, double confidence) {
    const Interval interval = ClopperPearson(events, n, confidence);
    return py::make_tuple(interval.lower, interval.upper);
  });
  AddCampaigns(module);
  AddResults(module);
}
