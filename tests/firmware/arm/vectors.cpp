// The first words that a Cortex-M reads: its stack, and where to begin. newlib does the rest.
extern "C" {
extern unsigned char stack_top;
void _start(void);

struct Vectors {
  const void* stack;
  void (*entry)(void);
};
extern const Vectors VECTORS;
__attribute__((section(".vectors"), used)) const Vectors VECTORS = {&stack_top, _start};
}
