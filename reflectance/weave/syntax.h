/* The two halves of reading a weave that need no quadrature. Private to the room. */
#ifndef WEFT_REFLECTANCE_WEAVE_SYNTAX_H
#define WEFT_REFLECTANCE_WEAVE_SYNTAX_H

#include "reflectance/weave/weave.h"

enum { WEFT_WEAVE_MAX_YARNS = 4096 };

/* What the text says, all of it checked except whether the model has such segments. Frees what it allocated on failure.
 */
weft_code weft_weave_parse_text(const char *text, const char *path, const weft_parameter *parameters,
                                int parameter_count, weft_weave *weave, weft_error *error);

/* Fills what follows from the text: admissibility, prepared segments, shares. `warning` as in weft_weave_read. */
void weft_weave_derive(weft_weave *weave, const char *path, char warning[WEFT_MESSAGE_SIZE]);

#endif
