// Writes and reads packets that a Python test makes up: one request a line, one answer a line.
//   pack <cells> <bits> <design> <sequence> <time> <period> <frames> <codes...> -> hex
//   read <cells> <hex of COBS> -> codes
//   cobs <hex> -> hex
#include <iostream>
#include <sstream>

#include "cobs.h"
#include "packet.h"
#include "reader.h"

using Bytes = std::vector<uint8_t>;

static Bytes fromHex(const std::string& text) {
  Bytes bytes;
  for (size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

static void printHex(const uint8_t* data, size_t size) {
  static const char digits[] = "0123456789abcdef";
  for (size_t i = 0; i < size; ++i) {
    std::cout << digits[data[i] >> 4] << digits[data[i] & 15];
  }
  std::cout << "\n";
}

template <size_t Cells, size_t Bits>
static void pack(std::istream& in) {
  static lumitip::PacketWriter<Cells, Bits, 16 + (6 * Cells * Bits + 7) / 8> writer;
  unsigned long design = 0, sequence = 0, time = 0, period = 0, frames = 0, code = 0;
  in >> design >> sequence >> time >> period >> frames;
  writer.begin(static_cast<uint16_t>(design), static_cast<uint16_t>(sequence),
               static_cast<uint32_t>(time), static_cast<uint16_t>(period));
  for (unsigned long frame = 0; frame < frames; ++frame) {
    uint16_t codes[Cells];
    for (uint16_t& value : codes) {
      in >> code;
      value = static_cast<uint16_t>(code);
    }
    if (!writer.add(codes)) {
      std::cout << "full at " << writer.frames() << "\n";
      return;
    }
  }
  writer.finish();
  printHex(writer.data(), writer.size());
}

template <size_t Cells>
static void packBits(size_t bits, std::istream& in) {
  bits == 8 ? pack<Cells, 8>(in) : bits == 10 ? pack<Cells, 10>(in) : pack<Cells, 12>(in);
}

static void answer(std::istream& in) {
  std::string what, hex;
  size_t cells = 0, bits = 0;
  in >> what;
  if (what == "pack") {
    in >> cells >> bits;
    cells == 1   ? packBits<1>(bits, in)
    : cells == 3 ? packBits<3>(bits, in)
    : cells == 7 ? packBits<7>(bits, in)
                 : packBits<32>(bits, in);
  } else if (what == "read") {
    in >> cells >> hex;
    Bytes packet;
    if (readCobs(fromHex(hex), packet)) {
      for (unsigned code : readPacket(packet, cells)) {
        std::cout << code << " ";
      }
    }
    std::cout << "\n";
  } else if (what == "cobs") {
    in >> hex;
    const Bytes data = fromHex(hex);
    Bytes out(lumitip::cobsBytes(data.size()));
    printHex(out.data(), lumitip::cobsEncode(data.data(), data.size(), out.data()));
  }
}

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in(line);
    answer(in);
  }
}
