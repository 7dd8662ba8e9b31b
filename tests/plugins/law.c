/* Proportional-derivative control that misbehaves as it is compiled: -D DISPERSA_MISBEHAVES=<one of the
 * numbers below>. */
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "dispersa/control_law.h"

#define CRASHES 1   /* in step, of one flight in four */
#define HANGS 2     /* in step, of one flight in four */
#define ALLOCATES 3 /* without bound, in step, of one flight in four */
#define ENDS 4      /* the process, in step, of one flight in four */
#define READS_THE_CLOCK 5
#define KEEPS_A_GLOBAL 6 /* across flights */
#define FAILS 7          /* says so, of one flight in four */
#define COMMANDS_NAN 8   /* of one flight in four, in pitch */
#define ROUNDS_UP 9      /* leaves the processor in another rounding mode */
#define OTHER_ABI 10
#define CRASHES_AT_ONCE 11 /* in describe */
#define CRASHES_ALWAYS 12
#define PRINTS 13   /* on the standard output */
#define DEFLECTS 14 /* commands deflections */
#define SLEEPS 15   /* in step, of one flight in four */
#define FORKS 16
#define CLOSES_FILES 17        /* all of them, in step, and hangs */
#define HANGS_AT_THE_END 18    /* where objects are unloaded */
#define COUNTS_FLIGHTS 19      /* a line each on the standard error */
#define DIFFERS_BY_WORKER 20   /* by the process that flies it: its parent's number */
#define COMMANDS_INFINITY 21   /* of one flight in four, in yaw */
#define DEFLECTS_FAR 22        /* of one flight in four, in roll: finite, but no finite acceleration */
#define COMMANDS_MUCH 23       /* of one flight in four, in pitch: finite, but no filter could take it */
#define TELLS_NAN 24           /* as telemetry */
#define WRITES_BEFORE 25       /* its memory, some way */
#define WRITES_BEHIND 26       /* its memory, a byte */
#define CRASHES_IN_WORKERS 27  /* when it is created there */
#define IS_SLOW 28             /* a minute a flight */
#define CONNECTS 29            /* a socket, in step, of one flight in four */
#define EXECUTES 30            /* a program, in step, of one flight in four */
#define READS_A_FILE 31        /* of the user, that USERS_FILE names: it aborts if it can */
#define WRITES_A_FILE 32       /* that USERS_FILE names */
#define TALKS_WITHOUT_END 33   /* to whoever reads its results, in step, of one flight in four */
#define STEERS_THE_TERMINAL 34 /* and the page, by its name and version */

#ifndef DISPERSA_MISBEHAVES
#define DISPERSA_MISBEHAVES 0
#endif
#ifndef USERS_FILE
#define USERS_FILE ""
#endif

struct memory {
  double kp_1_s2[DISPERSA_LAW_AXES], kd_1_s[DISPERSA_LAW_AXES];
  int is_chosen; /* one of the flights in four: drawn from its first errors */
  int has_seen;
};

static int global_count;
static char* volatile nowhere; /* the compiler must not know */

const dispersa_law_description* dispersa_law_describe(void) {
  static dispersa_law_description description = {
      DISPERSA_LAW_ABI, sizeof(struct memory), DISPERSA_LAW_ANGULAR_ACCELERATION, 0, "pd_test", "1", 0};
  if (DISPERSA_MISBEHAVES == STEERS_THE_TERMINAL) {
    description.name =
        "\x1b]0;taken\x07<script>alert(1)</script>\n\xc2\x9b"
        "31m";
    description.version =
        "\xe2\x80\xae 1\r2 0123456789012345678901234567890123456789012345678901234567890123456789";
  }
  if (DISPERSA_MISBEHAVES == OTHER_ABI) description.abi = 77;
  if (DISPERSA_MISBEHAVES == DEFLECTS || DISPERSA_MISBEHAVES == DEFLECTS_FAR)
    description.command = DISPERSA_LAW_DEFLECTION;
  if (DISPERSA_MISBEHAVES == CRASHES_AT_ONCE) abort();
  return &description;
}

__attribute__((destructor)) static void at_the_end(void) {
  if (DISPERSA_MISBEHAVES == HANGS_AT_THE_END)
    for (volatile int forever = 1; forever;) continue;
}

int dispersa_law_create(const dispersa_law_setup* setup, void* memory) {
  (void)setup;
  (void)memory;
  if (DISPERSA_MISBEHAVES == CRASHES_IN_WORKERS) {
    struct rlimit files;
    if (getrlimit(RLIMIT_NOFILE, &files) != 0) return 1;
    if (files.rlim_cur == 777) abort(); /* the limit that the test gives to workers */
  }
  if (DISPERSA_MISBEHAVES == COUNTS_FLIGHTS) {
    static const char words[] = "a flight begins\n";
    if (write(2, words, sizeof words - 1) < 0) return 1;
  }
  if (DISPERSA_MISBEHAVES == READS_A_FILE && open(USERS_FILE, O_RDONLY) >= 0) abort();
  if (DISPERSA_MISBEHAVES == WRITES_A_FILE && open(USERS_FILE, O_WRONLY | O_CREAT, 0600) >= 0) abort();
  return 0;
}

