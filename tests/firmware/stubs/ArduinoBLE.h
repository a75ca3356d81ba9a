// The part of the ArduinoBLE interface that the sketch uses.
#pragma once

#include <Arduino.h>

enum BLEProperty { BLERead = 0x02, BLENotify = 0x10 };

class BLECharacteristic {
 public:
  BLECharacteristic(const char* uuid, uint16_t permissions, int valueSize, bool fixedLength = false);
  virtual ~BLECharacteristic();
  int writeValue(const uint8_t value[], int length);
  bool subscribed();
};

class BLEService {
 public:
  BLEService(const char* uuid);
  virtual ~BLEService();
  void addCharacteristic(BLECharacteristic& characteristic);
};

class BLELocalDevice {
 public:
  virtual ~BLELocalDevice();
  virtual int begin();
  virtual void poll();
  virtual bool connected() const;
  virtual void setLocalName(const char* localName);
  virtual void setDeviceName(const char* deviceName);
  virtual void setConnectionInterval(uint16_t minimum, uint16_t maximum);
  virtual void setSupervisionTimeout(uint16_t timeout);
  virtual void setAdvertisedService(const BLEService& service);
  virtual void addService(BLEService& service);
  virtual int advertise();
};
extern BLELocalDevice& BLE;
