// ESP-IDF's watchdog of tasks, whose interface changed between the versions 4 and 5.
#pragma once

#include <stdint.h>

#include "esp_idf_version.h"

typedef int esp_err_t;
typedef void* TaskHandle_t;
extern "C" {
#if ESP_IDF_VERSION_MAJOR >= 5
typedef struct {
  uint32_t timeout_ms;
  uint32_t idle_core_mask;
  bool trigger_panic;
} esp_task_wdt_config_t;
esp_err_t esp_task_wdt_reconfigure(const esp_task_wdt_config_t* config);
#else
esp_err_t esp_task_wdt_init(uint32_t timeout, bool panic);
#endif
esp_err_t esp_task_wdt_add(TaskHandle_t task);
esp_err_t esp_task_wdt_reset(void);
}
