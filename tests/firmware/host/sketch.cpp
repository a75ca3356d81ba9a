// The sketch itself on a board that is played: pins, Bluetooth that cuts off at the MTU as
// ArduinoBLE does, a serial line, registers. Prints what happens to it.
#include <stdio.h>
#include <string.h>

#include <map>
#include <string>

#include "firmware.ino"

NRF_WDT_Type watchdogRegisters;
NRF_POWER_Type powerRegisters;
USBSerial Serial;

struct Played {
  std::string uuid;
  bool asked;
};

static std::map<const BLECharacteristic*, Played>& characteristics() {
  static std::map<const BLECharacteristic*, Played> all;
  return all;
}

static struct {
  uint32_t us = 0;
  bool bluetooth = true;
  bool connected = false;
  uint16_t mtu = 23;
  bool serialOpen = false;
  int level[32] = {};
  int rises = 0;
  int rests = 0;
  uint32_t onUs = 0;
  uint32_t litUs = 0;
} world;

static void print(const std::string& what, const uint8_t* data, size_t size) {
  printf("%s ", what.c_str());
  for (size_t i = 0; i < size; ++i) {
    printf("%02x", data[i]);
  }
  printf("\n");
}

void pinMode(pin_size_t pin, PinMode mode) { printf("pin %d %d\n", pin, mode); }
void digitalWrite(pin_size_t pin, PinStatus level) {
  if (pin == LED_BUILTIN && level != world.level[pin]) {
    world.rises += level;
    world.onUs += level == HIGH ? 0 : world.us - world.litUs;
    world.litUs = world.us;
  }
  world.level[pin] = level;
}
int analogRead(pin_size_t pin) {
  static const int lines[] = {LUMITIP_SELECT_PINS};
  int channel = 0;
  for (int line = 0; line < lumitip::SELECT_LINES; ++line) {
    channel |= world.level[lines[line]] << line;
  }
  world.us += 15;
  const int code = ((pin - A0) * 977 + channel * 131) & 4095;
  if (lumitip::EMITTER_PIN < 0) {
    return code;
  }
  // Room light takes 200 off, of codes that the emitter leaves above it.
  const bool lit = world.level[lumitip::EMITTER_PIN] == HIGH;
  const int floor = code > 300 ? code : 300;
  return (lit ? floor : 4095) - 200;
}
void analogReadResolution(int bits) { printf("resolution %d\n", bits); }
unsigned long micros() { return world.us; }
unsigned long millis() { return world.us / 1000; }
void delay(unsigned long ms) {
  world.us += 1000 * ms + 990;  // Mbed sleeps for whole ticks, and begins within one
  ++world.rests;
}
void delayMicroseconds(unsigned int us) { world.us += us; }

void USBSerial::begin(unsigned long) {}
bool USBSerial::connected() { return world.serialOpen; }
void USBSerial::send_nb(uint8_t* buffer, uint32_t size, uint32_t* actual, bool) {
  *actual = size < 64 ? size : 64;
  print("serial", buffer, *actual);
}

BLECharacteristic::BLECharacteristic(const char* uuid, uint16_t permissions, int size, bool fixed) {
  characteristics()[this] = {uuid, false};
  printf("characteristic %s %u %d %d\n", uuid, permissions, size, fixed);
}
BLECharacteristic::~BLECharacteristic() {}
int BLECharacteristic::writeValue(const uint8_t value[], int length) {
  const Played& played = characteristics()[this];
  if (world.connected && played.asked) {
    const int room = world.mtu - 3;
    print(played.uuid, value, length < room ? length : room);
  }
  return 1;
}
bool BLECharacteristic::subscribed() { return characteristics()[this].asked; }

BLEService::BLEService(const char*) {}
BLEService::~BLEService() {}
void BLEService::addCharacteristic(BLECharacteristic& added) {
  printf("serves %s\n", characteristics()[&added].uuid.c_str());
}

static BLELocalDevice radio;
BLELocalDevice& BLE = radio;
BLELocalDevice::~BLELocalDevice() {}
int BLELocalDevice::begin() { return world.bluetooth; }
void BLELocalDevice::poll() {}
bool BLELocalDevice::connected() const { return world.connected; }
void BLELocalDevice::setLocalName(const char* name) { printf("name %s\n", name); }
void BLELocalDevice::setDeviceName(const char*) {}
void BLELocalDevice::setConnectionInterval(uint16_t least, uint16_t most) {
  printf("interval %u %u\n", least, most);
}
void BLELocalDevice::setSupervisionTimeout(uint16_t timeout) { printf("timeout %u\n", timeout); }
void BLELocalDevice::setAdvertisedService(const BLEService&) {}
void BLELocalDevice::addService(BLEService&) {}
int BLELocalDevice::advertise() { return 1; }

static ATTClass layer;
ATTClass& ATT = layer;
ATTClass::~ATTClass() {}
bool ATTClass::connected() const { return world.connected; }
// The connection in use has handle 2 here; all others answer 23, as ArduinoBLE does.
uint16_t ATTClass::mtu(uint16_t handle) const { return handle == 2 ? world.mtu : 23; }

static void phase(const char* name) {
  printf("phase %s\n", name);
  world.rises = 0;
  world.rests = 0;
  world.onUs = 0;
  world.litUs = world.us;
  unsigned unfed = 0;
  for (const uint32_t end = world.us + 2048000; static_cast<int32_t>(end - world.us) > 0;) {
    watchdogRegisters.RR[0] = 0;
    loop();
    unfed += watchdogRegisters.RR[0] != WDT_RR_RR_Reload;
    world.us += 100;
  }
  const uint32_t onUs = world.onUs + (world.level[LED_BUILTIN] ? world.us - world.litUs : 0);
  printf("light %d %u\nunfed %u\nrests %d\n", world.rises, onUs / 1000, unfed, world.rests);
}

static void ask(bool asked) {
  for (auto& entry : characteristics()) {
    entry.second.asked = asked;
  }
}

int main(int count, char** arguments) {
  world.bluetooth = count < 2 || strcmp(arguments[1], "silent") != 0;
  powerRegisters.RESETREAS = POWER_RESETREAS_DOG_Msk;
  setup();
  printf("watchdog %u %u\n", watchdogRegisters.TASKS_START, watchdogRegisters.CRV);
  phase("alone");
  if (world.bluetooth) {
    world.connected = true;
    ask(true);
    phase("mtu_23");
    world.mtu = 247;
    phase("mtu_247");
    world.connected = false;
    ask(false);
  }
  world.serialOpen = true;
  phase("serial");
}
