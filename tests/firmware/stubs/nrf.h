// The registers of the nRF52840 that the sketch uses, with the values of its product specification.
#pragma once

#include <stdint.h>

struct NRF_WDT_Type {
  volatile uint32_t TASKS_START;
  volatile uint32_t CRV;
  volatile uint32_t RREN;
  volatile uint32_t CONFIG;
  volatile uint32_t RR[8];
};
struct NRF_POWER_Type {
  volatile uint32_t RESETREAS;
};
extern NRF_WDT_Type watchdogRegisters;
extern NRF_POWER_Type powerRegisters;
#define NRF_WDT (&watchdogRegisters)
#define NRF_POWER (&powerRegisters)
#define WDT_CONFIG_SLEEP_Pos (0UL)
#define WDT_CONFIG_SLEEP_Run (1UL)
#define WDT_RREN_RR0_Msk (0x1UL)
#define WDT_RR_RR_Reload (0x6E524635UL)
#define POWER_RESETREAS_DOG_Msk (0x2UL)
