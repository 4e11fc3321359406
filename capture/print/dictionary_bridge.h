/* The markers of OpenCV's dictionaries. */
#ifndef WEFT_CAPTURE_PRINT_DICTIONARY_BRIDGE_H
#define WEFT_CAPTURE_PRINT_DICTIONARY_BRIDGE_H

#include "base/status.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_BOARD_MARKER_CELLS = 7 };

/* The cells of marker `id` of DICT_5X5_100 with its border: rows from the top, 1: ink. Errors: WEFT_SYSTEM with the
 * library's message. */
weft_code weft_board_marker(int id, uint8_t cell[WEFT_BOARD_MARKER_CELLS][WEFT_BOARD_MARKER_CELLS], weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
