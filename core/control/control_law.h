/* A control law of your own: what a shared object gives to dispersa. C, version 1 of the interface.
 *
 * An autopilot file names the shared object under `plugin` and says `law: plugin` of the axes that take their
 * commands from it; the other axes keep laws of dispersa's. Four functions, all of them exported with C
 * linkage:
 *
 *   const dispersa_law_description* dispersa_law_describe(void);
 *   int dispersa_law_create(const dispersa_law_setup* setup, void* memory);
 *   int dispersa_law_start_stage(const dispersa_law_stage* stage, void* memory);
 *   int dispersa_law_step(const dispersa_law_input* input, dispersa_law_output* output, void* memory);
 *
 * Rules. A flight's result is a function of the campaign and the case alone, so a law keeps nothing outside
 * the `memory` that it is given: `memory_bytes` of its description, aligned to 64 bytes, zero at first, one
 * for each flight. It may be moved between calls, so it must not point into itself. Flights are flown side by
 * side and calls for one alternate with calls for others. A law reads no clock, file, random number or
 * environment, and starts no thread. Functions return 0, or anything else for a failure, which ends the
 * flight as a numerical failure; so does a command that is not finite. A call of more than two seconds of
 * CPU time, or five of waiting, counts as one that does not return.
 *
 * Axes are in the order roll, pitch, yaw: about body x forward, y right, z down. An error is reference less
 * true attitude, so a positive command, which accelerates the body in the positive sense, reduces a positive
 * error. SI units and radians throughout. Structs grow only at their ends, and only with DISPERSA_LAW_ABI. */
#ifndef DISPERSA_CONTROL_LAW_H
#define DISPERSA_CONTROL_LAW_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DISPERSA_LAW_ABI 1u
#define DISPERSA_LAW_AXES 3
#define DISPERSA_LAW_TELEMETRY 4           /* most numbers of telemetry */
#define DISPERSA_LAW_MEMORY (1024u * 1024) /* most bytes of a flight's memory */

enum { DISPERSA_ROLL = 0, DISPERSA_PITCH = 1, DISPERSA_YAW = 2 };

/* What a law commands of its axes. */
enum {
  DISPERSA_LAW_ANGULAR_ACCELERATION = 0, /* rad/s^2: dispersa divides by the effectiveness */
  DISPERSA_LAW_DEFLECTION = 1            /* rad */
};

#define DISPERSA_LAW_EXPORT __attribute__((visibility("default")))

/* Constant; lives as long as the shared object. */
typedef struct dispersa_law_description {
  uint32_t abi;             /* DISPERSA_LAW_ABI */
  uint32_t memory_bytes;    /* of one flight, at most DISPERSA_LAW_MEMORY */
  uint32_t command;         /* DISPERSA_LAW_ANGULAR_ACCELERATION or DISPERSA_LAW_DEFLECTION */
  uint32_t parameter_count; /* numbers that the autopilot file gives under `plugin.parameters`, all of them */
  const char* name;         /* for reports */
  const char* version;
  const char* const* parameters; /* their keys; the unit belongs into the name */
} dispersa_law_description;

typedef struct dispersa_law_setup {
  double tick_s;            /* between two steps */
  uint32_t stages;          /* of the vehicle */
  uint32_t axes;            /* bit DISPERSA_PITCH, ...: set where the law is in command */
  const double* parameters; /* in the order of the description; valid during the call */
} dispersa_law_setup;

/* An ignition. Commands, delay line and actuators start anew at zero. */
typedef struct dispersa_law_stage {
  uint32_t stage; /* from 0 */
  uint32_t reserved;
  double
      kp_1_s2[DISPERSA_LAW_AXES]; /* `gains` of the axes in the autopilot file: the error dynamics that are */
  double kd_1_s[DISPERSA_LAW_AXES]; /* wanted, s^2 + kd s + kp */
  double limit_rad;                 /* of a nozzle's deflection */
} dispersa_law_stage;

/* A tick of powered flight. */
typedef struct dispersa_law_input {
  double time_s;           /* since lift-off */
  double since_ignition_s; /* of the stage */
  uint32_t stage;          /* from 0 */
  uint32_t reserved;
  double angle_error_rad[DISPERSA_LAW_AXES]; /* as the sensors see it */
  double rate_error_rad_s[DISPERSA_LAW_AXES];
  double rate_rad_s[DISPERSA_LAW_AXES]; /* of the body, as the sensors see it */
  double
      effectiveness_1_s2[DISPERSA_LAW_AXES]; /* angular acceleration by deflection, nominal, rad/s^2 by rad */
  double program_rad_s2[DISPERSA_LAW_AXES];  /* what the attitude program asks for; added behind the law where
                                                an  axis has `feed_forward`, else 0 */
  double saturation[DISPERSA_LAW_AXES];      /* -1, 0, 1: the last deflection was limited in this sense */
} dispersa_law_input;

typedef struct dispersa_law_output {
  double command[DISPERSA_LAW_AXES];        /* zero at first; of axes with another law it is ignored */
  double telemetry[DISPERSA_LAW_TELEMETRY]; /* zero at first; what histories show as law_telemetry_1, ... */
} dispersa_law_output;

DISPERSA_LAW_EXPORT const dispersa_law_description* dispersa_law_describe(void);
DISPERSA_LAW_EXPORT int dispersa_law_create(const dispersa_law_setup* setup, void* memory);
DISPERSA_LAW_EXPORT int dispersa_law_start_stage(const dispersa_law_stage* stage, void* memory);
DISPERSA_LAW_EXPORT int dispersa_law_step(const dispersa_law_input* input, dispersa_law_output* output,
                                          void* memory);

#ifdef __cplusplus
}
#endif
#endif
