// The device: scans at a steady rate, makes packets, and hands them to Bluetooth and serial.
// Nothing here blocks but the settling of the inputs, and Bluetooth where its radio has no room
// left. Nothing is allocated.
//
// Board: what a Scanner needs of its Hardware, and
//   microseconds() -> uint32_t
//   mtu() -> ATT MTU in force, 0 while nobody is connected
//   subscribed() -> whether the connected computer asked for packets
//   notify(data, size), status(data, size), legacy(data, size) -> whether Bluetooth took them
//   light(on): switches the emitter, which a design with EMITTER_PIN can
//   serialOpen() -> whether somebody listens; serialWrite(data, size) -> bytes taken at once
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "cobs.h"
#include "packet.h"
#include "scan.h"
#include "status.h"

namespace lumitip {

static_assert(BITS <= ADC_BITS, "BITS: not more than the converter has");

constexpr size_t NOTIFICATION_BYTES = 244;  // the longest that one radio packet carries
constexpr size_t PACKET_BYTES = packetBytes(1, CELLS, BITS) > NOTIFICATION_BYTES
                                    ? packetBytes(1, CELLS, BITS)
                                    : NOTIFICATION_BYTES;

constexpr size_t MOST_FITTING = framesWithin(PACKET_BYTES, CELLS, BITS);
constexpr size_t MOST_IN_TIME =
    LATENCY_US / PERIOD_US < MOST_FITTING ? LATENCY_US / PERIOD_US : MOST_FITTING;

template <class Board>
class Device {
 public:
  explicit Device(Board& board) : board_(board), scanner_(board) {}

  // `faults`: what is known to be wrong already, like WATCHDOG_RESET.
  void begin(uint16_t faults = 0) {
    faults_ = faults;
    scanner_.begin();
    due_ = board_.microseconds();
    tellStatus();
  }

  // To be called as often as can be.
  void poll() {
    pumpSerial();
    const uint32_t now = board_.microseconds();
    if (static_cast<int32_t>(now - due_) < 0) {
      return;
    }
    if (now - due_ >= PERIOD_US) {
      faults_ |= LATE;
      // Frames that there was no time for are counted, so that a reader sees them as lost.
      sequence_ = static_cast<uint16_t>(sequence_ + (now - due_) / PERIOD_US);
      due_ = now;
    }
    due_ += PERIOD_US;
    takeFrame(now);
    tellStatus();
  }

  // How long until the next frame is due (us).
  uint32_t idleUs() {
    const int32_t left = static_cast<int32_t>(due_ - board_.microseconds());
    return left > 0 ? static_cast<uint32_t>(left) : 0;
  }

  uint16_t faults() const { return faults_; }

 private:
  void takeFrame(uint32_t now) {
    scan();
    uint8_t bytes[CELLS];
    for (uint16_t cell = 0; cell < CELLS; ++cell) {
      bytes[cell] = static_cast<uint8_t>(codes_[cell] >> (ADC_BITS - 8));
      codes_[cell] = static_cast<uint16_t>(codes_[cell] >> (ADC_BITS - BITS));
    }
    if (writer_.frames() > 0 && !onTime(now)) {
      send();  // the packet's period would give this frame a wrong time
    }
    if (writer_.frames() == 0) {
      firstUs_ = now;
      writer_.begin(DESIGN_CODE, sequence_, now, PERIOD_US);
    }
    writer_.add(codes_);
    ++sequence_;
    board_.legacy(bytes, CELLS);
    if (writer_.frames() >= batch()) {
      send();
    }
  }

  // With an emitter that can be switched, twice, to take the ambient light off.
  void scan() {
    if (SCANS == 1) {
      scanner_.scan(codes_);
      return;
    }
    scanner_.scan(codes_, [this](bool on) {
      board_.light(on);
      board_.waitUs(EMITTER_US);
    });
    if (scanner_.bright()) {
      faults_ |= AMBIENT;
    }
  }

  bool onTime(uint32_t now) const {
    const uint32_t expected = firstUs_ + static_cast<uint32_t>(writer_.frames()) * PERIOD_US;
    const int32_t off = static_cast<int32_t>(now - expected);
    return off < PERIOD_US / 8 && -off < PERIOD_US / 8;
  }

  // Frames of a packet: as many as fit into a notification and need not wait too long.
  size_t batch() {
    const size_t fit = largestBatch(board_.mtu(), CELLS, BITS);
    const size_t most = fit > 0 && fit < MOST_IN_TIME ? fit : MOST_IN_TIME;
    return most > 0 ? most : 1;
  }

  void send() {
    writer_.finish();
    if (board_.serialOpen()) {
      if (serialAt_ < serialSize_) {
        faults_ |= SERIAL_FULL;
      } else {
        serialAt_ = 0;
        serialSize_ = cobsEncode(writer_.data(), writer_.size(), serial_);
        pumpSerial();
      }
    }
    // A packet begun at a larger MTU is left out rather than cut off.
    if (board_.subscribed() && writer_.size() + ATT_BYTES <= board_.mtu()) {
      if (!board_.notify(writer_.data(), writer_.size())) {
        faults_ |= NOTIFY_FAILED;
      }
    }
    writer_.begin(0, 0, 0, 0);
  }

  void pumpSerial() {
    if (!board_.serialOpen()) {
      serialAt_ = serialSize_;
    } else if (serialAt_ < serialSize_) {
      serialAt_ += board_.serialWrite(serial_ + serialAt_, serialSize_ - serialAt_);
    }
  }

  void tellStatus() {
    const uint16_t mtu = board_.mtu();
    const bool tooSmall = board_.subscribed() && mtu < neededMtu(CELLS, BITS);
    faults_ = static_cast<uint16_t>(tooSmall ? faults_ | MTU_TOO_SMALL : faults_ & ~MTU_TOO_SMALL);
    uint8_t status[STATUS_BYTES];
    writeStatus(mtu, faults_, status);
    if (memcmp(status, status_, STATUS_BYTES) != 0) {
      memcpy(status_, status, STATUS_BYTES);
      board_.status(status_, STATUS_BYTES);
    }
  }

  Board& board_;
  Scanner<Board> scanner_;
  PacketWriter<CELLS, BITS, PACKET_BYTES> writer_;
  uint16_t codes_[CELLS] = {};
  uint32_t due_ = 0;
  uint32_t firstUs_ = 0;
  uint16_t sequence_ = 0;
  uint16_t faults_ = 0;
  uint8_t status_[STATUS_BYTES] = {};
  uint8_t serial_[cobsBytes(PACKET_BYTES)] = {};
  size_t serialSize_ = 0;
  size_t serialAt_ = 0;
};

}  // namespace lumitip
