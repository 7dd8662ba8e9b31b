#include "pitch_autopilot.h"

/* Model step function */
void pitch_autopilot_step(RT_MODEL_pitch_autopilot_T* const pitch_autopilot_M) {
  DW_pitch_autopilot_T* dwork = pitch_autopilot_M->dwork;
  ExtU_pitch_autopilot_T* u = pitch_autopilot_M->inputs;
  ExtY_pitch_autopilot_T* y = pitch_autopilot_M->outputs;
  int i;
  for (i = 0; i < 3; i++) {
    /* Sum: '<Root>/PD'; Gain: '<Root>/Kp', '<Root>/Kd' */
    real_T rtb_PD = u->kp_1_s2[i] * u->angle_error_rad[i] + u->kd_1_s[i] * u->rate_error_rad_s[i];

    /* Outport: '<Root>/command' incorporates: DiscreteFilter: '<Root>/Smooth', UnitDelay: '<Root>/Unit Delay'
     */
    y->command_rad_s2[i] = 0.8 * rtb_PD + 0.2 * dwork->UnitDelay_DSTATE[i];

    /* Update for UnitDelay: '<Root>/Unit Delay' */
    dwork->UnitDelay_DSTATE[i] = rtb_PD;
  }
}

/* Model initialize function */
void pitch_autopilot_initialize(RT_MODEL_pitch_autopilot_T* const pitch_autopilot_M) {
  int i;
  for (i = 0; i < 3; i++) {
    pitch_autopilot_M->dwork->UnitDelay_DSTATE[i] = 0.0;
    pitch_autopilot_M->outputs->command_rad_s2[i] = 0.0;
  }
}
