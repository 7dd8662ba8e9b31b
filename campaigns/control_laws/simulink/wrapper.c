/* What stands between dispersa and a model of Simulink Coder: copy inputs, step, copy outputs. */
#include <string.h>

#include "dispersa/control_law.h"
#include "pitch_autopilot.h"

/* A flight's memory. The model's own structs; the pointers between them are made anew for each call, since
 * the memory may have moved. */
struct memory {
  DW_pitch_autopilot_T dwork;
  ExtU_pitch_autopilot_T inputs;
  ExtY_pitch_autopilot_T outputs;
};

static RT_MODEL_pitch_autopilot_T model_in(struct memory* m) {
  RT_MODEL_pitch_autopilot_T model;
  model.dwork = &m->dwork;
  model.inputs = &m->inputs;
  model.outputs = &m->outputs;
  return model;
}

const dispersa_law_description* dispersa_law_describe(void) {
  static const dispersa_law_description description = {
      .abi = DISPERSA_LAW_ABI,
      .memory_bytes = sizeof(struct memory),
      .command = DISPERSA_LAW_ANGULAR_ACCELERATION,
      .name = "pitch_autopilot",
      .version = "1",
  };
  return &description;
}

int dispersa_law_create(const dispersa_law_setup* setup, void* memory) {
  (void)setup;
  (void)memory;
  return 0;
}

int dispersa_law_start_stage(const dispersa_law_stage* stage, void* memory) {
  struct memory* m = memory;
  RT_MODEL_pitch_autopilot_T model = model_in(m);
  pitch_autopilot_initialize(&model);
  memcpy(m->inputs.kp_1_s2, stage->kp_1_s2, sizeof m->inputs.kp_1_s2);
  memcpy(m->inputs.kd_1_s, stage->kd_1_s, sizeof m->inputs.kd_1_s);
  return 0;
}

int dispersa_law_step(const dispersa_law_input* input, dispersa_law_output* output, void* memory) {
  struct memory* m = memory;
  RT_MODEL_pitch_autopilot_T model = model_in(m);
  memcpy(m->inputs.angle_error_rad, input->angle_error_rad, sizeof m->inputs.angle_error_rad);
  memcpy(m->inputs.rate_error_rad_s, input->rate_error_rad_s, sizeof m->inputs.rate_error_rad_s);
  pitch_autopilot_step(&model);
  memcpy(output->command, m->outputs.command_rad_s2, sizeof output->command);
  return 0;
}
