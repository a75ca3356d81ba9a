// What may be tuned. Each value can also be given to the compiler: -DLUMITIP_BITS=10.
// A design whose LEDs are switched has values of its own in layout.h.
#pragma once

#include <stdint.h>

#include "layout.h"

#ifndef LUMITIP_BITS
// Of each value sent: 8, 10 or 12, not more than the converter has. Inputs settle to half a step
// of 8 bits in any case.
#define LUMITIP_BITS 8
#endif
#ifndef LUMITIP_PERIOD_US
#define LUMITIP_PERIOD_US 5000  // from frame to frame
#endif
#ifndef LUMITIP_LATENCY_US
#define LUMITIP_LATENCY_US 7500  // a frame waits no longer for others to share its packet
#endif
#ifndef LUMITIP_SAMPLES
#define LUMITIP_SAMPLES 1  // conversions whose mean is one value
#endif
#ifndef LUMITIP_RADIO_US
#define LUMITIP_RADIO_US 2750  // of the period, for radio and USB; scans fill the rest by waiting
#endif
#ifndef LUMITIP_CONVERSION_US
#define LUMITIP_CONVERSION_US 30  // of one conversion
#endif
#ifndef LUMITIP_SETTLE_FACTOR
#define LUMITIP_SETTLE_FACTOR 2  // shortest wait, times the charging of the line: for long wires
#endif
#ifndef LUMITIP_WATCHDOG_S
#define LUMITIP_WATCHDOG_S 10  // a lost connection may block the radio for as long; 0: for ever
#endif
#ifndef LUMITIP_EMITTER_PIN
#define LUMITIP_EMITTER_PIN -1  // switches the LEDs, high is on; -1: they are always on
#endif
#ifndef LUMITIP_AMBIENT
#define LUMITIP_AMBIENT 1  // 0: leaves the ambient light in the codes; the LEDs stay on
#endif
#ifndef LUMITIP_CEILING
#ifdef ARDUINO_ARCH_ESP32
#define LUMITIP_CEILING 939  // its converter ends near 3.1 V of 3.3
#else
#define LUMITIP_CEILING 1000  // greatest reading, in thousandths of the full scale
#endif
#endif
#ifndef LUMITIP_EMITTER_US
#define LUMITIP_EMITTER_US 200  // from switching the LEDs until light and photodetectors are steady
#endif

namespace lumitip {

constexpr uint8_t BITS = LUMITIP_BITS;
constexpr uint16_t PERIOD_US = LUMITIP_PERIOD_US;
constexpr uint32_t LATENCY_US = LUMITIP_LATENCY_US;
constexpr uint8_t SAMPLES = LUMITIP_SAMPLES;
constexpr int32_t RADIO_US = LUMITIP_RADIO_US;
constexpr int32_t CONVERSION_US = LUMITIP_CONVERSION_US;
constexpr uint8_t SETTLE_FACTOR = LUMITIP_SETTLE_FACTOR;
constexpr int EMITTER_PIN = LUMITIP_EMITTER_PIN;
constexpr uint32_t EMITTER_US = LUMITIP_EMITTER_US;
constexpr uint8_t FIRMWARE_VERSION[3] = {1, 2, 1};

static_assert(LUMITIP_PERIOD_US >= 100 && LUMITIP_PERIOD_US <= 65535, "PERIOD_US: 100 to 65535");
static_assert(LUMITIP_RADIO_US >= 0 && LUMITIP_RADIO_US <= 65535, "RADIO_US: 0 to 65535");
static_assert(LUMITIP_CONVERSION_US >= 1 && LUMITIP_CONVERSION_US <= 1000,
              "CONVERSION_US: 1 to 1000");
static_assert(LUMITIP_CEILING >= 500 && LUMITIP_CEILING <= 1000, "CEILING: 500 to 1000");
static_assert(LUMITIP_SAMPLES >= 1 && LUMITIP_SAMPLES <= 64, "SAMPLES: 1 to 64");
static_assert(BITS == 8 || BITS == 10 || BITS == 12, "BITS: 8, 10 or 12");

}  // namespace lumitip
