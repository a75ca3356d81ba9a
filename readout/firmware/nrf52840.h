// What the nRF52840 of the Arduino Nano 33 BLE has of its own: watchdog, serial over USB.
#pragma once

#include <Arduino.h>
#include <nrf.h>

#include "settings.h"

namespace lumitip {

class Nrf52840 {
 public:
  bool startWatchdog() {
    const bool bitten = (NRF_POWER->RESETREAS & POWER_RESETREAS_DOG_Msk) != 0;
    NRF_POWER->RESETREAS = POWER_RESETREAS_DOG_Msk;  // writing a one clears it
    if (LUMITIP_WATCHDOG_S != 0) {
      NRF_WDT->CONFIG = WDT_CONFIG_SLEEP_Run << WDT_CONFIG_SLEEP_Pos;
      NRF_WDT->CRV = 32768u * LUMITIP_WATCHDOG_S - 1;
      NRF_WDT->RREN = WDT_RREN_RR0_Msk;
      NRF_WDT->TASKS_START = 1;
    }
    return bitten;
  }

  void feedWatchdog() { NRF_WDT->RR[0] = WDT_RR_RR_Reload; }
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
