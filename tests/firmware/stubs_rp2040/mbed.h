// The part of Mbed OS that the sketch uses on an RP2040: declared as its documentation has it.
#pragma once

#include <stdint.h>

typedef enum { RESET_REASON_POWER_ON, RESET_REASON_PIN_RESET, RESET_REASON_WATCHDOG } reset_reason_t;

namespace mbed {

class ResetReason {
 public:
  static reset_reason_t get();
};

class Watchdog {
 public:
  static Watchdog& get_instance();
  bool start(uint32_t timeout);
  void kick();
  uint32_t get_max_timeout() const;
};

}  // namespace mbed
