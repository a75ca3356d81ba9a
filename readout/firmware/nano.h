// An Arduino Nano as a Board: pins, Bluetooth, light. What differs from chip to chip is in Chip:
//   startWatchdog() -> whether the one before bit; feedWatchdog()
//   measure(pin) -> code of ADC_BITS bits, ends at the detectors' supply
//   serialOpen(), serialWrite(data, size) -> bytes taken at once
#pragma once

#include <Arduino.h>
#include <ArduinoBLE.h>
#include <utility/ATT.h>

#include "blink.h"
#include "device.h"
#include "protocol.h"

namespace lumitip {

template <class Chip>
class Nano {
 public:
  // Returns what is wrong already.
  uint16_t begin() {
    for (uint8_t line = 0; line < SELECT_LINES; ++line) {
      pinMode(SELECT_PINS[line], OUTPUT);
    }
    pinMode(LED_BUILTIN, OUTPUT);
    if (EMITTER_PIN >= 0) {
      pinMode(EMITTER_PIN, OUTPUT);
      light(true);
    }
    analogReadResolution(ADC_BITS);
    Serial.begin(115200);  // over USB: the rate means nothing
    beginBluetooth();
    return chip_.startWatchdog() ? WATCHDOG_RESET : 0;
  }

  // Between frames: serves the radio and tells the watchdog that all is well.
  void poll() {
    chip_.feedWatchdog();
    if (bluetooth_) {
      BLE.poll();
    }
  }

  // The light on the board, for people.
  void tell(uint16_t faults) {
    Flashes flashes = LISTENED_TO;
    if (!bluetooth_) {
      flashes = NO_BLUETOOTH;
    } else if (faults & MTU_TOO_SMALL) {
      flashes = TOO_SMALL_MTU;
    } else if (!BLE.connected() && !chip_.serialOpen()) {
      flashes = WAITING;
    }
    digitalWrite(LED_BUILTIN, lightOn(millis(), flashes) ? HIGH : LOW);
  }

  // The radio has a thread of its own, which runs at once while this one sleeps. Sleeping for a
  // millisecond takes up to two.
  void rest(uint32_t idleUs) {
    if (idleUs > 2500) {
      delay(1);
    }
  }

  void select(uint8_t line, bool high) { digitalWrite(SELECT_PINS[line], high ? HIGH : LOW); }
  uint16_t read(uint16_t mux) { return chip_.measure(ADC_PINS[mux]); }
  void light(bool on) { digitalWrite(EMITTER_PIN, on ? HIGH : LOW); }
  void waitUs(uint32_t us) { delayMicroseconds(us); }
  uint32_t microseconds() { return micros(); }

  // ArduinoBLE cuts notifications off at the MTU and has no call that tells it. Its ATT layer
  // knows the MTU of each connection handle, and 23 for handles that are not in use.
  uint16_t mtu() {
    if (!bluetooth_ || !ATT.connected()) {
      return 0;
    }
    uint16_t largest = 0;
    for (uint16_t handle = 0; handle < MOST_HANDLES; ++handle) {
      const uint16_t mtu = ATT.mtu(handle);
      largest = mtu > largest ? mtu : largest;
    }
    return largest;
  }

  bool subscribed() { return bluetooth_ && frames_.subscribed(); }
  bool notify(const uint8_t* data, size_t size) { return write(frames_, data, size); }
  bool status(const uint8_t* data, size_t size) { return write(status_, data, size); }

  bool legacy(const uint8_t* data, size_t size) {
    // Read or notified, but never cut off.
    const bool fits = !legacy_.subscribed() || size + ATT_BYTES <= mtu();
    return fits && write(legacy_, data, size);
  }

  bool serialOpen() { return chip_.serialOpen(); }
  size_t serialWrite(const uint8_t* data, size_t size) { return chip_.serialWrite(data, size); }

 private:
  static constexpr uint16_t MOST_HANDLES = 8;

  bool write(BLECharacteristic& to, const uint8_t* data, size_t size) {
    return bluetooth_ && to.writeValue(data, static_cast<int>(size)) > 0;
  }

  void beginBluetooth() {
    bluetooth_ = BLE.begin() != 0;
    if (!bluetooth_) {
      return;
    }
    BLE.setLocalName(LUMITIP_DEVICE_NAME);
    BLE.setDeviceName(LUMITIP_DEVICE_NAME);
    BLE.setConnectionInterval(6, 12);  // in steps of 1.25 ms: 7.5 to 15 ms
    // In steps of 10 ms: until a computer that vanished counts as gone, ArduinoBLE takes packets
    // for it and then waits for room. That wait may last beyond the connection, since packets of
    // one that ended are not counted as sent: the watchdog then starts the device anew.
    BLE.setSupervisionTimeout(100);
    service_.addCharacteristic(frames_);
    service_.addCharacteristic(status_);
    BLE.addService(service_);
    legacyService_.addCharacteristic(legacy_);
    BLE.addService(legacyService_);
    BLE.setAdvertisedService(service_);
    bluetooth_ = BLE.advertise() != 0;
  }

  Chip chip_;
  const int ADC_PINS[MUXES] = {LUMITIP_ADC_PINS};
  const int SELECT_PINS[SELECT_LINES] = {LUMITIP_SELECT_PINS};

  BLEService service_{SERVICE_UUID};
  BLECharacteristic frames_{FRAMES_UUID, BLENotify, NOTIFICATION_BYTES};
  BLECharacteristic status_{STATUS_UUID, BLERead | BLENotify, STATUS_BYTES, true};
  BLEService legacyService_{LEGACY_SERVICE_UUID};
  BLECharacteristic legacy_{LEGACY_FRAMES_UUID, BLERead | BLENotify, CELLS, true};
  bool bluetooth_ = false;
};

}  // namespace lumitip
