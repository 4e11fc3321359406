/* Files in the folder of a session that are none of its own. */
#ifndef WEFT_CAPTURE_FOREIGN_H
#define WEFT_CAPTURE_FOREIGN_H

#include "capture/session_check.h"

/* Adds every file, and every folder of files, that belongs to no shot of the plan and is no part of a session; and what
 * a capture leaves that is killed. Other hidden files are somebody's business. Errors: WEFT_SYSTEM. */
weft_code weft_find_foreign(const weft_session *session, weft_session_faults *faults, weft_error *error);

#endif
