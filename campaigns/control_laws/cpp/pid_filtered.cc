// Proportional-integral-derivative control whose derivative is low-passed, in C++: an integral that holds
// while the deflection is limited, parameters from the autopilot file, telemetry for histories.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>

#include "dispersa/control_law.h"

namespace {

// In the order of the description's names.
struct Parameters {
  double integral_time_s;  // ki = kp / integral_time
  double filter_rad_s;     // of the error's rate
};

struct Axis {
  double integral_rad_s2 = 0.0;
  double rate_rad_s = 0.0;  // low-passed
  bool has_rate = false;
};

// A flight's memory. Nothing in it points anywhere.
class Law {
 public:
  explicit Law(const dispersa_law_setup& setup)
      : parameters_{setup.parameters[0], setup.parameters[1]}, tick_s_(setup.tick_s) {}

  void StartStage(const dispersa_law_stage& stage) {
    std::copy(std::begin(stage.kp_1_s2), std::end(stage.kp_1_s2), kp_1_s2_);
    std::copy(std::begin(stage.kd_1_s), std::end(stage.kd_1_s), kd_1_s_);
    for (Axis& axis : axes_) axis = Axis();
  }

  void Step(const dispersa_law_input& in, dispersa_law_output& out) {
    const double pole = -std::expm1(-parameters_.filter_rad_s * tick_s_);
    for (int i = 0; i < DISPERSA_LAW_AXES; ++i) {
      Axis& axis = axes_[i];
      if (!axis.has_rate) axis.rate_rad_s = in.rate_error_rad_s[i];
      axis.has_rate = true;
      axis.rate_rad_s += pole * (in.rate_error_rad_s[i] - axis.rate_rad_s);
      out.command[i] =
          kp_1_s2_[i] * in.angle_error_rad[i] + kd_1_s_[i] * axis.rate_rad_s + axis.integral_rad_s2;
      const bool is_held = in.saturation[i] * in.angle_error_rad[i] > 0.0;
      if (!is_held)
        axis.integral_rad_s2 += tick_s_ * kp_1_s2_[i] / parameters_.integral_time_s * in.angle_error_rad[i];
    }
    out.telemetry[0] = axes_[DISPERSA_PITCH].integral_rad_s2;
    out.telemetry[1] = axes_[DISPERSA_PITCH].rate_rad_s;
  }

 private:
  Parameters parameters_;
  double tick_s_;
  double kp_1_s2_[DISPERSA_LAW_AXES] = {};
  double kd_1_s_[DISPERSA_LAW_AXES] = {};
  Axis axes_[DISPERSA_LAW_AXES];
};

}  // namespace

extern "C" {

const dispersa_law_description* dispersa_law_describe(void) {
  static const char* const names[] = {"integral_time_s", "filter_rad_s"};
  static const dispersa_law_description description = {
      DISPERSA_LAW_ABI, sizeof(Law), DISPERSA_LAW_ANGULAR_ACCELERATION, 2, "pid_filtered", "1", names};
  return &description;
}

int dispersa_law_create(const dispersa_law_setup* setup, void* memory) {
  if (!(setup->parameters[0] > 0.0) || !(setup->parameters[1] > 0.0)) return 1;
  new (memory) Law(*setup);
  return 0;
}

int dispersa_law_start_stage(const dispersa_law_stage* stage, void* memory) {
  static_cast<Law*>(memory)->StartStage(*stage);
  return 0;
}

int dispersa_law_step(const dispersa_law_input* input, dispersa_law_output* output, void* memory) {
  static_cast<Law*>(memory)->Step(*input, *output);
  return 0;
}

}  // extern "C"
