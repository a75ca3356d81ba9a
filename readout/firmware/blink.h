// What the light on the board tells: on while somebody listens, else short flashes in groups.
#pragma once

#include <stdint.h>

namespace lumitip {

enum Flashes : uint8_t {
  LISTENED_TO = 0,    // steadily on
  WAITING = 1,        // nobody is connected
  TOO_SMALL_MTU = 2,  // connected, but a frame does not fit into a notification
  NO_BLUETOOTH = 3    // Bluetooth did not start; serial works
};

constexpr bool lightOn(uint32_t ms, Flashes flashes) {
  return flashes == LISTENED_TO || (ms % 2048 < 300u * flashes && ms % 2048 % 300 < 120);
}

}  // namespace lumitip
