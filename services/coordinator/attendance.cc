#include "services/coordinator/attendance.h"

#include "services/log/log.h"
#include "services/transport/network.h"

namespace dispersa {
namespace {

constexpr double kSayAgain_s = 30.0;

}  // namespace

void Attendance::Check(bool attended, double now_s) {
  if (attended) {
    present_s_ = said_s_ = now_s;
    return;
  }
  if (now_s - said_s_ >= kSayAgain_s) {
    said_s_ = now_s;
    LogWarning("no worker for {:.0f} s; workers can join at port {}", now_s - present_s_,
               CoordinatorPort(domain_));
  }
}

}  // namespace dispersa
