// A device through everything that can happen to it; prints all that it sends. The same source
// runs on the computer and on a Cortex-M4.
#include "bench_board.h"
#include "device.h"

static BenchBoard bench;
static lumitip::Device<BenchBoard> device(bench);

static void frames(uint32_t count) {
  const uint32_t end = bench.frame + count;
  while (bench.frame < end) {
    device.poll();
    bench.us += 50;
  }
}

static void phase(const char* name) { printf("phase %s\n", name); }

int main() {
  bench.us = 0u - 65530u * lumitip::PERIOD_US;  // soon to wrap while it is looked at
  device.begin(lumitip::WATCHDOG_RESET);
  bench.muted = true;
  frames(65520);  // sequence numbers soon wrap
  bench.muted = false;

  phase("serial");
  frames(24);
  phase("mtu_23");
  bench.attMtu = 23;
  bench.asked = true;
  frames(24);
  phase("just_enough");
  bench.attMtu = static_cast<uint16_t>(lumitip::neededMtu(lumitip::CELLS, lumitip::BITS));
  frames(24);
  phase("mtu_247");
  bench.attMtu = 247;
  frames(24);
  phase("not_asked");
  bench.asked = false;
  frames(24);
  phase("refused");
  bench.asked = true;
  bench.takesNotifications = false;
  frames(24);
  phase("serial_stuck");
  bench.takesNotifications = true;
  bench.serialRoom = 0;
  frames(24);
  phase("serial_slow");
  bench.serialRoom = 7;
  frames(24);
  phase("serial_closed");
  bench.open = false;
  frames(24);
  phase("late");
  bench.us += 3 * lumitip::PERIOD_US;
  bench.frame += 2;  // the third one is read, late
  frames(24);
  phase("jitter");
  for (int i = 0; i < 24; ++i) {
    frames(1);
    bench.us += i % 3 == 0 ? lumitip::PERIOD_US / 10 * 9 : 0;
  }
  phase("serial_cut");
  bench.open = true;
  bench.serialRoom = 1;
  frames(24);
  bench.open = false;
  frames(24);
  phase("serial_reopened");
  bench.open = true;
  bench.serialRoom = 1000;
  frames(24);
  printf("selects %u unsettled %u\n", bench.selects, bench.unsettled);
  return 0;
}
