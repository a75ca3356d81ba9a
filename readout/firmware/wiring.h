// Which cell each input of each multiplexer reads, worked out and proven by the compiler.
#pragma once

#include <stdint.h>

#include "crc.h"
#include "layout.h"
#include "protocol.h"

namespace lumitip {

constexpr uint16_t NO_CELL = 0xFFFF;

struct InputMap {
  uint16_t cell[MUXES][CHANNELS];
};

constexpr InputMap inputMap() {
  InputMap map{};
  for (unsigned mux = 0; mux < MUXES; ++mux) {
    for (unsigned channel = 0; channel < CHANNELS; ++channel) {
      map.cell[mux][channel] = NO_CELL;
    }
  }
  for (uint16_t cell = 0; cell < CELLS; ++cell) {
    map.cell[MUX[cell]][CHANNEL[cell]] = cell;
  }
  return map;
}

constexpr bool withinReach() {
  for (unsigned cell = 0; cell < CELLS; ++cell) {
    if (MUX[cell] >= MUXES || CHANNEL[cell] >= CHANNELS) {
      return false;
    }
  }
  return true;
}

// Whether every cell has an input of its own.
constexpr bool everyCellOnce() {
  const InputMap map = inputMap();
  for (uint16_t cell = 0; cell < CELLS; ++cell) {
    if (map.cell[MUX[cell]][CHANNEL[cell]] != cell) {
      return false;
    }
  }
  return true;
}

constexpr bool sameText(const char* a, const char* b) {
  while (*a != 0 && *a == *b) {
    ++a;
    ++b;
  }
  return *a == *b;
}

constexpr uint16_t wiringSum() {
  uint16_t crc = CRC_START;
  for (unsigned cell = 0; cell < CELLS; ++cell) {
    crc = crcOf(crc, static_cast<uint8_t>(MUX[cell] & 0xFF));
    crc = crcOf(crc, static_cast<uint8_t>(MUX[cell] >> 8));
    crc = crcOf(crc, CHANNEL[cell]);
  }
  return crc;
}

static_assert(sameText(LAYOUT_HASH, PROTOCOL_HASH),
              "layout.h and protocol.h were made for two designs: build the design again");
static_assert(wiringSum() == WIRING_SUM,
              "the wiring in layout.h was changed by hand: build the design again");
static_assert(withinReach(), "layout.h has a cell on an input that no multiplexer has");
static_assert(everyCellOnce(), "layout.h has two cells on one input");

constexpr InputMap INPUT_MAP = inputMap();

}  // namespace lumitip
