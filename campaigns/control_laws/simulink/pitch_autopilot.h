/* A model in the shape in which Simulink Coder (Embedded Coder's ert.tlc, "Reusable function" packaging)
 * exports one called pitch_autopilot: structs of inputs, outputs and states, and functions that take them.
 * Written by hand: your own export takes its place. With the packaging "Nonreusable function" a model keeps
 * its state in globals, which flights side by side would share; dispersa's first check of a law finds that
 * and refuses it. */
#ifndef PITCH_AUTOPILOT_H
#define PITCH_AUTOPILOT_H

typedef double real_T;

/* External inputs (root inports) */
typedef struct {
  real_T angle_error_rad[3];
  real_T rate_error_rad_s[3];
  real_T kp_1_s2[3];
  real_T kd_1_s[3];
} ExtU_pitch_autopilot_T;

/* External outputs (root outports) */
typedef struct {
  real_T command_rad_s2[3];
} ExtY_pitch_autopilot_T;

/* Block states (discrete) */
typedef struct {
  real_T UnitDelay_DSTATE[3]; /* of the lead filter on the command */
} DW_pitch_autopilot_T;

/* Real-time model: the packaging hands over states, inputs and outputs through it. */
typedef struct {
  DW_pitch_autopilot_T* dwork;
  ExtU_pitch_autopilot_T* inputs;
  ExtY_pitch_autopilot_T* outputs;
} RT_MODEL_pitch_autopilot_T;

void pitch_autopilot_initialize(RT_MODEL_pitch_autopilot_T* const pitch_autopilot_M);
void pitch_autopilot_step(RT_MODEL_pitch_autopilot_T* const pitch_autopilot_M);

#endif
