// The device by the clock of this computer, its serial line on standard output, until it closes.
#include <time.h>
#include <unistd.h>

#include "bench_board.h"
#include "device.h"

struct LiveBoard : BenchBoard {
  bool closed = false;

  uint32_t microseconds() {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<uint32_t>(now.tv_sec * 1000000LL + now.tv_nsec / 1000);
  }
  bool legacy(const uint8_t*, size_t) { return ++frame > 0; }
  bool status(const uint8_t*, size_t) { return true; }
  size_t serialWrite(const uint8_t* data, size_t size) {
    const ssize_t taken = write(STDOUT_FILENO, data, size);
    closed = taken < 0;
    return closed ? size : static_cast<size_t>(taken);
  }
};

int main() {
  static LiveBoard live;
  static lumitip::Device<LiveBoard> device(live);
  device.begin();
  while (!live.closed && live.frame < 60000) {
    device.poll();
    usleep(100);
  }
}
