// The portable core by itself, for any compiler: everything of the sketch but the board.
#include "device.h"

struct AnyBoard {
  void select(uint8_t line, bool high);
  uint16_t read(uint16_t mux);
  void light(bool on);
  void waitUs(uint32_t us);
  uint32_t microseconds();
  uint16_t mtu();
  bool subscribed();
  bool notify(const uint8_t* data, size_t size);
  bool status(const uint8_t* data, size_t size);
  bool legacy(const uint8_t* data, size_t size);
  bool serialOpen();
  size_t serialWrite(const uint8_t* data, size_t size);
};

template class lumitip::Device<AnyBoard>;
