/* The smallest law: proportional-derivative control with the gains of the autopilot file. It gives the bits
 * of `law: pd`, which adds with one rounding, as fma does. */
#include <math.h>
#include <string.h>

#include "dispersa/control_law.h"

struct memory {
  double kp_1_s2[DISPERSA_LAW_AXES];
  double kd_1_s[DISPERSA_LAW_AXES];
};

const dispersa_law_description* dispersa_law_describe(void) {
  static const dispersa_law_description description = {
      .abi = DISPERSA_LAW_ABI,
      .memory_bytes = sizeof(struct memory),
      .command = DISPERSA_LAW_ANGULAR_ACCELERATION,
      .name = "pd_c",
      .version = "1",
  };
  return &description;
}

int dispersa_law_create(const dispersa_law_setup* setup, void* memory) {
  (void)setup;
  (void)memory; /* is zero */
  return 0;
}

int dispersa_law_start_stage(const dispersa_law_stage* stage, void* memory) {
  struct memory* m = memory;
  memcpy(m->kp_1_s2, stage->kp_1_s2, sizeof m->kp_1_s2);
  memcpy(m->kd_1_s, stage->kd_1_s, sizeof m->kd_1_s);
  return 0;
}

int dispersa_law_step(const dispersa_law_input* input, dispersa_law_output* output, void* memory) {
  const struct memory* m = memory;
  for (int axis = 0; axis < DISPERSA_LAW_AXES; ++axis)
    output->command[axis] =
        fma(m->kp_1_s2[axis], input->angle_error_rad[axis], m->kd_1_s[axis] * input->rate_error_rad_s[axis]);
  return 0;
}
