// What the ESP32-S3 of the Arduino Nano ESP32 has of its own: converter, watchdog, serial over USB.
#pragma once

#include <Arduino.h>
#include <esp_idf_version.h>
#include <esp_system.h>
#include <esp_task_wdt.h>

#include "layout.h"
#include "settings.h"

namespace lumitip {

class Esp32S3 {
 public:
  bool startWatchdog() {
    const bool bitten = esp_reset_reason() == ESP_RST_TASK_WDT;
    if (LUMITIP_WATCHDOG_S != 0) {
#if ESP_IDF_VERSION_MAJOR >= 5
      esp_task_wdt_config_t wanted = {};
      wanted.timeout_ms = 1000u * LUMITIP_WATCHDOG_S;
      wanted.trigger_panic = true;
      esp_task_wdt_reconfigure(&wanted);
#else
      esp_task_wdt_init(LUMITIP_WATCHDOG_S, true);
#endif
      esp_task_wdt_add(nullptr);  // the task that runs loop()
    }
    return bitten;
  }

  void feedWatchdog() {
    if (LUMITIP_WATCHDOG_S != 0) {
      esp_task_wdt_reset();
    }
  }

  // The converter is bent and ends near 3.1 V. The core corrects it by what the maker burnt in, and
  // tells millivolts.
  uint16_t measure(int pin) {
    const uint32_t code = (analogReadMilliVolts(pin) * FULL + SUPPLY_MV / 2) / SUPPLY_MV;
    return static_cast<uint16_t>(code < FULL ? code : FULL);
  }

  bool serialOpen() { return static_cast<bool>(Serial); }

  size_t serialWrite(const uint8_t* data, size_t size) {
    const int free = Serial.availableForWrite();  // write() would wait for more
    const size_t room = free > 0 ? static_cast<size_t>(free) : 0;
    const size_t taken = size < room ? size : room;
    return taken != 0 ? Serial.write(data, taken) : 0;
  }

 private:
  static constexpr uint32_t SUPPLY_MV = 3300;  // of the detectors: the board's 3V3
  static constexpr uint32_t FULL = (uint32_t{1} << ADC_BITS) - 1;
};

}  // namespace lumitip
