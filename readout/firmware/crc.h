// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, not reflected.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace lumitip {

constexpr uint16_t CRC_START = 0xFFFF;

// A byte at a time without a table: the shifts are the polynomial's x^12 + x^5 + 1.
constexpr uint16_t crcOf(uint16_t crc, uint8_t byte) {
  uint32_t c = ((crc >> 8) | (static_cast<uint32_t>(crc) << 8)) & 0xFFFF;
  c ^= byte;
  c ^= (c & 0xFF) >> 4;
  c ^= (c << 12) & 0xFFFF;
  c ^= (c & 0xFF) << 5;
  return static_cast<uint16_t>(c);
}

inline uint16_t crcOf(const uint8_t* data, size_t size) {
  uint16_t crc = CRC_START;
  for (size_t i = 0; i < size; ++i) {
    crc = crcOf(crc, data[i]);
  }
  return crc;
}

}  // namespace lumitip
