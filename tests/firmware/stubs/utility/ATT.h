// The part of ArduinoBLE's ATT layer that the sketch uses.
#pragma once

#include <ArduinoBLE.h>

class ATTClass {
 public:
  virtual ~ATTClass();
  virtual bool connected() const;
  virtual uint16_t mtu(uint16_t handle) const;
};
extern ATTClass& ATT;
