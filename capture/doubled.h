/* Shots of a session that have one and the same photograph. */
#ifndef WEFT_CAPTURE_DOUBLED_H
#define WEFT_CAPTURE_DOUBLED_H

#include "capture/session_check.h"

/* Adds every shot whose photograph has the bytes of one that the journal names before it. Checksums alone would find
 * two in a large session by chance. Errors: WEFT_SYSTEM for memory. */
weft_code weft_find_doubled(const weft_session *session, weft_session_faults *faults, weft_error *error);

#endif
