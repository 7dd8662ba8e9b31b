// The results of a flight's guidance, for its metrics.
#pragma once

namespace dispersa {

struct GuidanceOutcome {
  bool acted = false;    ///< it has planned at least once
  bool arrives = false;  ///< the last plan reaches the target, and the last in which altitude and plane
                         ///< counted did; and a last burn that no command ended left the target's energy
  double ignition_shift_s = 0.0;  ///< of the last stage, against the reference
  double excess_m_s = 0.0;   ///< of the last burn, that its turn in yaw takes away as planned at ignition
  double postponed_s = 0.0;  ///< because the attitude had not settled
};

}  // namespace dispersa
