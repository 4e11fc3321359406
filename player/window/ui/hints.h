/* What a widget of the panel does, in a line that is shown where the pointer rests on it. Pure. */
#ifndef WEFT_PLAYER_WINDOW_UI_HINTS_H
#define WEFT_PLAYER_WINDOW_UI_HINTS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* NULL where the label says it all. A key that does the same stands in brackets at the end. */
const char *weft_hint_of(const char *label);

/* All of them, for the tests: that of `number`, or NULL beyond the last; its label in *label. */
const char *weft_hint_at(size_t number, const char **label);

#ifdef __cplusplus
}
#endif
#endif
