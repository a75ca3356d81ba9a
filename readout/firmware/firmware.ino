// Lumitip on an Arduino Nano: reads the receiver and sends packets over Bluetooth and USB.
// Everything that differs between designs is in layout.h and protocol.h, made by lumitip-fab.

#include "board.h"
#include "device.h"

static lumitip::Board nano;
static lumitip::Device<lumitip::Board> device(nano);

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
