// What the device says of itself: 20 bytes, which fit into a notification at every MTU.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "layout.h"
#include "packet.h"
#include "protocol.h"
#include "settings.h"

namespace lumitip {

enum Fault : uint16_t {
  MTU_TOO_SMALL = 1,   // a frame does not fit into a notification, so none is sent
  NOTIFY_FAILED = 2,   // the Bluetooth stack refused a notification
  SERIAL_FULL = 4,     // the serial line was not read in time: packets were left out there
  LATE = 8,            // a scan began a whole period late or more
  WATCHDOG_RESET = 16,  // the watchdog started the device anew
  AMBIENT = 32         // ambient light filled most of a cell's range: it reads as covered
};

constexpr size_t STATUS_BYTES = 20;

inline void writeStatus(uint16_t mtu, uint16_t faults, uint8_t* out) {
  const size_t needed = neededMtu(CELLS, BITS);
  const size_t words[4] = {CELLS, mtu, needed < 0xFFFF ? needed : 0xFFFF, faults};
  *out++ = VERSION;
  for (uint8_t part : FIRMWARE_VERSION) {
    *out++ = part;
  }
  for (uint8_t byte : DESIGN_HASH) {
    *out++ = byte;
  }
  for (size_t word : words) {
    *out++ = static_cast<uint8_t>(word);
    *out++ = static_cast<uint8_t>(word >> 8);
  }
}

}  // namespace lumitip
