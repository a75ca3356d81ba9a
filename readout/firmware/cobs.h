// COBS: bytes without a zero, so that on a serial line a zero ends each packet.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace lumitip {

// Most bytes that `size` bytes become, with the zero that ends them.
constexpr size_t cobsBytes(size_t size) { return size + size / 254 + 2; }

// Writes the packet and its ending zero to `out`, of cobsBytes(size) bytes; returns how many.
inline size_t cobsEncode(const uint8_t* data, size_t size, uint8_t* out) {
  size_t code = 0;  // where the length of the run being written goes
  size_t end = 1;
  for (size_t i = 0; i < size; ++i) {
    if (data[i] != 0) {
      out[end++] = data[i];
    }
    const bool full = end - code == 255;
    if (data[i] == 0 || (full && i + 1 < size)) {
      out[code] = static_cast<uint8_t>(end - code);
      code = end++;
    }
  }
  out[code] = static_cast<uint8_t>(end - code);
  out[end++] = 0;
  return end;
}

}  // namespace lumitip
