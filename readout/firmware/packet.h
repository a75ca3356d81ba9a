// Packets of protocol version 2: header, codes packed from the lowest bit on, CRC; little-endian.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "crc.h"
#include "protocol.h"

namespace lumitip {

constexpr size_t HEADER_BYTES = 14;
constexpr size_t CRC_BYTES = 2;
constexpr size_t ATT_BYTES = 3;  // of an ATT MTU, what a notification spends on its own header
constexpr size_t MOST_FRAMES = 255;

constexpr size_t packetBytes(size_t frames, size_t cells, size_t bits) {
  return HEADER_BYTES + (frames * cells * bits + 7) / 8 + CRC_BYTES;
}

constexpr size_t neededMtu(size_t cells, size_t bits) {
  return ATT_BYTES + packetBytes(1, cells, bits);
}

// Whole frames that fit into `bytes` bytes; 0 where not even one does.
constexpr size_t framesWithin(size_t bytes, size_t cells, size_t bits) {
  const size_t least = HEADER_BYTES + CRC_BYTES;
  const size_t fit = bytes < least ? 0 : (bytes - least) * 8 / (cells * bits);
  return fit < MOST_FRAMES ? fit : MOST_FRAMES;
}

constexpr size_t largestBatch(size_t mtu, size_t cells, size_t bits) {
  return mtu < ATT_BYTES ? 0 : framesWithin(mtu - ATT_BYTES, cells, bits);
}

// Collects frames into one packet of at most `Capacity` bytes.
template <size_t Cells, size_t Bits, size_t Capacity>
class PacketWriter {
  static_assert(Bits == 8 || Bits == 10 || Bits == 12, "a packet's codes have 8, 10 or 12 bits");
  static_assert(framesWithin(Capacity, Cells, Bits) >= 1, "a packet holds at least one frame");

 public:
  static constexpr size_t CAPACITY_FRAMES = framesWithin(Capacity, Cells, Bits);

  void begin(uint16_t design, uint16_t sequence, uint32_t timeUs, uint16_t periodUs) {
    size_ = 0;
    frames_ = 0;
    held_ = 0;
    heldBits_ = 0;
    put(MAGIC, 1);
    put(VERSION, 1);
    put(design, 2);
    put(sequence, 2);
    put(0, 1);  // how many frames: written when they are known
    put(Bits, 1);
    put(timeUs, 4);
    put(periodUs, 2);
  }

  // Adds a frame of `Cells` codes below 2^Bits; false, and nothing added, if there is no room.
  bool add(const uint16_t* codes) {
    if (frames_ >= CAPACITY_FRAMES) {
      return false;
    }
    for (size_t i = 0; i < Cells; ++i) {
      held_ |= static_cast<uint32_t>(codes[i] & MASK) << heldBits_;
      heldBits_ += Bits;
      while (heldBits_ >= 8) {
        bytes_[size_++] = static_cast<uint8_t>(held_);
        held_ >>= 8;
        heldBits_ -= 8;
      }
    }
    ++frames_;
    return true;
  }

  // Ends the packet; its bytes are then data(), size() of them, until the next begin().
  void finish() {
    if (heldBits_ > 0) {
      bytes_[size_++] = static_cast<uint8_t>(held_);
      heldBits_ = 0;
    }
    bytes_[FRAMES_AT] = static_cast<uint8_t>(frames_);
    put(crcOf(bytes_, size_), 2);
  }

  size_t frames() const { return frames_; }
  size_t size() const { return size_; }
  const uint8_t* data() const { return bytes_; }

 private:
  static constexpr uint32_t MASK = (1u << Bits) - 1;
  static constexpr size_t FRAMES_AT = 6;

  void put(uint32_t value, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      bytes_[size_++] = static_cast<uint8_t>(value >> (8 * i));
    }
  }

  uint8_t bytes_[Capacity] = {};
  size_t size_ = 0;
  size_t frames_ = 0;
  uint32_t held_ = 0;
  size_t heldBits_ = 0;
};

}  // namespace lumitip
