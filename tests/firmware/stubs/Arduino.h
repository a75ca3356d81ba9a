// The part of the Arduino interface that the sketch uses: declared as its documentation has it.
#pragma once

#include <stddef.h>
#include <stdint.h>

enum PinStatus { LOW, HIGH };
enum PinMode { INPUT, OUTPUT };
typedef uint8_t pin_size_t;
#define LED_BUILTIN (13u)
static const uint8_t A0 = 14, A1 = 15, A2 = 16, A3 = 17, A4 = 18, A5 = 19, A6 = 20, A7 = 21;

void pinMode(pin_size_t pin, PinMode mode);
void digitalWrite(pin_size_t pin, PinStatus level);
int analogRead(pin_size_t pin);
void analogReadResolution(int bits);
unsigned long micros();
unsigned long millis();
void delay(unsigned long ms);
void delayMicroseconds(unsigned int us);
void setup();
void loop();

// Serial over USB of the Mbed core, but for `operator bool`, which delays by a millisecond there.
class USBSerial {
 public:
  void begin(unsigned long rate);
  bool connected();
  void send_nb(uint8_t* buffer, uint32_t size, uint32_t* actual, bool now = true);
};
extern USBSerial Serial;
