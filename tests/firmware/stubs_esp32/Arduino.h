// The part of Arduino's core for the ESP32 that the sketch uses: declared as its sources have it.
#pragma once

#include <stddef.h>
#include <stdint.h>

#define LOW 0x0
#define HIGH 0x1
#define OUTPUT 0x03
static constexpr uint8_t LED_BUILTIN = 13;
static constexpr uint8_t A0 = 17, A1 = 18, A2 = 19, A3 = 20, A4 = 21, A5 = 22, A6 = 23, A7 = 24;

void pinMode(uint8_t pin, uint8_t mode);
void digitalWrite(uint8_t pin, uint8_t level);
uint32_t analogReadMilliVolts(uint8_t pin);
void analogReadResolution(uint8_t bits);
unsigned long micros();
unsigned long millis();
void delay(uint32_t ms);
void delayMicroseconds(uint32_t us);
void setup();
void loop();

class USBCDC {
 public:
  void begin(unsigned long rate = 0);
  int availableForWrite();
  size_t write(const uint8_t* buffer, size_t size);
  operator bool() const;
};
extern USBCDC Serial;
