// Lumitip on an Arduino Nano 33 BLE: reads the receiver and sends packets over Bluetooth and USB.
// Everything that differs between designs is in layout.h and protocol.h, made by lumitip-fab.

#include "device.h"
#include "nano33ble.h"

static lumitip::Nano33Ble nano;
static lumitip::Device<lumitip::Nano33Ble> device(nano);

void setup() {
  const uint16_t faults = nano.begin();
  device.begin(faults);
}

void loop() {
  nano.poll();
  device.poll();
  nano.tell(device.faults());
  nano.rest(device.idleUs());
}
