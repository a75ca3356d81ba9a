// What the RP2040 of the Arduino Nano RP2040 Connect has of its own: watchdog, serial over USB.
#pragma once

#include <Arduino.h>
#include <mbed.h>

#include "settings.h"

namespace lumitip {

class Rp2040 {
 public:
  bool startWatchdog() {
    const bool bitten = mbed::ResetReason::get() == RESET_REASON_WATCHDOG;
    if (LUMITIP_WATCHDOG_S != 0) {
      mbed::Watchdog& watchdog = mbed::Watchdog::get_instance();
      const uint32_t most = watchdog.get_max_timeout();  // 8.4 s
      const uint32_t wanted = 1000u * LUMITIP_WATCHDOG_S;
      watchdog.start(wanted < most ? wanted : most);
    }
    return bitten;
  }

  void feedWatchdog() { mbed::Watchdog::get_instance().kick(); }
  uint16_t measure(int pin) { return static_cast<uint16_t>(analogRead(pin)); }

  // Not `if (Serial)`, which waits a millisecond on this board to let other threads run.
  bool serialOpen() { return Serial.connected(); }

  size_t serialWrite(const uint8_t* data, size_t size) {
    uint32_t taken = 0;  // write() would wait for a computer that does not read
    Serial.send_nb(const_cast<uint8_t*>(data), size, &taken);
    return taken;
  }
};

}  // namespace lumitip
