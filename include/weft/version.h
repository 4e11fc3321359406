/* The version of Weft. */
#ifndef WEFT_VERSION_H
#define WEFT_VERSION_H

#include "weft/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of these headers. Until 1.0 a new minor version may change the interface; a patch never does. */
#define WEFT_VERSION_MAJOR 0
#define WEFT_VERSION_MINOR 2
#define WEFT_VERSION_PATCH 0

/* "MAJOR.MINOR.PATCH" of the library that is loaded. Static; thread-safe. */
WEFT_API const char *weft_version(void);

#ifdef __cplusplus
}
#endif
#endif
