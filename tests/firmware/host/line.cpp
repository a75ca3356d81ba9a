// The device with its serial line on standard output, until it closes. Its clock stands still while
// this computer does other work: no frame is missed for want of time.
#include <unistd.h>

#include "bench_board.h"
#include "device.h"

struct LiveBoard : BenchBoard {
  bool closed = false;

  bool legacy(const uint8_t*, size_t) { return ++frame > 0; }
  bool status(const uint8_t*, size_t) { return true; }
  size_t serialWrite(const uint8_t* data, size_t size) {
    const ssize_t taken = write(STDOUT_FILENO, data, size);
    closed = taken < 0;
    return closed ? size : static_cast<size_t>(taken);
  }
};

int main() {
  constexpr uint32_t STEP_US = 100;
  static LiveBoard live;
  static lumitip::Device<LiveBoard> device(live);
  device.begin();
  while (!live.closed && live.frame < 60000) {
    device.poll();
    usleep(STEP_US);
    live.us += STEP_US;
  }
}
