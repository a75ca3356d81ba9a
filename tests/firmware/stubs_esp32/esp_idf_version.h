// Which ESP-IDF the core is made with: 4 in Arduino's own board package, 5 in Espressif's.
#pragma once

#ifndef ESP_IDF_VERSION_MAJOR
#define ESP_IDF_VERSION_MAJOR 5
#endif
