#include "core/results/nominal_json.h"

#include "core/campaign/dispersion_table.h"
#include "core/flight/flight_inputs.h"
#include "core/results/json_number.h"
#include "core/results/metric_catalogue.h"

namespace dispersa {

std::string NominalJson(const RowInputs& inputs) {
  nlohmann::ordered_json constants = nlohmann::ordered_json::object();
  for (const std::size_t position : inputs.constants()) {
    const std::string& name = InputColumns()[position].name;
    constants[name] = {{"value", Number(inputs.constant(position))},
                       {"unit", SplitUnit(name).unit},
                       {"key", TextOrNull(InputKey(static_cast<int>(position)))}};
  }
  const nlohmann::ordered_json json = {{"schema", "dispersa/nominal/1"}, {"inputs", std::move(constants)}};
  return json.dump(1) + "\n";
}

}  // namespace dispersa
