// Scans with several conversions a value, and without ambient light.
#include "bench_board.h"

struct Noisy : BenchBoard {
  unsigned reads = 0;
  uint16_t read(uint16_t) {
    us += 15;
    return static_cast<uint16_t>(100 + (reads++ % 4));  // mean 101.5
  }
};

struct Lit : BenchBoard {
  bool lit = true;
  uint16_t ambient = 300;
  // Of the full scale ambient light takes some, the emitter 1000 and 17 more for each channel. The
  // converter tells no more than its greatest reading.
  uint16_t read(uint16_t mux) {
    const uint16_t through = lit ? 1000 + static_cast<uint16_t>(17 * mux) : 0;
    const uint16_t code = static_cast<uint16_t>(lumitip::FULL_SCALE - ambient - through);
    return code < lumitip::CEILING ? code : lumitip::CEILING;
  }
};

static void print(const uint16_t* codes) {
  for (unsigned cell = 0; cell < lumitip::CELLS; ++cell) {
    printf("%u ", codes[cell]);
  }
  printf("\n");
}

int main() {
  uint16_t codes[lumitip::CELLS] = {};
  Noisy noisy;
  lumitip::Scanner<Noisy, 4> averaging(noisy);
  averaging.begin();
  averaging.scan(codes);
  print(codes);

  Lit board;
  lumitip::Scanner<Lit> scanner(board);
  scanner.begin();
  const auto light = [&](bool on) { board.lit = on; };
  scanner.scan(codes, light);
  print(codes);
  board.ambient = 0;
  scanner.scan(codes, light);
  print(codes);
  for (unsigned quarter = 1; quarter <= 3; ++quarter) {
    board.ambient = static_cast<uint16_t>(lumitip::FULL_SCALE / 4 * quarter);
    board.ambient = static_cast<uint16_t>(board.ambient + (quarter == 3 ? 10 : 0));
    scanner.scan(codes, light);
    printf("%d ", scanner.bright());
  }
  printf("\n");

  BenchBoard order;
  lumitip::Scanner<BenchBoard> once(order);
  once.begin();
  const unsigned before = order.selects;
  once.scan(codes);
  const unsigned first = order.selects - before;
  once.scan(codes);
  printf("%u %u %u\n", first, order.selects - before - first, order.unsettled);

  const uint32_t began = order.us;
  once.scan(codes);
  printf("%u %u\n", order.us - began, lumitip::SHORTEST_US);
}
