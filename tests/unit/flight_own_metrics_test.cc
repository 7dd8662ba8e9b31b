// Own metrics compute only the parts of a history row that they read: with the history's bits.
#include "core/flight/own_metrics.h"

#include "core/flight/flight_model.h"
#include "core/flight/history.h"
#include "tests/slv4_flight.h"
#include "tests/test.h"

namespace dispersa::flight_own_metrics_test {
namespace {

TEST(FlightOwnMetrics, OneColumnAloneHasTheHistorysBits) {
  FlightDefinition definition = Slv4Definition(DISPERSA_CAMPAIGNS);
  History history;
  FlightOptions options;
  options.history = &history;
  Fly(FlightModel(definition), Table3Inputs(), options);
  // In a burn, in the air and with wind: every column has a value of its own there.
  std::size_t row = 0;
  while (history.at(row, 0) < 35.0) ++row;
  const std::string at = ", " + std::to_string(history.at(row, 0)) + ")";

  for (const int column : HistoryColumnsUnder(definition.autopilot)) {
    const std::string& name = HistoryColumns()[static_cast<std::size_t>(column)];
    FlightDefinition measured = definition;
    OwnMetric metric{"own", "at(" + name + at, ""};
    metric.parsed = ParseOwnMetric(metric.expression, 4, definition.autopilot);
    measured.own_metrics = {metric};
    const FlightResult flight = Fly(FlightModel(measured), Table3Inputs());
    const double expected = history.at(row, column);
    EXPECT_EQ(std::memcmp(&flight.metrics.back(), &expected, sizeof(double)), 0)
        << name << ": " << flight.metrics.back() << " and " << expected;
  }
}

}  // namespace
}  // namespace dispersa::flight_own_metrics_test
