// Reads every cell once: the multiplexers step through their inputs in Gray-code order, so that
// only one select line changes at a time, and each input settles before it is read.
//
// Hardware: select(line, high), read(mux) -> code of ADC_BITS bits, waitUs(us).
#pragma once

#include <stdint.h>

#include "layout.h"
#include "settings.h"
#include "wiring.h"

namespace lumitip {

constexpr uint16_t FULL_SCALE = (1u << ADC_BITS) - 1;
constexpr uint16_t CEILING = uint32_t{FULL_SCALE} * LUMITIP_CEILING / 1000;  // of a dark cell
constexpr uint16_t BRIGHT_SHARE = 4;  // ambient light leaves less than a quarter of a cell's range

// The pull-up charges the line until half a step of the bits sent is left: R C ln(2^(BITS + 1)).
constexpr double CHARGED_US = PULL_UP_OHM * 1e-6 * LINE_PF * 0.6931472 * (BITS + 1);
constexpr uint32_t LINE_US = static_cast<uint32_t>(SETTLE_FACTOR * CHARGED_US) + 1;

// A phototransistor settles more slowly than the line. With a pull-up of its own it is known how
// slowly; with one for all it depends on the part. So an input waits for as long as the period
// allows, and never less than line and detector need.
constexpr uint32_t SHORTEST_US = DETECTOR_US > LINE_US ? DETECTOR_US : LINE_US;
constexpr int32_t SCANS = EMITTER_PIN >= 0 && LUMITIP_AMBIENT ? 2 : 1;  // of a frame
constexpr int32_t SCAN_US = (PERIOD_US - RADIO_US) / SCANS;
constexpr int32_t STEADY_US = SCANS == 1 ? 0 : EMITTER_US;
constexpr int32_t READING_US = int32_t{CELLS} * SAMPLES * CONVERSION_US;
constexpr int32_t SPARE_US = (SCAN_US - STEADY_US - READING_US) / CHANNELS;
constexpr uint32_t SETTLE_US =
    SPARE_US > static_cast<int32_t>(SHORTEST_US) ? static_cast<uint32_t>(SPARE_US) : SHORTEST_US;

template <class Hardware, unsigned Samples = SAMPLES>
class Scanner {
 public:
  explicit Scanner(Hardware& hardware) : hardware_(hardware) {}

  void begin() {
    for (uint8_t line = 0; line < SELECT_LINES; ++line) {
      hardware_.select(line, false);
    }
    selected_ = 0;
  }

  // Writes the code of each cell, in frame order.
  void scan(uint16_t* codes) {
    for (uint16_t step = 0; step < CHANNELS; ++step) {
      const uint16_t channel = step ^ (step >> 1);
      select(channel);
      if (inUse(channel)) {
        hardware_.waitUs(SETTLE_US);
        readAll(channel, codes);
      }
    }
  }

  // The same without ambient light, where the light of the emitter can be switched:
  // light(on) switches it and waits until it is steady. Dark is high, so ambient light lowers
  // a code; what it lowers without the emitter is given back.
  template <class Light>
  void scan(uint16_t* codes, Light&& light) {
    uint16_t unlit[CELLS];
    light(false);
    scan(unlit);
    light(true);
    scan(codes);
    bright_ = false;
    for (uint16_t cell = 0; cell < CELLS; ++cell) {
      bright_ = bright_ || unlit[cell] < FULL_SCALE / BRIGHT_SHARE;
      const uint16_t lowered = unlit[cell] < CEILING ? CEILING - unlit[cell] : 0;
      const uint32_t code = uint32_t{codes[cell]} + lowered;
      codes[cell] = static_cast<uint16_t>(code < FULL_SCALE ? code : FULL_SCALE);
    }
  }

  // Whether the ambient light of the last frame was so bright that the emitter's could not be told
  // from it: such cells read as covered.
  bool bright() const { return bright_; }

 private:
  static bool inUse(uint16_t channel) {
    for (uint16_t mux = 0; mux < MUXES; ++mux) {
      if (INPUT_MAP.cell[mux][channel] != NO_CELL) {
        return true;
      }
    }
    return false;
  }

  void select(uint16_t channel) {
    for (uint8_t line = 0; line < SELECT_LINES; ++line) {
      const uint16_t bit = 1u << line;
      if ((channel ^ selected_) & bit) {
        hardware_.select(line, (channel & bit) != 0);
      }
    }
    selected_ = channel;
  }

  void readAll(uint16_t channel, uint16_t* codes) {
    for (uint16_t mux = 0; mux < MUXES; ++mux) {
      const uint16_t cell = INPUT_MAP.cell[mux][channel];
      if (cell == NO_CELL) {
        continue;
      }
      uint32_t sum = Samples / 2;
      for (unsigned i = 0; i < Samples; ++i) {
        sum += hardware_.read(mux);
      }
      codes[cell] = static_cast<uint16_t>(sum / Samples);
    }
  }

  Hardware& hardware_;
  uint16_t selected_ = 0;
  bool bright_ = false;
};

}  // namespace lumitip
