// The board that the sketch is compiled for.
#pragma once

#include "nano.h"

#if defined(ARDUINO_ARCH_ESP32)
#include "esp32s3.h"
namespace lumitip {
using Board = Nano<Esp32S3>;
}
#elif defined(ARDUINO_ARCH_RP2040)
#include "rp2040.h"
namespace lumitip {
using Board = Nano<Rp2040>;
}
#else
#include "nrf52840.h"
namespace lumitip {
using Board = Nano<Nrf52840>;
}
#endif
