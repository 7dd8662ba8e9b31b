// Ends a program with a clear message on a processor that cannot run it: the one function that is compiled
// for any x86-64 processor, run before the constructors of everything that is not.
#include <unistd.h>

#include <cstring>

namespace {

[[gnu::constructor(101), gnu::target("arch=x86-64")]] void RequireProcessor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt")) {
    return;
  }
  const char message[] =
      "dispersa needs a processor of level x86-64-v3 (AVX2, FMA, BMI2: Intel Haswell, AMD Zen, or later)\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message, std::strlen(message));
  _exit(1);
}

}  // namespace
