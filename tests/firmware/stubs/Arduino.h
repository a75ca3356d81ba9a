// The part of the Arduino interface that the sketch uses: declared as its documentation has it.
#pragma once

#include <stddef.h>
#include <stdint.h>

#define LOW 0
#define HIGH 1
#define OUTPUT 1
#define LED_BUILTIN 13
static const uint8_t A0 = 14, A1 = 15, A2 = 16, A3 = 17, A4 = 18, A5 = 19, A6 = 20, A7 = 21;

void pinMode(int pin, int mode);
void digitalWrite(int pin, int level);
int analogRead(int pin);
void analogReadResolution(int bits);
unsigned long micros();
unsigned long millis();
void delayMicroseconds(unsigned int us);
void setup();
void loop();

// Serial over USB of the Mbed core.
class USBSerial {
 public:
  void begin(unsigned long rate);
  operator bool();
  void send_nb(uint8_t* buffer, uint32_t size, uint32_t* actual, bool now = true);
};
extern USBSerial Serial;