int dispersa_law_start_stage(const dispersa_law_stage* stage, void* memory) {
  struct memory* m = memory;
  memcpy(m->kp_1_s2, stage->kp_1_s2, sizeof m->kp_1_s2);
  memcpy(m->kd_1_s, stage->kd_1_s, sizeof m->kd_1_s);
  return 0;
}

/* What it does in the flights that it has chosen, in the third second. */
static int misbehave(dispersa_law_output* output) {
  switch (DISPERSA_MISBEHAVES) {
    case CRASHES:
      *(volatile int*)nowhere = 1;
      return 0;
    case HANGS:
      for (volatile int forever = 1; forever;) continue;
      return 0;
    case ALLOCATES:
      for (;;) {
        volatile char* bytes = malloc(16u << 20);
        bytes[0] = 1; /* the limit is one of addresses */
      }
    case ENDS:
      exit(0);
    case SLEEPS:
      sleep(1000);
      return 0;
    case CLOSES_FILES:
      for (int file = 0; file < 64; ++file) close(file);
      for (volatile int forever = 1; forever;) continue;
      return 0;
    case CONNECTS:
      return socket(AF_INET, SOCK_STREAM, 0);
    case EXECUTES:
      return execl("/bin/true", "true", NULL);
    case TALKS_WITHOUT_END: {
      char words[4096];
      memset(words, 0xff, sizeof words);
      for (;;)
        if (write(3, words, sizeof words) < 0) return 1;
    }
    case FAILS:
      return 3;
    case COMMANDS_NAN:
      output->command[DISPERSA_PITCH] = NAN;
      return 0;
    case COMMANDS_INFINITY:
      output->command[DISPERSA_YAW] = -INFINITY;
      return 0;
    case DEFLECTS_FAR:
      output->command[DISPERSA_ROLL] = 1.7e308;
      return 0;
    case COMMANDS_MUCH:
      output->command[DISPERSA_PITCH] = -1e300;
      return 0;
  }
  return 0;
}

int dispersa_law_step(const dispersa_law_input* input, dispersa_law_output* output, void* memory) {
  struct memory* m = memory;
  for (int axis = 0; axis < DISPERSA_LAW_AXES; ++axis) {
    output->command[axis] =
        fma(m->kp_1_s2[axis], input->angle_error_rad[axis], m->kd_1_s[axis] * input->rate_error_rad_s[axis]);
    if (DISPERSA_MISBEHAVES == DEFLECTS || DISPERSA_MISBEHAVES == DEFLECTS_FAR)
      output->command[axis] /= input->effectiveness_1_s2[axis];
  }
  output->telemetry[0] = input->since_ignition_s;
  if (DISPERSA_MISBEHAVES == TELLS_NAN) output->telemetry[1] = NAN;
  if (!m->has_seen && input->time_s > 2.0) {
    /* Of dispersed flights alone: the nominal one has no roll. */
    unsigned long long bits;
    memcpy(&bits, &input->angle_error_rad[DISPERSA_PITCH], sizeof bits);
    bits ^= bits >> 32;
    bits ^= bits >> 16;
    bits ^= bits >> 8;
    m->is_chosen = (bits & 3) == 3;
    m->has_seen = 1;
  }
  if (m->is_chosen && input->time_s > 3.0) return misbehave(output);
  switch (DISPERSA_MISBEHAVES) {
    case READS_THE_CLOCK: {
      struct timespec now;
      clock_gettime(CLOCK_MONOTONIC, &now);
      output->command[DISPERSA_PITCH] *= 1.0 + 1e-12 * (double)(now.tv_nsec & 1023);
      break;
    }
    case KEEPS_A_GLOBAL:
      output->command[DISPERSA_PITCH] *= 1.0 + 1e-12 * global_count++;
      break;
    case WRITES_BEFORE:
      memset((char*)m - 256, 0x5a, 64);
      break;
    case WRITES_BEHIND:
      *((volatile char*)m + sizeof *m) = 1;
      break;
    case IS_SLOW:
      usleep(2000);
      break;
    case DIFFERS_BY_WORKER:
      output->command[DISPERSA_PITCH] *= 1.0 + 1e-12 * getppid();
      break;
    case ROUNDS_UP: {
      unsigned mode = 0;
      __asm__ volatile("stmxcsr %0" : "=m"(mode));
      mode |= 0x4000;
      __asm__ volatile("ldmxcsr %0" : : "m"(mode));
      break;
    }
    case FORKS:
      if (input->time_s < 0.005 && fork() == 0) _exit(0);
      break;
    case CRASHES_ALWAYS:
      if (input->time_s > 3.0) abort();
      break;
    case PRINTS:
      if (input->time_s < 0.05) {
        static const char words[] = "a law prints this\n";
        if (write(1, words, sizeof words - 1) < 0) return 1;
      }
      break;
  }
  return 0;
}
