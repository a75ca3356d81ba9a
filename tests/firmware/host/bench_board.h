// A Board without hardware, whose every reading and every failure is prescribed.
#pragma once

#include <stdint.h>
#include <stdio.h>

#include "layout.h"
#include "scan.h"

class BenchBoard {
 public:
  uint32_t us = 0;
  uint16_t attMtu = 0;
  bool asked = false;
  bool open = true;
  bool takesNotifications = true;
  size_t serialRoom = 1000;
  bool muted = false;
  uint32_t frame = 0;  // number of the frame being read
  unsigned selects = 0;
  unsigned unsettled = 0;

  void select(uint8_t line, bool high) {
    const uint16_t bit = 1u << line;
    channel = high ? channel | bit : channel & ~bit;
    changedUs = us;
    ++selects;
  }

  void light(bool) {}
  void waitUs(uint32_t time) { us += time; }

  uint16_t read(uint16_t mux) {
    if (us - changedUs < lumitip::SETTLE_US) {
      ++unsettled;
    }
    us += 15;
    const uint32_t code = mux * 977u + channel * 131u + frame * 37u;
    return static_cast<uint16_t>(code & lumitip::FULL_SCALE);
  }

  uint32_t microseconds() {
    askedUs = us;
    return us;
  }
  uint16_t mtu() const { return attMtu; }
  bool subscribed() const { return asked; }
  bool serialOpen() const { return open; }

  bool notify(const uint8_t* data, size_t size) {
    if (takesNotifications) {
      tell("notify", data, size);
    }
    return takesNotifications;
  }

  bool status(const uint8_t* data, size_t size) { return tell("status", data, size); }

  bool legacy(const uint8_t* data, size_t size) {
    if (!muted) {
      printf("began %lu %lu\n", static_cast<unsigned long>(frame),
             static_cast<unsigned long>(askedUs));
    }
    ++frame;  // called once a frame, after the scan
    return tell("legacy", data, size);
  }

  size_t serialWrite(const uint8_t* data, size_t size) {
    const size_t taken = size < serialRoom ? size : serialRoom;
    tell("serial", data, taken);
    return taken;
  }

 private:
  bool tell(const char* what, const uint8_t* data, size_t size) {
    if (muted || size == 0) {
      return true;
    }
    printf("%s %lu ", what, static_cast<unsigned long>(frame));
    for (size_t i = 0; i < size; ++i) {
      printf("%02x", data[i]);
    }
    printf("\n");
    return true;
  }

  uint16_t channel = 0;
  uint32_t changedUs = 0;
  uint32_t askedUs = 0;
};
