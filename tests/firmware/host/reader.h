// Reads packets as another computer would: written from the description, not from the firmware.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include <string>
#include <vector>

inline bool readCobs(const std::vector<uint8_t>& in, std::vector<uint8_t>& out) {
  size_t at = 0;
  while (at < in.size()) {
    const size_t code = in[at];
    if (code == 0 || at + code > in.size()) {
      return false;
    }
    out.insert(out.end(), in.begin() + at + 1, in.begin() + at + code);
    at += code;
    if (code < 255 && at < in.size()) {
      out.push_back(0);
    }
  }
  return true;
}

// Frames' codes in order, empty if the packet is damaged.
inline std::vector<unsigned> readPacket(const std::vector<uint8_t>& packet, size_t cells) {
  std::vector<unsigned> codes;
  unsigned crc = 0xFFFF;
  for (size_t i = 0; i + 2 < packet.size(); ++i) {
    crc ^= packet[i] << 8;
    for (int bit = 0; bit < 8; ++bit) {
      crc = crc & 0x8000 ? (crc << 1 ^ 0x1021) & 0xFFFF : crc << 1;
    }
  }
  const size_t end = packet.size() - 2;
  if (packet.size() < 16 || crc != static_cast<unsigned>(packet[end] | packet[end + 1] << 8)) {
    return codes;
  }
  const unsigned bits = packet[7];
  for (size_t i = 0; i < packet[6] * cells; ++i) {
    unsigned code = 0;
    for (unsigned bit = 0; bit < bits; ++bit) {
      const size_t at = i * bits + bit;
      code |= (packet[14 + at / 8] >> at % 8 & 1u) << bit;
    }
    codes.push_back(code);
  }
  return codes;
}
